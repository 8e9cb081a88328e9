"""Design files: what may change in a case, what is required of it, and what is to be least."""
