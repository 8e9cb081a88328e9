"""Overturning spectra of pulses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.figures import style
from rpscli.report.files.csv_text import Column
from rpscli.report.study.labels import key_columns
from rpscli.report.study.panels import by_values, left_out, panel_figure
from rpscli.report.study.report import Report
from rpscli.sweep.reports.overturning_spectrum import (
    SpectrumOptions,
    SpectrumPanel,
    SpectrumReport,
    spectrum_report,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS = (
    ("at_rest", "no uplift", style.GREY, ".", 2.0),
    ("survived", "stands", style.SKY, "o", 3.0),
    ("overturned", "overturns", style.RED, "s", 3.0),
)


def spectrum_columns(report: SpectrumReport) -> list[Column]:
    """One row a point."""
    rows = [(p, place) for p in report.panels for place in range(len(p.outcomes))]
    return [
        *key_columns(report.panel_keys, [p.values for p, _ in rows]),
        Column("frequency_over_p", "-", [float(p.frequency_ratio[i]) for p, i in rows]),
        Column("amplitude_over_g_tan_alpha", "-", [float(p.amplitude_ratio[i]) for p, i in rows]),
        Column("rotation_ratio", "-", [float(p.rotation_ratio[i]) for p, i in rows]),
        Column("outcome", "-", [p.outcomes[i] for p, i in rows]),
    ]


def spectrum_figure(report: SpectrumReport, title: str) -> bytes:
    """Outcomes over frequency and amplitude, and the least amplitude that overturns."""

    def draw(axes: Axes, panel: SpectrumPanel) -> None:
        for word, name, colour, marker, size in LOOKS:
            chosen = np.array([outcome.startswith(word) for outcome in panel.outcomes])
            axes.plot(
                panel.frequency_ratio[chosen], panel.amplitude_ratio[chosen], ls="",
                color=colour, marker=marker, ms=size, mew=0.0, label=name,
            )  # fmt: skip
        axes.plot(
            panel.boundary[:, 0], panel.boundary[:, 1], color=style.BLACK, lw=1.2,
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
        note=left_out(sum(p.failed for p in report.panels)),
    )


REPORT = Report(
    options=SpectrumOptions,
    numbers=lambda study, options: spectrum_report(study.table, study.context, options),
    tables={"": spectrum_columns},
    figure=spectrum_figure,
)
