"""Risk: how often in its life a structure exceeds its limit states, from fragility and hazard."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Field

from rpscli.case.schema.fields import Quantity, Section, Text
from rpscli.errors import CaseError
from rpscli.records.measures import AT_PERIOD, Measure
from rpscli.report.study.fragility import (
    Fragilities,
    Fragility,
    FragilityOptions,
    LimitState,
    fragilities,
    limit_name,
    limit_states,
    measure_name,
    side_by_side,
)
from rpscli.report.study.labels import keyed, labels
from rpscli.report.study.panels import Layout, colour, log_ticks, over, panel_figure, remarks
from rpscli.report.study.report import Found, Report
from rpscli.sweep.fits.hazard import Hazard, annual_rate, rates_above, read_hazard
from rpscli.sweep.fits.lognormal import NOTHING, Band, percentiles
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BINS = 24
"""Of intensities, for what contributes."""
CLEARLY = 0.05
"""Share of the rate beyond which the ends of the hazard curve are worth a note."""


class HazardSection(Section):
    """A hazard curve: how often a year each intensity is exceeded at the site."""

    file: Text = Field(
        description="CSV with the header `PGV [cm/s],rate [1/year]`, seen from the study's folder"
    )
    measure: Measure = Field(description="of its first column")


class RiskOptions(FragilityOptions):
    """Annual rates of limit states, from their fragilities and a hazard curve."""

    hazard: HazardSection = Field(description="the hazard curve")
    years: Annotated[float, Quantity(above=0)] = Field(
        50.0, description="the life for which a probability is given"
    )


@dataclass(frozen=True, eq=False)
class Risk:
    """Annual rate of one limit state of one group of systems; NaN without a fragility.

    `rates` (bins,) are from motions between `edges` (bins + 1,), the last of which is infinite.
    `band` encloses the confidence asked for over the bootstrap samples of the fragility; `half` is
    the intensity that half of the rate comes from below.
    """

    fragility: Fragility
    rate: float
    band: Band
    edges: Array
    rates: Array
    half: float
    notes: tuple[str, ...]


def probability(rate: float, years: float) -> float:
    """Of at least one excess within so many years, if excesses are a Poisson process.

    >>> round(probability(1 / 475, 50), 3)
    0.1
    """
    return -math.expm1(-rate * years)


def risk_faults(layout: StudyPoints, options: RiskOptions) -> Iterator[str]:
    """What keeps a study from having a risk: its hazard curve, above all."""
    measure = options.hazard.measure
    if options.measure not in (None, measure):
        yield f"measure: {options.measure} is not hazard.measure: {measure}; take the first out"
    if measure in AT_PERIOD and options.period is None:
        yield f"a hazard curve of {measure} is for one period; give the report a `period`"
    try:
        hazard_of(layout, options)
    except CaseError as error:
        yield str(error)


def hazard_of(layout: StudyPoints, options: RiskOptions) -> Hazard:
    """The hazard curve that a report names."""
    return read_hazard(layout.study.folder / options.hazard.file, options.hazard.measure)


def risk(study: StudyResults, options: RiskOptions) -> Found:
    """Fit the fragilities and integrate them over the hazard."""
    hazard = hazard_of(study.table.layout, options)
    options = options.model_copy(update={"measure": options.hazard.measure})
    found = fragilities(study, options)
    risks = [risk_of(curve, hazard, options.confidence) for curve in found.curves]
    known = [each for each in risks if each.fragility.fit.fitted]
    keys, measured, unit = found.systems.keys, found.intensity.measure, found.intensity.unit
    life = f"probability_in_{options.years:g}_years"
    heads = {"limit": "-"}
    heads |= dict.fromkeys(("annual_rate", "annual_rate_low", "annual_rate_high"), "1/year")
    heads |= {"return_period": "year"} | dict.fromkeys((life, f"{life}_low", f"{life}_high"), "-")
    heads |= {f"half_from_{measured}_below": unit, "median": unit, "beta": "-", "note": "-"}
    rows = [
        (
            each.fragility.values,
            each.fragility.limit.label,
            *rates,
            1.0 / each.rate if each.rate > 0.0 else math.nan,
            *(probability(rate, options.years) for rate in rates),
            each.half,
            fit.median,
            fit.beta,
            "; ".join(filter(None, [fit.note, *each.notes])) or None,
        )
        for each in risks
        for fit, rates in [(each.fragility.fit, (each.rate, *each.band))]
    ]
    part_heads = {
        "limit": "-", f"{measured}_from": unit, f"{measured}_to": unit, "annual_rate": "1/year",
        "share": "-",
    }  # fmt: skip
    parts = [
        (each.fragility.values, each.fragility.limit.label, low, high, rate, rate / each.rate)
        for each in known
        for low, high, rate in zip(each.edges, each.edges[1:], each.rates, strict=False)
    ]
    notes = dict.fromkeys(
        f"{found.named(each.fragility)}: {note}" for each in risks for note in each.notes
    )
    return Found(
        {"": keyed(keys, heads, rows), "_contributions": keyed(keys, part_heads, parts)},
        (lambda title: risk_figure(found, known, options.years, title)) if known else None,
        [*found.notes, *notes],
    )


def risk_of(fragility: Fragility, hazard: Hazard, confidence: float) -> Risk:
    """The annual rate of one fragility, with what contributes to it."""
    low, high = hazard.intensity[[0, -1]]
    edges = np.append(np.geomspace(low, high, BINS + 1), math.inf)
    if not fragility.fit.fitted:
        none = np.full(BINS + 1, math.nan)
        return Risk(fragility, math.nan, NOTHING, edges, none, math.nan, ())
    fit = fragility.fit
    above = np.append(rates_above(hazard, fit.median, fit.beta, edges[:-1]), 0.0)
    tails = (50.0 * (1.0 - confidence), 50.0 * (1.0 + confidence))
    # A sample in which fewer exceed the limit in stronger motions has no lognormal fragility.
    sampled = [
        annual_rate(hazard, median, beta)
        for median, beta in zip(*fit.resampled, strict=True)
        if 0.0 < beta < math.inf and 0.0 < median < math.inf
    ]
    lost = len(fit.resampled[0]) - len(sampled)
    return Risk(
        fragility=fragility,
        rate=float(above[0]),
        band=percentiles(np.array(sampled), tails),
        edges=edges,
        rates=-np.diff(above),
        half=_half(hazard, fragility),
        notes=tuple(_notes(fragility, hazard, above, lost)),
    )


def _half(hazard: Hazard, fragility: Fragility) -> float:
    """The intensity below and above which motions contribute the same."""
    fit = fragility.fit
    low, high = np.log(hazard.intensity[0]), np.log(hazard.intensity[-1]) + 10.0
    whole = annual_rate(hazard, fit.median, fit.beta)
    for _ in range(60):  # halving, to the last digits
        middle = 0.5 * (low + high)
        rest = rates_above(hazard, fit.median, fit.beta, np.exp([middle]))[0]
        low, high = (middle, high) if rest > 0.5 * whole else (low, middle)
    return float(np.exp(low))


def _notes(fragility: Fragility, hazard: Hazard, above: Array, lost: int) -> Iterator[str]:
    first = math.log(hazard.intensity[0] / fragility.fit.median)
    probable = 0.5 * math.erfc(-first / fragility.fit.beta / math.sqrt(2.0))
    if hazard.rate[0] * probable / above[0] > CLEARLY:
        yield (
            "the fragility is not negligible at the first intensity of the hazard curve, below"
            " which nothing is counted; begin the curve with weaker motions"
        )
    if (beyond := above[-2] / above[0]) > CLEARLY:
        yield (
            f"{100.0 * beyond:.0f} % of the annual rate come from beyond the last intensity of the"
            " hazard curve, which is continued with its last slope; extend the curve"
        )
    if lost:
        yield (
            f"{lost} bootstrap samples have fragilities that do not grow with the intensity, and"
            " are left out of the bands"
        )


def risk_figure(found: Fragilities, risks: Sequence[Risk], years: float, title: str) -> bytes:
    """One panel a limit state: what share of its rate comes from which intensities."""
    limits = [limit for limit in found.limits if found.fitted(limit)]
    values = list(dict.fromkeys(each.fragility.values for each in risks))

    def draw(axes: Axes, limit: LimitState) -> None:
        for each in risks:
            if each.fragility.limit != limit:
                continue
            place = values.index(each.fragility.values)
            shade = colour(place, len(values))
            axes.stairs(
                100.0 * each.rates[:-1] / each.rate, each.edges[:-1], color=shade, lw=1.4,
                label=labels(found.systems.keys, each.fragility.values) or None,
            )  # fmt: skip
            axes.axvline(each.half, color=shade, lw=0.8, ls="--")

    def limit_axes(axes: Axes) -> None:
        axes.set_xscale("log")  # of all panels at the end: ticks of logarithms are of another kind
        log_ticks(axes.xaxis)
        axes.set_xlim(*_shown(risks))
        axes.set_ylim(bottom=0.0)

    names = [f"{limit_name(limit)}\n{_chance(risks, limit, years)}" for limit in limits]
    return panel_figure(
        Layout(names, side_by_side(len(limits))),
        limits,
        draw,
        title=title,
        x_label=f"{measure_name(found.intensity)} [{found.intensity.unit}]",
        y_label="share of the annual rate [%]",
        limits=limit_axes,
        note=remarks(
            f"P: probability in {years:g} years",
            "dashed: half of the rate from either side",
            over(found.systems.pooled),
        ),
    )


def _shown(risks: Sequence[Risk]) -> tuple[float, float]:
    """The intensities from which more than a hundredth of the largest share comes."""
    lows, highs = [], []
    for each in risks:
        counting = np.flatnonzero(each.rates[:-1] >= 0.01 * each.rates[:-1].max())
        lows.append(float(each.edges[counting[0]]))
        highs.append(float(each.edges[counting[-1] + 1]))
    return 0.9 * min(lows), 1.1 * max(highs)


def _chance(risks: Sequence[Risk], limit: LimitState, years: float) -> str:
    """Probability within a life, of the only curve or of the least and the largest."""
    rates = [each.rate for each in risks if each.fragility.limit == limit]
    ends = [f"{probability(rate, years):.2g}" for rate in (min(rates), max(rates))]
    return f"P = {' to '.join(dict.fromkeys(ends))}"


REPORT = Report(
    RiskOptions,
    risk,
    requires=risk_faults,
    results=lambda options: [limit.result for limit in limit_states(options)],
)
