"""Largest demands of one history, without its samples: what studies are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.failure import failure_text
from rpscli.analyses.kernel_input import (
    floor_parameters,
    ground_parameters,
    numerics,
    podium_parameters,
)
from rpscli.analyses.results import Outcome
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import OUTCOMES
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout
from rpscli.records.ground_motion import GroundMotion


@dataclass(frozen=True, eq=False)
class Demand:
    """Largest demands of a history; names as in `TimeHistoryResult`."""

    outcome: Outcome
    failure: str | None
    max_rotation: float
    critical_passage_time: float | None
    storey_shears: NDArray[np.float64]
    floor_accelerations: NDArray[np.float64]
    friction_demand: float
    energy_input: float
    energy_impact: float
    energy_created: float
    creating_impacts: int
    uplifts: int
    impacts: int
    duration: float


def demand(
    structure: PodiumStructure,
    record: GroundMotion,
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
) -> Demand:
    """Largest demands of the structure under a record; the kernel runs without the GIL.

    The numbers are those of `time_history`, bit for bit: both run the same kernel.
    """
    from rpscli.physics.driver import integrate  # noqa: PLC0415

    settings = settings or TimeHistorySettings()
    history = integrate(
        podium_parameters(structure, settings),
        floor_parameters(structure.superstructure),
        ground_parameters(record, vertical),
        numerics(structure, record.dt, settings),
        np.empty((0, layout.ROW_FLOORS + 2 * structure.storeys)),
        np.empty((0, layout.LOG_COLUMNS)),
    )
    given, _, lost, _ = (float(e) for e in history.energies)
    return Demand(
        outcome=OUTCOMES.get(int(history.outcome), "failed"),
        failure=failure_text(history),
        max_rotation=float(history.max_rotation),
        critical_passage_time=float(history.critical_time) if history.critical_time >= 0 else None,
        storey_shears=history.storey_shears,
        floor_accelerations=history.floor_accelerations,
        friction_demand=float(max(*history.contacts[: layout.NORMAL_TOP])),
        energy_input=given,
        energy_impact=lost,
        energy_created=float(history.energy_created),
        creating_impacts=int(history.creating_impacts),
        uplifts=int(history.counts[layout.UPLIFT]),
        impacts=int(history.counts[layout.IMPACT]),
        duration=float(history.time),
    )
