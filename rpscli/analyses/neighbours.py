"""Histories beside one: with other motion, another impact law, shorter steps.

>>> from rpscli import Bearing, PodiumStructure, load_record, time_history
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
>>> result = time_history(podium, load_record("pulse:sine?amplitude=0.4g&period=0.8"))
>>> [each.change for each in neighbours(result)][-2:]
['1.03 times the motion', 'podium.impact.loss 0.5']
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.result_quantities import SAMPLED, plain
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import time_history

FACTORS = (0.97, 0.98, 0.99, 1.01, 1.02, 1.03)
"""On the motion."""

NEAR = (0.99, 1.01)
"""Those of them that tell what a percent does."""

TURNS = (-1.0, 1.0)
"""Of a motion with both components [deg]."""

OTHER_LOSS = 0.5
"""`podium.impact.loss` of the history beside that of the law as it is."""

FINER = 2.0
"""Times the accuracy, with which steps have half their length."""

MOST_STEPS_BESIDE = 100_000
"""Of a history that is run eight times more, some tenths of a second in all."""


OF_MOTION = " times the motion"
"""Behind a factor, in words."""


class Neighbour(NamedTuple):
    """One of them, and what came of it, SI units."""

    factor: float  # on its motion
    restitution: float  # of its law
    outcome: str
    rotation_ratio: float
    max_base_shear: float
    demands: dict[str, float | None]  # results that may be limited, by name
    turned: float = 0.0  # of a pair [deg]
    step: float = 1.0  # length of its steps over that of the history

    @property
    def change(self) -> str:
        """What it differs in, in words."""
        if self.step != 1.0:
            return "steps of half the length"
        if self.factor != 1.0:
            return f"{self.factor:g}{OF_MOTION}"
        if self.turned:
            return f"the motion turned by {self.turned:g} deg"
        return f"podium.impact.loss {OTHER_LOSS:g}"


def neighbours(result: TimeHistoryResult, limited: Iterable[str] = ()) -> list[Neighbour]:
    """Histories beside one; none if they take too long, or if it failed.

    `limited` are names of results that have a limit. Where one of them needs samples, the
    nearest motions are followed with these, which takes some ten times as long.
    """
    structure = result.structure
    plain_request = DemandRequest(structure, result.motion, result.settings)
    law = structure.impact_law
    beside = [(plain_request, factor, 0.0) for factor in FACTORS]
    if result.both_components and structure.superstructure_y is not None:
        # Columns are round: of a building alike in x and y all turns with the motion.
        beside += [
            (replace(plain_request, motion=result.motion.turned(angle)), 1.0, angle)
            for angle in TURNS
        ]
    if structure.restitution < 1.0 and law.kind != "value" and law.loss > OTHER_LOSS:
        other = replace(structure, impact_law=replace(law, loss=OTHER_LOSS))
        beside.append((replace(plain_request, structure=other), 1.0, 0.0))
    requests = [replace(request, scale=factor) for request, factor, _ in beside]
    turns = [angle for *_, angle in beside]
    return _computed(result, requests, turns, {*limited})


def nearest(result: TimeHistoryResult) -> list[Neighbour]:
    """Those with one percent less and more motion, without what needs samples."""
    plain_request = DemandRequest(result.structure, result.motion, result.settings)
    requests = [replace(plain_request, scale=factor) for factor in NEAR]
    return _computed(result, requests, [0.0] * len(NEAR), ())


def with_half_the_step(
    result: TimeHistoryResult, limited: Iterable[str] = ()
) -> Neighbour | None:
    """The same history with steps of half the length, as studies compute points again;
    None where there are no neighbours.
    """
    settings = replace(result.settings, accuracy=FINER * result.settings.accuracy)
    request = DemandRequest(result.structure, result.motion, settings)
    found = _computed(result, [request], [0.0], {*limited})
    return found[0]._replace(step=1.0 / FINER) if found else None


def _computed(
    result: TimeHistoryResult,
    requests: Sequence[DemandRequest],
    turns: Sequence[float],
    limited: Collection[str],
) -> list[Neighbour]:
    if result.outcome == "failed" or result.history["steps"] > MOST_STEPS_BESIDE:
        return []
    if result.twist is not None:  # of which motions beside it would know nothing
        return []
    names = [quantity.name for quantity in result.quantities if quantity.limit]
    sampled = sorted({quantity.name for quantity in SAMPLED} & {*limited})
    # One by one: the kernel for many at a time would have to be compiled first.
    results = demands(requests, worth_lanes=len(requests) + 1)
    found = []
    for request, each, angle in zip(requests, results, turns, strict=True):
        values = {name: plain(getattr(each, name)) for name in names}
        if sampled and (request.scale in NEAR or len(requests) == 1):
            whole = _whole(request)
            values |= {name: plain(getattr(whole, name)) for name in sampled}
        found.append(
            Neighbour(
                request.scale,
                request.structure.restitution,
                each.outcome,
                each.rotation_ratio,
                each.max_base_shear,
                values,
                angle,
            )
        )
    return found


def _whole(request: DemandRequest) -> TimeHistoryResult:
    motion = request.motion
    if request.scale != 1.0:
        motion = motion.scaled(request.scale)
    return time_history(request.structure, motion, request.settings)
