"""Seismic hazard against a lognormal fragility: how often a year a
limit state is exceeded.

Between its points a hazard curve is a power law, H = H_a (im/im_a)^-k, and so it
goes on beyond the last of them. With P = Phi(ln(im/median)/beta) every such
piece of the annual rate

    rate = integral of P |dH| = P(im_0) H(im_0) + integral of H dP

has a closed form, by completing the square: no step of integration has to be chosen.

References
----------
C. A. Cornell, F. Jalayer, R. O. Hamburger and D. A. Foutch, J. Struct. Eng. 128, 2002: a
power law throughout gives rate = H(median) exp(k^2 beta^2/2).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rpscli.case.text.document import shown
from rpscli.case.text.files import read_text
from rpscli.errors import CaseError
from rpscli.model.podium import Array
from rpscli.records.measures import MEASURES, Measure
from rpscli.titled_table import Row, TitledTable, number_of, titled_table
from rpscli.units import si_value

RATE_UNITS = ("1/year", "1/yr", "1/a")
USUAL: dict[Measure, str] = {"PGA": "g", "Sa": "g", "PGV": "cm/s"}
"""Units in which hazard curves of a measure come."""


@dataclass(frozen=True, eq=False)
class Hazard:
    """Ascending intensities (points,) in SI, and how often a year
    they are exceeded [1/year].

    `fractiles` are further curves (points,), by the share of the site's models that they
    are above; `left_out` rows at the end of the table had rates of zero.
    """

    intensity: Array
    rate: Array
    fractiles: Mapping[float, Array] = field(default_factory=dict)
    left_out: int = 0

    def fractile(self, share: float) -> Hazard:
        """One of the further curves."""
        return Hazard(self.intensity, self.fractiles[share])


def read_hazard(path: Path, measure: Measure) -> Hazard:
    """A hazard curve from a CSV file headed ``PGV [cm/s],rate
    [1/year]``, then fractiles.
    """
    table = titled_table(read_text(path, wide=True), path, CaseError)
    rows = list(table.rows)
    # Tables go on with rates that print as zero.
    while rows and rows[-1].cells[1:] and {*map(number_of, rows[-1].cells[1:])} == {0.0}:
        rows.pop()
    if len(rows) < 2 and not _of_probabilities(table):
        raise CaseError(
            f"{path}: a hazard curve has a header, {_header(measure)}, and at least two"
            " rows"
        )
    factor, shares = _head(table, measure)
    for line, text in table.remarks:
        if match := _OTHERWISE.search(text):
            raise CaseError(
                f"{path}:{line}: the remark {shown(text)} says {match[0]!r}, and the"
                " column is taken as rates a year: write these, and take it away"
            )
    points = np.array([_numbers(path, row, len(shares) + 2) for row in rows])
    for (line, cells), steps in zip(rows[1:], np.diff(points, axis=0), strict=True):
        if steps[0] <= 0.0:
            raise CaseError(
                f"{path}:{line}: {shown(cells[0])} must be above the row before"
            )
        if (steps[1:] > 0.0).any():
            rate = cells[1 + int(np.argmax(steps[1:] > 0.0))]
            raise CaseError(
                f"{path}:{line}: the rate {shown(rate)} is above that of the row before;"
                " stronger motions are not more frequent"
            )
    fractiles = dict(zip(shares, points.T[2:], strict=True))
    return Hazard(
        points[:, 0] * factor, points[:, 1], fractiles, len(table.rows) - len(rows)
    )


def _header(measure: Measure) -> str:
    return f"`{measure} [{USUAL.get(measure, MEASURES[measure].unit)}],rate [1/year]`"


RATES = ("rate", "mean", "afe", "annual rate", "annual frequency of exceedance")
"""Names of the column of rates."""

_OTHERWISE = re.compile(
    r"\btimes\b|\bfactor\b|\bscale|x ?10|probabilit|\bpoe\b"
    r"|\d+ ?(?:yr|years?|jahre?|ans?|anni)\.? (?:exceed|uber|depass|super|eccedenza)",
    re.IGNORECASE,
)
"""Words of remarks that say that rates are others than they look."""

POE = (
    " probabilities of exceedance become rates by -ln(1 - poe)/t, with the investigation"
    " time t: write these into a table of a row an intensity"
)


def _of_probabilities(table: TitledTable) -> bool:
    """True of curves as OpenQuake writes them, a column an intensity."""
    return any(name.lower().startswith("poe") for name in table.names)


def _head(table: TitledTable, measure: Measure) -> tuple[float, tuple[float, ...]]:
    """Factor to SI, and the fractiles of further columns."""
    names = [name.lower() for name in table.names]
    wrong = f"{table.source}:{table.line}: the header {shown(table.written)}"
    if _of_probabilities(table):
        raise CaseError(f"{wrong} is of OpenQuake; {_header(measure)} is needed:{POE}")
    if names[:1] != [measure.lower()] or not {*names[1:2]} & {*RATES}:
        raise CaseError(
            f"{wrong} must be {_header(measure)}, and fractiles behind it, `0.16"
            " [1/year]`"
        )
    if missing := [shown(title.name) for title in table.titles if not title.unit]:
        raise CaseError(
            f"{wrong} lacks the unit of {', '.join(missing)}: write {_header(measure)}"
        )
    shares = []
    for name, unit in table.titles[1:]:
        if unit not in RATE_UNITS:
            raise CaseError(
                f"{wrong}: the unit of {name} must be one of {', '.join(RATE_UNITS)}"
            )
    for name in names[2:]:
        shares.append(number_of(name))
        if not 0.0 < shares[-1] < 1.0:
            raise CaseError(
                f"{wrong}: {shown(name)} must be a fractile, as in `0.84 [1/year]`"
            )
    unit = table.titles[0].unit
    try:
        return si_value(f"1 {unit}", MEASURES[measure].unit), tuple(shares)
    except ValueError as error:
        raise CaseError(
            f"{table.source}:{table.line}: the unit of {measure}: 1 {unit} {error}"
        ) from None


def _numbers(path: Path, row: Row, count: int) -> tuple[float, ...]:
    found = tuple(map(number_of, row.cells))
    if len(found) != count or not all(0.0 < value < math.inf for value in found):
        number = "two" if count == 2 else str(count)
        text = f"must be {number} numbers > 0, an intensity and its annual rate"
        raise CaseError(f"{path}:{row.line}: {shown(','.join(row.cells))} {text}")
    return found


def exceeded(hazard: Hazard, intensities: Array) -> Array:
    """(n,) how often a year the ground motion is above intensities [1/year]."""
    x = np.log(hazard.intensity)
    height = np.log(hazard.rate)
    at = np.log(intensities)
    first = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    slopes = np.diff(height) / np.diff(x)
    return np.asarray(np.exp(height[first] + slopes[first] * (at - x[first])))


def rate_of_shares(hazard: Hazard, intensities: Array, shares: Array) -> float:
    """The annual rate straight from shares (levels,) that exceed the limit [1/year]."""
    # By parts: P(im_0) H(im_0) + integral of H dP. Shares are linear in ln im and
    # constant outside; the mean of a power law over a step of the logarithm is the
    # logarithmic mean of its ends.
    levels = intensities[intensities > hazard.intensity[0]]
    grid = np.unique(np.concatenate([hazard.intensity, levels]))
    rates = exceeded(hazard, grid)
    probable = np.interp(np.log(grid), np.log(intensities), shares)
    ratio = np.log(rates[:-1] / rates[1:])
    flat = ratio < 1e-9
    means = np.where(flat, rates[1:], -np.diff(rates) / np.where(flat, 1.0, ratio))
    return float(probable[0] * rates[0] + np.diff(probable) @ means)


def annual_rate(hazard: Hazard, median: float, beta: float) -> float:
    """Annual rate at which motions above the curve's first point
    exceed the limit [1/year].
    """
    low = hazard.intensity[:1]
    return float(rates_above(hazard, median, beta, low)[0])


def rates_above(hazard: Hazard, median: float, beta: float, intensities: Array) -> Array:
    """(n,) how often a year motions above intensities of the curve
    exceed the limit [1/year].
    """
    from scipy.special import ndtr

    x = np.log(hazard.intensity)
    height = np.log(hazard.rate)
    slopes = -np.diff(height) / np.diff(x)
    at = np.log(intensities)
    first = np.minimum(np.searchsorted(x, at, side="right") - 1, len(slopes) - 1)
    here = np.log(exceeded(hazard, intensities))
    # Whole pieces, then the one without end, and of each the part above an intensity in
    # it.
    ends = np.append(x[1:-1], math.inf)
    pieces = _pieces(height[:-1], slopes, x[:-1], ends, math.log(median), beta)
    later = np.append(np.cumsum(pieces[::-1])[::-1][1:], 0.0)
    part = _pieces(here, slopes[first], at, ends[first], math.log(median), beta)
    return np.asarray(
        ndtr((at - math.log(median)) / beta) * np.exp(here) + part + later[first]
    )


def _pieces(
    height: Array, slope: Array, start: Array, end: Array, middle: float, beta: float
) -> Array:
    """Integrals of H dP over power laws that have the logarithm
    `height` at their start.
    """
    from scipy.special import log_ndtr

    constant = height + slope * (start - middle) + 0.5 * (slope * beta) ** 2
    low, high = ((y - middle) / beta + slope * beta for y in (start, end))
    # In the tail where both are small, or their difference would have no digits.
    low, high = np.where(low > 0.0, (-high, -low), (low, high))
    with np.errstate(divide="ignore"):
        below = log_ndtr(low)
        above = log_ndtr(high)
        return np.asarray(np.exp(constant + above + np.log1p(-np.exp(below - above))))
