"""CDMG/CSMIP volume 2 files: corrected acceleration, velocity and displacement, by channel."""

from __future__ import annotations

import re

import numpy as np

from rpscli.records.formats.channels import Channel, chosen_channel, peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, canonical_unit

_CHANNEL = re.compile(
    r"^CORRECTED ACCELEROGRAM\b.*\bCHAN\s+(\d+):\s*(\S.*?)\s*(?:FROM)?\s*$", re.IGNORECASE
)
_POINTS = re.compile(
    rf"^\s*(\d+)\s+POINTS OF ACCEL DATA EQUALLY SPACED AT\s+({NUMBER_PATTERN})\s*SEC.*"
    rf"UNITS:\s*({UNIT_PATTERN})",
    re.IGNORECASE,
)
_PEAK = re.compile(rf"PEAK ACCELERATION\s*=\s*({NUMBER_PATTERN})", re.IGNORECASE)


def recognises_csmip(text: RecordText) -> bool:
    """Whether the first line is that of a volume 2 channel."""
    return _CHANNEL.match(text.lines[0]) is not None


def read_csmip(text: RecordText) -> GroundMotion:
    """Read the acceleration of one channel of a CSMIP volume 2 file."""
    channel = chosen_channel(
        text,
        [
            Channel(int(match[1]), index, " ".join(match[2].split()))
            for index, line in enumerate(text.lines)
            if (match := _CHANNEL.match(line))
        ],
    )
    peak = None
    for index in range(channel.line, len(text.lines)):
        line = text.lines[index]
        peak = peak or _PEAK.search(line)
        if points := _POINTS.match(line):
            break
    else:
        raise text.fault("no line announces the acceleration data of this channel", channel.line)
    unit, factor = text.agreed_factor(canonical_unit(points[3]))
    values = np.array(text.values(index + 1, int(points[1])))
    titles = [text.lines[channel.line + offset].strip() for offset in (2, 6)]
    return GroundMotion(
        values * factor,
        text.agreed_dt(float(points[2])),
        text.name,
        text.source,
        "CSMIP volume 2",
        f"{'; '.join(titles)}; channel {channel.number}, {channel.label}; values in {unit}",
        peak_warnings(values, float(peak[1]), 1e-3) if peak else (),
    )
