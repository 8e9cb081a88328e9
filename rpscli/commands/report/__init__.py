"""`rps report`."""
