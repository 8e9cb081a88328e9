"""Overturning spectra of pulses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.study.panels import by_values, colour, left_out, marker, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.overturning_spectrum import (
    SpectrumOptions,
    SpectrumPanel,
    SpectrumReport,
    SpectrumSeries,
    records_without_period,
    spectrum_report,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS = (
    ("at_rest", "at rest", style.GREY, ".", 2.0),
    ("survived", "survived", style.SKY, "o", 3.0),
    ("overturned", "overturned", style.RED, "s", 3.0),
)


def spectrum_columns(report: SpectrumReport) -> list[Column]:
    """One row a point."""
    rows = [
        (panel, series, place)
        for panel in report.panels
        for series in panel.series
        for place in range(len(series.outcomes))
    ]
    return [
        *key_columns(report.panel_keys, [p.values for p, *_ in rows]),
        *key_columns(report.series_keys, [s.values for _, s, _ in rows]),
        Column("frequency_over_p", "-", [float(s.frequency_ratio[i]) for _, s, i in rows]),
        Column(
            "amplitude_over_g_tan_alpha", "-", [float(s.amplitude_ratio[i]) for _, s, i in rows]
        ),
        Column("rotation_ratio", "-", [float(s.rotation_ratio[i]) for _, s, i in rows]),
        Column("outcome", "-", [s.outcomes[i] for _, s, i in rows]),
    ]


def spectrum_figure(report: SpectrumReport, title: str) -> bytes:
    """Outcomes over frequency and amplitude, and the least amplitude that overturns."""
    several = max(len(panel.series) for panel in report.panels) > 1

    def draw(axes: Axes, panel: SpectrumPanel) -> None:
        for place, series in enumerate(panel.series):
            if several:
                draw_in_colour(axes, series, place, len(panel.series))
            else:
                draw_outcomes(axes, series)

    def draw_in_colour(axes: Axes, series: SpectrumSeries, place: int, count: int) -> None:
        """What overturned and the least that did; survivors would hide the other series."""
        fell = np.array([outcome.startswith("overturned") for outcome in series.shown])
        shade = colour(place, count)
        axes.plot(
            series.frequency_ratio[fell], series.amplitude_ratio[fell], ls="", color=shade,
            marker=marker(place), ms=2.6, mew=0.0, alpha=0.35,
        )  # fmt: skip
        axes.plot(
            series.boundary[:, 0], series.boundary[:, 1], color=shade, marker=marker(place),
            ms=3.4, lw=1.3, label=labels(report.series_keys, series.values),
        )  # fmt: skip

    def draw_outcomes(axes: Axes, series: SpectrumSeries) -> None:
        for word, name, shade, mark, size in LOOKS:
            chosen = np.array([outcome.startswith(word) for outcome in series.shown])
            if not chosen.any():
                continue
            axes.plot(
                series.frequency_ratio[chosen], series.amplitude_ratio[chosen], ls="",
                color=shade, marker=mark, ms=size, mew=0.0, label=name,
            )  # fmt: skip
        axes.plot(
            series.boundary[:, 0], series.boundary[:, 1], color=style.BLACK, lw=1.2,
            label="least that overturns",
        )  # fmt: skip

    def limits(axes: Axes) -> None:
        axes.set_xlim(left=0.0)
        axes.set_ylim(bottom=0.0)

    return panel_figure(
        by_values(report.panel_keys, report.panels),
        report.panels,
        draw,
        title=title,
        x_label=r"$\omega/p$ [-]",
        y_label=r"$a_p/(g\,\tan\alpha)$ [-]",
        limits=limits,
        note=remarks("only what overturned" * several, left_out(report.failed)),
    )


REPORT = Report(
    options=SpectrumOptions,
    numbers=lambda study, options: spectrum_report(study.table, study.context, options),
    tables={"": spectrum_columns},
    figure=spectrum_figure,
    requires=records_without_period,
)
