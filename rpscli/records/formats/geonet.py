"""GeoNet (New Zealand) volume 2 files: corrected acceleration of several components."""

from __future__ import annotations

import re

import numpy as np

from rpscli.records.formats.channels import Channel, chosen_channel, peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, canonical_unit

_TITLE = re.compile(r"^Corrected accelerogram\b")
_COUNT = re.compile(r"Number of points\s+(\d+)")
_STEP = re.compile(rf"data at\s+({NUMBER_PATTERN})\s*sec intervals")
_COMPONENT = re.compile(r"^Component\s+(\S+)")
_PEAK = re.compile(rf"^Acceleration:\s*peak\s+({NUMBER_PATTERN})\s*({UNIT_PATTERN})", re.IGNORECASE)
_TEXT_LINES, _HEADER_LINES, _HEADER_WIDTH = 16, 10, 10


def recognises_geonet(text: RecordText) -> bool:
    """Whether the file begins like a volume 2 file of GeoNet."""
    head = "\n".join(text.lines[:_TEXT_LINES])
    return bool(_TITLE.match(head)) and _COUNT.search(head) is not None


def read_geonet(text: RecordText) -> GroundMotion:
    """Read the acceleration of one component, chosen by its place in the file."""
    starts = [index for index, line in enumerate(text.lines) if _TITLE.match(line)]
    channel = chosen_channel(
        text, [Channel(i, start, _label(text, start)) for i, start in enumerate(starts, 1)]
    )
    head = text.lines[channel.line : channel.line + _TEXT_LINES]
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
    text.values(first, _HEADER_LINES * _HEADER_WIDTH)  # the headers are where they should be
    values = np.array(text.values(first + _HEADER_LINES, int(count[1])))
    titles = [" ".join(head[index].split()) for index in (1, 7)]
    return GroundMotion(
        values * factor,
        text.agreed_dt(float(step[1])),
        text.name,
        text.source,
        "GeoNet volume 2",
        f"{'; '.join(titles)}; component {channel.label}; values in {unit}",
        peak_warnings(values, float(peak[1]), 0.1),
    )


def _label(text: RecordText, start: int) -> str:
    for line in text.lines[start : start + _TEXT_LINES]:
        if match := _COMPONENT.match(line):
            return match[1]
    return "unnamed"
