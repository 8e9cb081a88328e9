"""The podium in a vertical plane: its equation of motion, steps, events, and results."""
