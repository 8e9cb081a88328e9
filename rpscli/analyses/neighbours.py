"""A history run again: its motion a little changed, or another impact law."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.result_quantities import values_of
from rpscli.analyses.results import TimeHistoryResult

FACTORS = (0.97, 0.98, 0.99, 1.01, 1.02, 1.03)
"""On the motion."""

TURNS = (-1.0, 1.0)
"""Of a motion with both components [deg]."""

OTHER_LOSS = 0.5
"""`podium.impact.loss` of the history beside that of the law as it is."""

MOST_STEPS_BESIDE = 100_000
"""Of a history that is run seven times more, some tenths of a second in all."""


class Neighbour(NamedTuple):
    """One of them, and what came of it, SI units."""

    factor: float  # on its motion
    restitution: float  # of its law
    outcome: str
    rotation_ratio: float
    max_base_shear: float
    demands: dict[str, float | None]  # results that may be limited, by name
    turned: float = 0.0  # of a pair [deg]


def neighbours(result: TimeHistoryResult) -> list[Neighbour]:
    """Histories beside one; none if they take too long, or if it failed."""
    if result.outcome == "failed" or result.history["steps"] > MOST_STEPS_BESIDE:
        return []
    structure, settings = result.structure, result.settings
    law = structure.impact_law
    beside = [(structure, factor, 0.0) for factor in FACTORS]
    if result.both_components and structure.superstructure_y is not None:
        # Columns are round: of a building alike in x and y all turns with the motion.
        beside += [(structure, 1.0, angle) for angle in TURNS]
    if structure.restitution < 1.0 and law.kind != "value" and law.loss > OTHER_LOSS:
        beside.append((replace(structure, impact_law=replace(law, loss=OTHER_LOSS)), 1.0, 0.0))
    requests = [
        Request(of, result.motion.turned(angle), settings, factor) for of, factor, angle in beside
    ]
    # One by one: the kernel for many at a time would have to be compiled first.
    results = demands(requests, worth_lanes=len(requests) + 1)
    limited = [quantity for quantity in result.quantities if quantity.limit]
    return [
        Neighbour(
            factor,
            of.restitution,
            each.outcome,
            each.rotation_ratio,
            each.max_base_shear,
            values_of(each, limited),
            angle,
        )
        for (of, factor, angle), each in zip(beside, results, strict=True)
    ]
