"""Limits and verdicts in words: values in the unit in which their limit was written."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence

from rpscli.analyses.neighbours import OF_MOTION
from rpscli.case.conditions import EVENTS, FOR_A_MEAN, LIMITS, RATE, Condition
from rpscli.errors import listed
from rpscli.report.table import Table, large, measured
from rpscli.sweep.statistics.verdicts import Verdict
from rpscli.units import Written, digits_beside

ALL_DIGITS = 10
"""Of a limit, which is printed as it was written."""
RATE_DIGITS = 6
"""Of a rate, which may come from a probability."""
VERDICT = ("limit", "", "requirement", "result")  # heads of `verdict_texts`


def limit_unit(name: str) -> str:
    """SI unit of what is limited."""
    return LIMITS[name].unit if name in LIMITS else "1/year" if name == RATE else "-"


def _bound(condition: Condition) -> str:
    """The number of a limit, as it was written or with all of its digits."""
    limit = condition.limit
    if isinstance(limit, Written) and limit.unit:
        return limit.text
    number, unit = large(limit * condition.factor, limit_unit(condition.name))
    short = f"{number:g}"
    same = math.isclose(float(short), number or 0.0, rel_tol=10.0**-ALL_DIGITS)
    return f"{short if same else f'{number:.{ALL_DIGITS}g}'} {unit}".strip()


def reached_text(condition: Condition, value: float, overturned: int = 0) -> str:
    """A demand in the unit of its limit, and times the factor of this; of so many
    overturned records.
    """
    if math.isinf(
        value
    ):  # friction is asked for without bound where contact is lost as well
        return (
            "overturned"
            if overturned or condition.name != "friction_ratio"
            else "unbounded"
        )
    unit = limit_unit(condition.name)
    demand = measured(value, unit, condition.limit)
    if condition.factor == 1.0:
        return demand
    limit = condition.limit
    bound = Written(limit * condition.factor, getattr(limit, "text", ""))
    product = measured(value * condition.factor, unit, bound)
    return f"{condition.factor:g} x {demand} = {product}"


def bound_text(condition: Condition) -> str:
    """The limit in words."""
    times = "" if condition.factor == 1.0 else f" with factor {condition.factor:g}"
    return f"at {'least' if condition.from_below else 'most'} {_bound(condition)}{times}"


def requirement_text(condition: Condition) -> str:
    """A condition in words."""
    if condition.name == RATE:
        return f"at most {condition.limit:.{RATE_DIGITS}g} a year"
    if condition.fractile is not None:
        return f"{bound_text(condition)} at the {100.0 * condition.fractile:g} % fractile"
    if condition.of == "mean":
        return f"{bound_text(condition)} in the mean"
    percent = f"{100.0 * condition.share:g} %"
    if condition.name in EVENTS:
        return f"at most {percent} of the records" if condition.share else "no record"
    rest = (
        f" except in {percent} of the records" if condition.share else " in every record"
    )
    return f"{bound_text(condition)}{rest}"


def verdict_text(verdict: Verdict) -> str:
    """Words for what a verdict rests on."""
    if verdict.interval:
        low, high = verdict.interval
        digits = digits_beside(verdict.value, verdict.condition.limit, 3)
        return f"{verdict.value:.{digits}g} a year ({low:.2g} to {high:.2g})"
    if verdict.fractile is not None:
        demand = reached_text(verdict.condition, verdict.fractile, verdict.overturned)
        return f"{demand} there, n = {verdict.beyond.of}{_shown_by(verdict)}"
    fallen = f", {verdict.overturned} overturned" if verdict.overturned else ""
    if verdict.judged_by:
        return f"{_mean_text(verdict)}{fallen}"
    return f"{verdict.beyond}{fallen}{_shown_by(verdict)}"


def _mean_text(verdict: Verdict) -> str:
    """The mean of the records, or the worst of them where these are few."""
    condition = verdict.condition
    value = verdict.value
    why = ""
    if verdict.judged_by == "mean" and verdict.mean is not None:
        value = verdict.mean
    else:
        why = f", judged in place of the mean: fewer than {FOR_A_MEAN} recordings (EN 1998-1)"
    reached = reached_text(condition, value, verdict.overturned)
    return f"{verdict.judged_by} {reached} of {verdict.beyond.of}{verdict.beyond.behind}{why}"


def _shown_by(verdict: Verdict) -> str:
    """Number of recordings, or events, that would show that a limit is met: with no more
    beyond.
    """
    return f"; {verdict.shown_by} would show it" if verdict.shown_by else ""


def worst_text(verdict: Verdict) -> str:
    """Number of several records beyond a limit, and the worst of them."""
    mean = f"{_mean_text(verdict)}; " if verdict.judged_by else ""
    which = "least" if verdict.condition.from_below else "largest"
    value = reached_text(verdict.condition, verdict.value, verdict.overturned)
    worst = f", {which} {value} ({verdict.record})"
    worst = "" if verdict.condition.name in EVENTS else worst
    return (
        f"{mean}{verdict.beyond.number} of {verdict.beyond.of}"
        f" beyond{worst}{_shown_by(verdict)}"
    )


def doubt_texts(
    verdicts: Sequence[Verdict], of: str = "", *, several: bool = False
) -> Iterator[str]:
    """Each verdict that changes beside the histories reverse; values with one percent
    less and more motion of all that has a limit, and what was not looked at so, which of
    a single history is told elsewhere where it is all: not of `several`.
    """
    for verdict in verdicts:
        if not verdict.reversed_by:
            continue
        word, other = ("EXCEEDED", "met") if verdict.exceeded else ("met", "EXCEEDED")
        yield (
            f"{of}{verdict.condition.name} is {word} as it is, but {other} with"
            f" {_changes_text(verdict)}: judge by more records"
        )
    if near := [
        f"{verdict.condition.name} {_range_text(verdict)}"
        for verdict in verdicts
        if verdict.near and verdict.condition.name not in EVENTS
    ]:
        yield f"{of}with 1 % less or more motion {', '.join(near)}"
    unseen = [
        verdict.condition.name
        for verdict in verdicts
        if not verdict.near and verdict.condition.name not in EVENTS
    ]
    if unseen and (near or several):
        yield f"{of}not followed with 1 % less or more motion: {', '.join(unseen)}"


def _changes_text(verdict: Verdict) -> str:
    """Changes that reverse a verdict, factors on the motion together."""
    words = verdict.reversed_by or ()
    factors = [each.removesuffix(OF_MOTION) for each in words if each.endswith(OF_MOTION)]
    others = [each for each in words if not each.endswith(OF_MOTION)]
    together = [f"{listed(factors, 'and')}{OF_MOTION}"] if factors else []
    return listed([*together, *others], "and with")


def _range_text(verdict: Verdict) -> str:
    """Least and largest value with one percent less and more motion."""
    low, high = (reached_text(verdict.condition, each, 1) for each in verdict.near or ())
    unit = low.partition(" ")[2]
    first = low.removesuffix(f" {unit}") if high.endswith(f" {unit}") else low
    return low if low == high else f"{first} to {high}"


def excess_text(verdict: Verdict) -> str:
    """The limit that a single history exceeds."""
    condition = verdict.condition
    if condition.name in EVENTS:
        return f"{condition.name} ({condition.source})"
    value = reached_text(condition, verdict.value, verdict.overturned)
    if verdict.overturned:
        return f"{condition.name}: {value} ({condition.source})"
    beyond = "is below" if condition.from_below else "exceeds"
    asked = (
        f"{condition.name} = {value} {beyond} {_bound(condition)} ({condition.source})"
    )
    doubt = f", but not with {_changes_text(verdict)}" if verdict.reversed_by else ""
    return f"{asked}{doubt}"


def verdicts_in_short(verdicts: Sequence[Verdict], of: str = "") -> str:
    """Numbers of limits of something that are exceeded, met, or met without being
    shown.
    """
    if not verdicts:
        return "No limits were set."
    what = f"{len(verdicts)} limits{of}"
    exceeded = sum(verdict.exceeded for verdict in verdicts)
    unsure = sum(not (verdict.exceeded or verdict.shown) for verdict in verdicts)
    doubtful = sum(bool(verdict.reversed_by) for verdict in verdicts)
    first = f"{exceeded} of {what} exceeded" if exceeded else f"All {what} are met"
    parts = [first, *[f"{unsure} met but not shown"] * bool(unsure)]
    parts += [f"{doubtful} in doubt, as a small change reverses it"] * bool(doubtful)
    return f"{', '.join(parts)}."


def counts_of_limits(verdicts: Sequence[Verdict]) -> Table:
    """Every limit of a study once, with how many of its verdicts end in which way."""
    words = ("EXCEEDED", "met, not shown", "met")
    counts: dict[tuple[str, str], Counter[str]] = {}
    for verdict in verdicts:
        row = verdict.condition.name, requirement_text(verdict.condition)
        counts.setdefault(row, Counter())[verdict.word] += 1
    rows = [
        (*row, *(str(found[word]) for word in words)) for row, found in counts.items()
    ]
    return Table.of_texts(("limit", "requirement", *words), rows, words=2)


def verdict_texts(verdict: Verdict) -> tuple[str, str, str, str]:
    """A verdict as a row of a table."""
    condition = verdict.condition
    return (
        condition.name,
        verdict.word,
        requirement_text(condition),
        verdict_text(verdict),
    )


def limits_table(verdicts: Sequence[Verdict]) -> Table:
    """Every limit of a single history with its value."""
    rows = []
    for verdict in verdicts:
        condition = verdict.condition
        numbers = "", "not allowed"
        if condition.name not in EVENTS:
            value = math.inf if verdict.overturned else verdict.value
            numbers = (
                reached_text(condition, value, verdict.overturned),
                bound_text(condition)
                + ", one record in place of the mean" * (condition.of == "mean"),
            )
        rows.append((condition.name, verdict.word, condition.source, *numbers))
    return Table.of_texts(["limit", "", "from", "value", "requirement"], rows, words=3)
