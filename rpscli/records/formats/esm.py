"""ESM/ITACA ASCII files (DYNA 1.x): `KEY: value` lines, then one acceleration on a line."""

from __future__ import annotations

import re

from rpscli.records.formats.record_text import RecordText
from rpscli.records.formats.statements import (
    Statement,
    peak_warnings,
    refuse_other_duration,
    series,
    stated_count,
    stated_number,
)
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.quantities import KNOWN_UNITS, canonical_unit

_KEY = re.compile(r"^([A-Z][A-Z0-9_/^]*):\s*(.*)$")
_DURATION = "DURATION_S"
_PEAK = "PGA_CM/S^2"
_NEEDED = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS")


def recognises_esm(text: RecordText) -> bool:
    """Whether the first line is a key and the sampling interval follows among the keys."""
    head = text.heads[:80]
    return bool(_KEY.match(head[0])) and any(line.startswith(_NEEDED[0]) for line in head)


def read_esm(text: RecordText) -> GroundMotion:
    """Read an ESM/ITACA acceleration file."""
    text.single_channel()
    header: dict[str, str] = {}
    lines: dict[str, int] = {}
    start = 0
    while start < len(text.heads) and (pair := _KEY.match(text.heads[start])):
        key, value = pair[1], pair[2].strip()
        if header.setdefault(key, value) != value:
            raise text.fault(
                f"{key}: {value[:40]} contradicts line {lines[key] + 1}; keep one record in a"
                " file, and one value for a key",
                start,
            )
        lines.setdefault(key, start)
        start += 1
    missing = [key for key in _NEEDED if not header.get(key)]
    if missing:
        raise text.fault(f"the header lacks {', '.join(missing)}; fetch the file again")

    def stated(key: str) -> Statement:
        return Statement(key, header[key], lines[key])

    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise text.fault(f"the file holds {kind.lower()}; give the acceleration (.ACC.) file")
    stated_unit = canonical_unit(header["UNITS"])
    if stated_unit is None:
        raise text.fault(
            f"UNITS: {header['UNITS'][:40]} is not a unit of acceleration that is known"
            f" ({KNOWN_UNITS}); give the acceleration (.ACC.) file",
            lines["UNITS"],
        )
    unit, factor = text.agreed_factor(stated_unit)
    dt = stated_number(text, stated("SAMPLING_INTERVAL_S"))
    values = series(text, start, stated_count(text, stated("NDATA")), width=1)
    if header.get(_DURATION):
        refuse_other_duration(text, stated(_DURATION), values.size, dt, 1e-3)
    peak = stated_number(text, stated(_PEAK)) if header.get(_PEAK) else None
    where = " ".join(header.get(key, "") for key in ("EVENT_NAME", "EVENT_DATE_YYYYMMDD"))
    station = " ".join(header.get(key, "") for key in ("NETWORK", "STATION_CODE", "STREAM"))
    return GroundMotion(
        values * factor,
        text.agreed_dt(dt),
        text.name,
        text.source,
        "ESM ASCII",
        f"{where}; {station}; values in {unit}",
        () if peak is None else peak_warnings(values * factor * 100.0, peak, 1e-6),
        recording=Recording(
            station=header.get("STATION_CODE", ""),
            magnitude=next(
                (
                    stated_number(text, stated(key))
                    for key in ("MAGNITUDE_W", "MAGNITUDE_L")
                    if header.get(key)
                ),
                None,
            ),
            origin=" ".join(
                filter(
                    None, (header.get(f"EVENT_{of}", "") for of in ("DATE_YYYYMMDD", "TIME_HHMMSS"))
                )
            ),
            direction=header.get("STREAM", ""),
        ),
    )
