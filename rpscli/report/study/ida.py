"""Incremental dynamic analysis: demand of every record against intensity, and its fractiles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from pydantic import AliasChoices, Field

from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKeys
from rpscli.case.study.schema import Axis
from rpscli.case.text.document import Document, Fault
from rpscli.errors import listed
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.labels import keyed
from rpscli.report.study.report import DemandName, Found, Report
from rpscli.sweep.evaluation import SCALARS
from rpscli.sweep.statistics.fractiles import THREE, demand, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping, shown_keys
from rpscli.sweep.table import Array, StudyResults, unit_of

MOST_CURVES = 200
LINES = ((style.BLUE, ":"), (style.BLUE, "-"), (style.BLUE, "--"))


class IdaOptions(ReportOptions):
    """Incremental dynamic analysis: demand against intensity, with fractiles."""

    result: DemandName = Field(
        "rotation_ratio",
        description="horizontal axis",
        validation_alias=AliasChoices("result", "demand"),
    )
    panels: VariedKeys | None = Field(None, description="varied keys, one panel for each value")


class Panel(NamedTuple):
    """Demands of one group at ascending intensities, or factors; infinite is overturned."""

    values: tuple[object, ...]
    levels: list[Histories]
    heights: Array
    curves: Array  # (curves, levels) of each record, sample and member, NaN where it failed
    fractiles: Array  # (3, levels) of the points that did not fail


def ida(study: StudyResults, options: IdaOptions) -> Found:
    """Curves and fractiles of each system."""
    table = study.table
    found = grouping(table, options.panels, (INTENSITY,))
    demands = demand(table, table.columns[options.result])
    shown = []
    for group in found.groups:
        levels = sorted(group.parts([INTENSITY]), key=height)
        curves = np.column_stack([demands[level.every] for level in levels])
        spread = np.column_stack([fractiles(column, THREE) for column in curves.T])
        heights = np.array(list(map(height, levels)))
        shown.append(Panel(group.values, levels, heights, curves, spread))
    (name,) = shown_keys(table.layout, (INTENSITY,))
    quantity, level_unit = SCALARS["timehistory"][options.result], unit_of(name)
    heads = {name: level_unit}
    heads |= {f"{options.result}_{round(100 * share)}": quantity.unit for share in THREE}
    heads |= dict.fromkeys(("counted", "overturned", "failed"), "-")
    rows = [
        (panel.values, at, *spread, len(level), level.overturned.number, level.failed)
        for panel in shown
        for level, at, spread in zip(
            panel.levels, panel.heights.tolist(), panel.fractiles.T.tolist(), strict=True
        )
    ]
    finite = [panel.curves[np.isfinite(panel.curves)] for panel in shown]
    edge = 1.15 * max((float(values.max()) for values in finite if len(values)), default=1.0)
    top = 1.04 * max(float(panel.heights.max()) for panel in shown)
    numbers = sorted({str(len(panel.curves)) for panel in shown})

    def draw(axes: style.Axes, panel: Panel) -> None:
        levels = np.concatenate([[0.0], panel.heights])
        panels.large_axis(axes.xaxis, quantity.unit)
        # Evenly through all of them: more would only blacken the panel.
        for curve in panel.curves[:: max(1, len(panel.curves) // MOST_CURVES)]:
            line = _run_out(curve, levels, edge)
            axes.plot(*line, color=style.GREY, lw=0.8, label="single curves")
        for fractile, (colour, dashes), share in zip(panel.fractiles, LINES, THREE, strict=True):
            label = "median" if share == 0.5 else f"{style.percent(share)} fractile"
            line = _run_out(fractile, levels, edge)
            axes.plot(*line, color=colour, ls=dashes, lw=1.8, label=label)

    words: dict[str, Any] = {
        "x_label": panels.large_label(quantity),
        "y_label": f"{name} [{level_unit}]",
        "limits": lambda axes: axes.set(xlim=(0.0, 0.97 * edge), ylim=(0.0, top)),
        "note": panels.noted(
            found,
            f"fractiles of {listed(numbers)} curves",
            "level to the right: overturned at the next intensity" if found.overturned else "",
            "back to the left: stronger motions, smaller rotations",
        ),
    }
    drawn = panels.in_panels(found.keys, shown, draw, **words)
    return Found({"": keyed(found.keys, heads, rows)}, drawn, found.notes)


def height(level: Histories) -> float:
    """The factor or the intensity of a level."""
    return float(str(level.values[0]))


def _run_out(values: Array, levels: Array, edge: float) -> tuple[list[float], list[float]]:
    """A curve from the origin to the first level at which it leaves the frame."""
    x, y = [0.0], [0.0]
    for value, level in zip(values.tolist(), levels[1:].tolist(), strict=True):
        if np.isnan(value):
            continue
        if np.isinf(value):
            # Flat at the last level that stood: a little more, and it overturns.
            x.append(edge)
            y.append(y[-1])
            break
        x.append(value)
        y.append(level)
    return x, y


def single_intensity(
    document: Document, _axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A study without several intensities has no curves."""
    if not isinstance(document.content.get("scale"), dict | list):
        wanted = "several intensities: scale: {measure: PGV, values: [...]}"
        yield Fault(request.path, f"the report {request.kind} needs {wanted}")


REPORT = Report(IdaOptions, ida, check=single_intensity, results=lambda options: [options.result])
