"""Certified problems: each solved by two roads that share nothing."""
