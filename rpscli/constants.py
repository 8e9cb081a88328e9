"""Constants of physics, SI, and of the program."""

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s2] (3rd CGPM, 1901)."""

MOST_STOREYS = 200
"""Storeys that there is room for."""

MOST_JOBS = 1024
"""Threads of one study; systems refuse to start many thousands."""
