"""Studies with made-up results, whose statistics are known."""

from __future__ import annotations

from collections.abc import Callable

from rpscli.sweep.evaluation.results import SCALARS
from rpscli.sweep.points.layout import StudyPoints, lay_out
from rpscli.sweep.store import Stored
from rpscli.sweep.table import Table, tabulate
from sweep.small_studies import STUDY, Make

Answer = Callable[[int], Stored]

RHO, ALPHA = "podium.bearing.curvature_ratio", "podium.bearing.slenderness"


def stored(outcome: str = "survived", **results: object) -> Stored:
    """A made-up result."""
    whole: dict[str, object] = dict.fromkeys(SCALARS["timehistory"], 0.0)
    shears = results.pop("storey_shears", [3.0, 2.0, 1.0])
    return Stored(outcome, None, {**whole, "scale": 1.0, **results, "storey_shears": shears})


def table_of(make: Make, answer: Answer, *changes: tuple[str, str]) -> Table:
    """The study of 2 slendernesses x 3 curvatures x 3 records x 2 scales with made-up results."""
    layout = lay_out(make(STUDY, *changes))
    return tabulate(layout, (answer(number) for number in range(len(layout))))


def place(layout: StudyPoints, number: int) -> dict[str, object]:
    point = layout[number]
    assert point.record is not None
    named = dict(zip(layout.plan.keys, point.values, strict=True))
    return {**named, "record": int(point.record.source[-1]), "scale": point.scale}
