"""Efficiency and sufficiency of intensity measures, from intensities at which limits are passed.

An incremental dynamic analysis, read across: the intensity at which a record first passes a limit
lies between two of its levels, by any measure. A measure is *efficient* if these intensities
scatter little from record to record (their beta), and *sufficient* if they do not depend on what
else is known of the record: magnitude, distance, other measures. Residuals are those of intensities
at a response, not of responses at an intensity, so that overturned histories count: they have no
response that a regression could take.

References
----------
N. Luco and C. A. Cornell, Earthq. Spectra 23, 2007 (efficiency and sufficiency); D. Vamvatsikos and
C. A. Cornell, Earthq. Spectra 21, 2005 (the scatter of intensities at a limit state).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from rpscli.case.schema.fields import Several, Text
from rpscli.case.schema.scale_to import ScaleToSection, scale_to_of
from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.errors import RecordError
from rpscli.records.measures import MEASURES, needs_period
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

if TYPE_CHECKING:
    from matplotlib.axes import Axes

KNOWN = ("magnitude", "ln distance")
HEADS = (
    "limit", "measure", "unit", "most_telling", "median", "beta", "records", "never",
    "p_magnitude", "p_distance", "p_most_telling",
)  # fmt: skip

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
            spread = (math.exp(alone.mean), alone.sigma) if alone else (math.nan, math.nan)
            counts = (len(last), int(np.isinf(between[1]).sum()))
            chances = (*(p_of.get(each, math.nan) for each in KNOWN), least)
            rows.append((*of, measured[name].unit, telling.get(least), *spread, *counts, *chances))
            further += [(*of, *test) for test in tests]
    of_further = dict.fromkeys((*HEADS[:2], *Dependence._fields), "-")
    tables = {
        "": keyed(found.keys, dict.fromkeys(HEADS, "-"), rows),
        "_sufficiency": keyed(found.keys, of_further, further),
    }
    notes = list(found.notes)
    if not known:
        notes.append("magnitudes and distances of the records are not known, and left out")
    shown = dict.fromkeys((*found.keys, *HEADS), "")
    shown |= {"most_telling": "other", "p_most_telling": "p other"}
    return Found(
        tables,
        lambda title: efficiency_figure(found.keys, rows, limits, title, over(found.pooled)),
        notes,
        shown={"": shown},
        remark="median, beta: of the intensities at which records pass the limit; never: records"
        " that do not; p: that these intensities depend on magnitude, ln distance and the ratio to"
        " another measure by chance, components of one recording counting once; other: the"
        " measure with the least of these, all are in _sufficiency.csv",
    )


def asked(text: str) -> ScaleToSection:
    """A measure with its period."""
    name = text.partition("(")[0].strip().lower()
    unit = next((MEASURES[each].unit for each in MEASURES.names() if each.lower() == name), "")
    return scale_to_of(f"{text}=1 {unit}")


def _known_of_records(study: StudyResults) -> dict[str, Array]:
    """(points,) magnitude and logarithm of the distance; none where one is not known."""
    layout, cache = study.table.layout, study.context.records
    try:
        about = [cache.motion(each).horizontal.recording for each in layout.records if each]
    except RecordError:
        return {}
    if not about or any(None in (each.magnitude, each.distance) for each in about):
        return {}
    of = np.array([(each.magnitude, math.log(each.distance or 1.0)) for each in about])
    return dict(zip(KNOWN, of[layout.places[1]].T, strict=True))


def _passed(group: Histories, result: str, threshold: float) -> Passed:
    """The group by levels, without records of which a level failed."""
    levels = sorted(group.parts([INTENSITY]), key=height)
    points = np.array([level.every for level in levels])
    points = points[:, ~group.table.failed[points].any(axis=0)]
    return Passed(points, exceeds(group.table, result, threshold)[points])


def efficiency_figure(
    keys: Sequence[str],
    rows: Sequence[Sequence[Any]],
    limits: Sequence[LimitState],
    title: str,
    note: str,
) -> bytes:
    """One panel a limit state: the scatter by each measure."""
    groups = [*{str(row[0]): row[0] for row in rows}.values()]
    measures = list(dict.fromkeys(str(row[2]) for row in rows))

    def draw(axes: Axes, limit: LimitState) -> None:
        width = 0.8 / len(groups)
        for place, values in enumerate(groups):
            betas = [row[6] for row in rows if row[0] == values and row[1] == limit.label]
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
