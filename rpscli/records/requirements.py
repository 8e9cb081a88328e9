"""What codes ask of a set of ground motions, and whether a set has it.

Each entry says against what it was checked. None of the codes' own texts was at hand: whoever needs
a clause reads it there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from rpscli.records.pair_measure import SHOWN, Of

Component = Of | Literal["srss"]
"""What a spectrum is of: a measure of pairs, or the root of the sum of both squared spectra."""

NOT_VERIFIED = "NOT VERIFIED"
"""How statements begin that nothing was found to check."""


def component_text(of: Component) -> str:
    """A definition of the component as readers see it.

    >>> component_text("rotd100"), component_text("component")
    ('RotD100 of pairs, the maximum direction', 'single components')
    """
    if of == "component":
        return "single components"
    if of == "srss":
        return "SRSS of both components of pairs"
    among = ", the maximum direction" if of == "rotd100" else ""
    return f"{SHOWN.get(of, of)} of pairs{among}"


@dataclass(frozen=True)
class Requirements:
    """What a code asks of a set; `span` are multiples of T1, or of T_M where it is `isolated`."""

    clause: str
    checked: str
    count: int = 1
    """Motions or pairs at least."""
    least: float = 0.9
    """Mean spectrum over target at least."""
    mean_pga: bool = False
    """Whether the mean PGA must reach that of the target."""
    of: Component | None = None
    level: str = ""
    span: tuple[float, float] | None = None
    isolated: bool = False


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


class Periods(NamedTuple):
    """Periods of a structure [s]: the first one on a fixed base, and the secant one on bearings."""

    fixed: float | None
    secant: float


class Have(NamedTuple):
    """What a set has: its mean over the target within a range, and its mean PGA over that."""

    number: int
    of: Component
    level: str
    span: tuple[float, float]
    least: float
    pga_ratio: float


def rules_of(asked: Requirements, have: Have, periods: Periods | None) -> list[Rule]:
    """Every requirement of a code, judged; 1e-6 are for factors of six digits."""
    noun = "motions" if have.of == "component" else "pairs"
    enough = have.number >= asked.count
    found = [Rule(f"number of {noun}", f">= {asked.count}", str(have.number), enough)]
    if asked.of is not None:
        texts = component_text(asked.of), component_text(have.of)
        found.append(Rule("component", *texts, have.of == asked.of))
    if asked.level:
        told = have.level or "not said by the target"
        same = have.level.lower() == asked.level.lower() if have.level else None
        found.append(Rule("level", asked.level, told, same))
    if asked.mean_pga:
        reached = have.pga_ratio >= 1.0 - 1e-6
        found.append(Rule("mean PGA over the target's", ">= 1", f"{have.pga_ratio:.3f}", reached))
    reached = have.least >= asked.least - 1e-6
    low, high = have.span
    place = f"mean/target, {low:.3g} to {high:.3g} s"
    found.append(Rule(place, f">= {asked.least:g}", f"{have.least:.3f}", reached))
    if asked.span is not None:
        found.append(_covered(asked, have, periods))
    return found


def _covered(asked: Requirements, have: Have, periods: Periods | None) -> Rule:
    """Whether the range is that of the code."""
    assert asked.span is not None, "a code without a range covers it"
    name = "T_M" if asked.isolated else "T1"
    text = " to ".join(f"{factor:g} {name}" for factor in asked.span)
    span = f"{have.span[0]:.3g} to {have.span[1]:.3g} s"
    period = periods and (periods.secant if asked.isolated else periods.fixed)
    if period is None:
        return Rule("range of periods", text, f"{span}; {name} is not known: give --case", None)
    low, high = (factor * period for factor in asked.span)
    covers = have.span[0] <= low * (1.0 + 1e-6) and high * (1.0 - 1e-6) <= have.span[1]
    return Rule("range of periods", f"{text} = {low:.3g} to {high:.3g} s", span, covers)
