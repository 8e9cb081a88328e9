"""`rps design`."""
