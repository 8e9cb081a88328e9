"""A batch of points -> their results: the one place where the work of a study is done.

Pure: what comes out for a point depends on the point and the plan alone, not on its batch, the
order, or the process. A point that cannot be computed gives a row that says why.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.demand import Request, histories
from rpscli.analyses.fixed_base import fixed_base_shears
from rpscli.analyses.largest_demands import Histories
from rpscli.analyses.outcome import failure_text
from rpscli.analyses.result_quantities import HISTORY, IMPACTS, SAMPLED, STOREY_SHEARS, values_of
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import time_history
from rpscli.errors import RpsError
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import MotionComponents
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.evaluation.results import (
    DONE,
    FAILED,
    Array,
    Indices,
    PointResults,
    failures,
    parametric_results,
    put,
    stacked,
)

Result = TypeVar("Result")

KEPT = (*HISTORY, *IMPACTS, STOREY_SHEARS)
"""What a study keeps of a history besides its outcome, its scale and its intensities."""


def run_batch(context: StudyContext, points: Sequence[Point]) -> PointResults:
    """Results of some points of the study, in the same order."""
    if context.plan.analysis != "timehistory":
        return _parametric(context, points)
    found = failures(["not computed"] * len(points))
    requests: dict[int, Request] = {}
    for row, point in enumerate(points):
        request = _attempt(context.history, point)
        if isinstance(request, str):
            found.messages[row] = request
        else:
            requests[row] = request
    rows = np.array([*requests], np.int64)
    run = _whole if context.plan.whole else _together
    for members, results, sampled in run([*requests.values()]):
        at = rows[members]
        if isinstance(results, str):
            found.messages.update(dict.fromkeys(at.tolist(), results))
        else:
            _keep(found, at, results, results.columns(KEPT) | sampled)
    done = np.flatnonzero(found.outcomes != FAILED)
    scales = np.array([requests[row].scale for row in done.tolist()])
    put(found, done, "scale", scales)
    for name, values in context.intensities([points[row] for row in done.tolist()], scales).items():
        put(found, done, name, values)
    return found


def _keep(found: PointResults, at: Indices, results: Histories, columns: dict[str, Array]) -> None:
    """Add histories at some rows; of those that failed, why."""
    outcomes = results.outcomes
    good = outcomes != FAILED
    for row, left in zip(at[~good].tolist(), results.left[~good], strict=True):
        found.messages[row] = str(failure_text(left))
    found.outcomes[at] = outcomes
    for row in at[good].tolist():
        del found.messages[row]
    for name, values in columns.items():
        put(found, at[good], name, values[good])


Run = tuple[list[int], Histories | str, dict[str, Array]]
"""Numbers of histories, what was found or why nothing was, and what their samples tell."""


def _together(requests: list[Request]) -> list[Run]:
    """Histories side by side."""
    found = _attempt(_histories, requests)
    if not isinstance(found, str):
        return [(members, results, {}) for members, results in found]
    # One of them cannot be had: which one shows when each is tried alone.
    alone = [_attempt(_histories, [request]) for request in requests]
    return [([i], r if isinstance(r, str) else r[0][1], {}) for i, r in enumerate(alone)]


def _histories(requests: list[Request]) -> list[tuple[list[int], Histories]]:
    return list(histories(requests))


def _whole(requests: list[Request]) -> Iterator[Run]:
    """Each by itself, with what its samples tell."""
    for i, request in enumerate(requests):
        found = _attempt(_whole_history, request)
        if isinstance(found, str):
            yield [i], found, {}
        else:
            sampled = values_of(found, SAMPLED)
            results = Histories.of_one(found.structure, found.history)
            yield [i], results, {name: stacked([v]) for name, v in sampled.items()}


def _whole_history(request: Request) -> TimeHistoryResult:
    motion = request.motion.scaled(request.scale)
    return time_history(request.structure, motion, request.settings)


def _parametric(context: StudyContext, points: Sequence[Point]) -> PointResults:
    """Of an analysis without histories."""
    found = failures([""] * len(points))
    rows: list[dict[str, Any]] = []
    analysis, systems = context.plan.analysis, context.systems
    for row, point in enumerate(points):
        results = _attempt(lambda p: parametric_results(analysis, systems[p].structure), point)
        if isinstance(results, str):
            found.messages[row] = results
        else:
            found.outcomes[row] = DONE
            del found.messages[row]
        rows.append({} if isinstance(results, str) else results)
    for name in dict.fromkeys(name for row in rows for name in row):
        found.columns[name] = stacked([row.get(name) for row in rows])
    return found


def _attempt(work: Callable[..., Result], *given: Any) -> Result | str:
    """What the work gives, or a text that says why it gives nothing."""
    try:
        return work(*given)
    except RpsError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001 -- one point must not take the study down
        return f"{type(error).__name__}: {error}"


def reference_shears(structure: PodiumStructure, motion: MotionComponents) -> NDArray[np.float64]:
    """Largest storey shears (n,) [N] from the bottom, of a pair resultants, of an unscaled one."""
    building = structure.superstructure
    assert building is not None, "only buildings have a response"
    across = structure.superstructure_y or building
    # The largest shear after the end of the record comes within a period.
    after = math.ceil(max(float(each.periods[0]) for each in (building, across)) / motion.dt)
    shaken = [each.npts for name, each in motion.named.items() if name != "vertical"]
    return fixed_base_shears(structure, motion, max(shaken) - 1 + after)
