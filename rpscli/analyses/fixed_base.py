"""The same building without bearings, as a yardstick."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.model.superstructure import Superstructure
from rpscli.physics.parameters import Floors, Ground


@dataclass(frozen=True, eq=False)
class FixedBaseResponse:
    """Exact linear response of the building on a fixed base."""

    storey_shears: NDArray[np.float64]
    """(n,) largest k_i d_i [N], from the bottom."""
    floor_accelerations: NDArray[np.float64]
    """(n,) largest absolute accelerations [m/s2]."""
    floor_displacements: NDArray[np.float64]
    """(samples, n) relative to the ground [m]."""
    drifts: NDArray[np.float64]
    """(n,) largest storey drifts [m]."""

    @property
    def base_shear(self) -> float:
        """Largest elastic base shear [N]."""
        return float(self.storey_shears[0])


def fixed_base_response(
    building: Superstructure, floors: Floors, ground: Ground, intervals: int
) -> FixedBaseResponse:
    """Run the building on a fixed base for a number of sampling intervals."""
    from rpscli.physics.fixed_base import integrate_fixed_base  # noqa: PLC0415

    n = building.storeys
    samples = np.empty((intervals + 1, 2 * n))
    shears, accelerations = integrate_fixed_base(floors, ground, intervals, samples)
    return FixedBaseResponse(
        storey_shears=shears,
        floor_accelerations=accelerations,
        floor_displacements=samples[:, :n],
        drifts=shears / building.stiffnesses,
    )
