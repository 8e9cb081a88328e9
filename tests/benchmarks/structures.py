"""The structures and ground motions that the benchmarks share."""

from __future__ import annotations

import numpy as np

from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping, Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

SECONDS = 40.0
STEP = 0.005
PEAK = "0.5g"


def structure(storeys: int, rho: float = 0.5, period: float | None = None) -> PodiumStructure:
    """The paper's building: T_1 = n/10 s or `period`, gamma = 10, eta = n, the rigid law."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, period or storeys / 10, "sine")
    building = Superstructure(masses, stiffnesses, RayleighDamping(0.05, (1, 2)))
    return PodiumStructure(Bearing(1.5, 0.15, 0.30, rho), 2e4, 2e5, building, ImpactLaw("rigid"))


def motion(seed: int, *, duration: float = SECONDS, peak: str = PEAK) -> GroundMotion:
    """A synthetic record at 200 Hz."""
    return load_record(f"synthetic:?pga={peak}&duration={duration}&dt={STEP}&seed={seed}")


def motions(count: int) -> list[GroundMotion]:
    """Synthetic records of 40 s at 200 Hz, seeds from 1 up."""
    return [motion(seed) for seed in range(1, count + 1)]
