"""ESM/ITACA ASCII files (DYNA 1.x): `KEY: value` lines, then one acceleration on a line."""

from __future__ import annotations

import re

import numpy as np

from rpscli.records.formats.channels import peak_warnings
from rpscli.records.formats.record_text import RecordText
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.quantities import canonical_unit

_KEY = re.compile(r"^([A-Z][A-Z0-9_/^]*):\s*(.*)$")
_NEEDED = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS")


def recognises_esm(text: RecordText) -> bool:
    """Whether the first line is a key and the sampling interval follows among the keys."""
    head = text.lines[:80]
    return bool(_KEY.match(head[0])) and any(line.startswith(_NEEDED[0]) for line in head)


def read_esm(text: RecordText) -> GroundMotion:
    """Read an ESM/ITACA acceleration file.

    Raises
    ------
    RecordError
        If the file holds velocity or displacement, besides the usual faults.
    """
    text.single_channel()
    header: dict[str, str] = {}
    start = 0
    while start < len(text.lines) and (pair := _KEY.match(text.lines[start])):
        header[pair[1]] = pair[2].strip()
        start += 1
    missing = [key for key in _NEEDED if not header.get(key)]
    if missing:
        raise text.fault(f"the header lacks {', '.join(missing)}")
    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise text.fault(f"the file holds {kind.lower()}; give the acceleration (.ACC.) file")
    stated = canonical_unit(header["UNITS"])
    if stated is None:
        raise text.fault(f"UNITS: {header['UNITS']} is no unit of acceleration that is known")
    unit, factor = text.agreed_factor(stated)
    values = np.array(text.values(start, int(header["NDATA"])))
    peak = header.get("PGA_CM/S^2")
    where = " ".join(header.get(key, "") for key in ("EVENT_NAME", "EVENT_DATE_YYYYMMDD"))
    station = " ".join(header.get(key, "") for key in ("NETWORK", "STATION_CODE", "STREAM"))
    return GroundMotion(
        values * factor,
        text.agreed_dt(float(header["SAMPLING_INTERVAL_S"])),
        text.name,
        text.source,
        "ESM ASCII",
        f"{where}; {station}; values in {unit}",
        peak_warnings(values * factor * 100.0, float(peak), 1e-6) if peak else (),
    )
