"""The demands of codes on a set of motions, and the verdicts on what a set has."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from rpscli.records.target import COMPONENTS, NOT_VERIFIED, Component
from rpscli.units import digits_beside

SIX_DIGITS = 1e-6
"""Of ratios, by which factors that are written with six digits may miss a requirement."""


class Periods(NamedTuple):
    """Periods of a structure [s]: the first one on a fixed base, and
    the secant one on bearings.
    """

    fixed: float | None
    secant: float


class Rule(NamedTuple):
    """One requirement beside what a set has; met is None where it cannot be told."""

    rule: str
    required: str
    found: str
    met: bool | None

    @property
    def word(self) -> str:
        """As tables say it."""
        return "not checked" if self.met is None else ("met" if self.met else "NOT MET")


@dataclass(frozen=True)
class Requirements:
    """The demands of a code on a set: at least `count` motions or
    pairs, `least` of the target.

    `span` are multiples of T1, or of T_M where it is `isolated`, between which that is.
    """

    clause: str
    checked: str
    count: int = 1
    least: float = 0.9
    mean_pga: bool = False
    of: Component | None = None
    level: str = ""
    span: tuple[float, float] | None = None
    isolated: bool = False

    def judged(
        self,
        number: int,
        of: Component,
        level: str,
        pga_ratio: float,
        least_ratio: float,
        looked_at: tuple[float, float],
        structure: Periods | None,
    ) -> tuple[Rule, ...]:
        """Every requirement; ratios are the mean over the target,
        within the periods looked at.
        """
        noun = "motions" if of == "component" else "pairs"
        (low, high) = looked_at
        span = f"{low:.3g} to {high:.3g} s"
        found = [
            Rule(
                f"number of {noun}", f">= {self.count}", f"{number}", number >= self.count
            )
        ]
        if self.of is not None:
            texts = COMPONENTS[self.of], COMPONENTS[of]
            found.append(Rule("component", *texts, of == self.of))
        if self.level:
            same = level.lower() == self.level.lower() if level else None
            found.append(
                Rule("level", self.level, level or "not said by the target", same)
            )
        if self.mean_pga:
            known = not math.isnan(pga_ratio)
            text = _ratio(pga_ratio, 1.0) if known else "the target has no value at T = 0"
            met = pga_ratio >= 1.0 - SIX_DIGITS if known else None
            found.append(Rule("mean PGA over the target's", ">= 1", text, met))
        met = least_ratio >= self.least - SIX_DIGITS
        text = _ratio(least_ratio, self.least)
        found.append(Rule(f"mean/target, {span}", f">= {self.least:g}", text, met))
        if self.span is not None:
            found.append(self._range_of_periods(self.span, looked_at, structure))
        return tuple(found)

    def _range_of_periods(
        self,
        multiples: tuple[float, float],
        looked_at: tuple[float, float],
        structure: Periods | None,
    ) -> Rule:
        """The range of periods that a code asks for beside the one looked at."""
        (low, high) = looked_at
        span = f"{low:.3g} to {high:.3g} s"
        name = "T_M" if self.isolated else "T1"
        text = " to ".join(f"{factor:g} {name}" for factor in multiples)
        period = structure and (structure.secant if self.isolated else structure.fixed)
        if period is None:
            unknown = f"{span}; {name} is not known: give --case"
            return Rule("range of periods", text, unknown, None)
        ends = multiples[0] * period, multiples[1] * period
        covers = (
            low <= ends[0] * (1.0 + SIX_DIGITS) and ends[1] * (1.0 - SIX_DIGITS) <= high
        )
        text = f"{text} = {ends[0]:.3g} to {ends[1]:.3g} s"
        return Rule("range of periods", text, span, covers)


def _ratio(value: float, least: float) -> str:
    """A ratio beside what it must be at least, to be told from it."""
    return f"{value:.{digits_beside(value, least, 3)}f}"


RULES = {
    "en1998": Requirements(
        "EN 1998-1:2004, 3.2.3.1.2(4)",
        "compared with a public implementation (PEUSP-beta), not with the text",
        3,
        mean_pga=True,
        span=(0.2, 2.0),
    ),
    "asce7-ch16": Requirements(
        "ASCE/SEI 7-16, chapter 16",
        "number, direction, level and 0.9 compared with the manual of QuakeManager, not"
        f" with the text; the range of periods {NOT_VERIFIED}",
        11,
        of="rotd100",
        level="MCE_R",
        span=(0.2, 2.0),
    ),
    "asce7-ch17": Requirements(
        "ASCE/SEI 7-16, 17.3.3 (isolated structures)",
        f"{NOT_VERIFIED}: from memory",
        7,
        1.0,
        of="srss",
        level="MCE_R",
        span=(0.75, 1.25),
        isolated=True,
    ),
    "mean90": Requirements(
        "the 0.9 that EN 1998-1:2004 and ASCE/SEI 7-16 share",
        "compared with public implementations of both",
    ),
}
"""By the names of `--rules`."""
