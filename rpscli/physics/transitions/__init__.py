"""From one phase of motion to the next: uplift, roll, rock, impact, re-contact."""
