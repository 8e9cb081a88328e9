"""Structures and records in, histories out: what the analyses hand
to the compiled kernels.
"""
