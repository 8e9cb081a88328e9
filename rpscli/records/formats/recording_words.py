"""What headers of plain files say of the recording: station, earthquake, direction."""

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


def recording_of(lines: Iterable[str]) -> Recording:
    """The recording that lines with keys describe, or a title as the PEER flatfiles have.

    A title is `event, date, station, direction`, or of the first collection `EVENT date
    time, STATION, direction (agency)`.
    """
    said: dict[str, str] = {}
    for line in lines:
        for name, pattern in _KEYS.items():
            match = re.search(pattern, line, re.IGNORECASE)
            if match and match[1] and name not in said:
                said[name] = match[1][:80]
        if not said and (titled := titled_recording(line)) is not None:
            return titled
    return Recording(**said)  # type: ignore[arg-type]


def titled_recording(line: str) -> Recording | None:
    """The recording of a title; None if a line is none."""
    parts = [part.strip() for part in line.split(",")]
    if len(parts) == 4:
        event, date, station, direction = parts
        origin = date if re.search(r"\d:\d\d", date) else ""
        return Recording(
            f"{event}, {date}", station=station, direction=direction, origin=origin
        )
    direction = re.sub(r"\s*\(.*\)$", "", parts[-1])
    dated = re.search(r"\d/\d+/\d|\b(?:19|20)\d\d\b", parts[0])
    if len(parts) == 3 and dated and direction_of(direction) is not None:
        return Recording(parts[0], station=parts[1], direction=direction)
    return None
