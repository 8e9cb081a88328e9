"""Devices between ground and cap beam: forces, series, energy, events (Theory, section 11)."""
