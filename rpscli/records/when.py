"""Times that headers state, as seconds: of earthquakes, and of first samples."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta

from rpscli.records.words import folded

_MONTHS = {
    stem: number
    for number, stems in enumerate(
        (
            "jan oca ene gen янв ιαν", "feb fev sub фев φεβ", "mar мар μαρ",
            "apr avr nis abr апр απρ", "may mai maj mag мая май μαι",
            "jun juin haz giu июн ιουν", "jul juil tem lug июл ιουλ",
            "aug aou agu ago авг αυγ", "sep eyl set сен σεπ", "oct okt eki ott окт οκτ",
            "nov kas ноя νοε", "dec dez ara dic дек δεκ",
        ),
        1,
    )
    for stem in stems.split()
}  # fmt: skip
"""Beginnings of the names of months, of several languages."""
_ZONES = {
    "utc": 0.0, "gmt": 0.0, "ut": 0.0, "z": 0.0, "jst": 9.0, "cst8": 8.0, "pst": -8.0,
    "pdt": -7.0, "mst": -7.0, "mdt": -6.0, "est": -5.0, "edt": -4.0, "nzst": 12.0,
    "nzdt": 13.0, "cet": 1.0, "cest": 2.0, "eet": 2.0, "eest": 3.0, "msk": 3.0, "trt": 3.0,
    "irst": 3.5, "irdt": 4.5, "npt": 5.75, "wib": 7.0, "kst": 9.0, "clt": -4.0,
    "clst": -3.0, "art": -3.0,
}  # fmt: skip
"""Hours ahead of UTC."""

_REVERSED = re.compile(r"\b(\d{1,2})-(\d{1,2})-((?:19|20)\d\d)\b")
_ISO = re.compile(r"\b(\d{4})[-/.\s]\s?(\d{1,2})[-/.\s]\s?(\d{1,2})(?!\d)")
_SOLID = re.compile(r"\b((?:19|20)\d\d)(\d\d)(\d\d)(?=\D|$)")
_AMERICAN = re.compile(r"\b(\d{1,2})/(\d{1,2})/(\d{4}|\d{2})\b")
_DOTTED = re.compile(r"\b(\d{1,2})\.(\d{1,2})\.(\d{4})\b")
_NAMED = re.compile(r"\b([^\W\d_]{3,11})\.?\s+(\d{1,2}),?\s+(\d{4})\b", re.IGNORECASE)
_EUROPEAN = re.compile(
    r"\b(\d{1,2})\.?[\s-]+(?:de\s+)?([^\W\d_]{3,11})\.?,?[\s-]+(?:de\s+)?(\d{4})\b",
    re.IGNORECASE,
)
_GREEN = re.compile(r"\b(\d{4})\s+([^\W\d_]{3,11})\s+(\d{1,2})\b", re.IGNORECASE)
_ORDINAL = re.compile(r"\b((?:19|20)\d\d)[./-](\d{3})(?!\d)")
_CLOCK = re.compile(
    r"(?:\b|T)(\d{1,2})(?:[:時]|h\s?)(\d{2})(?:(?:[:分]|m(?:in)?\s?)(\d{2}(?:[.,]\d+)?))?"
    r"|(?<![\d.])(\d{2})\.(\d{2})\.(\d{2})(?![\d.])"
)
_SOLID_CLOCK = re.compile(r"(?:^|[\s_T])(\d{2})(\d{2})(\d{2}(?:\.\d+)?)?(?=\D|$)")
_ZONE = re.compile(
    r"(?:\b(?:GMT|UTC)\s*|(?<=\d)\s?)([+-]\d{1,2}):?(\d{2})?\b|\b([A-Z]{1,4})\b"
)
_EPOCH = re.compile(r"\s*(\d{9,10}(?:\.\d+)?)\s*")
_LOCAL = re.compile(r"\blocal|\byerel|\blokal|местн", re.IGNORECASE)


def seconds_of(text: str) -> float | None:
    """Seconds since 1970 of a date with hour and minute; None where they are not told.

    Years of two digits are those of the last century from 30 on. Without a zone the time
    is taken as UTC; of a zone that is not known nothing is told.

    >>> seconds_of("05/02/03, 23:42:38.5 UTC") == seconds_of("2003-05-02 23:42:38.5")
    True
    >>> seconds_of("2011-02-03T13:05:06+09:00") == seconds_of("2011.034 04h05m06s")
    True
    """
    if match := _EPOCH.fullmatch(text):
        return float(match[1])
    dated = _date(text)
    if dated is None:
        return None
    (year, month, day), rest = dated
    clock = _CLOCK.search(rest) or _SOLID_CLOCK.search(rest)
    if clock is None:
        return None
    parts = [part.replace(",", ".") for part in clock.groups() if part]
    hour, minute, second = (*map(float, parts), 0.0)[:3]
    if half := re.match(r"\s*([ap])\.?m\b", rest[clock.end() :], re.IGNORECASE):
        hour = hour % 12.0 + (12.0 if half[1].lower() == "p" else 0.0)
    ahead = _hours_ahead(rest[clock.end() :], rest)
    if ahead is None:
        return None
    try:
        whole = datetime(year, month, day, tzinfo=UTC).timestamp()
    except ValueError:
        return None
    return whole + 3600.0 * (hour - ahead) + 60.0 * minute + second


def _date(text: str) -> tuple[tuple[int, int, int], str] | None:
    """Year, month and day, and the text without them."""
    text = re.sub(r"(\d{4})年\s?(\d{1,2})月\s?(\d{1,2})日", r"\1-\2-\3 ", text)
    if match := _ORDINAL.search(text):
        year = int(match[1])
        number = int(match[2])
        rest = f"{text[: match.start()]} {text[match.end() :].lstrip('-')}"
        if 0 < number <= 366:
            at = datetime(year, 1, 1, tzinfo=UTC) + timedelta(days=number - 1)
            return (at.year, at.month, at.day), rest
    for pattern, order in (
        (_ISO, "ymd"), (_AMERICAN, "mdy"), (_DOTTED, "dmy"), (_REVERSED, "dmy"),
        (_NAMED, "mdy"), (_EUROPEAN, "dmy"), (_GREEN, "ymd"), (_SOLID, "ymd"),
    ):  # fmt: skip
        if match := pattern.search(folded(text)):
            parts = dict(zip(order, match.groups(), strict=True))
            named = parts["m"].isalpha()
            month = _month(parts["m"]) if named else int(parts["m"])
            day = int(parts["d"])
            if not 0 < month <= 12 and not (pattern is _AMERICAN and day <= 12):
                continue
            if pattern is _AMERICAN and month > 12 >= day:  # as they write in Europe
                month, day = day, month
            year = int(parts["y"])
            if len(parts["y"]) == 2:
                year += 2000 if year < 30 else 1900
            rest = f"{text[: match.start()]} {text[match.end() :]}"
            return (year, month, day), rest
    return None


def _month(name: str) -> int:
    """The number of a month by its name; 0 of another word."""
    return _MONTHS.get(name[:4]) or _MONTHS.get(name[:3]) or 0


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


def either_seconds(text: str) -> list[float]:
    """`seconds_of` a text, and of it with day and month exchanged where both may be.

    >>> len(either_seconds("03/02/2011 04:05:06")), len(either_seconds("2011-02-03 04:05"))
    (2, 1)
    """
    match = _SLASHED.search(text)
    texts = [text]
    if match and int(match[1]) <= 12 and int(match[2]) <= 12 and match[1] != match[2]:
        changed = f"{match[2]}/{match[1]}/{match[3]}"
        texts.append(f"{text[: match.start()]}{changed}{text[match.end() :]}")
    return [found for each in texts if (found := seconds_of(each)) is not None]


def has_clock(text: str) -> bool:
    """True of a text with a clock time and no date.

    >>> has_clock("04:05:06"), has_clock("2011-02-03 04:05:06"), has_clock("0.005")
    (True, False, False)
    """
    return _CLOCK.search(text) is not None and _date(text) is None


def _hours_ahead(behind: str, text: str) -> float | None:
    """Hours ahead of UTC of a zone behind a clock time, or in a text; None of one that is
    not known.
    """
    for offset, minutes, name in _ZONE.findall(f"0{behind}"):
        if offset:
            part = float(minutes or 0.0) / 60.0
            return float(offset) + (-part if offset.startswith("-") else part)
        if name.lower() in _ZONES:
            return _ZONES[name.lower()]
        if len(name) > 2 and name not in ("AM", "PM"):
            return None
    known = (name for _, _, name in _ZONE.findall(text) if name.lower() in _ZONES)
    if name := next(known, ""):
        return _ZONES[name.lower()]
    return None if _LOCAL.search(text) else 0.0
