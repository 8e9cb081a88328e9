"""Risk: how often in its life a structure exceeds its limit states,
from fragility and hazard.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.fields import Quantity
from rpscli.case.study.schema import HazardSection
from rpscli.errors import CaseError
from rpscli.records.measures import Of, needs_period
from rpscli.report.figures import style
from rpscli.report.study import fragility as fragile
from rpscli.report.study import panels
from rpscli.report.study.fragility import MOST_BANDS, Fragilities, Fragility
from rpscli.report.study.fragility_options import FragilityOptions
from rpscli.report.study.report import Found, Report, keyed, with_band
from rpscli.report.table import Column
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics import hazard as rates
from rpscli.sweep.statistics.hazard import Hazard, annual_rate
from rpscli.sweep.statistics.lognormal import NOTHING, Band, band
from rpscli.sweep.statistics.verdicts import component_notes
from rpscli.sweep.table import Array, StoredPoints

BINS = 24  # of intensities, for what contributes
CLEARLY = (
    0.05  # share of the rate beyond which the ends of the hazard curve are worth a note
)


class RiskOptions(FragilityOptions):
    """Annual rates of limit states, from their fragilities and a hazard curve."""

    hazard: HazardSection | None = Field(
        None, description="the hazard curve; that of the study by default"
    )
    years: Annotated[float, Quantity(above=0)] = Field(
        50.0, description="the life for which a probability is given"
    )


@dataclass(frozen=True, eq=False)
class Risk:
    """Annual rate of one limit state of one group of systems; NaN without a fragility."""

    fragility: Fragility
    rate: float
    band: Band  # over the bootstrap samples of the fragility
    edges: Array  # of bins of intensity (bins + 1,), the last is infinite
    rates: Array  # from motions in these (bins,)
    of_records: float  # without other uncertainties
    of_shares: float  # straight from the observed shares
    of_hazard: tuple[float, ...]  # of the further hazard curves (fractiles,)
    beyond_computed: (
        float  # share of the rate beyond the largest intensity that was computed
    )
    below_computed: float  # likewise, below the smallest one
    notes: tuple[str, ...]

    @property
    def note(self) -> str | None:
        """Doubts about the fragility and the rate."""
        return "; ".join(filter(None, [self.fragility.fit.note, *self.notes])) or None

    @property
    def beyond_hazard(self) -> float:
        """Share of the rate."""
        return float(self.rates[-1] / self.rate)

    def probabilities(self, years: float) -> tuple[float, ...]:
        """Of an excess within so many years (a Poisson process), and
        of both ends of the band.
        """
        return tuple(-math.expm1(-rate * years) for rate in (self.rate, *self.band))


def risk_faults(layout: StudyPoints, options: RiskOptions) -> Iterator[str]:
    """Faults that keep a study from having a risk: of its hazard curve, above all."""
    section = options.hazard or layout.study.file.hazard
    if section is None:
        yield "hazard is missing; name its curve, `hazard: {file: FILE, measure: PGV}`"
        return
    measure = section.measure
    if options.measure not in (None, measure):
        yield f"measure: {options.measure} is not hazard.measure: {measure}; remove the first"
    if needs_period(measure) and options.period is None:
        yield f"a hazard curve of {measure} is for one period; give the report a `period`"
    yield from fragile.fragility_faults(
        layout, options.model_copy(update={"measure": measure})
    )
    try:
        rates.read_hazard(layout.study.folder / section.file, section.measure)
    except CaseError as error:
        yield str(error)


def risk(study: StoredPoints, options: RiskOptions) -> Found:
    """Fit the fragilities and integrate them over the hazard."""
    layout = study.table.layout
    section = options.hazard or layout.study.file.hazard
    assert section is not None, "asked before"
    hazard = rates.read_hazard(layout.study.folder / section.file, section.measure)
    options = options.model_copy(update={"measure": section.measure})
    found = fragile.fragilities(study, options)
    risks = [risk_of(curve, hazard, options) for curve in found.curves]
    known = [each for each in risks if each.fragility.fit.fitted]
    keys = found.systems.keys
    columns = _quantities(found, options, hazard)
    rows = [
        (each.fragility.values, *(of.value(each) for of in columns)) for each in risks
    ]
    heads = ", ".join(f"{of.name} [{of.unit}]" for of in columns)
    tables = {
        "": keyed(keys, heads, rows),
        "_contributions": _contributions(found, known),
        **({"_at": fragile.margins(study, options, found)} if options.at else {}),
    }
    readers = {of.name: of.label for of in columns if of.label}
    return Found(
        tables,
        risk_figure(found, risks, options.years) if known else None,
        [*_report_notes(found, known, section.component), *found.notes],
        shown={"": dict.fromkeys(keys, "") | readers}
        | ({"_at": {}} if options.at else {}),
        remark=(
            f"{fragile.what_bands_hold(layout, options)}; rate of shares: from observed"
            " shares, no lognormal"
        ),
    )


class _Quantity(NamedTuple):
    """A column: name, unit, what readers see above it, if they see it, and its value."""

    name: str
    unit: str
    label: str | None
    value: Callable[[Risk], object]


def _quantities(
    found: Fragilities, options: RiskOptions, hazard: Hazard
) -> list[_Quantity]:
    """The columns of all rates."""
    years = options.years
    life = f"probability_in_{years:g}_years"
    total = bool(options.dispersion.given)
    rows: list[tuple[str, str, str | None, Callable[[Risk], object]]] = [
        ("limit", "-", "limit", lambda r: r.fragility.limit.label),
        ("annual_rate", "1/year", "annual rate", lambda r: r.rate),
        ("return_period", "year", "return period", lambda r: 1.0 / r.rate if r.rate else math.nan),
        ("annual_rate_low", "1/year", None, lambda r: r.band[0]),
        ("annual_rate_high", "1/year", None, lambda r: r.band[1]),
        (life, "-", f"P in {years:g} years", lambda r: r.probabilities(years)[0]),
        (f"{life}_low", "-", None, lambda r: r.probabilities(years)[1]),
        (f"{life}_high", "-", None, lambda r: r.probabilities(years)[2]),
        ("median", found.intensity.unit, "median", lambda r: r.fragility.fit.median),
        ("beta", "-", "beta", lambda r: r.fragility.fit.beta),
        ("beta_total", "-", "beta total" if total else None, lambda r: r.fragility.total),
        ("confidence", "-", None, lambda _: options.confidence),
        (
            "annual_rate_of_records", "1/year", "rate of records alone" if total else None,
            lambda r: r.of_records,
        ),
        ("annual_rate_of_shares", "1/year", "rate of shares", lambda r: r.of_shares),
        *(
            (
                f"annual_rate_of_hazard_{100 * share:g}", "1/year",
                f"rate of hazard {100 * share:g} %", lambda r, n=n: r.of_hazard[n],
            )
            for n, share in enumerate(hazard.fractiles)
        ),
        ("share_beyond_computed", "-", "from beyond computed", lambda r: r.beyond_computed),
        ("share_below_computed", "-", "from below computed", lambda r: r.below_computed),
        ("share_beyond_hazard", "-", "from beyond hazard", lambda r: r.beyond_hazard),
        ("note", "-", None, lambda r: r.note),
    ]  # fmt: skip
    return [_Quantity(*row) for row in rows]


def _contributions(found: Fragilities, risks: Sequence[Risk]) -> list[Column]:
    """One row a bin of intensities: the rate from motions in it."""
    measured = found.intensity.name
    unit = found.intensity.unit
    rows = [
        (
            each.fragility.values,
            each.fragility.limit.label,
            low,
            high,
            rate,
            rate / each.rate,
        )
        for each in risks
        for low, high, rate in zip(each.edges, each.edges[1:], each.rates, strict=False)
    ]
    ends = f"{measured}_from [{unit}], {measured}_to [{unit}]"
    return keyed(found.systems.keys, f"limit, {ends}, annual_rate [1/year], share", rows)


def risk_of(fragility: Fragility, hazard: Hazard, options: RiskOptions) -> Risk:
    """The annual rate of one fragility, with what contributes to it."""
    low, high = hazard.intensity[[0, -1]]
    edges = np.append(np.geomspace(low, high, BINS + 1), math.inf)
    fit = fragility.fit
    total = fragility.total
    observed = fragility.observed
    nan = math.nan
    of_shares = math.nan
    if observed.share.any():
        of_shares = rates.rate_of_shares(hazard, observed.intensity, observed.share)
    if not fit.fitted:
        none = np.full(BINS + 1, nan)
        lost = (nan,) * len(hazard.fractiles)
        known = (none, nan, of_shares, lost, nan, nan, ())
        return Risk(fragility, nan, NOTHING, edges, *known)
    ends = [max(fragility.smallest, low), max(fragility.largest, low)]
    at = np.append(edges[:-1], ends)
    above = rates.rates_above(hazard, fit.median, total, at)
    medians, betas = fit.resampled
    sampled = [
        annual_rate(hazard, *pair) if 0.0 < pair[0] < math.inf else nan
        for pair in zip(medians, options.dispersion.total(betas), strict=True)
    ]
    rate = float(above[0])
    curves = [hazard.fractile(share) for share in hazard.fractiles]
    return Risk(
        fragility,
        rate,
        band=band(np.array(sampled), options.confidence),
        edges=edges,
        rates=-np.diff(np.append(above[:-2], 0.0)),
        of_records=annual_rate(hazard, fit.median, fit.beta),
        of_shares=of_shares,
        of_hazard=tuple(annual_rate(curve, fit.median, total) for curve in curves),
        beyond_computed=float(above[-1] / rate),
        below_computed=float(1.0 - above[-2] / rate),
        notes=tuple(_notes(fragility, hazard, rate, of_shares)),
    )


def _notes(
    fragility: Fragility, hazard: Hazard, rate: float, of_shares: float
) -> Iterator[str]:
    """Doubts about one rate, and about that of the shares."""
    fit = fragility.fit
    weakest = fragility.observed.intensity[:1]
    unseen = fragility.observed.share[0] * (
        hazard.rate[0] - rates.exceeded(hazard, weakest)[0]
    )
    if unseen > CLEARLY * of_shares:
        yield (
            f"{100.0 * unseen / of_shares:.0f} % of the rate of shares come from below"
            " the weakest intensity computed, where its share is assumed to hold too;"
            " add weaker ones"
        )
    first = math.log(hazard.intensity[0] / fit.median)
    probable = 0.5 * math.erfc(-first / fragility.total / math.sqrt(2.0))
    if hazard.rate[0] * probable / rate > CLEARLY:
        yield (
            "the fragility is not negligible at the first intensity of the hazard curve,"
            " below which nothing is counted; begin the curve with weaker motions"
        )
    if fit.method == "penalised":
        below, above = fit.between
        most = rates.exceeded(hazard, np.array([max(below, hazard.intensity[0])]))[0]
        least = rates.exceeded(hazard, np.array([above]))[0] if above < math.inf else 0.0
        yield f"separated data show only that the rate is between {least:.2g} and {most:.2g}"


def _report_notes(
    found: Fragilities, risks: Sequence[Risk], of: Of | None
) -> Iterator[str]:
    """Shares of rates from beyond what is known, and the
    component that the hazard is of.
    """
    places = {
        "beyond_computed": (
            "beyond the largest intensity computed, by the fitted curve; add intensities"
        ),
        "below_computed": (
            "below the weakest intensity computed, by the fitted curve; add weaker ones"
        ),
        "beyond_hazard": (
            "beyond the last intensity of the hazard curve, which is continued with its last"
            " slope; extend the curve"
        ),
    }
    for name, place in places.items():
        shares = [(float(getattr(each, name)), each) for each in risks]
        far = [pair for pair in shares if pair[0] > CLEARLY]
        if far:
            most, worst = max(far, key=lambda pair: pair[0])
            share = f"{'up to ' * (len(far) > 1)}{100.0 * most:.0f} %"
            which = (
                f"({found.named(worst.fragility)}; above 5 % in {len(far)} of"
                f" {len(risks)})"
            )
            yield f"{share} of the annual rate {which} come from {place}"
    yield from component_notes(of, found.intensity.of)
    yield from found.told((each.fragility, "; ".join(each.notes)) for each in risks)


def risk_figure(
    found: Fragilities, risks: Sequence[Risk], years: float
) -> Callable[[str], style.Draw]:
    """One panel a limit state: what share of its rate comes from which intensities."""
    groups = found.in_panels(risks, lambda each: each.fragility)
    known = [each for each in risks if each.fragility.fit.fitted]
    rows = min(max(map(len, groups.values())), MOST_BANDS)
    (low, high) = _shown(known)
    last = float(known[0].edges[-2])

    def limit_axes(axes: style.Axes) -> None:
        # Of all panels at the end: ticks of logarithms are of another kind.
        axes.set_xscale("log")
        panels.log_ticks(axes.xaxis)
        axes.set_xlim(low, high)
        axes.set_ylim(0.0, axes.get_ylim()[1] / (0.97 - _line(axes) * rows))

    note = panels.remarks(
        f"P in {years:g} years, {style.percent(found.confidence)} bands of the choice of"
        " records",
        "dotted: all from beyond the hazard curve" * (high > last),
        "grey: nothing computed",
        panels.over(found.systems.pooled),
    )
    y_label = "share of the annual rate [%]"
    draw = partial(_draw_shares, found=found, years=years, shown=(low, high))
    return found.figure(groups, draw, y_label=y_label, note=note, limits=limit_axes)


def _draw_shares(
    axes: style.Axes,
    panel: list[Risk],
    found: Fragilities,
    years: float,
    shown: tuple[float, float],
) -> None:
    """Shares of the rates of one panel, between the intensities that are shown."""
    low, high = shown
    panel = [each for each in panel if each.fragility.fit.fitted]
    if not panel:
        panels.nothing(axes, "no rate")
        return
    for row, each in enumerate(panel):
        _, name, place, count = found.placed(each.fragility)
        shade = panels.colour(place, count)
        shares = 100.0 * each.rates / each.rate
        last = float(each.edges[-2])
        axes.stairs(shares[:-1], each.edges[:-1], color=shade, lw=1.4, label=name or None)
        if high > last:
            axes.stairs(shares[-1:], [last, high], color=shade, lw=1.4, ls=":")
        if len(panel) <= MOST_BANDS and not style.tight(axes.figure):
            band = with_band(*each.probabilities(years))
            words = f"P = {band.replace(' (', f'{panels.break_if_narrow(axes)}(')}"
            axes.text(
                0.02, 0.98 - _line(axes) * row, words, color=shade, transform=axes.transAxes,
                va="top", fontsize=0.85 * style.small(),
            )  # fmt: skip
    ends = [(each.fragility.smallest, each.fragility.largest) for each in panel]
    fragile.shade_not_computed(axes, max(end for _, end in ends), high)
    fragile.shade_not_computed(axes, low, min(start for start, _ in ends))


def _line(axes: style.Axes) -> float:
    """Height of the numbers above the steps: two lines where panels are narrow."""
    return 0.15 if style.narrow(axes.figure) else 0.075


def _shown(risks: Sequence[Risk]) -> tuple[float, float]:
    """The intensities from which more than a hundredth of the largest share comes."""
    edges = risks[0].edges
    counting = [np.flatnonzero(of.rates >= 0.01 * of.rates[:-1].max()) for of in risks]
    high = min(edges[max(of[-1] for of in counting) + 1], 1.4 * edges[-2])
    return 0.9 * float(edges[min(of[0] for of in counting)]), 1.1 * float(high)


REPORT = Report(
    RiskOptions, risk, requires=risk_faults, results=lambda options: options.results
)
