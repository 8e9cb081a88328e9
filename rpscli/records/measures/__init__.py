"""What a ground motion measures: integrals, intensities, spectra."""
