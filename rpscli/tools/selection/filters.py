"""Ranges of magnitude, distance, soil or duration that motions must lie in."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from rpscli.errors import UsageError, hint
from rpscli.records import measures
from rpscli.records.ground_motion import GroundMotion
from rpscli.units import bare_or_si

_RANGES = {
    "magnitude": "",
    "distance": "m",
    "vs30": "m/s",
    "usable_period": "s",
    "d5_75": "s",
    "d5_95": "s",
}
"""Quantities that have a range, with SI units; significant durations
are those of the motion."""


class Filter(NamedTuple):
    """A range that one quantity must lie in, ends included [SI]."""

    text: str
    name: str
    low: float
    high: float

    def keeps(self, motion: GroundMotion) -> bool | None:
        """True if a motion may be a candidate; None if the
        quantity is not known of it.
        """
        durations = self.name.startswith("d5")
        of = measures.intensity_measures(motion) if durations else motion.recording
        value = getattr(of, self.name)
        return None if value is None else self.low <= value <= self.high


def kept(
    motions: Sequence[GroundMotion], filters: Iterable[Filter]
) -> tuple[list[GroundMotion], dict[str, dict[str, int]]]:
    """Motions that pass every filter, and how many each keeps
    out, or knows nothing of.
    """
    passing = list(motions)
    left_out = {}
    for each in filters:
        verdicts = [each.keeps(motion) for motion in passing]
        left_out[each.text] = {
            "outside": verdicts.count(False),
            "not_known": verdicts.count(None),
        }
        passing = list(itertools.compress(passing, verdicts))
    return passing, left_out


def parse_filter(text: str) -> Filter:
    """A range as ``--where`` gives it, in SI or with units; an end may be left out.

    Such are `magnitude=6.5..7.5` and `pulse=no`.
    """
    name, _, wanted = (part.strip() for part in text.partition("="))
    fault = ""
    ends = [0.0, 0.0]
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
            fault = (
                "" if ends[0] <= ends[1] else "must not fall; write the lower end first"
            )
        except ValueError as error:
            fault = f"an end of the range {error}"
    if fault:
        raise UsageError(f"--where {text}: {fault}")
    return Filter(text, name, *ends)
