"""Spectra that motions are chosen to fit: a table, or the design spectra of codes."""
