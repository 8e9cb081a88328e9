"""Studies: many histories, resumable."""
