"""What the files and documents of each analysis hold, as columns and quantities."""
