"""Requirements of codes on a set of ground motions, verdicts on a set, and what candidates are.

Each entry says against what it was checked. None of the codes' own texts was at hand: whoever needs
a clause reads it there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from rpscli.errors import UsageError, hint
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import Of, intensity_measures
from rpscli.units import bare_or_si

Component = Of | Literal["srss"]
"""Kinds of spectra: measures of pairs, or the root of the sum of both squared spectra."""

NOT_VERIFIED = "NOT VERIFIED"  # the beginning of statements that nothing was found to check
COMPONENTS: dict[Component, str] = {
    "component": "single components",
    "rotd50": "RotD50 of pairs",
    "rotd100": "RotD100 of pairs, the maximum direction",
    "geomean": "geometric means of pairs",
    "larger": "larger components of pairs",
    "x": "first components of pairs",
    "srss": "SRSS of both components of pairs",
}
"""As readers see them."""


class Periods(NamedTuple):
    """Periods of a structure [s]: the first one on a fixed base, and the secant one on bearings."""

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
    """The demands of a code on a set: at least `count` motions or pairs, `least` of the target.

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
        """Every requirement; ratios are the mean over the target, within the periods looked at."""
        noun, (low, high) = "motions" if of == "component" else "pairs", looked_at
        span = f"{low:.3g} to {high:.3g} s"
        # 1e-6 of the ratios are for factors of six digits.
        found = [Rule(f"number of {noun}", f">= {self.count}", f"{number}", number >= self.count)]
        if self.of is not None:
            texts = COMPONENTS[self.of], COMPONENTS[of]
            found.append(Rule("component", *texts, of == self.of))
        if self.level:
            same = level.lower() == self.level.lower() if level else None
            found.append(Rule("level", self.level, level or "not said by the target", same))
        if self.mean_pga:
            known = not math.isnan(pga_ratio)
            text = f"{pga_ratio:.3f}" if known else "the target has no value at T = 0"
            met = pga_ratio >= 1.0 - 1e-6 if known else None
            found.append(Rule("mean PGA over the target's", ">= 1", text, met))
        met = least_ratio >= self.least - 1e-6
        found.append(Rule(f"mean/target, {span}", f">= {self.least:g}", f"{least_ratio:.3f}", met))
        if self.span is not None:
            name = "T_M" if self.isolated else "T1"
            text = " to ".join(f"{factor:g} {name}" for factor in self.span)
            period = structure and (structure.secant if self.isolated else structure.fixed)
            if period is None:
                unknown = f"{span}; {name} is not known: give --case"
                return (*found, Rule("range of periods", text, unknown, None))
            ends = self.span[0] * period, self.span[1] * period
            covers = low <= ends[0] * (1.0 + 1e-6) and ends[1] * (1.0 - 1e-6) <= high
            text = f"{text} = {ends[0]:.3g} to {ends[1]:.3g} s"
            found.append(Rule("range of periods", text, span, covers))
        return tuple(found)


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
        "number, direction, level and 0.9 compared with the manual of QuakeManager, not with the"
        f" text; the range of periods {NOT_VERIFIED}",
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

_RANGES = {
    "magnitude": "",
    "distance": "m",
    "vs30": "m/s",
    "usable_period": "s",
    "d5_75": "s",
    "d5_95": "s",
}
"""Quantities that have a range, with SI units; significant durations are those of the motion."""


class Filter(NamedTuple):
    """A range that one quantity must lie in, ends included [SI]."""

    text: str
    name: str
    low: float
    high: float

    def keeps(self, motion: GroundMotion) -> bool | None:
        """True if a motion may be a candidate; None if the quantity is not known of it."""
        if self.name.startswith("d5"):
            value = getattr(intensity_measures(motion), self.name)
        else:
            value = getattr(motion.recording, self.name)
        return None if value is None else self.low <= value <= self.high


def kept(
    motions: Sequence[GroundMotion], filters: Iterable[Filter]
) -> tuple[list[GroundMotion], dict[str, dict[str, int]]]:
    """Motions that pass every filter, and how many each keeps out, or knows nothing of."""
    passing, left_out = list(motions), {}
    for each in filters:
        verdicts = [each.keeps(motion) for motion in passing]
        left_out[each.text] = {"outside": verdicts.count(False), "not_known": verdicts.count(None)}
        passing = [motion for motion, keeps in zip(passing, verdicts, strict=True) if keeps]
    return passing, left_out


def parse_filter(text: str) -> Filter:
    """A range as ``--where`` gives it, in SI or with units; an end may be left out.

    Such are `magnitude=6.5..7.5` and `pulse=no`.
    """
    name, _, wanted = (part.strip() for part in text.partition("="))
    fault, ends = "", [0.0, 0.0]
    low, dots, high = wanted.partition("..")
    if name == "pulse":
        ends = [1.0 if wanted == "yes" else 0.0] * 2
        fault = "" if wanted in ("yes", "no") else "write pulse=yes or pulse=no"
    elif name not in _RANGES:
        known = f"known are {', '.join(_RANGES)}, pulse"
        fault = f"{name!r} is not known; {hint(name, _RANGES, known)}"
    elif not dots:
        fault = f"write {name}=LOW..HIGH; an end may be left out"
    else:
        try:
            texts = low.strip() or "-inf", high.strip() or "inf"
            ends = [bare_or_si(end, _RANGES[name]) for end in texts]
            fault = "" if ends[0] <= ends[1] else "must not fall; write the lower end first"
        except ValueError as error:
            fault = f"an end of the range {error}"
    if fault:
        raise UsageError(f"--where {text}: {fault}")
    return Filter(text, name, *ends)
