"""Tables and figures of a search for a design."""
