"""A batch of points -> its outcomes: the one place where the work of a study is done.

Pure: what comes out for a point depends on the point and the plan alone, not on its batch, the
order, or the process. A point that cannot be computed gives a row that says why.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.result_quantities import SAMPLED, values_of
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import time_history
from rpscli.errors import RpsError
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.evaluation.results import DONE, FAILED, Results, parametric_results

Result = TypeVar("Result")


class Row(NamedTuple):
    """What became of a point. Results are empty where it failed, and the message says why."""

    number: int
    outcome: str
    message: str | None
    results: Results


def run_batch(context: StudyContext, points: Sequence[Point]) -> list[Row]:
    """Outcomes of some points of the study, in the same order."""
    if context.plan.analysis != "timehistory":
        return [_row(point, _attempt(_parametric, context, point)) for point in points]
    if context.plan.whole:
        return [_whole_history_row(context, point) for point in points]
    histories = [_attempt(context.history, point) for point in points]
    found = iter(_demands([history for history in histories if isinstance(history, Request)]))
    demanded = [next(found) if isinstance(h, Request) else h for h in histories]
    return [
        _history_row(context, point, history, demand)
        for point, history, demand in zip(points, histories, demanded, strict=True)
    ]


def _demands(requests: list[Request]) -> list[Demand | str]:
    """Largest demands of each history, or why there are none."""
    together = _attempt(demands, requests)
    if not isinstance(together, str):
        return list(together)
    # One of them cannot be had: which one shows when each is tried alone.
    alone = (_attempt(demands, [request]) for request in requests)
    return [found if isinstance(found, str) else found[0] for found in alone]


def _parametric(context: StudyContext, point: Point) -> Results:
    return parametric_results(context.plan.analysis, context.systems[point].structure)


def _whole_history_row(context: StudyContext, point: Point) -> Row:
    """Of a history by itself, with what its samples tell."""
    history = _attempt(context.history, point)
    found = history if isinstance(history, str) else _attempt(_whole_history, history)
    row = _history_row(context, point, history, found)
    if isinstance(found, str) or row.outcome == FAILED:
        return row
    return row._replace(results=row.results | values_of(found, SAMPLED))


def _whole_history(request: Request) -> TimeHistoryResult:
    vertical, scale = request.vertical, request.scale
    return time_history(
        request.structure,
        request.record.scaled(scale),
        request.settings,
        vertical=None if vertical is None else vertical.scaled(scale),
    )


def _history_row(
    context: StudyContext, point: Point, history: Request | str, demand: Demand | str
) -> Row:
    if isinstance(history, str):
        return _row(point, history)
    if isinstance(demand, str) or demand.failure is not None:
        return _row(point, demand if isinstance(demand, str) else str(demand.failure))
    results = demand.results() | context.intensities(point)
    return Row(point.number, demand.outcome, None, {"scale": history.scale} | results)


def _row(point: Point, results: Results | str) -> Row:
    if isinstance(results, str):
        return Row(point.number, FAILED, results, {})
    return Row(point.number, DONE, None, results)


def _attempt(work: Callable[..., Result], *given: Any) -> Result | str:
    """What the work gives, or a text that says why it gives nothing."""
    try:
        return work(*given)
    except RpsError as error:
        return str(error)
    except Exception as error:  # noqa: BLE001 -- one point must not take the study down
        return f"{type(error).__name__}: {error}"
