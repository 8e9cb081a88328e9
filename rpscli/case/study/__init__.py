"""Studies: what their files may say, checked."""
