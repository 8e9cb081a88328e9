"""Numbers, units and options of sources as record files and users spell them.

Fortran and its heirs print numbers ragged, glued together, with D exponents.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rpscli import errors
from rpscli.errors import RecordError
from rpscli.units import si_factor

# Digits are matched in one way only: otherwise a long word of them is tried at every division.
_UNSIGNED = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[EeDd][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"[+-]?{_UNSIGNED}")
# Fixed columns leave no blank before a minus sign; digits glued without one stay unreadable.
_GLUED = re.compile(rf"[+-]?{_UNSIGNED}(?:[+-]{_UNSIGNED})*")
# `float` alone would also take nan, inf, 1_000 and the digits of other scripts.
_NUMERIC_LINE = re.compile(r"[-+.0-9EeDd,\s]*")

NUMBER_PATTERN = rf"[+-]?{_UNSIGNED}"  # a regular expression for one number
_FACTORS = {
    name: si_factor(name, "m/s2")
    for name in ("g", "m/s2", "cm/s2", "mm/s2", "gal", "in/s2", "ft/s2")
}

KNOWN_UNITS = ", ".join(_FACTORS)  # the canonical names, for messages
UNIT_PATTERN = (
    r"(?:[cm]?m|in|ft)\s*/\s*s(?:ec)?\s*(?:/\s*s(?:ec)?|\^\s*2|\*\*\s*2|2|²)(?![A-Za-z0-9])"
    r"|gals?(?![A-Za-z0-9])|gravity\b|g's(?![A-Za-z0-9])"
    r"|g(?![A-Za-z0-9/])"
)
"""A regular expression (ignoring case) for the spellings of `canonical_unit` in running text."""


def to_float(numeral: str) -> float:
    """The value of one numeral, exponents written with D included."""
    return float(numeral.replace("D", "E").replace("d", "e"))


def numbers_in(line: str) -> list[float] | None:
    """The finite numbers of a line that holds nothing else, or None."""
    # Commas separate if each field holds one number: decimal commas are not read as separators.
    if not _NUMERIC_LINE.fullmatch(line):
        return None
    fields = line.split()
    if "," in line:
        fields = [field.strip() for field in line.strip().removesuffix(",").split(",")]
    try:
        row = [float(field) for field in fields]
    except ValueError:
        if not all(_GLUED.fullmatch(field) for field in fields):
            return None
        row = [to_float(numeral) for field in fields for numeral in _NUMBER.findall(field)]
    return row if all(map(math.isfinite, row)) else None


def why_no_numbers(line: str) -> str:
    """The punctuation that keeps a line from being read as numbers, in words; else nothing."""
    if re.fullmatch(r"[-+.,0-9EeDd;\s]*[0-9][-+.,0-9EeDd;\s]*", line):
        if re.search("[0-9],[0-9]", line) and ";" in line:
            return " (decimal commas and semicolons: write points, and commas or blanks between)"
        if re.search("[0-9],[0-9]", line):
            return " (decimal commas: write points)"
        if ";" in line:
            return " (semicolons: separate by commas or blanks)"
    return ""


def numerals_in(line: str) -> list[str]:
    """The numbers of a line of numbers, as they are printed."""
    return _NUMBER.findall(line)


def last_digit(numeral: str) -> float:
    """The unit of the last digit that is printed."""
    mantissa, _, exponent = re.sub("[dD]", "E", numeral.upper()).partition("E")
    decimals = len(mantissa.partition(".")[2])
    # Beyond these the unit is zero or infinite anyway, however many digits the exponent has.
    power = float(exponent or 0.0) - decimals
    return math.pow(10.0, max(min(power, 308.0), -400.0))


def canonical_unit(text: str) -> str | None:
    """One of the known names for a unit of acceleration, or None if it is not one."""
    unit = re.sub(r"[\s()\[\]]", "", text.lower())
    unit = unit.replace("sec", "s").replace("²", "2").replace("**", "^").replace("^", "")
    unit = re.sub(r"/s/s$", "/s2", unit)
    unit = {"gals": "gal", "gravity": "g", "g's": "g"}.get(unit, unit)
    return unit if unit in _FACTORS else None


def unit_factor(unit: str) -> float:
    """The size of a canonical unit in m/s2."""
    return _FACTORS[unit]


_QUANTITY = re.compile(rf"\s*({NUMBER_PATTERN})\s*(.*?)\s*")
_UNITS = {
    "time": {"": 1.0, "s": 1.0, "sec": 1.0, "ms": 1e-3},
    "frequency": {"": 1.0, "hz": 1.0},
    "velocity": {"": 1.0, "m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "angle": {"": 1.0, "rad": 1.0, "deg": math.pi / 180.0},
    "direction": {"": 1.0, "deg": 1.0, "rad": 180.0 / math.pi},
    "ratio": {"": 1.0, "%": 0.01},
    "acceleration": {"": 1.0, **_FACTORS},
}


EXAMPLES = {
    "tl": "8 s",
    "sds": "1 g",
    "sd1": "0.6 g",
    "ag": "0.2 g",
    "amplitude": "0.3g",
    "period": "0.8",
}
"""Examples of options."""

LIKENESS = 0.5  # of a name to the one that was meant: names of records are long, and made of parts
SOME = 12  # known words that are listed where there are more than twice as many


def hint(word: str, known: Sequence[str]) -> str:
    """The nearest known word that might have been meant, or else all of them, or some of many."""
    rest = f" and {len(known) - SOME} more" if len(known) > 2 * SOME else ""
    some = ", ".join(known[:SOME] if rest else known)
    return errors.hint(word, known, f"known: {some}{rest}", LIKENESS)


@dataclass(frozen=True)
class Query:
    """The options of one source, as text; each accessor turns one into a number in SI."""

    source: str
    values: Mapping[str, str]

    def quantity(
        self, key: str, kind: str, default: float | None = None, *, bare: bool = True
    ) -> float:
        """A number with a unit, which may be left out where it may be `bare`, in SI."""
        value = self.values.get(key)
        if value is None:
            if default is not None:
                return default
            raise RecordError(
                f"{self.source}: {key} is missing; add {key}={EXAMPLES.get(key, '...')}"
            )
        match = _QUANTITY.fullmatch(value)
        number, unit = match.groups() if match else ("nan", "")
        known = canonical_unit(unit) or unit if kind == "acceleration" else unit.lower()
        factor = _UNITS[kind].get(known)
        if not re.fullmatch(NUMBER_PATTERN, number) or not math.isfinite(to_float(number)):
            fault = f"{key} = {value[:40]!r} is not a number; write {key}=0.5"
        elif not (unit or bare):
            fault = f"say the unit: {key}={number} g, or {key}={number} m/s2"
        elif factor is None:
            units = ", ".join(filter(None, _UNITS[kind]))
            fault = f"{key} = {value!r} is no {kind} in {units}"
        else:
            return to_float(number) * factor
        raise RecordError(f"{self.source}: {fault}")

    def acceleration(self, key: str, *, bare: bool = True) -> float:
        """An acceleration [m/s2]: `0.4g`, `3.9 m/s2`, or a number in m/s2 where it may be bare."""
        return self.quantity(key, "acceleration", bare=bare)

    def choice(self, key: str, usual: str, known: Sequence[str]) -> str:
        """One of the known words, whatever their case."""
        value = self.values.get(key, usual)
        found = next((word for word in (usual, *known) if word.lower() == value.lower()), None)
        if found is None:
            raise RecordError(
                f"{self.source}: {key} = {value!r} is not known; {hint(value, known)}"
            )
        return found

    def integer(self, key: str) -> int:
        """A whole number that is not negative."""
        value = self.values.get(key)
        if value is None or not re.fullmatch("[0-9]{1,18}", value):
            found = "is missing" if value is None else f"= {value[:40]!r} is not one"
            raise RecordError(f"{self.source}: {key} {found}; give a whole number, {key}=1")
        return int(value)


def options_in(text: str, source: str) -> dict[str, str | None]:
    """Values of `key=value&flag` by names; a value is None without `=`, and none comes twice."""
    found: dict[str, str | None] = {}
    for item in filter(None, map(str.strip, text.split("&"))):
        name, mark, value = map(str.strip, item.partition("="))
        if name in found:
            raise RecordError(f"{source}: {name} is given twice; keep one")
        found[name] = value if mark else None
    return found


def query_of(
    options: Mapping[str, str | None],
    source: str,
    allowed: Sequence[str],
    flags: Sequence[str] = (),
) -> Query:
    """Options that are all allowed, and have values but for flags."""
    for key, value in options.items():
        if key not in allowed:
            raise RecordError(f"{source}: option {key!r} is not known; {hint(key, allowed)}")
        if not value and key not in flags:
            raise RecordError(f"{source}: {key} has no value; write {key}=...")
    return Query(source, {key: value or "" for key, value in options.items()})


def parse_query(text: str, source: str, allowed: Sequence[str]) -> Query:
    """Split `key=value&key=value`."""
    return query_of(options_in(text, source), source, allowed)
