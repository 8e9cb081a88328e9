"""Rules that join several keys of a case."""
