"""Conditions that histories must keep: the limits of a case or a study, or of `--fail-on`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpscli.analyses.result_quantities import LIMITED

if TYPE_CHECKING:
    from rpscli.case.schema.limits import LimitsSection

EVENTS = {"overturning": "overturn", "uplift": "uplift"}
"""Conditions on something that must not happen, and what the histories do then."""

LIMITS = {quantity.name: quantity for quantity in LIMITED}
"""Results that conditions may limit, in SI units."""


@dataclass(frozen=True)
class Condition:
    """One condition.

    Parameters
    ----------
    name
        Of an event or a result.
    limit
        The value that no record may exceed, SI units; 0 for an event.
    source
        Who asks for it, in words.
    share
        Share of the records of a study that may exceed it.
    fractile
        Fractile of the results that must keep it, in place of the share.
    """

    name: str
    limit: float
    source: str
    share: float = 0.0
    fractile: float | None = None


def conditions_of(limits: LimitsSection, source: str) -> tuple[Condition, ...]:
    """The limits that a case or a study sets, in the order of the table of results."""
    found = []
    for name, given in limits.model_dump(exclude_none=True).items():
        if name in EVENTS:
            found.append(Condition(name, 0.0, source, given))
        elif isinstance(given, dict):
            share, fractile = given.get("share", 0.0), given.get("fractile")
            found.append(Condition(name, given["at_most"], source, share, fractile))
        else:
            found.append(Condition(name, given, source))
    return tuple(found)


def condition_text(condition: Condition) -> str:
    """What a condition asks for.

    >>> condition_text(Condition("rotation_ratio", 0.5, "", share=0.1))
    'at most 0.5 but for 10 % of the records'
    >>> condition_text(Condition("overturning", 0.0, "")), condition_text(Condition("a", 2.0, ""))
    ('no record', 'at most 2 in every record')
    """
    if condition.fractile is not None:
        return f"at most {condition.limit:g} at the {100.0 * condition.fractile:g} % fractile"
    percent = f"{100.0 * condition.share:g} %"
    if condition.name in EVENTS:
        return f"at most {percent} of the records" if condition.share else "no record"
    rest = f" but for {percent} of the records" if condition.share else " in every record"
    return f"at most {condition.limit:g}{rest}"
