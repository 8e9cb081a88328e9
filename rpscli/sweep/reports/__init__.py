"""The numbers of each kind of report."""
