"""GeoNet (New Zealand) volume 2 files: corrected acceleration of several components."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import (
    Channel,
    Statement,
    chosen_channel,
    peak_warnings,
    refuse_other_duration,
    series,
    stated_count,
    stated_number,
)
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, canonical_unit, to_float

_TITLE = re.compile(r"^Corrected accelerogram\b")
_COUNT = re.compile(r"Number of points\s+(\d+)")
_DURATION = re.compile(rf"\bDuration\s+({NUMBER_PATTERN})\s*sec")
_STEP = re.compile(rf"data at\s+({NUMBER_PATTERN})\s*sec intervals")
_COMPONENT = re.compile(r"^Component\s+(\S+)")
_PEAK = re.compile(rf"^Acceleration:\s*peak\s+({NUMBER_PATTERN})\s*({UNIT_PATTERN})", re.IGNORECASE)
_TEXT_LINES, _HEADER_LINES, _ROW = 16, 10, 10


def recognises_geonet(text: RecordText) -> bool:
    """Whether the file begins like a volume 2 file of GeoNet."""
    head = "\n".join(text.heads[:_TEXT_LINES])
    return bool(_TITLE.match(head)) and _COUNT.search(head) is not None


def read_geonet(text: RecordText) -> GroundMotion:
    """Read the acceleration of one component, chosen by its place in the file."""
    starts = [index for index, line in enumerate(text.heads) if _TITLE.match(line)]
    channel = chosen_channel(
        text, [Channel(i, start, _label(text, start)) for i, start in enumerate(starts, 1)]
    )
    head = text.heads[channel.line : channel.line + _TEXT_LINES]
    joined = "\n".join(head)
    count, step = _COUNT.search(joined), _STEP.search(joined)
    peak = next((match for line in head if (match := _PEAK.match(line))), None)
    if not (count and step and peak):
        raise text.fault(
            "the header lacks the number of points, the interval or the peak acceleration",
            channel.line,
        )
    unit, factor = text.agreed_factor(canonical_unit(peak[2]))
    first = channel.line + _TEXT_LINES
    here = channel.line
    values = _acceleration(
        text, first, stated_count(text, Statement("Number of points", count[1], here))
    )
    dt = stated_number(text, Statement("the interval of the data", step[1], here))
    if duration := _DURATION.search(joined):
        refuse_other_duration(text, Statement("Duration", duration[1], here), values.size, dt, 0.01)
    titles = [" ".join(head[index].split()) for index in (1, 7)]
    return GroundMotion(
        values * factor,
        text.agreed_dt(dt),
        text.name,
        text.source,
        "GeoNet volume 2",
        f"{'; '.join(titles)}; component {channel.label}; values in {unit}",
        peak_warnings(values, to_float(peak[1]), 0.1),
    )


def _acceleration(text: RecordText, first: int, count: int) -> NDArray[np.float64]:
    # Velocities and displacements follow without a line between: a row too few or too many shows
    # in the length of all three, and a lost line of text in that of the header.
    body = first + _HEADER_LINES
    series(text, first, _HEADER_LINES * _ROW, width=_ROW, stop=body)
    rows = -(-count // _ROW)
    for place in range(3):
        values = series(
            text,
            body + place * rows,
            count,
            width=_ROW,
            stop=None if place == 2 else body + (place + 1) * rows,
            closed_by=_TITLE,
        )
        if place == 0:
            acceleration = values
    return acceleration


def _label(text: RecordText, start: int) -> str:
    matches = map(_COMPONENT.match, text.heads[start : start + _TEXT_LINES])
    return next((match[1] for match in matches if match), "unnamed")
