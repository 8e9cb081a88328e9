"""Verdicts on histories held against those on the histories beside them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from rpscli.analyses.neighbours import NEAR, Neighbour
from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import EVENTS, Condition
from rpscli.sweep.statistics.summary import Records
from rpscli.sweep.statistics.verdicts import Verdict, judged_records


def beside_verdicts(
    verdicts: Sequence[Verdict],
    beside: Sequence[Sequence[Neighbour]],
    labels: Sequence[str],
    sources: Sequence[str],
    conditions: Iterable[Condition],
) -> list[Verdict]:
    """The verdicts with what changes of all histories make of them.

    `beside` are those of each history; a change that not all of them have, or that makes
    one fail, is left out. Without any the verdicts are as they were.
    """
    asked = tuple(conditions)
    by_change = [{each.change: each for each in of} for of in beside]
    common = [name for name in by_change[0] if all(name in of for of in by_change)]
    found = []
    for name in common:
        changed = [of[name] for of in by_change]
        if any(each.outcome == "failed" for each in changed):
            continue
        outcomes = [each.outcome for each in changed]
        records = Records.of(outcomes, [_values(each) for each in changed], sources)
        found.append((changed, judged_records(records, labels, asked)))
    return [
        _with_changes(
            verdict,
            [
                (changed[0], others[place])
                for changed, others in found
                if _known(verdict.condition.name, changed)
            ],
        )
        for place, verdict in enumerate(verdicts)
    ]


def _with_changes(
    verdict: Verdict, others: Sequence[tuple[Neighbour, Verdict]]
) -> Verdict:
    """A verdict with those that take its place after changes; as it is without any."""
    if not others:
        return verdict
    near = [other.decisive for change, other in others if change.factor in NEAR]
    reversed_by = tuple(
        change.change for change, other in others if other.exceeded != verdict.exceeded
    )
    ends = (min(near), max(near)) if near else None
    return replace(verdict, near=ends, reversed_by=reversed_by)


def _known(name: str, changed: Sequence[Neighbour]) -> bool:
    """True of events, and of results that were followed beside every history."""
    return name in EVENTS or all(name in each.demands for each in changed)


def _values(of: Neighbour) -> dict[str, float]:
    """Its results that may have limits, NaN for what it has not."""
    known = (of.demands.get(quantity.name) for quantity in LIMITED)
    values = [math.nan if value is None else float(value) for value in known]
    return dict(zip((quantity.name for quantity in LIMITED), values, strict=True))
