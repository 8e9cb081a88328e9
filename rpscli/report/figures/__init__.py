"""Pictures of each analysis."""
