"""COSMOS v1 files of corrected acceleration."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rpscli.records.formats.channels import Channel, chosen_channel, peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.series import series
from rpscli.records.formats.statements import Statement, refuse_other_duration, stated_count
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import NUMBER_PATTERN, UNIT_PATTERN, canonical_unit

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
    """Read the corrected acceleration of a COSMOS v1 file.

    Raises
    ------
    RecordError
        If the file holds raw counts, velocity or displacement, besides the usual faults.
    """
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
