"""Structures as files that other programs run."""
