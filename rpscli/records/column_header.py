"""What the header of a plain column file states: time step, units, count.

Read are `dt: 0.005` or `time step = 0.005 s`, `units: g`, `npts: 4000`, and titles of columns such
as `Time (s), Acceleration (m/s2)`, in any line before the first number.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from rpscli.records.acceleration_units import KNOWN_UNITS, UNIT_PATTERN, canonical_unit
from rpscli.records.numerals import NUMBER_PATTERN, to_float
from rpscli.records.record_text import RecordText

_STEP = re.compile(rf"\b(?:dt|time\s*step)\b\s*[=:]\s*({NUMBER_PATTERN})", re.IGNORECASE)
_COUNT = re.compile(r"\b(?:npts|ndata)\b\s*[=:]\s*([0-9]+)", re.IGNORECASE)
_UNITS_KEY = re.compile(r"\bunits?\b\s*(?:[=:]|of\b)\s*([^,;]+)", re.IGNORECASE)
_COLUMN_TITLE = re.compile(
    rf"\b(?:acc|accel|acceleration|ag|a)[\s_]*(?:[\[(]|\bin\b)\s*({UNIT_PATTERN})", re.IGNORECASE
)


def stated_count(header: Sequence[str]) -> int | None:
    """The number of values that the header announces."""
    count = _COUNT.search("\n".join(header))
    return int(count[1]) if count else None


def stated_step(text: RecordText, header: Sequence[str]) -> float | None:
    """The time step that the header states [s].

    Raises
    ------
    RecordError
        If it states two different ones.
    """
    steps = {to_float(numeral) for numeral in _STEP.findall("\n".join(header))}
    if len(steps) > 1:
        raise text.fault(f"the header states different time steps: {sorted(steps)}")
    return steps.pop() if steps else None


def stated_units(text: RecordText, header: Sequence[str]) -> str | None:
    """The canonical unit of acceleration that the header states.

    Raises
    ------
    RecordError
        If it states two different ones, or one that is not known.
    """
    units: set[str] = set()
    for line in header:
        key = _UNITS_KEY.search(line)
        if key:
            units.add(_unit_after_key(text, key[0], key[1]))
        title = _COLUMN_TITLE.search(line)
        if title and (unit := canonical_unit(title[1])):
            units.add(unit)
    if len(units) > 1:
        raise text.fault(f"the header states different units: {', '.join(sorted(units))}")
    return units.pop() if units else None


def _unit_after_key(text: RecordText, statement: str, spelling: str) -> str:
    word = re.match(rf"[\s(\[]*({UNIT_PATTERN})", spelling, re.IGNORECASE)
    unit = canonical_unit(word[1]) if word else None
    if unit is None:
        raise text.fault(
            f"the header says {statement.strip()!r}, which is no unit of acceleration that is "
            f"known ({KNOWN_UNITS})"
        )
    return unit
