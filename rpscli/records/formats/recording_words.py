"""Statements of plain files' headers on the recording: station, earthquake, direction."""

from __future__ import annotations

import re
from collections.abc import Iterable

from rpscli.records.directions import direction_of
from rpscli.records.ground_motion import Recording

_VALUE = r"\s*[:=]\s*([^;|#]*?)\s*(?=$|[;|#]|,\s*[A-Za-z ]+[:=])"
_KEYS = {
    "station": rf"(?<![?&])\bstation(?:[\s_]*(?:code|name|id|no\.?))?{_VALUE}",
    "direction": (
        rf"(?<![?&])\b(?:component|comp|direction|dir|orientation|azimuth|channel)\b\.?{_VALUE}"
    ),
    "event": rf"(?<![?&])\b(?:event|earthquake|eq)(?:[\s_]*name)?{_VALUE}",
    "origin": rf"(?<![?&])\b(?:origin(?:[\s_]*time)?|event[\s_]*(?:time|date)){_VALUE}",
    "start": rf"(?<![?&])\b(?:start[\s_]*time|time[\s_]*of[\s_]*first[\s_]*sample){_VALUE}",
}
"""Keys of header lines by the fields of a `Recording`."""


def without_recording(line: str) -> str:
    """A line without what it says of the station, the earthquake and times."""
    if titled_recording(line):
        return ""
    for name, pattern in _KEYS.items():
        if name != "direction":
            line = re.sub(pattern, ";", line, flags=re.IGNORECASE)
    return line


def recording_of(lines: Iterable[str]) -> Recording:
    """The recording that lines with keys describe, or a title as the PEER flatfiles have.

    A title is `event, date, station, direction`, or of the first collection `EVENT date
    time, STATION, direction (agency)`. What stands behind a key counts before it.
    """
    said: dict[str, str] = {}
    titled: Recording | None = None
    below = False
    for line in lines:
        below |= is_below_ground(line)
        for name, pattern in _KEYS.items():
            match = re.search(pattern, line, re.IGNORECASE)
            if match and match[1] and name not in said:
                said[name] = match[1][:80]
        if "direction" not in said and (way := _direction_without_key(line)):
            said["direction"] = way
        titled = titled or (None if said else titled_recording(line))
    found = (titled or Recording())._replace(**said)  # type: ignore[arg-type]
    if below:
        found = found._replace(station=f"{found.station} borehole".strip())
    return found


_DIP = re.compile(r"\bdip\b\s*[:=]\s*[+-]?90\b", re.IGNORECASE)
_WORD = re.compile(
    r"^\W*(?:dir\.|channel|component|comp\.?|direction|angle|inc\w*)\s+(\S{1,12})\s*$",
    re.IGNORECASE,
)
_BELOW = re.compile(
    r"bore-?hole|down-?hole|below\s+(?:the\s+)?ground|\bwithin\b.*rock|rock.*\bwithin\b"
    r"|\b(?:sensor|instrument|installation)?[\s_]*depth\b\s*[:=(m)\s]*-?0*[1-9][\d.]*\s*m\b"
    r"|\b(?:GL|elevation|level|position)\s*[:=]?\s*-\s*[1-9][\d.]*\s*m?\b"
    r"|\bpozo\b|\bforage\b|bohrloch|sondaj|скважин",
    re.IGNORECASE,
)
_OF_THE_EARTHQUAKE = re.compile(r"hypo|focal|event|source|epi", re.IGNORECASE)


def is_below_ground(line: str) -> bool:
    """True of a line that puts the instrument below the ground."""
    return bool(_BELOW.search(line)) and not _OF_THE_EARTHQUAKE.search(line)


def _direction_without_key(line: str) -> str:
    """The direction in lines such as `Dir. V`, `CHANNEL HNZ` and `dip: -90`."""
    if _DIP.search(line):
        return "UP"
    match = _WORD.match(line)
    return match[1] if match and direction_of(match[1]) is not None else ""


_DATE = re.compile(
    r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\b\d{1,2} \w{3,9} \d{4}\b|\b(?:19|20)\d\d\b|^-$"
)


def titled_recording(line: str) -> Recording | None:
    """The recording of a title; None if a line is none."""
    parts = [part.strip() for part in line.split(",")]
    dated = [k for k, part in enumerate(parts[1:-2], 1) if _DATE.search(part)]
    if dated:
        at = dated[-1]
        date = parts[at]
        return Recording(
            f"{', '.join(parts[:at])}, {date}",
            station=", ".join(parts[at + 1 : -1]),
            direction=parts[-1],
            origin=date if re.search(r"\d:\d\d", date) else "",
        )
    direction = re.sub(r"\s*\(.*\)$", "", parts[-1])
    of_event = re.search(r"\d/\d+/\d|\b(?:19|20)\d\d\b", parts[0])
    if len(parts) == 3 and of_event and direction_of(direction) is not None:
        return Recording(parts[0], station=parts[1], direction=direction)
    return None
