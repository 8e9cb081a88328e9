"""A vibration that goes on after the rocking: what locking leaves of it."""

from __future__ import annotations

import numpy as np

from .crossings import Array
from .devices import OracleDevice
from .second_integrator import simulate
from .storey_lagrangian import OracleSystem


def drifts_at_the_end(system: OracleSystem, tolerance: float, *devices: OracleDevice) -> Array:
    """Drifts at the last samples, upright, after a release from 0.02 rad."""
    result = simulate(
        system,
        np.zeros(1),
        0.02,
        free_vibration=2.0,
        recontact_tolerance=tolerance,
        initial_rotation=0.02,
        devices=devices,
    )
    assert result.theta[-1] == 0.0
    return result.drifts[-20:]
