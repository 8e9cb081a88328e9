"""A batch of points -> its outcomes: the one place where the work of a study is done.

Pure: what comes out for a point depends on the point and the plan alone, not on its batch, the
order, or the process. A point that cannot be computed gives a row that says why.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

from rpscli.analyses.demand import Demand, Request, demands
from rpscli.errors import AnalysisError, RpsError
from rpscli.sweep.points import Plan, Point
from rpscli.sweep.results import DONE, FAILED, Results, history_results, parametric_results
from rpscli.sweep.shelf import Shelf
from rpscli.sweep.systems import Systems

Result = TypeVar("Result")


class Row(NamedTuple):
    """What became of a point. Results are empty where it failed, and the message says why."""

    number: int
    outcome: str
    message: str | None
    results: Results


class Bench:
    """Systems and ground motions of a plan, shared by all batches of a process."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.shelf = Shelf()
        self.systems = Systems(plan)

    def factor(self, point: Point) -> float:
        """Factor on the record of a point.

        Raises
        ------
        RpsError
            If the record cannot be read, or cannot be scaled to the measure.
        """
        measure = self.plan.measure
        if measure is None:
            return point.scale * point.scale_change
        assert point.record is not None, "points of histories have a record"
        unscaled = self.shelf.intensity(
            point.record, measure.measure, point.period, measure.damping
        )
        if unscaled <= 0.0:
            raise AnalysisError(f"{measure.measure} of {point.record.source} is 0: cannot scale it")
        ratio = point.scale / unscaled
        return (ratio**0.5 if measure.measure == "Arias" else ratio) * point.scale_change

    def history(self, point: Point) -> Request:
        """The history of a point; its motion is shared, and scaled while it is used."""
        assert point.record is not None, "points of histories have a record"
        system, motion = self.systems[point], self.shelf.motion(point.record)
        return Request(
            structure=system.perturbed(point.restitution_change),
            record=motion.horizontal,
            settings=system.settings,
            scale=self.factor(point),
            vertical=motion.vertical,
        )

    def intensities(self, point: Point) -> Results:
        """Peaks of the scaled motion."""
        assert point.record is not None, "points of histories have a record"
        size = abs(self.factor(point))
        return {
            "pga": size * self.shelf.intensity(point.record, "PGA"),
            "pgv": size * self.shelf.intensity(point.record, "PGV"),
        }


def run_batch(bench: Bench, points: Sequence[Point]) -> list[Row]:
    """Outcomes of some points of the bench's plan, in the same order."""
    if bench.plan.analysis != "timehistory":
        return [_row(point, _attempt(_parametric, bench, point)) for point in points]
    histories = [_attempt(bench.history, point) for point in points]
    found = iter(_demands([history for history in histories if isinstance(history, Request)]))
    demanded = [next(found) if isinstance(h, Request) else h for h in histories]
    return [
        _history_row(bench, point, history, demand)
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


def _parametric(bench: Bench, point: Point) -> Results:
    return parametric_results(bench.plan.analysis, bench.systems[point].structure)


def _history_row(bench: Bench, point: Point, history: Request | str, demand: Demand | str) -> Row:
    if isinstance(history, str):
        return _row(point, history)
    if isinstance(demand, str) or demand.failure is not None:
        return _row(point, demand if isinstance(demand, str) else str(demand.failure))
    results = history_results(history.structure, demand) | bench.intensities(point)
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
