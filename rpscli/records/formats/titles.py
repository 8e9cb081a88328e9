"""Titles of columns: what a column holds, by its name and its unit.

A column is time or acceleration only where its title is understood so; what is not
understood is never taken for the one or the other.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from rpscli.records.directions import direction_of
from rpscli.records.quantities import UNIT_PATTERN, canonical_unit
from rpscli.records.words import folded, words_of

TIME, ACCELERATION, COUNT, UNKNOWN = "time", "acceleration", "count", ""
"""Kinds of column; others are called by their quantity, as `velocity`."""

_OTHER_UNITS = {
    "velocity": r"[cmk]?m\s*/\s*s(?:ec)?|in\s*/\s*s(?:ec)?|ft\s*/\s*s(?:ec)?|kine|kph"
    "|mph",
    "displacement": r"[cmk]?m|in|inch|ft|km",
    "force": r"[kM]?N|kips?|lbs?|tonf?",
    "counts": r"counts?|cts?|digits?|v|mv|volts?",
    "an angle": r"deg|rad|°",
    "a frequency": r"hz|1/s|rad/s",
}
_TIME_UNITS = (
    r"s|secs?|seconds?|seg|segundos?|sn|saniye|с|сек|秒|sek\w*|secondes?|secondi"
    r"|ms|msec|msecs|milliseconds?|мс|[uµμ]s(?:ec)?|microsec\w*"
)
_SPELT = {
    "cm_s2": "cm/s2", "m_s2": "m/s2", "mps2": "m/s2", "cmps2": "cm/s2", "m_s_2": "m/s2",
    "cm_s_2": "cm/s2", "ms-2": "m/s2",
    "cms2": "cm/s2", "ms2": "m/s2", "m s-2": "m/s2", "cm s-2": "cm/s2",
}  # fmt: skip
"""Units as names of columns spell them."""
_ANY = "|".join(
    [UNIT_PATTERN, *map(re.escape, _SPELT), *_OTHER_UNITS.values(), _TIME_UNITS]
)
ANY_UNIT = re.compile(rf"(?:{_ANY}|-)", re.IGNORECASE)
"""A unit, or none, in a row of units."""

_BRACKETED = re.compile(r"([^\[(]*?)[\s_]*[\[(]([^\])]*)[\])]")
_BEHIND = re.compile(rf"(.+?)(?:\s+in\s+|[\s_]+|,\s*)({_ANY})", re.IGNORECASE)
_TIME = re.compile(
    r"(?:elapsed[\s_]*)?time(?:[\s_]*(?:from|since)[\s_]*\w+)?|t|seconds?|secs?"
    r"|zeit|datetime|temps|tiempo|tempo|zaman|sure|время|χρονοσ|jikan|shijian|时间|時間|時刻"
    r"|czas|cas"
    r"|tijd|tid|waktu|vrijeme|ido|aika|thoigian|oras|زمان|זמן|시간|saniye"
)
_GROUND = re.compile(r"a_?g", re.IGNORECASE)
_ACCELERATION = re.compile(
    r"acc|acn|accn|accels?|acceleration?s?|accelerogram\w*|accelerat\w*|aceler\w*"
    r"|acceleraz\w*"
    r"|akseler\w*|beschl\w*|ivme\w*|ускор\w*|加速度|kasokudo|jiasudu|επιταχ\w*|przysp\w*"
    r"|versnell\w*|zrychl\w*|ubrz\w*|gyorsul\w*|acelerac\w*|acc(?:ns|ew|ud)|a|ag|u|g|가속도"
    r"|aa?cc[xyz]|a[xyz]|ug|[xu]?g?ddot"
)
_BESIDE = re.compile(
    r"ground|corr\w*|filt\w*|proc\w*|record\w*|horiz\w*|comp\w*|ch|channel|data|values?"
    r"|series|history|input|base|raw|uncorr\w*|signal|in|of|the|de|del|la|du|sol|suelo"
    r"|suolo"
    r"|boden|zemin|yer|terreno|th|deg|dir|direction|az|grunt\w*|грунта"
)
_DATA = frozenset(("data", "value", "values", "series", "signal", "record"))
_SPECTRAL = re.compile(
    r"\bperiods?\b|freq|spectr|spektr|espectr|спектр|\bfft\b|fourier|谱|スペクトル|(?:^|\b"
    r"|_)(?:p?s_?[adve]|psa|psv|t_?n|rsa|se|sae)(?:$|\b|_)",
    re.IGNORECASE,
)
MATCHED = re.compile(
    r"compat|match|target|uyumlu|angepasst|natural|filter|corner|removed|correct"
)
"""Words that make a spectrum that of which a motion was made."""
_OTHERS = {
    "velocity": r"\bvel\w*|\bv\b",
    "displacement": r"\bdispl?\w*|\bdisp\b",
    "a rotation": r"\brotat|\btilt",
    "Arias intensity": r"arias|\bia\b",
    "a force": r"\bforce\b|\bshear\b",
    "a drift": r"\bdrift",
    "a distance": r"\bdist\w*|\bdepth\b",
}
_CHANGED = re.compile(
    r"[²³|]|\d\s*[x*×]|[*×]\s*\d|\^\s*[23]|\blog|\babs|\bsq(?:r|uared?)?\b", re.IGNORECASE
)
"""Marks of what is computed from values."""
_COUNT = re.compile(
    r"(?:sample|index|indice|indeks|idx|no\.?|nr\.?|n|i|num(?:ber)?|#|row|point|sira"
    r"|nummer)s?",
    re.IGNORECASE,
)
REMARK = re.compile(r"\w*(?:corr|filt|proc|ground|raw)\w*", re.IGNORECASE)
"""Words in brackets behind a name that are no unit."""


CLOCK = re.compile(
    r"\s*[(\[]\s*(?:h+:m+(?::s+[.,\w]*)?|jst|utc|gmt|local|lt)\s*[)\]]", re.IGNORECASE
)
"""What stands behind the title of a column of clock times, in brackets."""

ACROSS = "trans"
"""In place of a unit: T beside L and V is the transverse direction, not a period."""


class ColumnTitle(NamedTuple):
    """The title of a column: its name, its unit, empty without one, and its line."""

    name: str
    unit: str
    line: int

    @property
    def kind(self) -> str:  # noqa: PLR0911 -- a rule a line
        """Kind of what the column holds, `UNKNOWN` where its title is not understood."""
        if _SPECTRAL.search(self.name) and not MATCHED.search(folded(self.name)):
            return "a spectrum"
        if _CHANGED.search(self.name):
            return UNKNOWN
        timed = re.fullmatch(_TIME_UNITS, self.unit, re.IGNORECASE) is not None
        accelerates = canonical_unit(self.unit or "-") is not None
        if self.name != "T" and _TIME.fullmatch(folded(self.name)):
            return TIME
        if accelerates:
            known = ACCELERATION if self._accelerates or not self.name else UNKNOWN
            named = direction_of(self.name) is not None
            return known if named else self._other_by_name or known
        if self.name == "T" or timed:  # a period, or what changes over time
            return ACCELERATION if self.unit == ACROSS else UNKNOWN
        if self._accelerates and any(map(_ACCELERATION.fullmatch, words_of(self.name))):
            return ACCELERATION  # a unit that is none of acceleration is refused by name
        if direction_of(self.name) is not None and (not self.unit or self.remarks):
            return ACCELERATION
        return self._other_by_name or self._other_by_unit or self._count

    @property
    def remarks(self) -> bool:
        """True if what stands in brackets is a direction or a remark, no unit."""
        if self.unit in ("V", "v"):  # volts
            return False
        return bool(REMARK.fullmatch(self.unit)) or direction_of(self.unit) is not None

    @property
    def _accelerates(self) -> bool:
        """True if all words of the name are those of a ground acceleration."""
        if direction_of(self.name) is not None:
            return self._is_of_acceleration
        words = re.findall(r"[^\W\d_]+", folded(self.name).replace("u''", "u"))
        named = [word for word in words if _ACCELERATION.fullmatch(word)]
        ways = [word for word in words if direction_of(word) is not None]
        known = (
            word in named or word in ways or _BESIDE.fullmatch(word) for word in words
        )
        plain = re.fullmatch(r"[\w\s.,'\"°:-]*", self.name)
        return bool(plain and all(known) and (named or ways or {*words} & _DATA))

    @property
    def _is_of_acceleration(self) -> bool:
        """True of a direction with a unit of acceleration behind it, or of `a`."""
        return canonical_unit(self.unit or "-") is not None or self.name.lower() == "a"

    @property
    def _other_by_name(self) -> str:
        words = (q for q, w in _OTHERS.items() if re.search(w, self.name, re.IGNORECASE))
        return next(words, UNKNOWN)

    @property
    def _other_by_unit(self) -> str:
        of = (
            quantity
            for quantity, units in _OTHER_UNITS.items()
            if re.fullmatch(units, self.unit, re.IGNORECASE)
        )
        return next(of, UNKNOWN)

    @property
    def _count(self) -> str:
        counts = not self.unit and (not self.name or _COUNT.fullmatch(self.name))
        return COUNT if counts else UNKNOWN


def title_of(cell: str, line: int) -> ColumnTitle:
    """A title from its cell: a unit in brackets, behind `in`, a blank or `_`."""
    text = cell.strip()
    text = re.sub(r"\s*[(\[][+-][)\]]", "", text)  # N(+): the positive direction
    text = CLOCK.sub("", text)
    if match := _BRACKETED.fullmatch(text):
        return ColumnTitle(match[1].strip(), _unit(match[2]), line)
    if not _GROUND.fullmatch(text) and (match := _BEHIND.fullmatch(text)):
        return ColumnTitle(match[1].strip(" _"), _unit(match[2]), line)
    return ColumnTitle(text, "", line)


def beside_each_other(titles: list[ColumnTitle]) -> list[ColumnTitle]:
    """Titles of one line: T is transverse where L or V stands beside it, and no time."""
    names = {title.name for title in titles}
    if not {"L", "V"} & names or any(title.kind == TIME for title in titles):
        return titles
    return [
        title._replace(unit=title.unit or ACROSS) if title.name == "T" else title
        for title in titles
    ]


def _unit(text: str) -> str:
    unit = text.strip()
    return _SPELT.get(unit.lower(), unit)
