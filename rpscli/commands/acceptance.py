"""Limits of a case, and `--fail-on`: what a time history must not exceed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpscli.analyses.result_quantities import LIMITED
from rpscli.errors import LimitExceeded, UsageError, nearest

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.case.schema.case_file import LimitsSection

EVENTS: dict[str, Callable[[TimeHistoryResult], float]] = {
    "overturning": lambda result: float(result.overturned),
    "uplift": lambda result: float(result.uplifts),
}
"""Conditions that name something that must not happen."""

LIMITS = {quantity.name: quantity for quantity in LIMITED}
"""Conditions of the form NAME=VALUE, by their names in JSON, in SI units."""


@dataclass(frozen=True)
class Condition:
    """One limit: exceeded by a larger value."""

    name: str
    limit: float
    source: str


@dataclass(frozen=True)
class Verdict:
    """What became of a condition."""

    name: str
    value: float
    limit: float
    exceeded: bool
    source: str

    def __str__(self) -> str:
        if self.name in EVENTS:
            return f"{self.name} ({self.source})"
        return f"{self.name} = {self.value:.4g} exceeds {self.limit:g} ({self.source})"


def parse_condition(text: str) -> Condition:
    """A condition as `--fail-on` gives it: ``overturning``, ``uplift`` or ``NAME=VALUE``.

    Raises
    ------
    UsageError
        If the name is not known, or the value is missing or no number.

    Examples
    --------
    >>> parse_condition("rotation_ratio=0.5")
    Condition(name='rotation_ratio', limit=0.5, source='--fail-on')
    """
    name, sign, value = (part.strip() for part in text.partition("="))
    if name in EVENTS and not sign:
        return Condition(name, 0.0, "--fail-on")
    if name not in LIMITS:
        known = [*EVENTS, *(f"{limited}=VALUE" for limited in LIMITS)]
        close = nearest(name, [*EVENTS, *LIMITS], 0.6)
        hint = f"did you mean {close}?" if close else f"known are {', '.join(known)}"
        raise UsageError(f"--fail-on {text}: {name or 'the name'} is not known; {hint}")
    try:
        limit = float(value)
    except ValueError:
        limit = math.nan
    if not math.isfinite(limit):
        raise UsageError(f"--fail-on {text}: write {name}=NUMBER, as in {name}=0.5")
    return Condition(name, limit, "--fail-on")


def case_conditions(limits: LimitsSection) -> list[Condition]:
    """The limits that a case sets.

    A structure that overturns meets none of them, whatever the numbers were until then.
    """
    given = limits.model_dump(exclude_none=True)
    found = [Condition(name, float(limit), "limits of the case") for name, limit in given.items()]
    return [Condition("overturning", 0.0, "limits of the case"), *found] if found else []


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
    value = EVENTS[name](result) if name in EVENTS else getattr(result, name)
    if value is None:
        raise UsageError(f"{condition.source}: {name} needs {LIMITS[name].needs}")
    return Verdict(name, float(value), condition.limit, value > condition.limit, condition.source)


def exceeded(verdicts: Iterable[Verdict]) -> LimitExceeded | None:
    """The error that names all conditions that failed; None if there are none."""
    failed = [str(verdict) for verdict in verdicts if verdict.exceeded]
    return LimitExceeded("limit exceeded: " + "\nlimit exceeded: ".join(failed)) if failed else None
