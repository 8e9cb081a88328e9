"""Limits of a case, and `--fail-on`: what a time history must keep."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpscli.case.conditions import EVENTS, LIMITS, Condition, conditions_of
from rpscli.errors import LimitExceeded, UsageError, hint

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.case.schema.limits import LimitsSection

HAPPENED: dict[str, Callable[[TimeHistoryResult], float]] = {
    "overturning": lambda result: float(result.overturned),
    "uplift": lambda result: float(result.uplifts),
}
"""How often each event happened."""


@dataclass(frozen=True)
class Verdict:
    """What became of a condition; `exceeded` is one that is not kept."""

    name: str
    value: float
    limit: float
    exceeded: bool
    source: str

    def __str__(self) -> str:
        if self.name in EVENTS:
            return f"{self.name} ({self.source})"
        beyond = "is below" if LIMITS[self.name].from_below else "exceeds"
        return f"{self.name} = {self.value:.4g} {beyond} {self.limit:g} ({self.source})"


def parse_condition(text: str) -> Condition:
    """A condition as `--fail-on` gives it: ``overturning``, ``uplift`` or ``NAME=VALUE``.

    An event may have the share of the records of a study that is admissible: ``overturning=0.1``.

    Raises
    ------
    UsageError
        If the name is not known, or the value is missing or no number.

    Examples
    --------
    >>> parse_condition("rotation_ratio=0.5")
    Condition(name='rotation_ratio', limit=0.5, source='--fail-on', share=0.0, fractile=None)
    """
    name, sign, value = (part.strip() for part in text.partition("="))
    if name in EVENTS and not sign:
        return Condition(name, 0.0, "--fail-on")
    if name not in LIMITS and name not in EVENTS:
        known = [*EVENTS, *(f"{limited}=VALUE" for limited in LIMITS)]
        meant = hint(name, [*EVENTS, *LIMITS], f"known are {', '.join(known)}", 0.6)
        raise UsageError(f"--fail-on {text}: {name or 'the name'} is not known; {meant}")
    try:
        limit = float(value)
    except ValueError:
        limit = math.nan
    if name in EVENTS:
        if not 0.0 <= limit < 1.0:
            raise UsageError(f"--fail-on {text}: write {name}=SHARE from 0 to 1, as in {name}=0.1")
        return Condition(name, 0.0, "--fail-on", share=limit)
    if not math.isfinite(limit):
        raise UsageError(f"--fail-on {text}: write {name}=NUMBER, as in {name}=0.5")
    return Condition(name, limit, "--fail-on")


def case_conditions(limits: LimitsSection) -> list[Condition]:
    """The limits that a case sets.

    A structure that overturns meets none of them, whatever the numbers were until then.
    """
    found = conditions_of(limits, "limits of the case")
    if not found or any(condition.name == "overturning" for condition in found):
        return list(found)
    return [Condition("overturning", 0.0, "limits of the case"), *found]


def judge(result: TimeHistoryResult, conditions: Iterable[Condition]) -> list[Verdict]:
    """Every condition with its value.

    Raises
    ------
    UsageError
        If a value does not exist in this structure.
    """
    return [_verdict(result, condition) for condition in conditions]


def _verdict(result: TimeHistoryResult, condition: Condition) -> Verdict:
    name = condition.name
    value = HAPPENED[name](result) if name in HAPPENED else getattr(result, name)
    if value is None:
        raise UsageError(f"{condition.source}: {name} needs {LIMITS[name].needs}")
    exceeded = not condition.kept_by(value)
    return Verdict(name, float(value), condition.limit, exceeded, condition.source)


def exceeded(verdicts: Iterable[Verdict]) -> LimitExceeded | None:
    """The error that names all conditions that failed; None if there are none."""
    failed = [str(verdict) for verdict in verdicts if verdict.exceeded]
    return LimitExceeded("limit exceeded: " + "\nlimit exceeded: ".join(failed)) if failed else None
