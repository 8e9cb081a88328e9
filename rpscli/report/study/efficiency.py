"""Efficiency and sufficiency of intensity measures, from intensities at which limits are passed.

An incremental dynamic analysis, read across: the intensity at which a record first passes a limit
lies between two of its levels, by any measure. A measure is *efficient* if these intensities
scatter little from record to record (their beta), and *sufficient* if they do not depend on what
else is known of the record: magnitude, distance, durations, other measures. Residuals are those of
intensities at a response, so that overturned histories count in full. Those of responses at an
intensity (sigma; of overturning, of rotations) are about a power law near the median at the limit;
an overturned history is known to have gone at least as far as where it was left.

References
----------
N. Luco and C. A. Cornell, Earthq. Spectra 23, 2007 (efficiency and sufficiency); D. Vamvatsikos and
C. A. Cornell, Earthq. Spectra 21, 2005 (the scatter of intensities at a limit state).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from rpscli.case.conditions import LIMITS
from rpscli.case.schema.fields import Several, Text
from rpscli.case.schema.scale_to import ScaleToSection, scale_to_of
from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.errors import RecordError, listed
from rpscli.records.measures import MEASURES, intensity_measures, needs_period
from rpscli.report.figures import style
from rpscli.report.study.fragility import (
    LimitState,
    LimitStates,
    limit_panels,
    limit_states,
    limited_results,
    measure_name,
)
from rpscli.report.study.ida import height, single_intensity
from rpscli.report.study.labels import keyed, labels
from rpscli.report.study.panels import colour, over, panel_figure, remarks
from rpscli.report.study.report import Found, Report
from rpscli.sweep.fits.censored import censored_fit, chance
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping
from rpscli.sweep.statistics.verdicts import exceeds
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array, Indices

BITS = 1e-3
"""Half of the width in ln within which a response that is known is taken to lie."""


class Row(NamedTuple):
    """One measure at one limit of one group of systems; NaN where nothing determines a number."""

    values: tuple[object, ...]
    limit: str
    measure: str
    unit: str
    most_telling: str | None
    median: float
    beta: float
    sigma: float
    records: int
    never: int
    p_magnitude: float
    p_distance: float
    p_d5_75: float
    p_d5_95: float
    p_most_telling: float


KNOWN = {
    "magnitude": "magnitude", "distance": "ln distance", "d5_75": "ln D5-75", "d5_95": "ln D5-95",
}  # fmt: skip
"""What intensities at limits may depend on, besides other measures."""

NEAR = 2.0
"""Times the median intensity at a limit, or as many parts of it, between which responses count."""

RESPONSES = {"overturning": "rotation_ratio"}

Measures = Annotated[tuple[Text, ...], Several(Text, spaced=False)]


class EfficiencyOptions(ReportOptions):
    """Which intensity measure tells most of the response, and whether others tell more."""

    measures: Measures = ("PGA", "PGV", "Sa", "Housner")
    """intensity measures, at a period as in Sa(1 s), else at T1 of each system"""
    limits: LimitStates = Field(LimitStates(), description="limit states")
    series: VariedKeys | None = Field(None, description="varied keys, kept apart; all by default")


class Passed(NamedTuple):
    """Records of a group by levels: points (levels, records), which of them are beyond a limit."""

    points: Indices
    beyond: NDArray[np.bool_]

    def between(self, values: Array) -> tuple[Array, Array]:
        """(records,) values of the last level that keeps the limit, and of the first beyond."""
        at, first = values[self.points], np.argmax(self.beyond, axis=0)
        ever, records = self.beyond.any(axis=0), np.arange(self.points.shape[1])
        last = np.where(ever, first - 1, len(self.points) - 1)
        low = np.where(last >= 0, at[last, records], -np.inf)
        return low, np.where(ever, at[first, records], np.inf)


class Dependence(NamedTuple):
    """Of the intensity at a limit on something else: slope, scatter that is left, p-value."""

    against: str
    slope: float
    beta: float
    p: float


def efficiency(study: StudyResults, options: EfficiencyOptions) -> Found:
    """Scatter of the intensities at each limit by each measure, and what it depends on."""
    found = grouping(study.table, options.series, (INTENSITY,))
    measured = {
        measure_name(one): one for one in map(study.intensity, map(asked, options.measures))
    }
    with np.errstate(divide="ignore"):  # nothing at a factor of 0
        logs = {name: np.log(one.values) for name, one in measured.items()}
    # The ratio of two measures of a record does not depend on the factor on it.
    sizes = {name: logs[name] / (1 + (one.measure == "Arias")) for name, one in measured.items()}
    known, limits = _known_of_records(study), list(limit_states(options.limits))
    rows, further = [], []
    for limit, group in product(limits, found.groups):
        passed = _passed(group, limit.result, limit.threshold or 0.0)
        last = passed.points[-1]
        weight = len(np.unique(study.table.clusters[last])) / max(len(last), 1)
        for name, values in logs.items():
            between = passed.between(values)
            alone = censored_fit(*between)
            others = {f"{o}/{name}": sizes[o] - sizes[name] for o in sizes if o != name}
            tests = [
                Dependence(against, float(fit.slopes[0]), fit.sigma, chance(alone, fit, weight))
                for against, each in (known | others).items()
                if alone and (fit := censored_fit(*between, each[last][:, None]))
            ]
            p_of = {test.against: test.p for test in tests}
            telling = {p_of[f"{o}/{name}"]: o for o in logs if f"{o}/{name}" in p_of}
            least = min(telling, default=math.nan)
            of = (group.values, limit.label, name)
            further += [(*of, *test) for test in tests]
            chances: Any = {f"p_{key}": p_of.get(words, math.nan) for key, words in KNOWN.items()}
            rows.append(
                Row(
                    *of,
                    unit=measured[name].unit,
                    most_telling=telling.get(least),
                    median=math.exp(alone.mean) if alone else math.nan,
                    beta=alone.sigma if alone else math.nan,
                    sigma=_scatter_of_responses(group, limit, values, alone.mean)
                    if alone
                    else math.nan,
                    records=len(last),
                    never=int(np.isinf(between[1]).sum()),
                    p_most_telling=least,
                    **chances,
                )
            )
    heads = dict.fromkeys(Row._fields[1:], "-")
    of_further = dict.fromkeys(("limit", "measure", *Dependence._fields), "-")
    tables = {
        "": keyed(found.keys, heads, rows),
        "_sufficiency": keyed(found.keys, of_further, further),
    }
    notes = list(found.notes)
    if unknown := [words for words in KNOWN.values() if words not in known]:
        notes.append(f"not known of all records, and left out: {listed(unknown, 'and')}")
    shown = dict.fromkeys((*found.keys, *heads), "")
    shown |= {"most_telling": "other", "p_most_telling": "p other"}
    return Found(
        tables,
        lambda title: efficiency_figure(found.keys, rows, limits, title, over(found.pooled)),
        notes,
        shown={"": shown},
        remark="median, beta: of the intensities at which records pass the limit; sigma: of ln"
        f" response about a power law of the intensity, from 1/{NEAR:g} to {NEAR:g} times that"
        " median, overturned histories having gone so far at least; never: records that do not; p:"
        " that these intensities depend on magnitude, ln distance, ln durations and the ratio to"
        " another measure by chance, components of one recording counting once; other: the"
        " measure with the least of these, all are in _sufficiency.csv",
    )


def _scatter_of_responses(group: Histories, limit: LimitState, logs: Array, middle: float) -> float:
    """Standard deviation of ln response about a line in ln intensity (points,), near a middle."""
    table, quantity = group.table, LIMITS[RESPONSES.get(limit.result, limit.result)]
    response, near = table.columns[quantity.name], np.abs(logs - middle) <= math.log(NEAR)
    kept = group.points[(near & (response > 0.0))[group.points]]
    at = np.log(response[kept])
    # An overturned one went at least so far.
    high = np.where(table.overturned[kept], np.inf, at + BITS)
    fit = None if quantity.from_below else censored_fit(at - BITS, high, logs[kept][:, None])
    return fit.sigma if fit else math.nan


def asked(text: str) -> ScaleToSection:
    """A measure with its period."""
    name = text.partition("(")[0].strip().lower()
    unit = next((MEASURES[each].unit for each in MEASURES.names() if each.lower() == name), "")
    return scale_to_of(f"{text}=1 {unit}")


def _known_of_records(study: StudyResults) -> dict[str, Array]:
    """(points,) of each of `KNOWN` that is known of all records."""
    layout, cache = study.table.layout, study.context.records
    try:
        motions = [cache.motion(each).horizontal for each in layout.records if each]
    except RecordError:
        return {}
    durations = [intensity_measures(motion) for motion in motions]
    of_each: dict[str, list[float | None]] = {
        "magnitude": [motion.recording.magnitude for motion in motions],
        "distance": [motion.recording.distance for motion in motions],
        "d5_75": [each.d5_75 for each in durations],
        "d5_95": [each.d5_95 for each in durations],
    }
    found = {}
    for key, values in of_each.items():
        if values and all(values):  # none is unknown, or 0
            numbers = np.array(values, dtype=float)
            found[KNOWN[key]] = (numbers if key == "magnitude" else np.log(numbers))[
                layout.places[1]
            ]
    return found


def _passed(group: Histories, result: str, threshold: float) -> Passed:
    """The group by levels, without records of which a level failed."""
    levels = sorted(group.parts([INTENSITY]), key=height)
    points = np.array([level.every for level in levels])
    points = points[:, ~group.table.failed[points].any(axis=0)]
    return Passed(points, exceeds(group.table, result, threshold)[points])


def efficiency_figure(
    keys: Sequence[str], rows: Sequence[Row], limits: Sequence[LimitState], title: str, note: str
) -> bytes:
    """One panel a limit state: the scatter by each measure."""
    groups = [*{str(row.values): row.values for row in rows}.values()]
    measures = list(dict.fromkeys(row.measure for row in rows))

    def draw(axes: style.Axes, limit: LimitState) -> None:
        width = 0.8 / len(groups)
        for place, values in enumerate(groups):
            own = [row for row in rows if row.values == values and row.limit == limit.label]
            betas = [row.beta for row in own]
            at = np.arange(len(betas)) + width * (place - 0.5 * (len(groups) - 1))
            name = labels(keys, values)
            axes.barh(at, betas, width, color=colour(place, len(groups)), label=name or None)
        axes.set_yticks(range(len(measures)), measures)

    return panel_figure(
        limit_panels(limits),
        limits,
        draw,
        title=title,
        x_label="beta of the intensity at the limit",
        y_label="",
        limits=lambda axes: axes.invert_yaxis(),
        note=remarks("less is more efficient", note),
    )


def wrong_measures(layout: StudyPoints, options: EfficiencyOptions) -> Iterator[str]:
    """What is no measure, or has no period."""
    for each in options.measures:
        try:
            own = asked(each)
        except ValueError as error:
            yield f"measures: {error}"
            continue
        at_first_period = needs_period(own.measure) and own.period is None
        if at_first_period and any(system.period is None for system in layout.properties):
            yield f"{each} at T1 needs storeys; write {each}(1 s)"


REPORT = Report(
    EfficiencyOptions,
    efficiency,
    check=single_intensity,
    requires=wrong_measures,
    results=limited_results,
)
