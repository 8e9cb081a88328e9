"""Structure, record and settings in; frozen results out."""
