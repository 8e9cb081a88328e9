"""Largest demands of many histories, without their samples: what studies are made of.

>>> from rpscli import Bearing, PodiumStructure, load_record
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
>>> pulse = load_record("pulse:sine?amplitude=0.4g&period=0.8")
>>> demand(podium, pulse).outcome
'survived'
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias, overload

import numpy as np

from rpscli.analyses.kernels.history import HistoryRequest, follow, refuse_steps, run_of
from rpscli.analyses.kernels.systems import longest_free_vibration, stacked_systems
from rpscli.analyses.largest_demands import Demand, Demands
from rpscli.analyses.settings import TimeHistorySettings, require_inputs
from rpscli.errors import UsageError
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import LANES
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.shown import frozen

Motion: TypeAlias = GroundMotion | MotionComponents


@dataclass(frozen=True, eq=False)
class DemandRequest:
    """One history to run: a structure under a motion, all of its
    components times `scale`.
    """

    structure: PodiumStructure
    motion: MotionComponents
    settings: TimeHistorySettings = field(default_factory=TimeHistorySettings)
    scale: float = 1.0


WORTH_LANES = 8
"""Histories with the same number of storeys that are followed side by side; fewer run one
by one, with the same results. A step of all lanes takes as long as some five of one."""


def histories(
    requests: Sequence[DemandRequest], *, worth_lanes: int = WORTH_LANES
) -> Iterator[tuple[list[int], Demands]]:
    """Numbers of requests alike in storeys and contact, and their
    results; without the GIL.
    """
    # From `worth_lanes` on they run side by side; no result depends on the others, or on
    # the order.
    groups: dict[tuple[int, bool, bool, bool], list[int]] = {}
    for i, request in enumerate(requests):
        pair = request.motion.y is not None
        gives_way = request.structure.bed is not None
        springs = request.structure.upwards is not None
        alike = request.structure.storeys, pair, gives_way, springs
        groups.setdefault(alike, []).append(i)
    for members in groups.values():
        yield members, _run([requests[i] for i in members], worth_lanes)


def demands(
    requests: Sequence[DemandRequest], *, worth_lanes: int = WORTH_LANES
) -> list[Demand]:
    """Largest demands of each of many histories, in their order; see `histories`.

    Raises UsageError for a slab that turns, of which they would know nothing.
    """
    if any(request.structure.twist for request in requests):
        raise UsageError(
            "demand follows the slab's centre alone, and podium.twist is given: use"
            " time_history, or twist=None"
        )
    by_number: dict[int, Demand] = {}
    for members, together in histories(requests, worth_lanes=worth_lanes):
        for i, left in zip(members, together.left.view(np.recarray), strict=True):
            by_number[i] = Demand(requests[i].structure, left)
    return [by_number[i] for i in range(len(requests))]


@overload
def demand(
    structure: PodiumStructure,
    record: Motion,
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
) -> Demand: ...
@overload
def demand(
    structure: PodiumStructure,
    record: Sequence[Motion],
    settings: TimeHistorySettings | None = None,
) -> list[Demand]: ...
def demand(
    structure: PodiumStructure,
    record: Motion | Sequence[Motion],
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
) -> Demand | list[Demand]:
    """Largest demands of a history: those of `time_history`, without its samples.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    record
        Horizontal ground acceleration, or all components of it; or a sequence of such
        motions, whose histories are followed side by side.
    settings
        Accuracy, tolerance, limits.
    vertical
        Vertical ground acceleration with the same time step, positive
        upwards, of a single record.

    Returns
    -------
    The demands, or a list of them in the order of the motions. No history depends on the
    others.

    Raises
    ------
    UsageError
        If `vertical` comes with several motions.
    """
    if isinstance(record, GroundMotion | MotionComponents) or not isinstance(
        record, Sequence
    ):
        chosen, motion = require_inputs(structure, record, settings, vertical)
        return demands([DemandRequest(structure, motion, chosen)])[0]
    if vertical is not None:
        raise UsageError(
            "vertical goes with a single record; give MotionComponents(x, vertical=...)"
            " for each"
        )
    inputs = [require_inputs(structure, each, settings, None) for each in record]
    asked = [DemandRequest(structure, motion, chosen) for chosen, motion in inputs]
    return demands(asked)


def _run(requests: Sequence[DemandRequest], worth_lanes: int) -> Demands:
    structures, of_structure = _distinct([id(r.structure) for r in requests])
    firsts, of_system = _distinct([(id(r.structure), id(r.settings)) for r in requests])
    shaken, of_motion = _distinct([id(r.motion) for r in requests])
    systems = [(requests[i].structure, requests[i].settings) for i in firsts]
    motions = [requests[i].motion for i in shaken]
    pairs = requests[0].motion.y is not None
    stacked = stacked_systems(systems, pairs=pairs)
    rates = stacked["step_rate"].tolist()[:: len(stacked) // len(systems)]
    for r, system in zip(requests, of_system, strict=True):
        seconds = r.motion.duration + longest_free_vibration(r.structure, r.settings)
        refuse_steps(seconds * rates[system], r.structure)
    scales = [r.scale for r in requests]
    given = [*map(HistoryRequest, of_system, of_motion, scales)]
    run = run_of(stacked, motions, given, pairs=pairs)
    follow(run, LANES if len(requests) >= worth_lanes else 1)
    return Demands(
        [requests[i].structure for i in structures], of_structure, frozen(run.results)
    )


def _distinct(ids: Sequence[Any]) -> tuple[list[int], list[int]]:
    """Places where each is met first, and the number of every one among these."""
    _, first, number = np.unique(ids, axis=0, return_index=True, return_inverse=True)
    return first.tolist(), number.ravel().tolist()
