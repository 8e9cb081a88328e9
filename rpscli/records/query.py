"""The options of a record source: `sine?amplitude=0.4g&period=1.2`."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rpscli.errors import RecordError, nearest
from rpscli.records.quantities import (
    KNOWN_UNITS,
    NUMBER_PATTERN,
    canonical_unit,
    to_float,
    unit_factor,
)

_QUANTITY = re.compile(rf"\s*({NUMBER_PATTERN})\s*(.*?)\s*")
_UNITS = {
    "time": {"": 1.0, "s": 1.0, "sec": 1.0, "ms": 1e-3},
    "frequency": {"": 1.0, "hz": 1.0},
    "velocity": {"": 1.0, "m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "angle": {"": 1.0, "rad": 1.0, "deg": math.pi / 180.0},
    "direction": {"": 1.0, "deg": 1.0, "rad": 180.0 / math.pi},
    "ratio": {"": 1.0, "%": 0.01},
}


LIKENESS = 0.5
"""Of a name to the one that was meant: names of records are long, and made of parts."""

SOME = 12
"""Known words that are told where there are more than twice as many."""


def hint(word: str, known: Sequence[str]) -> str:
    """What might have been meant: the nearest known word, or else all of them, or some of many."""
    close = nearest(word, known, LIKENESS)
    if close:
        return f"did you mean {close}?"
    rest = f" and {len(known) - SOME} more" if len(known) > 2 * SOME else ""
    return f"known: {', '.join(known[:SOME] if rest else known)}{rest}"


@dataclass(frozen=True)
class Query:
    """The options of one source, as text; each accessor turns one into a number in SI."""

    source: str
    values: Mapping[str, str]

    def quantity(self, key: str, kind: str, default: float | None = None) -> float:
        """A number with an optional unit, in SI."""
        if key not in self.values and default is not None:
            return default
        parts = self._parts(key)
        factor = _UNITS[kind].get(parts[1].lower())
        if factor is None:
            units = ", ".join(unit for unit in _UNITS[kind] if unit)
            raise RecordError(
                f"{self.source}: {key} = {self.values[key]!r} should be a {kind} in {units}"
            )
        return to_float(parts[0]) * factor

    def acceleration(self, key: str) -> float:
        """An acceleration [m/s2]: `0.4g`, `0.4 g`, `3.9 m/s2`, or a bare number in m/s2."""
        parts = self._parts(key)
        unit = canonical_unit(parts[1] or "m/s2")
        if unit is None:
            raise RecordError(
                f"{self.source}: {key} = {self.values[key]!r} should be an acceleration in "
                f"{KNOWN_UNITS} (bare: m/s2)"
            )
        return to_float(parts[0]) * unit_factor(unit)

    def integer(self, key: str) -> int:
        """A whole number that is not negative."""
        value = self.values.get(key)
        if value is None or not re.fullmatch("[0-9]{1,18}", value):
            found = "is missing" if value is None else f"= {value[:40]!r} is not one"
            raise RecordError(f"{self.source}: {key} {found}; give a whole number, {key}=1")
        return int(value)

    def _parts(self, key: str) -> tuple[str, str]:
        value = self.values.get(key)
        if value is None:
            raise RecordError(f"{self.source}: {key} is missing; add {key}=...")
        match = _QUANTITY.fullmatch(value)
        if not match or not math.isfinite(to_float(match[1])):
            raise RecordError(
                f"{self.source}: {key} = {value[:40]!r} is not a number; write {key}=0.5"
            )
        return match[1], match[2]


def parse_query(text: str, source: str, allowed: Sequence[str]) -> Query:
    """Split `key=value&key=value`."""
    values: dict[str, str] = {}
    for item in filter(None, text.split("&")):
        key, _, value = (part.strip() for part in item.partition("="))
        if key not in allowed:
            raise RecordError(f"{source}: option {key!r} is not known; {hint(key, allowed)}")
        if key in values:
            raise RecordError(f"{source}: {key} is given twice; keep one")
        if not value:
            raise RecordError(f"{source}: {key} has no value; write {key}=...")
        values[key] = value
    return Query(source, values)
