"""Annual rates of limit states, and the intensities that they come from."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rpscli.report.study.fragility import limit_name, measure_name, side_by_side
from rpscli.report.study.labels import key_columns, labels
from rpscli.report.study.panels import Layout, colour, log_ticks, over, panel_figure, remarks
from rpscli.report.study.report import Report
from rpscli.report.table import Column
from rpscli.sweep.reports.fragility import LimitState, limit_states
from rpscli.sweep.reports.risk import (
    Risk,
    RiskOptions,
    RiskReport,
    probability,
    risk_faults,
    risk_report,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def risk_columns(report: RiskReport) -> list[Column]:
    """One row a limit state: annual rate, return period, probability within a life; bands."""
    risks, life = report.risks, f"probability_in_{report.years:g}_years"
    measured = report.fragilities.intensity
    rates = {
        "": [risk.rate for risk in risks],
        "_low": [risk.band[0] for risk in risks],
        "_high": [risk.band[1] for risk in risks],
    }
    return [
        *_systems(report, risks),
        *(Column(f"annual_rate{end}", "1/year", found) for end, found in rates.items()),
        Column("return_period", "year", [_return_period(rate) for rate in rates[""]]),
        *(
            Column(f"{life}{end}", "-", [probability(rate, report.years) for rate in found])
            for end, found in rates.items()
        ),
        Column(f"half_from_{measured.measure}_below", measured.unit, [r.half for r in risks]),
        Column("median", measured.unit, [r.fragility.fit.median for r in risks]),
        Column("beta", "-", [r.fragility.fit.beta for r in risks]),
        Column("note", "-", ["; ".join(_notes(r)) or None for r in risks]),
    ]


def _return_period(rate: float) -> float:
    return 1.0 / rate if rate > 0.0 else math.nan


def _notes(risk: Risk) -> list[str]:
    return [*filter(None, [risk.fragility.fit.note]), *risk.notes]


def contribution_columns(report: RiskReport) -> list[Column]:
    """Annual rates from motions between two intensities; the last row is all stronger ones."""
    measured = report.fragilities.intensity
    rows = [(r, i) for r in report.known for i in range(len(r.contributions.rates))]
    edges = [(r.contributions.edges[i : i + 2].tolist()) for r, i in rows]
    return [
        *_systems(report, [r for r, _ in rows]),
        Column(f"{measured.measure}_from", measured.unit, [low for low, _ in edges]),
        Column(f"{measured.measure}_to", measured.unit, [high for _, high in edges]),
        Column("annual_rate", "1/year", [float(r.contributions.rates[i]) for r, i in rows]),
        Column("share", "-", [float(r.contributions.rates[i]) / r.rate for r, i in rows]),
    ]


def _systems(report: RiskReport, risks: list[Risk] | tuple[Risk, ...]) -> list[Column]:
    values = [risk.fragility.values for risk in risks]
    return [
        *key_columns(report.fragilities.series_keys, values),
        Column("limit", "-", [risk.fragility.limit.label for risk in risks]),
    ]


def risk_figure(report: RiskReport, title: str) -> bytes:
    """One panel a limit state: what share of its rate comes from which intensities."""
    found = report.fragilities
    limits = [limit for limit in found.limits if found.fitted(limit)]
    values = list(dict.fromkeys(risk.fragility.values for risk in report.known))

    def draw(axes: Axes, limit: LimitState) -> None:
        for risk in report.known:
            if risk.fragility.limit != limit:
                continue
            place = values.index(risk.fragility.values)
            shade, (edges, rates) = colour(place, len(values)), risk.contributions
            axes.stairs(
                100.0 * rates[:-1] / risk.rate, edges[:-1], color=shade, lw=1.4,
                label=labels(found.series_keys, risk.fragility.values) or None,
            )  # fmt: skip
            axes.axvline(risk.half, color=shade, lw=0.8, ls="--")

    def limit_axes(axes: Axes) -> None:
        axes.set_xscale("log")  # of all panels at the end: ticks of logarithms are of another kind
        log_ticks(axes.xaxis)
        axes.set_xlim(*_shown(report))
        axes.set_ylim(bottom=0.0)

    names = [f"{limit_name(limit)}\n{_chance(report, limit)}" for limit in limits]
    return panel_figure(
        Layout(names, side_by_side(len(limits))),
        limits,
        draw,
        title=title,
        x_label=f"{measure_name(found.intensity)} [{found.intensity.unit}]",
        y_label="share of the annual rate [%]",
        limits=limit_axes,
        note=remarks(
            f"P: probability in {report.years:g} years",
            "dashed: half of the rate from either side",
            over(found.pooled),
        ),
    )


def _shown(report: RiskReport) -> tuple[float, float]:
    """The intensities from which more than a hundredth of the largest share comes."""
    lows, highs = [], []
    for risk in report.known:
        edges, rates = risk.contributions
        counting = np.flatnonzero(rates[:-1] >= 0.01 * rates[:-1].max())
        lows.append(float(edges[counting[0]]))
        highs.append(float(edges[counting[-1] + 1]))
    return 0.9 * min(lows), 1.1 * max(highs)


def _chance(report: RiskReport, limit: LimitState) -> str:
    """Probability within a life, of the only curve or of the least and the largest."""
    rates = [risk.rate for risk in report.known if risk.fragility.limit == limit]
    ends = [f"{probability(rate, report.years):.2g}" for rate in (min(rates), max(rates))]
    return f"P = {' to '.join(dict.fromkeys(ends))}"


REPORT = Report(
    options=RiskOptions,
    numbers=risk_report,
    tables={"": risk_columns, "_contributions": contribution_columns},
    figure=risk_figure,
    drawable=lambda report: bool(report.known),
    notes=lambda report: report.notes,
    requires=risk_faults,
    results=lambda options: [limit.result for limit in limit_states(options)],
)
