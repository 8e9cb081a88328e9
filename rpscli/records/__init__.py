"""Ground motions: files, sets, pulses and synthetic ones, and what they measure."""
