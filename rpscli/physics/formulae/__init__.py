"""Mathematics that knows no lane: contact geometry, oscillator, polynomials."""
