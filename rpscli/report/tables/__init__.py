"""Columns and quantities of the files and documents of each analysis."""
