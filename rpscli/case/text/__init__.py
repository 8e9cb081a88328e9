"""Text files as plain values that know where they were written."""
