"""Rocking podium structures: multi-storey buildings on kinematic bearings."""
