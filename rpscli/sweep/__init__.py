"""Studies: many histories from one case, resumable."""
