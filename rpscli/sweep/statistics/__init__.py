"""Statistics of the histories of a study: shares, fractiles, verdicts."""
