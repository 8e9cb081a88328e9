"""What the histories of a study say together: shares, fractiles, verdicts."""
