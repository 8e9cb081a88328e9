"""Corrected acceleration of the Californian programme: COSMOS v1, and volume 2 of CSMIP."""

from __future__ import annotations

import re
from collections.abc import Sequence

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

_TITLE = re.compile(r"^(.*?)\(Format v0?1\.", re.IGNORECASE)
_REALS = re.compile(r"^\s*(\d+)\s+Real-header values follow", re.IGNORECASE)
_POINTS = re.compile(
    rf"^\s*(\d+)\s+acceleration p(?:oin)?ts.*?units\s*=\s*({UNIT_PATTERN})", re.IGNORECASE
)
_ROW = re.compile(r"Format\s*=\s*\(\s*([1-9]\d?)[A-Z]", re.IGNORECASE)
_TEXT = re.compile(r"\s*(?:\|.*|.*[A-Za-z]{3})")  # any line of words or comments
_NEXT = re.compile(
    r"\s*\||/&|End.of.data|.*\(Format v0?1\.|\s*\d+\s+[a-z]+ p(?:oin)?ts", re.IGNORECASE
)
_SECONDS = re.compile(rf"\bapprox\s+({NUMBER_PATTERN})\s*secs", re.IGNORECASE)
_STATION_CHANNEL = re.compile(r"Sta Chan?\s*(\d{1,9}):", re.IGNORECASE)
_INTERVAL = 61  # real-header value 62: sampling interval of the data [ms]
_PEAK = 63  # real-header value 64: their peak
_UNKNOWN = -999.0


def recognises_cosmos(text: RecordText) -> bool:
    """Whether the first line states version 1 of the format."""
    return _TITLE.match(text.heads[0]) is not None


def read_cosmos(text: RecordText) -> GroundMotion:
    """Read the corrected acceleration of a COSMOS v1 file."""
    starts = [index for index, line in enumerate(text.heads) if _TITLE.match(line)]
    channel = chosen_channel(text, [_channel(text, i, start) for i, start in enumerate(starts, 1)])
    title = _TITLE.match(text.heads[channel.line])
    if title is None or "corrected acceleration" not in title[1].lower():
        raise text.fault(
            f"the file holds {text.lines[channel.line][:26].strip()!r}; only corrected "
            f"acceleration can be read, usually the file ending in .v1 or .V2c",
            channel.line,
        )
    reals: Sequence[float] = ()
    for index in range(channel.line, len(text.lines)):
        if announced := _REALS.match(text.heads[index]):
            count = stated_count(text, Statement("real-header values", announced[1], index))
            reals = series(text, index + 1, count, closed_by=_TEXT).tolist()
        if points := _POINTS.match(text.heads[index]):
            break
    else:
        raise text.fault("no line announces acceleration values in a known unit", channel.line)
    if len(reals) <= _PEAK or reals[_INTERVAL] <= 0.0:
        raise text.fault(
            "real-header value 62, the sampling interval in ms, is missing; fetch the file again"
        )
    count = stated_count(text, Statement("acceleration points", points[1], index))
    dt = reals[_INTERVAL] / 1000.0
    if approximate := _SECONDS.search(text.heads[index]):
        said = Statement("approx", approximate[1], index)
        refuse_other_duration(text, said, count, dt, 1.0 + 0.01 * count * dt)
    unit, factor = text.agreed_factor(canonical_unit(points[2]))
    width = _ROW.search(text.heads[index])
    values = series(text, index + 1, count, width=int(width[1]) if width else None, closed_by=_NEXT)
    return GroundMotion(
        values * factor,
        text.agreed_dt(dt),
        text.name,
        text.source,
        "COSMOS v1",
        f"{' '.join(text.lines[channel.line + 1].split())}; {channel.label}; values in {unit}",
        () if reals[_PEAK] == _UNKNOWN else peak_warnings(values, reals[_PEAK], 1e-3),
    )


def _channel(text: RecordText, place: int, start: int) -> Channel:
    # Line 9 of the header: "Sta Chan  1: 340 deg (Rcrdr Chan  1) Location: ..."
    label = " ".join(" ".join(text.heads[start + 8 : start + 9]).split())
    number = _STATION_CHANNEL.match(label)
    return Channel(int(number[1]) if number else place, start, label)


_CSMIP_CHANNEL = re.compile(
    r"^CORRECTED ACCELEROGRAM\b.*\bCHAN\s+(\d{1,9}):\s*(\S.*?)\s*(?:FROM)?\s*$", re.IGNORECASE
)
_CSMIP_POINTS = re.compile(
    rf"^\s*(\d+)\s+POINTS OF ACCEL DATA EQUALLY SPACED AT\s+({NUMBER_PATTERN})\s*SEC.*?"
    rf"(?:UNITS:|,\s*IN)\s*({UNIT_PATTERN})",
    re.IGNORECASE,
)
_CSMIP_NEXT = re.compile(r"\s*\d+ POINTS OF |/&|CORRECTED ACCELEROGRAM\b", re.IGNORECASE)
_CSMIP_ROW = 8
_CSMIP_PEAK = re.compile(rf"PEAK ACCELERATION\s*=\s*({NUMBER_PATTERN})", re.IGNORECASE)


def recognises_csmip(text: RecordText) -> bool:
    """Whether the first line is that of a volume 2 channel."""
    return (
        _CSMIP_CHANNEL.match(text.heads[0]) is not None
        or _UNCORRECTED.match(text.heads[0]) is not None
    )


_UNCORRECTED = re.compile(r"^UNCORRECTED ACCELEROGRAM\b", re.IGNORECASE)


def read_csmip(text: RecordText) -> GroundMotion:
    """Read the acceleration of one channel of a CSMIP volume 2 file."""
    if _UNCORRECTED.match(text.heads[0]):
        raise text.fault(
            "the file holds an uncorrected accelerogram (volume 1); give the corrected one of"
            " volume 2, usually the file ending in .V2",
            0,
        )
    channel = chosen_channel(
        text,
        [
            Channel(int(match[1]), index, " ".join(match[2].split()))
            for index, line in enumerate(text.heads)
            if (match := _CSMIP_CHANNEL.match(line))
        ],
    )
    peak = None
    for index in range(channel.line, len(text.lines)):
        line = text.heads[index]
        peak = peak or _CSMIP_PEAK.search(line)
        if points := _CSMIP_POINTS.match(line):
            break
    else:
        raise text.fault("no line announces the acceleration data of this channel", channel.line)
    unit, factor = text.agreed_factor(canonical_unit(points[3]))
    count = stated_count(text, Statement("POINTS OF ACCEL DATA", points[1], index))
    values = series(text, index + 1, count, width=_CSMIP_ROW, closed_by=_CSMIP_NEXT)
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
