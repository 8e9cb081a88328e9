"""Sources: the text that a user writes for a ground motion, parsed
once, written back alike.

A source is `place?options` or `scheme:place?options`. Options of
every kind, in any order, are

* `factor=1.5`, on the values;
* of pairs `angle=30`, one direction between the components, or `both`, both components
  together, which `rotation=30` turns;
* of files `second=FILE`, the other component, seen from the folder of the first one; of
  files with several channels `channel=1,3` are both components.

All others are those of what reads or makes the motion, as `dt`, `units`
and `channel` of a file.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath
from typing import Self

from rpscli import errors
from rpscli.errors import RecordError
from rpscli.records.quantities import (
    ACCELERATIONS,
    NUMBER_PATTERN,
    canonical_unit,
    to_float,
)

FILE = ""
LIST = "list"
SET = "fema_p695"
SCHEMES = (SET, "pulse", "synthetic", LIST)

PAIRING = ("both", "angle", "rotation")
COMMON = ("second", *PAIRING, "factor")
FLAGS = ("both", "normalised")
SPELLINGS = {"normalized": "normalised"}

# Two letters at least: C: is a drive.
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9_.+-]+):(.*)", re.DOTALL)
# A question mark may also stand in a glob or a file name: options are key=value, or
# `both`.
_OPTION = r"(?:[A-Za-z_]\w*=[^&?]*|both)"
_FILE_OPTIONS = re.compile(rf"(.+?)\?({_OPTION}(?:&{_OPTION})*)", re.DOTALL)

Values = Mapping[str, str | None]

_QUANTITY = re.compile(rf"\s*({NUMBER_PATTERN})\s*(.*?)\s*")
_UNITS = {
    "time": {"": 1.0, "s": 1.0, "sec": 1.0, "ms": 1e-3},
    "frequency": {"": 1.0, "hz": 1.0},
    "velocity": {"": 1.0, "m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "angle": {"": 1.0, "rad": 1.0, "deg": math.pi / 180.0},
    "direction": {"": 1.0, "deg": 1.0, "rad": 180.0 / math.pi},
    "ratio": {"": 1.0, "%": 0.01},
    "acceleration": {"": 1.0, **ACCELERATIONS},
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

# of a name to the one that was meant: names of records are long, and made of parts
LIKENESS = 0.5
SOME = 12  # known words that are listed where there are more than twice as many


def hint(word: str, known: Sequence[str]) -> str:
    """The nearest known word that might have been meant, or else all
    of them, or some of many.
    """
    rest = f" and {len(known) - SOME} more" if len(known) > 2 * SOME else ""
    some = ", ".join(known[:SOME] if rest else known)
    return errors.hint(word, known, f"known: {some}{rest}", LIKENESS)


class Query(str):  # noqa: SLOT000 -- values are kept beside the text
    """A text with options: their values by name, None without `=`.

    Each accessor turns one into a number in SI.
    """

    values: Values

    def quantity(
        self, key: str, kind: str, default: float | None = None, *, bare: bool = True
    ) -> float:
        """A number with a unit, which may be left out where it may be `bare`, in SI."""
        value = self.values.get(key)
        if value is None:
            if default is not None:
                return default
            raise RecordError(
                f"{self}: {key} is missing; add {key}={EXAMPLES.get(key, '...')}"
            )
        match = _QUANTITY.fullmatch(value)
        number, unit = match.groups() if match else ("nan", "")
        known = canonical_unit(unit) or unit if kind == "acceleration" else unit.lower()
        factor = _UNITS[kind].get(known)
        if not re.fullmatch(NUMBER_PATTERN, number) or not math.isfinite(
            to_float(number)
        ):
            fault = f"{key} = {value[:40]!r} is not a number; write {key}=0.5"
        elif not (unit or bare):
            fault = f"say the unit: {key}={number} g, or {key}={number} m/s2"
        elif factor is None:
            units = ", ".join(filter(None, _UNITS[kind]))
            fault = f"{key} = {value!r} is no {kind} in {units}"
        else:
            return to_float(number) * factor
        raise RecordError(f"{self}: {fault}")

    def acceleration(self, key: str, *, bare: bool = True) -> float:
        """An acceleration [m/s2]: `0.4g`, `3.9 m/s2`, or a number in
        m/s2 where it may be bare.
        """
        return self.quantity(key, "acceleration", bare=bare)

    def choice(self, key: str, usual: str, known: Sequence[str]) -> str:
        """One of the known words, whatever their case."""
        value = self.values.get(key) or usual
        found = next(
            (word for word in (usual, *known) if word.lower() == value.lower()), None
        )
        if found is None:
            raise RecordError(
                f"{self}: {key} = {value!r} is not known; {hint(value, known)}"
            )
        return found

    def integer(self, key: str) -> int:
        """A whole number that is not negative."""
        value = self.values.get(key)
        if value is None or not re.fullmatch("[0-9]{1,18}", value):
            found = "is missing" if value is None else f"= {value[:40]!r} is not one"
            raise RecordError(f"{self}: {key} {found}; give a whole number, {key}=1")
        return int(value)

    def require(
        self,
        allowed: Sequence[str],
        flags: Sequence[str] = (),
        values: Values | None = None,
    ) -> Self:
        """Refuse options, or some of them, that are not allowed, or have no value."""
        for key, value in (self.values if values is None else values).items():
            if key not in allowed:
                raise RecordError(
                    f"{self}: option {key!r} is not known; {hint(key, allowed)}"
                )
            if not value and key not in flags:
                raise RecordError(f"{self}: {key} has no value; write {key}=...")
        return self


def parse_query(text: str, source: str, allowed: Sequence[str]) -> Query:
    """The options `key=value&key=value` of a source."""
    query = Query(source)
    query.values = options_in(text, source)
    return query.require(allowed)


def options_in(text: str, source: str) -> dict[str, str | None]:
    """Values of `key=value&flag` by names; a value is None without
    `=`, and none comes twice.
    """
    found: dict[str, str | None] = {}
    for item in filter(None, map(str.strip, text.split("&"))):
        name, mark, value = map(str.strip, item.partition("="))
        if name in found:
            raise RecordError(f"{source}: {name} is given twice; keep one")
        found[name] = value if mark else None
    return found


def _parts(text: str, folder: Path | None) -> tuple[str, str, str]:
    """Scheme, place and options of a source, as they are written."""
    match = _SCHEME.fullmatch(text)
    place, options = split_options(text)
    if is_file(text, folder):
        return FILE, text, ""
    if match is None or is_file(place, folder):
        return FILE, place, options
    scheme, rest = match.groups()
    if scheme not in SCHEMES:
        raise RecordError(
            f"{text}: {scheme!r} is not a kind of record source; {hint(scheme, SCHEMES)}"
        )
    if scheme == LIST:
        return scheme, *split_options(rest)
    place, _, options = rest.partition("?")
    return scheme, place, options


class Source(Query):
    """A source taken apart; its text reads the same.

    The `scheme` is empty for files, folders and globs of them, the `place`
    for synthetic motions. `values` are those of the options by name, of
    `COMMON` last; None without `=`.
    """

    scheme: str
    place: str

    def __new__(cls, scheme: str, place: str, values: Values) -> Self:
        """The parts, and the text that they are written as."""
        own = {name: value for name, value in values.items() if name not in COMMON}
        ordered = own | {name: values[name] for name in COMMON if name in values}
        words = "&".join(
            name if text is None else f"{name}={text}" for name, text in ordered.items()
        )
        head = f"{scheme}:{place}" if scheme else place
        made = super().__new__(cls, f"{head}?{words}" if words else head)
        made.scheme = scheme
        made.place = place
        made.values = ordered
        return made

    def __getnewargs__(self) -> tuple[str, str, Values]:  # type: ignore[override]
        """The parts of which a copy in another process is made."""
        return self.scheme, self.place, self.values

    @classmethod
    def parse(cls, text: str, folder: Path | None = None) -> Source:
        """The source of a text; relative files are looked for from a
        folder, or the working one.

        Raises a RecordError for an unknown scheme, an option twice, and
        those that exclude others.
        """
        if isinstance(text, Source):
            return text
        scheme, place, options = _parts(text, folder)
        each = options_in(options, text).items()
        source = cls(
            scheme, place, {SPELLINGS.get(name, name): value for name, value in each}
        )
        given = source.values
        fault = ""
        if valued := [name for name in FLAGS if given.get(name) is not None]:
            fault = f"{valued[0]} takes no value; write {valued[0]} alone"
        if "rotation" in given and not source.both:
            fault = "rotation turns both components together; write both&rotation"
        if source.both and "angle" in given:
            fault = (
                "angle= is one direction between the components, in which a plane"
                " structure is shaken; both has them act together, in two directions:"
                " keep one of the options, or turn the pair by rotation= in place of"
                " angle="
            )
        if fault:
            raise RecordError(f"{source}: {fault}")
        source.require(
            COMMON, FLAGS, {name: given[name] for name in COMMON if name in given}
        )
        _ = source.rotation, source.angle, source.factor  # which refuse what is no number
        return source

    @property
    def both(self) -> bool:
        """True if both components act together."""
        return "both" in self.values

    @property
    def rotation(self) -> float:
        """Of both from x towards y [deg]."""
        return self.quantity("rotation", "direction", 0.0)

    @property
    def angle(self) -> float | None:
        """Of one direction, from the first component towards the second [deg]."""
        return (
            self.quantity("angle", "direction", 0.0) if "angle" in self.values else None
        )

    @property
    def factor(self) -> float:
        """On the values."""
        return self.quantity("factor", "ratio", 1.0)

    @property
    def of_pair(self) -> bool:
        """True if two components are wanted: together, or one direction between them."""
        return self.both or "angle" in self.values

    @property
    def second(self) -> str | None:
        """The file of the second component, as seen from where the first one is seen."""
        second = self.values.get("second")
        return None if second is None else str(PurePath(self.place).parent / second)

    def query(self, *allowed: str) -> Self:
        """Refuse other options than the allowed ones of what reads or makes it."""
        return self.require((*allowed, *COMMON), FLAGS)

    def without(self, *names: str) -> Source:
        """The source without some options."""
        kept = {name: value for name, value in self.values.items() if name not in names}
        return Source(self.scheme, self.place, kept)

    def plus(self, **options: str | None) -> Source:
        """The source with further options, in place of those of the same names."""
        kept = self.without(*options).values
        return Source(self.scheme, self.place, {**kept, **options})

    def at(self, place: str) -> Source:
        """The source at another place."""
        return Source(self.scheme, place, self.values)

    @property
    def alone(self) -> Source:
        """The first component, or the pair itself, without what makes a motion of two."""
        return self.without("second", *PAIRING)

    @property
    def components(self) -> tuple[Source, Source] | None:
        """Both components that it names itself."""
        if self.scheme == SET:
            pair = re.sub("/[ab]$", "", self.place)
            return self.alone.at(f"{pair}/a"), self.alone.at(f"{pair}/b")
        if self.second is not None:
            return self.alone, self.alone.at(self.second)
        first, comma, other = (self.values.get("channel") or "").partition(",")
        return (
            (self.alone.plus(channel=first), self.alone.plus(channel=other))
            if comma
            else None
        )

    def together(self, other: Source) -> Source:
        """A source of both components: of one set, of one file, or of two."""
        if self.scheme == SET:
            return self.at(re.sub("/[ab]$", "", self.place))
        if self.place == other.place:
            return self.plus(
                channel=f"{self.values['channel']},{other.values['channel']}"
            )
        second = os.path.relpath(other.place, PurePath(self.place).parent)
        return self.plus(second=PurePath(second).as_posix())

    def turned(self, rotation: float) -> Source:
        """A source of both components, turned further [deg]."""
        if not self.both or rotation == 0.0:
            return self
        return self.plus(rotation=repr(self.rotation + rotation))

    def require_two(self) -> None:
        """Refuse what asks for two components and names one."""
        if self.of_pair and self.components is None:
            word = "both needs" if self.both else "angle turns"
            raise RecordError(
                f"{self}: {word} two components: a pair of a set,"
                " fema_p695:farfield/1?both, or second=FILE, seen from the folder of the"
                " first one"
            )


def split_options(text: str) -> tuple[str, str]:
    """The name of a file, and its options."""
    match = _FILE_OPTIONS.fullmatch(text)
    return (match[1], match[2]) if match else (text, "")


def is_file(place: str, folder: Path | None) -> bool:
    """True if there is such a file."""
    try:
        return ((folder or Path()) / Path(place).expanduser()).is_file()
    except (OSError, ValueError, RuntimeError):  # too long, a zero byte, no such user
        return False
