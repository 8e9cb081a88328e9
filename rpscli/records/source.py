"""What a user writes for a ground motion, as a value: parsed once, written back as it reads.

A source is `place?options` or `scheme:place?options`. Options of every kind, in any order, are

* `factor=1.5`, on the values;
* of pairs `angle=30`, one direction between the components, or `both`, both components together,
  which `rotation=30` turns;
* of files `second=FILE`, the other component, seen from the folder of the first one.

All others are those of what reads or makes the motion, as `dt`, `units` and `channel` of a file.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path, PurePath

from rpscli.errors import RecordError
from rpscli.records.quantities import Query, hint, parse_query

FILE, LIST, SET = "", "list", "fema_p695"
SCHEMES = (SET, "pulse", "synthetic", LIST)

PAIRING = ("both", "angle", "rotation")
COMMON = ("second", *PAIRING, "factor")
FLAGS = ("both", "normalised")
SPELLINGS = {"normalized": "normalised"}

# Two letters at least: C: is a drive.
_SCHEME = re.compile(r"([A-Za-z][A-Za-z0-9_.+-]+):(.*)", re.DOTALL)
# A question mark may also stand in a glob or a file name: options are key=value, or `both`.
_OPTION = r"(?:[A-Za-z_]\w*=[^&?]*|both)"
_FILE_OPTIONS = re.compile(rf"(.+?)\?({_OPTION}(?:&{_OPTION})*)", re.DOTALL)


@dataclass(frozen=True)
class Source:
    """A source taken apart.

    Parameters
    ----------
    text
        As it was written, for messages.
    scheme
        Of what is no file; empty for files, folders and globs of them.
    place
        The file, the pair or component of a set, the name of a pulse; empty for synthetic motions.
    options
        Names and values, those of `COMMON` last; a value is None without `=`.
    """

    text: str
    scheme: str
    place: str
    options: tuple[tuple[str, str | None], ...] = ()

    def __str__(self) -> str:
        """As it is written: what reads the same."""
        words = (name if value is None else f"{name}={value}" for name, value in self.options)
        head = f"{self.scheme}:{self.place}" if self.scheme else self.place
        return f"{head}?{'&'.join(words)}" if self.options else head

    @classmethod
    def parse(cls, text: str, folder: Path | None = None) -> Source:
        """The source of a text; relative files are looked for from a folder, or the working one.

        Raises
        ------
        RecordError
            For an unknown scheme, an option twice, and options that exclude each other.
        """
        match = _SCHEME.fullmatch(text)
        if match is None or is_file(split_options(text)[0], folder) or is_file(text, folder):
            place, options = (text, "") if is_file(text, folder) else split_options(text)
            found = cls(text, FILE, place, _parsed(options, text))
        elif match[1] in SCHEMES:
            place, options = match[2].partition("?")[::2]
            if match[1] == LIST:
                place, options = split_options(match[2])
            found = cls(text, match[1], place, _parsed(options, text))
        else:
            raise RecordError(
                f"{text}: {match[1]!r} is not a kind of record source; {hint(match[1], SCHEMES)}"
            )
        found._check()
        return found

    def _check(self) -> None:
        if "rotation" in self._values and not self.both:
            raise RecordError(
                f"{self.text}: rotation turns both components together; write both&rotation"
            )
        if self.both and "angle" in self._values:
            raise RecordError(
                f"{self.text}: angle= is one direction between the components, in which a plane"
                " structure is shaken; both has them act together, in two directions: keep one of"
                " the options, or turn the pair by rotation= in place of angle="
            )
        for name in COMMON:
            if name in self._values and not self._values[name] and name not in FLAGS:
                raise RecordError(f"{self.text}: {name} has no value; write {name}=...")
        _ = self.rotation, self.angle, self.factor  # which refuse what is no number

    @cached_property
    def _values(self) -> dict[str, str | None]:
        return dict(self.options)

    def _number(self, name: str, kind: str, usual: float) -> float:
        if (value := self._values.get(name)) is None and name not in self._values:
            return usual
        return parse_query(f"{name}={value or ''}", self.text, (name,)).quantity(name, kind)

    @property
    def both(self) -> bool:
        """Whether both components act together."""
        return "both" in self._values

    @property
    def rotation(self) -> float:
        """Of both from x towards y [deg]."""
        return self._number("rotation", "direction", 0.0)

    @property
    def angle(self) -> float | None:
        """Of one direction, from the first component towards the second [deg]."""
        return self._number("angle", "direction", 0.0) if "angle" in self._values else None

    @property
    def factor(self) -> float:
        """On the values."""
        return self._number("factor", "ratio", 1.0)

    @property
    def of_pair(self) -> bool:
        """Whether two components are wanted: together, or one direction between them."""
        return self.both or "angle" in self._values

    @property
    def second(self) -> str | None:
        """The file of the second component, as seen from where the first one is seen."""
        second = self._values.get("second")
        return None if second is None else str(PurePath(self.place).parent / second)

    def query(self, *allowed: str) -> Query:
        """The options of what reads or makes it: raises RecordError for others than the allowed."""
        own = {name: value or "" for name, value in self.options if name not in COMMON}
        for name, value in self.options:
            if name not in (*COMMON, *allowed):
                known = (*allowed, *COMMON)
                raise RecordError(f"{self.text}: option {name!r} is not known; {hint(name, known)}")
            if not value and name not in FLAGS:
                raise RecordError(f"{self.text}: {name} has no value; write {name}=...")
        return Query(self.text, own)

    def without(self, *names: str) -> Source:
        """The same without some options."""
        return replace(self, options=tuple(each for each in self.options if each[0] not in names))

    def plus(self, **options: str | None) -> Source:
        """The same with further options, in place of those of the same names."""
        kept = self.without(*options).options
        return replace(self, options=_in_order((*kept, *options.items())))

    def at(self, place: str) -> Source:
        """The same of another place."""
        return replace(self, place=place)

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
        return None if self.second is None else (self.alone, self.alone.at(self.second))

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
                f"{self.text}: {word} two components: a pair of a set, fema_p695:farfield/1?both,"
                " or second=FILE, seen from the folder of the first one"
            )


def _parsed(options: str, text: str) -> tuple[tuple[str, str | None], ...]:
    return _in_order(_each(options, text))


def _in_order(options: Iterable[tuple[str, str | None]]) -> tuple[tuple[str, str | None], ...]:
    """Own options as they were written, and behind them those that all kinds have."""
    rank = {name: number for number, name in enumerate(COMMON)}
    return tuple(sorted(options, key=lambda each: rank.get(each[0], -1)))


def _each(options: str, text: str) -> Iterator[tuple[str, str | None]]:
    seen = set[str]()
    for item in filter(None, (part.strip() for part in options.split("&"))):
        name, mark, value = (part.strip() for part in item.partition("="))
        if name in seen:
            raise RecordError(f"{text}: {name} is given twice; keep one")
        seen.add(name)
        name = SPELLINGS.get(name, name)
        if name in FLAGS and mark:
            raise RecordError(f"{text}: {name} takes no value; write {name} alone")
        yield name, value if mark else None


def split_options(text: str) -> tuple[str, str]:
    """The name of a file, and its options."""
    match = _FILE_OPTIONS.fullmatch(text)
    return (match[1], match[2]) if match else (text, "")


def is_file(place: str, folder: Path | None) -> bool:
    """Whether there is such a file."""
    try:
        return ((folder or Path()) / Path(place).expanduser()).is_file()
    except (OSError, ValueError, RuntimeError):  # too long, a zero byte, no such user
        return False
