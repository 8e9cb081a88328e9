"""Which points a study has."""
