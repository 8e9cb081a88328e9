"""Largest demands of many histories, without their samples: what studies are made of."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.compilation import SINGLE, compiled, lanes_of
from rpscli.analyses.failure import failure_text
from rpscli.analyses.history import History, empty_results, history_of, shape_of_one
from rpscli.analyses.kernel_input import aligned
from rpscli.analyses.kernel_tables import joined, point, points, stacked_systems
from rpscli.analyses.outcome import Outcome, outcome_of
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout
from rpscli.physics.parameters import Shape
from rpscli.records.ground_motion import GroundMotion

Item = TypeVar("Item")


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
    energy_impact: float
    energy_created: float
    creating_impacts: int
    uplifts: int
    impacts: int
    duration: float


@dataclass(frozen=True, eq=False)
class Request:
    """One history to run: a structure under a record, both of its components times `scale`."""

    structure: PodiumStructure
    record: GroundMotion
    settings: TimeHistorySettings = field(default_factory=TimeHistorySettings)
    scale: float = 1.0
    vertical: GroundMotion | None = None


LANES = 8
"""Histories that one core follows at once: doubles in a 512-bit register."""

WORTH_LANES = 160
"""Histories with the same number of storeys for which a kernel of their own is worth compiling.
Fewer run in the kernel of single histories, which gives the same bits."""


def demands(
    requests: Sequence[Request], *, worth_lanes: int = WORTH_LANES, lanes: int = LANES
) -> list[Demand]:
    """Largest demands of many histories.

    Parameters
    ----------
    requests
        In any order; structures and records that are the same object are stored once. Those with
        the same number of storeys run together, in lanes of one core if there are many.
    worth_lanes
        How many are many: for studies that come in batches, 1 once the whole study is large.
    lanes
        How many histories a core then follows at once. With 1 each runs by itself, in the kernel
        of its number of storeys: twice as fast as in the one that serves all, with the same
        results to rounding (1e-12; near a chaotic impact that may grow).

    Returns
    -------
    One demand a request, in their order. None of them depends on the others, or on the order.

    Notes
    -----
    The kernels run without the GIL: call this from several threads to use several cores.
    """
    answers: dict[int, Demand] = {}
    groups: dict[int, list[int]] = {}
    for i, request in enumerate(requests):
        groups.setdefault(request.structure.storeys, []).append(i)
    for members in groups.values():
        histories = _run([requests[i] for i in members], worth_lanes, lanes)
        answers.update(zip(members, map(demand_of, histories), strict=True))
    return [answers[i] for i in range(len(requests))]


def demand(
    structure: PodiumStructure,
    record: GroundMotion,
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
) -> Demand:
    """Largest demands of one history: those of `time_history`, without its samples."""
    chosen = settings or TimeHistorySettings()
    return demands([Request(structure, record, chosen, vertical=vertical)])[0]


def _run(requests: Sequence[Request], worth_lanes: int, lanes: int) -> list[History]:
    from rpscli.physics.driver import integrate  # noqa: PLC0415

    systems = _Shelf[tuple[PodiumStructure, TimeHistorySettings]]()
    motions = _Shelf[GroundMotion]()
    rows = []
    for r in requests:
        record, vertical = aligned(r.record, r.vertical)
        system = systems.place((id(r.structure), r.settings), (r.structure, r.settings))
        along = motions.place((id(r.record), id(r.vertical)), record)
        above = None
        if vertical is not None:
            above = motions.place((id(r.vertical), id(r.record), "up"), vertical)
        rows.append((system, along, above, r.scale))
    acceleration, starts = joined(motions.items)
    given = points(
        [
            point(
                system,
                motions.items[along],
                starts[along],
                None if above is None else starts[above],
                scale,
            )
            for system, along, above, scale in rows
        ]
    )
    results = empty_results(len(requests), requests[0].structure.storeys)
    structure = requests[0].structure
    if len(requests) >= worth_lanes:
        shape = shape_of_many(structure, lanes)
        name = lanes_of(structure, lanes)
    else:
        shape, name = shape_of_one(structure), SINGLE
    with compiled(name):
        integrate(stacked_systems(systems.items), acceleration, given, shape, results)
    return [history_of(*row) for row in zip(results.numbers, results.integers, strict=True)]


class _Shelf(Generic[Item]):
    """Distinct items in the order of their first use."""

    def __init__(self) -> None:
        self.items: list[Item] = []
        self._places: dict[Hashable, int] = {}

    def place(self, key: Hashable, item: Item) -> int:
        """Number of the item with this key, which is put on the shelf if it is new."""
        if key not in self._places:
            self._places[key] = len(self.items)
            self.items.append(item)
        return self._places[key]


def shape_of_many(structure: PodiumStructure, lanes: int) -> Shape:
    """Lanes side by side, for a number of floors that the compiler knows."""
    return Shape(((),) * structure.storeys, ((),) * lanes, ((),) * lanes, (), ())


def demand_of(history: History) -> Demand:
    """The demand that a history leaves."""
    return Demand(
        outcome=outcome_of(history),
        failure=failure_text(history),
        max_rotation=history.max_rotation,
        critical_passage_time=history.critical_time if history.critical_time >= 0.0 else None,
        storey_shears=history.storey_shears,
        floor_accelerations=history.floor_accelerations,
        friction_demand=float(max(history.friction)),
        energy_impact=float(history.energies[2]),
        energy_created=history.energy_created,
        creating_impacts=history.creating_impacts,
        uplifts=int(history.counts[layout.UPLIFT]),
        impacts=int(history.counts[layout.IMPACT]),
        duration=history.time,
    )
