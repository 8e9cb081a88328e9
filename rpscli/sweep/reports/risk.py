"""Risk: how often in its life a structure exceeds its limit states, from fragility and hazard."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.fields import Quantity, Section, Text
from rpscli.errors import CaseError
from rpscli.records.measures import Measure
from rpscli.sweep.fits.hazard import Hazard, annual_rate, rates_above, read_hazard
from rpscli.sweep.fits.lognormal import NOTHING, Band, percentiles
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.reports.fragility import (
    Fragility,
    FragilityOptions,
    FragilityReport,
    fragility_report,
)
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array

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


class Contributions(NamedTuple):
    """Annual rates (bins,) from motions between edges (bins + 1,); the last edge is infinite."""

    edges: Array
    rates: Array


@dataclass(frozen=True, eq=False)
class Risk:
    """Annual rate of one limit state of one group of systems; NaN without a fragility.

    `band` encloses the confidence asked for over the bootstrap samples of the fragility; `half` is
    the intensity that half of the rate comes from below.
    """

    fragility: Fragility
    rate: float
    band: Band
    contributions: Contributions
    half: float
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class RiskReport:
    """All of them."""

    fragilities: FragilityReport
    hazard: Hazard
    years: float
    risks: tuple[Risk, ...]

    @property
    def known(self) -> list[Risk]:
        """Those that have a rate."""
        return [risk for risk in self.risks if risk.fragility.fitted]

    @property
    def notes(self) -> list[str]:
        """What keeps fragilities and rates from being plain."""
        named = self.fragilities.named
        found = [f"{named(risk.fragility)}: {note}" for risk in self.risks for note in risk.notes]
        return [*self.fragilities.notes, *dict.fromkeys(found)]


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
    if measure == "Sa" and options.period is None:
        yield "a hazard curve of Sa is for one period; give the report a `period`"
    try:
        hazard_of(layout, options)
    except CaseError as error:
        yield str(error)


def hazard_of(layout: StudyPoints, options: RiskOptions) -> Hazard:
    """The hazard curve that a report names."""
    return read_hazard(layout.study.folder / options.hazard.file, options.hazard.measure)


def risk_report(study: StudyResults, options: RiskOptions) -> RiskReport:
    """Fit the fragilities and integrate them over the hazard."""
    hazard = hazard_of(study.table.layout, options)
    options = options.model_copy(update={"measure": options.hazard.measure})
    fragilities = fragility_report(study.table, study.intensity(options), options)
    risks = tuple(risk_of(curve, hazard, options.confidence) for curve in fragilities.curves)
    return RiskReport(fragilities, hazard, options.years, risks)


def risk_of(fragility: Fragility, hazard: Hazard, confidence: float) -> Risk:
    """The annual rate of one fragility, with what contributes to it."""
    low, high = hazard.intensity[[0, -1]]
    edges = np.append(np.geomspace(low, high, BINS + 1), math.inf)
    if not fragility.fitted:
        nothing = Contributions(edges, np.full(BINS + 1, math.nan))
        return Risk(fragility, math.nan, NOTHING, nothing, math.nan, ())
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
        contributions=Contributions(edges, -np.diff(above)),
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


def _notes(fragility: Fragility, hazard: Hazard, above: Array, lost: int) -> Iterable[str]:
    at_first = (hazard.rate[0] * _probability(fragility, hazard.intensity[0])) / above[0]
    if at_first > CLEARLY:
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


def _probability(fragility: Fragility, intensity: float) -> float:
    fit = fragility.fit
    return 0.5 * math.erfc(-math.log(intensity / fit.median) / fit.beta / math.sqrt(2.0))
