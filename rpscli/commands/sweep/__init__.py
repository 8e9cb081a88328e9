"""`rps sweep`."""
