"""Conditions that a recording must meet to be a candidate: `magnitude=6.5..7.5`, `pulse=no`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from rpscli.errors import UsageError, hint
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import intensity_measures
from rpscli.units import bare_or_si

UNITS = {
    "magnitude": "",
    "distance": "m",
    "vs30": "m/s",
    "usable_period": "s",
    "d5_75": "s",
    "d5_95": "s",
}
"""Quantities that have a range, with SI units; significant durations are those of the motion."""

PULSE = {"yes": 1.0, "no": 0.0}


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
    """A range as ``--where`` gives it, in SI or with units; an end may be left out."""
    name, _, wanted = (part.strip() for part in text.partition("="))
    if name == "pulse":
        if wanted not in PULSE:
            raise UsageError(f"--where {text}: write pulse=yes or pulse=no")
        return Filter(text, name, PULSE[wanted], PULSE[wanted])
    if name not in UNITS:
        known_are = f"known are {', '.join(UNITS)}, pulse"
        raise UsageError(f"--where {text}: {name!r} is not known; {hint(name, UNITS, known_are)}")
    low, dots, high = wanted.partition("..")
    if not dots:
        raise UsageError(f"--where {text}: write {name}=LOW..HIGH; an end may be left out")
    try:
        ends = _value(low, UNITS[name], -math.inf), _value(high, UNITS[name], math.inf)
    except ValueError as error:
        raise UsageError(f"--where {text}: an end of the range {error}") from None
    if not ends[0] <= ends[1]:
        raise UsageError(f"--where {text}: must not fall; write the lower end first")
    return Filter(text, name, *ends)


def _value(text: str, unit: str, missing: float) -> float:
    return bare_or_si(text.strip(), unit) if text.strip() else missing
