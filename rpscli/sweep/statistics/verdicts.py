"""Histories against limits: of one record, of several, of a study, and of designs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_forces import OF_COLUMNS
from rpscli.case.conditions import EVENTS, NOT_SHOWN, RATE, Condition
from rpscli.case.text.document import Fault
from rpscli.records.measures import SHOWN, Of
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import ROUNDING, Share, share_of, shown_by
from rpscli.sweep.statistics.hazard import exceeded, rate_of_shares, read_hazard
from rpscli.sweep.statistics.summary import Records, Summary
from rpscli.sweep.table import Array, Indices, Outcomes, PointTable

MEAN_ROUNDING = 1e-12
"""Of a mean, which may be a sum's last digits beyond equal values."""


@dataclass(frozen=True)
class Verdict:
    """Verdict on a condition on some histories.

    `values` are those of the keys of a summary. `beyond` are histories that exceed the
    limit: every overturned one does, `overturned` of them where the condition is on a
    result. `value` is the worst demand, infinite where it overturned, and `record` had
    it. `fractile` is the demand at the fractile of the condition, if it has one, `mean`
    the mean of the demands of a condition on it, infinite with an overturned one.
    Without any history nothing is exceeded.

    A limit that a share of the records may exceed is *shown* to be kept if the
    interval of the probability ends below that share. One for every record says
    something of these records alone. It `fails` where it is exceeded or, if judged so
    `strictly`, not shown to be kept.

    `near` are least and largest of the value under one percent less and more motion,
    `reversed_by` the changes beside the histories that reverse the verdict; None where
    none was looked at.

    On an annual rate `interval` is that of the rate [1/year], from those of the shares at
    all intensities at once, which is too wide; `beyond` is the share at the last one.
    """

    condition: Condition
    values: tuple[object, ...]
    beyond: Share
    overturned: int
    value: float
    record: str
    fractile: float | None
    exceeded: bool
    strictly: bool = False
    interval: tuple[float, float] | None = None
    mean: float | None = None
    near: tuple[float, float] | None = None
    reversed_by: tuple[str, ...] | None = None

    @property
    def decisive(self) -> float:
        """The value that is held against the limit: of a fractile, a mean, or the
        worst.
        """
        if self.fractile is not None:
            return self.fractile
        of_mean = self.judged_by == "mean" and self.mean is not None
        return self.mean if of_mean and self.mean is not None else self.value

    @property
    def judged_by(self) -> str | None:
        """Word for the value by which a condition on the mean was judged: of few
        recordings the worst.
        """
        if self.condition.of is None:
            return None
        if self.condition.under(self.beyond.recordings).of is not None:
            return "mean"
        return "least" if self.condition.from_below else "largest"

    @property
    def word(self) -> str:
        """As tables say it."""
        word = "EXCEEDED" if self.exceeded else "met" if self.shown else "met, not shown"
        return f"{word}, in doubt" if self.reversed_by else word

    @property
    def fails(self) -> bool:
        """True if it counts for the exit code."""
        return self.exceeded or (self.strictly and not self.shown)

    @property
    def shown(self) -> bool:
        """True if it is met, and the records are enough to say so of the probability."""
        if self.exceeded:
            return False
        if self.interval is not None:
            return self.interval[1] <= self.condition.limit
        admissible = self.condition.admissible
        return self.beyond.of < 2 or admissible <= 0.0 or self.beyond.high <= admissible

    @property
    def shown_by(self) -> int | None:
        """Number of recordings that would show it, with no more
        beyond; None where it is shown.
        """
        if self.exceeded or self.shown or self.interval is not None:
            return None
        return shown_by(self.beyond, self.condition.admissible)


def rates_of_levels(layout: StudyPoints) -> tuple[Array, float]:
    """(levels,) annual rate of what happens at one intensity alone;
    that of stronger motions.

    The rate of any shares (levels,) is their product with these: it is linear in them.
    """
    section = layout.study.file.hazard
    measure = layout.plan.measure
    assert section is not None, "a limit on a rate has a hazard"
    if measure is None or measure.measure != section.measure or len(layout.scales) < 2:
        text = (
            f"hazard: shares at two and more values of {section.measure} are needed;"
            " write"
        )
        text += f" `scale: {{measure: {section.measure}, values: [...]}}`"
        layout.study.document.refuse([Fault(("hazard",), text)])
    hazard = read_hazard(layout.study.folder / section.file, section.measure)
    levels = np.array(layout.scales, dtype=float)
    order = np.argsort(levels)
    rates = np.zeros(len(levels))
    for place, alone in zip(order, np.eye(len(levels)), strict=True):
        rates[place] = rate_of_shares(hazard, levels[order], alone)
    return rates, float(exceeded(hazard, levels[order[-1:]])[0])


def component_notes(of: Of | None, own: Of | None) -> Iterator[str]:
    """Remarks on a hazard curve that is of another measure of a pair than the study."""
    own = own or "component"
    if of != own:
        known = (
            f"is of {SHOWN.get(of, of)}" if of else "does not say what of a pair it is of"
        )
        yield (
            f"the hazard curve {known} (hazard: component), while intensities of the"
            f" study are of {SHOWN.get(own, own)}: both must be of one definition (scale:"
            " of)"
        )


def rate_notes(layout: StudyPoints) -> Iterator[str]:
    """Assumptions of a limit on a rate; refuse one that the study cannot tell of."""
    section = layout.study.file.hazard
    if section and any(limit.name == RATE for limit in layout.properties[0].limits):
        _, beyond = rates_of_levels(layout)
        yield from component_notes(section.component, layout.of)
        if rows := read_hazard(
            layout.study.folder / section.file, section.measure
        ).left_out:
            yield f"{section.file}: {rows} row(s) at its end have rates of zero and are left out"
        yield (
            f"{RATE}: motions beyond the largest intensity come {beyond:.2g} times a"
            " year; they are taken to overturn the share that the largest does, and"
            " those below the least the share that the least does"
        )


class Judgement(NamedTuple):
    """(weightings, rows) histories that are counted, that
    exceed a limit, and that may.
    """

    total: Array
    beyond: Array
    admissible: Array

    @property
    def met(self) -> NDArray[np.bool_]:
        """(weightings, rows) whether no more exceed it than may;
        never without any history.
        """
        return (self.total > 0.0) & (self.beyond <= self.admissible)

    @property
    def excess(self) -> Array:
        """(weightings, rows) histories too many over all; infinite without any."""
        with np.errstate(invalid="ignore", divide="ignore"):
            excess = (self.beyond - np.floor(self.admissible)) / self.total
        return np.where(self.total > 0.0, excess, np.inf)


def judge(demands: Array, weights: Array, condition: Condition) -> Judgement:
    """Demands (rows, histories), larger the worse, in weights
    (weightings, histories) of each.
    """
    total = weights @ (~np.isnan(demands)).T
    beyond = weights @ (demands > condition.sign * condition.limit).T
    if condition.of == "mean":  # where it is beyond, all beyond it are too many
        limit = condition.sign * condition.limit
        most = limit + MEAN_ROUNDING * abs(limit)
        beyond = np.where(means(demands, weights) > most, beyond, 0.0)
    return Judgement(total, beyond, _admissible(condition, total))


def means(demands: Array, weights: Array) -> Array:
    """(weightings, rows) means of demands (rows, histories), infinite
    with one that overturned; NaN without any.
    """
    total = weights @ (~np.isnan(demands)).T
    fallen = weights @ np.isposinf(demands).T
    sums = weights @ np.nan_to_num(demands, nan=0.0, posinf=0.0).T
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where((fallen > 0.0) & (total > 0.0), np.inf, sums / total)


def decisive(demands: Array, weights: Array, condition: Condition) -> Array:
    """(weightings, rows) least demands that no more than the
    admissible histories exceed; of a condition on the mean, means.
    """
    if condition.of == "mean":
        return means(demands, weights)
    found = np.full((len(weights), len(demands)), np.nan)
    for place, row in enumerate(demands):
        order = np.argsort(row, kind="stable")[: int((~np.isnan(row)).sum())]
        if not len(order):
            continue
        counted = np.cumsum(weights[:, order], axis=1)
        total = counted[:, -1]
        needed = total - _admissible(condition, total)
        first = (counted >= needed[:, None] - ROUNDING).argmax(axis=1)
        found[:, place] = np.where(total > 0.0, row[order][first], np.nan)
    return found


def _admissible(condition: Condition, total: Array) -> Array:
    """Number of histories, which may be parts of one, that may be beyond the limit."""
    # The fractile from below is itself one of those that keep the limit.
    below = condition.fractile is not None and condition.from_below
    return np.asarray(
        condition.admissible * total + (-2.0 * ROUNDING if below else ROUNDING)
    )


def worse(table: Outcomes, name: str) -> Array:
    """(points,) demands on a limit, larger ones the worse; NaN where the point failed."""
    # An overturned history exceeds every limit, and so does one without such a result.
    condition = Condition(name, 0.0, "")
    if name == "overturning":
        found = table.overturned.astype(float)
    elif name in EVENTS:
        found = np.maximum(table.columns["uplifts"], table.overturned)
    else:
        found = condition.sign * table.columns[name]
        found = np.where(table.overturned | np.isnan(found), np.inf, found)
    return np.where(table.failed, np.nan, found)


def exceeds(table: Outcomes, name: str, limit: float) -> NDArray[np.bool_]:
    """(points,) in which a result is beyond a limit [SI]; overturned
    ones exceed every limit.
    """
    return np.asarray(worse(table, name) > Condition(name, 0.0, "").sign * limit)


def verdicts(
    table: Outcomes,
    points: Indices,
    conditions: Iterable[Condition],
    record_of: Callable[[int], str],
    values: tuple[object, ...] = (),
) -> list[Verdict]:
    """On histories that did not fail, by their points; `record_of`
    names the record of a point.
    """
    found = []
    asked = tuple(conditions)
    strictly = any(condition.name == NOT_SHOWN for condition in asked)
    for condition in (each for each in asked if each.name != NOT_SHOWN):
        demands = worse(table, condition.name)[points]
        every = np.ones((1, len(points)))
        recordings = len(np.unique(table.clusters[points]))
        counted = judge(demands[None], every, condition.under(recordings))
        at = None
        mean = None
        worst = int(np.argmax(demands))
        if condition.fractile is not None:
            at = condition.sign * float(decisive(demands[None], every, condition)[0, 0])
        if condition.of == "mean":
            mean = condition.sign * float(means(demands[None], every)[0, 0])
        of_result = condition.name not in EVENTS
        found.append(
            Verdict(
                condition=condition,
                values=values,
                beyond=share_of(
                    table, points, demands > condition.sign * condition.limit
                ),
                overturned=int(table.overturned[points].sum()) if of_result else 0,
                value=condition.sign * float(demands[worst]),
                record=record_of(int(points[worst])),
                fractile=at,
                exceeded=not counted.met[0, 0],
                strictly=strictly,
                mean=mean,
            )
        )
    return found


def judged_records(
    records: Records, labels: Sequence[str], conditions: Iterable[Condition]
) -> list[Verdict]:
    """Of one structure under records of these names."""
    points = np.nonzero(~records.failed)[0]
    return (
        verdicts(records, points, conditions, labels.__getitem__) if len(points) else []
    )


def judged(
    table: PointTable, summary: Summary, conditions: Iterable[Condition] = ()
) -> list[Verdict]:
    """Of each row of a summary, on the limits of study and cases
    and on further conditions.

    Systems that cannot have a result are not judged by it; `not_judged` tells of them.
    """
    layout = table.layout
    further = tuple(conditions)
    found = list[Verdict]()
    strictly = any(condition.name == NOT_SHOWN for condition in further)
    on_rates = [
        limit for limit in layout.properties[0].limits if limit.name == RATE
    ]  # the study's

    def record_of(number: int) -> str:
        record = layout[number].record
        return "" if record is None else record.source

    for row in summary.rows:
        if not len(row.points):
            continue
        limits = _limits_known(table, row.points, further)
        of_points = [each for each in limits if each not in on_rates]
        found += verdicts(table, row.points, of_points, record_of, row.values)
    for condition in on_rates:
        found += _on_rate(layout, summary, condition, strictly=strictly)
    return found


def _limits_known(
    table: PointTable, points: Indices, further: Iterable[Condition]
) -> list[Condition]:
    """Limits of the systems of some points, and further ones, on results they have."""
    layout = table.layout
    systems = np.unique(points // layout.points_of_system)
    own = [layout.properties[system] for system in systems]
    lacking = frozenset[str]().union(*(properties.lacking for properties in own))
    return [
        each
        for each in (*own[0].limits, *further)
        if each.name not in lacking or _is_known(table, points, each.name)
    ]


def _is_known(table: PointTable, points: Indices, name: str) -> bool:
    """True if points have a result all the same; the mean of columns is not that of one,
    beside systems that have this.
    """
    others = table.layout.properties
    if name in OF_COLUMNS and any(name not in each.lacking for each in others):
        return False
    return bool(np.isfinite(table.columns[name][points]).any())


def _on_rate(
    layout: StudyPoints, summary: Summary, condition: Condition, *, strictly: bool
) -> Iterator[Verdict]:
    """Of each system, on a limit on the annual rate at which it overturns."""
    rates, _ = rates_of_levels(layout)
    for first in range(0, len(summary.rows), len(rates)):  # intensities follow each other
        rows = summary.rows[first : first + len(rates)]
        shares = [row.overturned for row in rows]
        ends = [
            (np.nan if s.fraction is None else s.fraction, s.low, s.high) for s in shares
        ]
        rate, low, high = (rates @ np.array(ends)).tolist()
        yield Verdict(
            condition=condition,
            values=(*rows[0].values[:-1], "all"),
            beyond=shares[-1],
            overturned=0,
            value=rate,
            record="",
            fractile=None,
            exceeded=not rate <= condition.limit,
            strictly=strictly,
            interval=(low, high),
        )
