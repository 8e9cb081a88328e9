"""Stability of a slab against turning about the vertical, by the plan of its columns.

Displaced by u along e and turned by a small psi, a slab that warps freely gains the energy
psi^2 W [r_par^2 F/(W u) + r_perp^2 F'/W]/2 (Theory (17.12)): each column follows its own
head, and the force F of one that moved on is smaller. Where that is below zero a turn grows.
"""

from __future__ import annotations

import numpy as np

from rpscli.model.podium import PodiumStructure

PARTS = 2000
"""Of the critical rotation, at which stability is looked at."""


def plan_of(structure: PodiumStructure) -> np.ndarray | None:
    """(N, 2) places of the columns from their centre [m]; None without rows in x and y."""
    if not (structure.rows and structure.rows_y):
        return None
    x, y = np.meshgrid(structure.rows, structure.rows_y)
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    return np.asarray(places - places.mean(axis=0))


def unstable_from(structure: PodiumStructure) -> float | None:
    """Least displacement of the cap beam over the critical one from which a turn grows.

    Along x or y, whichever comes first, without friction in pivoting, devices and storeys
    that twist; None without a plan in both directions, or where no turn grows.
    """
    places = plan_of(structure)
    if places is None:
        return None
    tilt = np.linspace(0.0, structure.critical_rotation, PARTS + 1)[1:]
    force, moved, _ = structure.path(tilt)
    slope = np.gradient(force, moved)
    squares = (places**2).mean(axis=0)
    unstable = [
        moved[growing][0]
        for along, across in (squares, squares[::-1])
        if (growing := along * force / moved + across * slope < 0.0).any()
    ]
    return float(min(unstable) / moved[-1]) if unstable else None
