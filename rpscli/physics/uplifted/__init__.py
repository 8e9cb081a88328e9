"""The uplifted storey: Taylor steps of all lanes together, and what is decided lane by lane."""
