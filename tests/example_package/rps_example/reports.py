"""A report of studies: the points that came off worst."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np

from rpscli.plugins import (
    Column,
    Found,
    Report,
    ReportOptions,
    StudyResults,
    Whole,
    point_columns,
    single,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RESULT = "rotation_ratio"


class WorstOptions(ReportOptions):
    """The points with the largest rotations."""

    count: Annotated[int, Whole(1)] = 5
    """how many are shown"""


def worst(study: StudyResults, options: WorstOptions) -> Found:
    """A table and a figure of them, the worst first."""
    columns = point_columns(study.table)
    values = np.nan_to_num(columns[RESULT], nan=-np.inf)  # failed points come last
    first = np.argsort(-values, kind="stable")[: options.count]
    names = [str(name) for name in columns["record"][first]]

    def draw(axes: Axes, heights: list[float]) -> None:
        axes.barh(range(len(names)), heights, tick_label=names)
        axes.set(xlabel="rotation ratio")

    def figure(title: str) -> bytes:
        return single(draw, columns[RESULT][first].tolist(), (title,), 3.0)

    table = [Column("record", "-", names), Column(RESULT, "-", columns[RESULT][first])]
    return Found({"": table}, figure, shown={"": {}})


WORST = Report(WorstOptions, worst, results=lambda _: [RESULT])
