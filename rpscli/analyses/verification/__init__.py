"""What an installation is verified by."""
