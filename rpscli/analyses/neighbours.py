"""A history run again: with shorter steps, its motion a little changed, another impact law."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.result_quantities import HISTORY, values_of
from rpscli.analyses.results import TimeHistoryResult
from rpscli.model.podium import PodiumStructure
from rpscli.records.pair import turned

PROMISED = 1e-4
"""Of the largest rotation and base shear: what the default step keeps where motions converge."""

NO_ROTATION = 1e-9
"""Of the critical one."""

SHORTER = (2.0, 4.0, 8.0)

MOST_STEPS = 300_000
"""Of a history that is run again, some tenths of a second; longer ones are not looked at."""


def steps_warning(result: TimeHistoryResult) -> str | None:
    """What to know of a history whose maxima change with its steps; None if they do not."""
    # The energy does not tell: a slow vibration may shift when friction holds or columns lift off.
    before: Demand = result
    settings, first = result.settings, ""
    for factor in SHORTER:
        if not steps_left(before, MOST_STEPS):
            break
        (after,) = run_again(result, [(result.structure, 1.0, 0.0)], factor)
        changed = _changes(before, after)
        first = first or changed
        if not changed:
            enough = 0.5 * factor * settings.accuracy
            return f"{first}; use analysis.accuracy = {enough:g}" if first else None
        before = after
    if not first:
        return None
    return f"{first}, and shorter ones change it again: this is one of many; judge by many records"


def steps_left(found: Demand, most: int) -> bool:
    """Whether a history may be run again: one that ended, in no more steps."""
    return found.outcome != "failed" and found.history["steps"] <= most


def run_again(
    result: TimeHistoryResult,
    beside: Iterable[tuple[PodiumStructure, float, float]],
    accuracy: float = 1.0,
) -> list[Demand]:
    """A history with other structures, its motion with a factor and turned, and shorter steps."""
    settings = replace(result.settings, accuracy=accuracy * result.settings.accuracy)
    requests = [
        Request(st, turned(result.motion, angle) if angle else result.motion, settings, factor)
        for st, factor, angle in beside
    ]
    # One by one: the kernel for many at a time would have to be compiled first.
    return demands(requests, worth_lanes=len(requests) + 1)


def _changes(before: Demand, after: Demand) -> str:
    """What steps of half the length change, in words; empty if nothing."""
    if before.outcome != after.outcome:
        return f"steps of half the length change the outcome to {after.outcome.replace('_', ' ')}"
    least, parts = NO_ROTATION * after.critical_rotation, []
    for name, old, new in (
        ("largest rotation", before.max_rotation, after.max_rotation),
        ("base shear", before.max_base_shear, after.max_base_shear),
    ):
        if abs(new - old) > max(PROMISED * new, least):
            parts.append(f"the {name} by {abs(new - old) / max(old, new):.2g} of it")
    return f"steps of half the length change {' and '.join(parts)}" if parts else ""


FACTORS = (0.97, 0.98, 0.99, 1.01, 1.02, 1.03)
"""On the motion."""

TURNS = (-1.0, 1.0)
"""Of a motion with both components [deg]."""

OTHER_LOSS = 0.5
"""`podium.impact.loss` of the history beside that of the law as it is."""

MOST_STEPS_BESIDE = 100_000
"""Of a history that is run seven times more, some tenths of a second in all."""


class Neighbour(NamedTuple):
    """One of them: factor on its motion, its restitution, and what came of it, SI units.

    A pair may be `turned` [deg].

    `demands` has all results of a history that may be limited, by name.
    """

    factor: float
    restitution: float
    outcome: str
    rotation_ratio: float
    max_base_shear: float
    demands: dict[str, float | None]
    turned: float = 0.0


def neighbours(result: TimeHistoryResult) -> list[Neighbour]:
    """Histories beside one; none if they take too long, or if it failed."""
    if not steps_left(result, MOST_STEPS_BESIDE):
        return []
    structure, law = result.structure, result.structure.impact_law
    beside = [(structure, factor, 0.0) for factor in FACTORS]
    if result.both_components and structure.superstructure_y is not None:
        # Columns are round: of a building alike in x and y all turns with the motion.
        beside += [(structure, 1.0, angle) for angle in TURNS]
    if structure.restitution < 1.0 and law.kind != "value" and law.loss > OTHER_LOSS:
        beside.append((replace(structure, impact_law=replace(law, loss=OTHER_LOSS)), 1.0, 0.0))
    found = run_again(result, beside)
    limited = [quantity for quantity in HISTORY if quantity.limit]
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
        for (of, factor, angle), each in zip(beside, found, strict=True)
    ]
