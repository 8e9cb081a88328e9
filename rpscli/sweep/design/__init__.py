"""The search for a design: where it looks, how designs are judged, and what it answers."""
