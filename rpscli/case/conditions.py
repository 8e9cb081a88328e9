"""Conditions that histories must keep: the limits of a case or a
study, or of `--fail-on`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.text.document import Document
from rpscli.errors import UsageError, alike, hint
from rpscli.units import KINDS, Written, bare_or_si

if TYPE_CHECKING:
    from rpscli.case.schema.limits import LimitsSection
    from rpscli.model.podium import PodiumStructure

EVENTS = {"overturning": "overturn", "uplift": "uplift"}
"""Conditions on something that must not happen, and what the histories do then."""

FRICTION = "podium.friction"
"""Source of the condition that the columns do not slide."""

RATE = "annual_rate"
"""Condition on how often a year the structure overturns
[1/year], over all intensities."""

NOT_SHOWN = "not-shown"
"""Word of `--fail-on`: limits which are met and not shown to be kept count too."""

FOR_A_MEAN = 7
"""Recordings from which on a mean of maxima is judged, by EN 1998-1; of fewer the
largest.
"""

LIMITS = {quantity.name: quantity for quantity in LIMITED}
"""Results that conditions may limit, in SI units."""


@dataclass(frozen=True)
class Condition:
    """A limit on an event or a result [SI], and who asks for it; 0 for an event.

    Of the records of a study a `share` may exceed it, or fall below where small values
    are bad; or the `fractile` of the results must keep it; or their mean, `of` them.
    Where demands are judged times a `factor`, the limit is the admissible value over it.
    """

    name: str
    limit: float
    source: str
    share: float = 0.0
    fractile: float | None = None
    of: Literal["mean"] | None = None
    factor: float = 1.0

    @property
    def from_below(self) -> bool:
        """True if small values are bad."""
        return self.name in LIMITS and LIMITS[self.name].from_below

    @property
    def sign(self) -> float:
        """Factor by which larger values are the worse ones."""
        return -1.0 if self.from_below else 1.0

    @property
    def admissible(self) -> float:
        """Share of the records that may be beyond the limit; of a mean, may overturn."""
        if self.fractile is None:
            return self.share
        return self.fractile if self.from_below else 1.0 - self.fractile

    def under(self, recordings: int) -> Condition:
        """The condition under so many recordings: of few the largest, not the mean."""
        few = self.of == "mean" and recordings < FOR_A_MEAN
        return replace(self, of=None) if few else self


def parse_condition(text: str) -> Condition:
    """A condition of `--fail-on`: ``overturning``, with a share
    ``=0.1``, or ``NAME=VALUE``.
    """
    name, sign, value = (part.strip() for part in text.partition("="))
    if (name in EVENTS or name == NOT_SHOWN) and not sign:
        return Condition(name, 0.0, "--fail-on")
    if name not in LIMITS and name not in EVENTS:
        some = ", ".join(alike(name, known := [*EVENTS, *LIMITS, NOT_SHOWN], 3))
        meant = hint(name, known, f"near are {some}; `rps explain limits` lists all", 0.6)
        raise UsageError(f"--fail-on {text}: {name or 'the name'} is not known; {meant}")
    unit = LIMITS[name].unit if name in LIMITS else "-"
    try:
        limit: float = Written(bare_or_si(value, unit), value)
    except ValueError:
        limit = math.nan
    if name in EVENTS:
        if not 0.0 <= limit < 1.0:
            raise UsageError(
                f"--fail-on {text}: write {name}=SHARE from 0 to 1, as in {name}=0.1"
            )
        return Condition(name, 0.0, "--fail-on", share=limit)
    in_unit = f" or '0.5 {KINDS[unit][1][0]}'" if unit in KINDS else ""
    if not math.isfinite(limit):
        raise UsageError(
            f"--fail-on {text}: write {name}=NUMBER, as in {name}=0.5{in_unit}"
        )
    return Condition(name, limit, "--fail-on")


def conditions_of(limits: LimitsSection, source: str) -> tuple[Condition, ...]:
    """The limits that a case or a study sets, in the order of the table of results."""
    conditions = []
    for name, given in limits.model_dump(exclude_none=True).items():
        if name in EVENTS:
            conditions.append(Condition(name, 0.0, source, given))
        elif name == "probability_in_50_years":  # of a Poisson process
            conditions.append(Condition(RATE, -math.log1p(-given) / 50.0, source))
        elif isinstance(given, dict):
            share = given.get("share", 0.0)
            fractile = given.get("fractile")
            limit = given["at_least" if LIMITS[name].from_below else "at_most"]
            of = given.get("of")
            factor = given.get("factor", 1.0)
            if factor != 1.0:
                limit = Written(limit / factor, getattr(limit, "text", ""))
            conditions.append(Condition(name, limit, source, share, fractile, of, factor))
        else:
            conditions.append(Condition(name, given, source))
    return tuple(conditions)


def case_conditions(
    limits: LimitsSection, structure: PodiumStructure, records: int = 1
) -> tuple[Condition, ...]:
    """The limits that a case sets for so many records, with those
    that follow from others.

    What overturns exceeds every limit: where one is for every
    record, no record may overturn.
    """
    found = conditions_of(limits, "limits of the case")
    every = found if records == 1 else [each for each in found if each.admissible == 0.0]
    if every and not any(each.name == "overturning" for each in found):
        found = (Condition("overturning", 0.0, "limits of the case"), *found)
    return with_friction(found, structure)


def lacking_results(
    conditions: Iterable[Condition], structure: PodiumStructure
) -> list[str]:
    """Needs of conditions that a structure does not meet, each with its source."""
    found = (
        (each, LIMITS[each.name].lacks(structure))
        for each in conditions
        if each.name in LIMITS
    )
    return [
        f"{each.source}: {each.name} needs {lacking}"
        for each, lacking in found
        if lacking
    ]


def unknown_of_pairs(
    conditions: Iterable[Condition], structure: PodiumStructure
) -> list[str]:
    """Reasons why conditions cannot be judged where both components
    act, each with its source.
    """
    from rpscli.analyses.column_forces import no_bound  # numpy is slow

    found = ((each.source, no_bound(each.name, structure)) for each in conditions)
    return [f"{source}: {why}".removeprefix(": ") for source, why in found if why]


def with_friction(
    conditions: tuple[Condition, ...], structure: PodiumStructure
) -> tuple[Condition, ...]:
    """The conditions, and that columns do not slide, unless the
    friction ratio has a limit.
    """
    if structure.friction is None or any(
        each.name == "friction_ratio" for each in conditions
    ):
        return conditions
    return (*conditions, Condition("friction_ratio", 1.0, FRICTION))


def replaced_limits(base: dict[str, Any], own: LimitsSection | None) -> str:
    """Names of the limits of a base case that a study has its own in
    place of, if it has any.
    """
    given = Document("", base).has(("podium", "friction"))
    still = given and own and "friction_ratio" not in own.model_fields_set
    said = (
        {"friction_ratio": f"friction_ratio (still at most 1, by {FRICTION})"}
        if still
        else {}
    )
    return ", ".join(said.get(name, name) for name in base.get("limits") or () if own)
