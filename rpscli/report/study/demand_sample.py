"""Demands of storeys and floors as CSV files that pelicun reads.

Columns are called event-type-location-direction; a row of units follows the header.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import by_values, left_out, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.demand_sample import (
    DemandSample,
    DemandSampleOptions,
    DemandSampleReport,
    demand_sample_report,
)
from rpscli.sweep.reports.floor_spectra import FloorSpectraOptions, without_floors
from rpscli.sweep.statistics.fractiles import HIGH
from rpscli.sweep.table import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HOW = (
    "for pelicun: OVT is 1 where a history overturned, its other demands are those until then;"
    ' take it as collapse with "CustomDemandTypes": {"Overturning": {"Acronym": "OVT", "UnitType":'
    ' "unitless"}} and "CollapseFragility": {"DemandType": "OVT", "CapacityDistribution": "N/A",'
    ' "CapacityMedian": 0.5}; BRD is the cap beam displacement, RID-0 the residual tilt of columns'
)


def sample_text(sample: DemandSample) -> str:
    """The file of one system at one intensity; level 0 is the ground."""
    columns = list(_columns(sample))
    lines = [["", *(name for name, _, _ in columns)], ["Units", *(unit for _, unit, _ in columns)]]
    for row, point in enumerate(sample.points.tolist()):
        lines.append([str(point + 1), *(f"{values[row]:.10g}" for *_, values in columns)])
    return "".join(",".join(line) + "\n" for line in lines)


def _columns(sample: DemandSample) -> Iterator[tuple[str, str, Array]]:
    """Name, unit in pelicun's spelling, and values of each column."""
    for level, values in enumerate(sample.accelerations.T):
        yield f"1-PFA-{level}-1", "mps2", values
    for storey, values in enumerate(sample.drifts.T, start=1):
        yield f"1-PID-{storey}-1", "unitless", values
    yield "1-RID-0-1", "unitless", sample.residual_rotations
    for storey, values in enumerate(sample.drifts.T, start=1):
        yield f"1-RID-{storey}-1", "unitless", 0.0 * values  # the building is linear
    yield "1-BRD-0-1", "m", sample.displacements
    yield "1-OVT-0-1", "unitless", sample.overturned


def sample_files(report: DemandSampleReport) -> Mapping[str, str]:
    """One file for each system and intensity, numbered as the rows of the table."""
    return {f"_{n}.csv": sample_text(one) for n, one in enumerate(report.samples, start=1)}


def file_columns(report: DemandSampleReport) -> list[Column]:
    """Which file is of which system and intensity."""
    samples = report.samples
    return [
        Column("file", "-", [number for number, _ in enumerate(samples, start=1)]),
        *key_columns(report.keys, [sample.values for sample in samples]),
        Column("counted", "-", [len(sample.points) for sample in samples]),
        Column("overturned", "-", [int(sample.overturned.sum()) for sample in samples]),
        Column("failed", "-", [sample.failed for sample in samples]),
    ]


def demand_sample_figure(report: DemandSampleReport, title: str) -> bytes:
    """Median and 84 % fractile of the accelerations from the ground to the roof."""

    def draw(axes: Axes, sample: DemandSample) -> None:
        axes.locator_params(axis="y", integer=True)
        reached = np.where(sample.overturned[:, None] > 0.0, np.inf, sample.accelerations)
        for share, dashes, name in ((0.5, "-", "median"), (HIGH, "--", "84 % fractile")):
            values = np.quantile(reached, share, axis=0, method="inverted_cdf")
            axes.plot(
                np.where(np.isfinite(values), values, np.nan), range(len(values)), "o",
                ls=dashes, ms=3.0, color=style.BLUE, label=name,
            )  # fmt: skip

    overturned = sum(int(sample.overturned.sum()) for sample in report.samples)
    return panel_figure(
        by_values(report.keys, report.samples),
        report.samples,
        draw,
        title=title,
        x_label="largest acceleration [m/s²]",
        y_label="level (0 = ground)",
        limits=lambda axes: axes.set_xlim(left=0.0),
        note=remarks(
            "fractiles that overturned are not drawn" if overturned else "",
            left_out(sum(sample.failed for sample in report.samples)),
        ),
    )


REPORT = Report(
    options=DemandSampleOptions,
    numbers=demand_sample_report,
    tables={"": file_columns},
    texts=sample_files,
    figure=demand_sample_figure,
    drawable=lambda report: bool(report.samples),
    notes=lambda report: [HOW] * bool(report.samples),
    results=lambda _: ["drift_ratio"],
    requires=lambda layout, _: without_floors(layout, FloorSpectraOptions()),
)
