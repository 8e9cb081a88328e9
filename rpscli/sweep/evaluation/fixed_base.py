"""The building of a system on a fixed base."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.fixed_base import fixed_base_shears
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion


def reference_shears(structure: PodiumStructure, motion: GroundMotion) -> NDArray[np.float64]:
    """Largest storey shears (n,) [N] from the bottom, under an unscaled motion."""
    building = structure.superstructure
    assert building is not None, "only buildings have a response"
    # The largest shear after the end of the record comes within a period.
    after = math.ceil(float(building.periods[0]) / motion.dt)
    return fixed_base_shears(building, motion, motion.npts - 1 + after)
