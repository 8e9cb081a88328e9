"""Times that headers state, as seconds: of earthquakes, and of first samples."""

from __future__ import annotations

import re
from datetime import UTC, datetime

_MONTHS = {
    name: number
    for number, name in enumerate(
        [
            "jan",
            "feb",
            "mar",
            "apr",
            "may",
            "jun",
            "jul",
            "aug",
            "sep",
            "oct",
            "nov",
            "dec",
        ],
        1,
    )
}
_ZONES = {
    "utc": 0.0, "gmt": 0.0, "ut": 0.0, "z": 0.0, "jst": 9.0, "cst8": 8.0, "pst": -8.0,
    "pdt": -7.0, "mst": -7.0, "mdt": -6.0, "est": -5.0, "edt": -4.0, "nzst": 12.0,
    "nzdt": 13.0, "cet": 1.0, "cest": 2.0,
}  # fmt: skip
"""Hours ahead of UTC."""

_ISO = re.compile(r"\b(\d{4})[-/.\s]\s?(\d{1,2})[-/.\s]\s?(\d{1,2})(?!\d)")
_SOLID = re.compile(r"\b((?:19|20)\d\d)(\d\d)(\d\d)(?=\D|$)")
_AMERICAN = re.compile(r"\b(\d{1,2})/(\d{1,2})/(\d{4}|\d{2})\b")
_DOTTED = re.compile(r"\b(\d{1,2})\.(\d{1,2})\.(\d{4})\b")
_NAMED = re.compile(r"\b([a-z]{3})[a-z]*\.?\s+(\d{1,2}),?\s+(\d{4})\b", re.IGNORECASE)
_EUROPEAN = re.compile(r"\b(\d{1,2})\s+([a-z]{3})[a-z]*\.?,?\s+(\d{4})\b", re.IGNORECASE)
_GREEN = re.compile(r"\b(\d{4})\s+([a-z]{3})[a-z]*\s+(\d{1,2})\b", re.IGNORECASE)
_CLOCK = re.compile(r"(?:\b|T)(\d{1,2}):(\d{2})(?::(\d{2}(?:\.\d+)?))?")
_SOLID_CLOCK = re.compile(r"(?:^|[\s_T])(\d{2})(\d{2})(\d{2}(?:\.\d+)?)?(?=\D|$)")
_ZONE = re.compile(r"\b(?:GMT|UTC)\s*([+-]\d{1,2})\b|\b([A-Z]{1,4})\b")


def seconds_of(text: str) -> float | None:
    """Seconds since 1970 of a date with hour and minute; None where they are not told.

    Years of two digits are those of the last century from 30 on. Without a zone the time
    is taken as UTC.

    >>> seconds_of("05/02/03, 23:42:38.5 UTC") == seconds_of("2003-05-02 23:42:38.5")
    True
    """
    dated = _date(text)
    if dated is None:
        return None
    (year, month, day), rest = dated
    clock = _CLOCK.search(rest) or _SOLID_CLOCK.search(rest)
    if clock is None:
        return None
    hour, minute, second = (float(part or 0.0) for part in clock.groups())
    try:
        whole = datetime(year, month, day, tzinfo=UTC).timestamp()
    except ValueError:
        return None
    return whole + 3600.0 * (hour - _hours_ahead(rest)) + 60.0 * minute + second


def _date(text: str) -> tuple[tuple[int, int, int], str] | None:
    """Year, month and day, and the text without them."""
    for pattern, order in (
        (_ISO, "ymd"), (_AMERICAN, "mdy"), (_DOTTED, "dmy"), (_NAMED, "mdy"), (_EUROPEAN, "dmy"),
        (_GREEN, "ymd"), (_SOLID, "ymd"),
    ):  # fmt: skip
        if match := pattern.search(text):
            parts = dict(zip(order, match.groups(), strict=True))
            month = _MONTHS.get(parts["m"].lower()) or (
                int(parts["m"]) if parts["m"].isdigit() else 0
            )
            day = int(parts["d"])
            if pattern is _AMERICAN and month > 12 >= day:  # as they write in Europe
                month, day = day, month
            year = int(parts["y"])
            if len(parts["y"]) == 2:
                year += 2000 if year < 30 else 1900
            rest = f"{text[: match.start()]} {text[match.end() :]}"
            return (year, month, day), rest
    return None


_SLASHED = re.compile(r"\b(\d{1,2})[/.](\d{1,2})[/.](\d{4}|\d{2})\b")


def days_of(text: str) -> set[tuple[int, int, int]]:
    """Year, month and day of a date, in both orders where day and month are not told.

    >>> sorted(days_of("4/6/2009")), days_of("17.08.1999"), days_of("in 1999")
    ([(2009, 4, 6), (2009, 6, 4)], {(1999, 8, 17)}, set())
    """
    dated = _date(text)
    if dated is None:
        return set()
    year, month, day = dated[0]
    found = {(year, month, day)}
    if _SLASHED.search(text) and day <= 12 and month <= 12:
        found.add((year, day, month))
    return found


def _hours_ahead(text: str) -> float:
    for offset, name in _ZONE.findall(text):
        if offset:
            return float(offset)
        if name.lower() in _ZONES:
            return _ZONES[name.lower()]
    return 0.0
