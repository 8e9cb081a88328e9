"""Heights in pictures of the structure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.model.podium import PodiumStructure

STOREY_HEIGHT = 3.0
"""Where the case gives none [m]."""


def level_heights(structure: PodiumStructure) -> NDArray[np.float64]:
    """Heights of the cap beam and of the floors above it at rest, (n + 1,) [m]."""
    column = 2.0 * structure.bearing.half_height
    building = structure.superstructure
    if building is None:
        return np.array([column])
    heights = building.storey_heights
    storeys = np.full(building.storeys, STOREY_HEIGHT) if heights is None else heights
    return column + np.concatenate([[0.0], np.cumsum(storeys)])
