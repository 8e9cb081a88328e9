"""What measurements on a standing structure say about it."""
