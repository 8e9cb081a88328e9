"""Record files: one module a format, and the registry that recognises them."""
