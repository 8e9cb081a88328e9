"""Physical constants, SI."""

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s2] (3rd CGPM, 1901)."""
