"""Compiled kernels on plain floats and arrays; no strings, no exceptions, no files.

`geometry` holds the contact geometry, `uplifted` the equation of motion, `contact` the exact
solution while every column stands on its flat ends, `events` and `impact` what happens between
them, `driver` the loop that strings them together.
"""
