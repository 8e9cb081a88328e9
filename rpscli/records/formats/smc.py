"""USGS SMC files of corrected acceleration.

Eleven lines of text, 48 integers, 50 reals, comments that begin with a bar, then the values in
fields of ten characters that touch where they are negative.
"""

from __future__ import annotations

import re

from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import MOST_VALUES, peak_warnings, series
from rpscli.records.ground_motion import GroundMotion

_TITLE = re.compile(r"^\s*([1-5])\s+(UNCORRECTED|CORRECTED|VELOCITY|DISPLACEMENT|RESPONSE)\b")
_CORRECTED = "2"
_TEXT_LINES, _INTEGERS, _REALS = 11, 48, 50
_INTEGER_LINES, _REAL_LINES, _ROW = 6, 10, 8


def recognises_smc(text: RecordText) -> bool:
    """Whether the first line carries one of the format's five titles."""
    return _TITLE.match(text.heads[0]) is not None


def read_smc(text: RecordText) -> GroundMotion:
    """Read a corrected accelerogram; the format's accelerations are in cm/s2."""
    text.single_channel()
    title = _TITLE.match(text.heads[0])
    if title is None or title[1] != _CORRECTED:
        raise text.fault(
            f"the file is {text.heads[0].strip()[:40]!r}; only '2 CORRECTED ACCELEROGRAM' can be"
            " read",
            0,
        )
    body = _TEXT_LINES + _INTEGER_LINES
    integers = series(text, _TEXT_LINES, _INTEGERS, stop=body)
    reals = series(text, body, _REALS, stop=body + _REAL_LINES)
    comments, count, rate = int(integers[15]), int(integers[16]), reals[1]
    if not (0 <= comments < MOST_VALUES and 0 < count < MOST_VALUES and 0.0 < rate < 1e4):
        raise text.fault(
            f"the headers give {count} values, {rate:g} a second, {comments} comments, which no"
            " record has; fetch the file again"
        )
    unit, factor = text.agreed_factor("cm/s2")
    values = series(text, body + _REAL_LINES + comments, count, width=_ROW)
    parts = [" ".join(text.heads[index].split()) for index in (3, 5)]
    return GroundMotion(
        values * factor,
        text.agreed_dt(1.0 / rate),
        text.name,
        text.source,
        "SMC",
        f"{'; '.join(parts)}; values in {unit}",
        peak_warnings(values, max(abs(reals[29]), abs(reals[31])), 1e-3),
    )
