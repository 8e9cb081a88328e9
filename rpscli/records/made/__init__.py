"""Ground motions that nobody recorded: pulses and seeded noise."""
