"""CDMG/CSMIP volume 2 files: corrected acceleration, velocity and displacement, by channel."""

from __future__ import annotations

import re

from rpscli.records.formats.channels import Channel, chosen_channel, peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.series import series
from rpscli.records.formats.statements import Statement, stated_count, stated_number
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, canonical_unit, to_float

_CHANNEL = re.compile(
    r"^CORRECTED ACCELEROGRAM\b.*\bCHAN\s+(\d{1,9}):\s*(\S.*?)\s*(?:FROM)?\s*$", re.IGNORECASE
)
_POINTS = re.compile(
    rf"^\s*(\d+)\s+POINTS OF ACCEL DATA EQUALLY SPACED AT\s+({NUMBER_PATTERN})\s*SEC.*"
    rf"UNITS:\s*({UNIT_PATTERN})",
    re.IGNORECASE,
)
_NEXT = re.compile(r"\s*\d+ POINTS OF |/&|CORRECTED ACCELEROGRAM\b", re.IGNORECASE)
_ROW = 8
_PEAK = re.compile(rf"PEAK ACCELERATION\s*=\s*({NUMBER_PATTERN})", re.IGNORECASE)


def recognises_csmip(text: RecordText) -> bool:
    """Whether the first line is that of a volume 2 channel."""
    return _CHANNEL.match(text.heads[0]) is not None


def read_csmip(text: RecordText) -> GroundMotion:
    """Read the acceleration of one channel of a CSMIP volume 2 file."""
    channel = chosen_channel(
        text,
        [
            Channel(int(match[1]), index, " ".join(match[2].split()))
            for index, line in enumerate(text.heads)
            if (match := _CHANNEL.match(line))
        ],
    )
    peak = None
    for index in range(channel.line, len(text.lines)):
        line = text.heads[index]
        peak = peak or _PEAK.search(line)
        if points := _POINTS.match(line):
            break
    else:
        raise text.fault("no line announces the acceleration data of this channel", channel.line)
    unit, factor = text.agreed_factor(canonical_unit(points[3]))
    count = stated_count(text, Statement("POINTS OF ACCEL DATA", points[1], index))
    values = series(text, index + 1, count, width=_ROW, closed_by=_NEXT)
    dt = stated_number(text, Statement("the spacing of the data", points[2], index))
    titles = [line.strip() for line in text.heads[channel.line + 2 : channel.line + 7 : 4]]
    return GroundMotion(
        values * factor,
        text.agreed_dt(dt),
        text.name,
        text.source,
        "CSMIP volume 2",
        f"{'; '.join(titles)}; channel {channel.number}, {channel.label}; values in {unit}",
        peak_warnings(values, to_float(peak[1]), 1e-3) if peak else (),
    )
