"""One table for files, terminals, pages and documents, and numbers as people read them.

A column has a name, an SI unit and values, which is what files and documents hold,
and a label and a form for readers. `csv_text` and `records` write columns; a `Table`
says how readers see them.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import (
    Callable,
    Collection,
    Iterable,
    Iterator,
    Mapping,
    Sequence,
)
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, cast

from rpscli.units import Written, digits_beside, si_factor

if TYPE_CHECKING:
    from numpy.typing import NDArray


def told_once(named: Iterable[tuple[str, str]], count: int, noun: str) -> Iterator[str]:
    """Each kind of text once, with how many of all it is about and
    the numbers of the first.
    """
    kinds: dict[str, list[str]] = {}
    for name, text in named:
        kinds.setdefault(re.sub(r"[-+\d.]+", "", text), []).append(f"{name}: {text}")
    for first, *others in kinds.values():
        yield f"{1 + len(others)} of {count} {noun}, such as {first}" if others else first


def shown(value: float | str | None, digits: int = 4) -> str:
    """A number with so many significant digits; ``-`` if there is none."""
    if value is None:
        return "-"
    if isinstance(value, str | int):
        return str(value)
    if not math.isfinite(value):
        return "inf" if value > 0.0 else "-"
    if value == 0.0:
        return "0"
    if not 1e-4 <= (size := abs(value)) < 1e7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(size)))}f}"


def shown_beside(value: float | None, limit: float | None, digits: int = 4) -> str:
    """A number beside a limit, with more digits where both would print alike."""
    if value is not None and limit is not None and math.isfinite(value):
        digits = digits_beside(value, limit, digits)
    return shown(value, digits)


def standing(value: float | None, digits: int = 4) -> str:
    """A demand; ``-`` of those that an overturned history takes to infinity."""
    return shown(value if value is not None and math.isfinite(value) else None, digits)


Units: TypeAlias = Mapping[str, tuple[str, float]]

LARGE_UNITS: Units = {
    "N": ("kN", 1e-3), "J": ("kJ", 1e-3), "kg": ("t", 1e-3), "N/m": ("kN/m", 1e-3),
    "N m": ("kN m", 1e-3), "Pa": ("MPa", 1e-6),
}  # fmt: skip
"""Names for many of an SI unit, and the factor; other units are shown as they are."""

PAGE_UNITS: Units = {**LARGE_UNITS, "m": ("mm", 1e3)}
"""Those of pages for a checker, as drawings have them."""


def large(
    value: float | None, unit: str, units: Units = LARGE_UNITS
) -> tuple[float | None, str]:
    """A value in SI and its unit as people read them."""
    if unit in units:
        name, factor = units[unit]
        return None if value is None else value * factor, name
    return value, "" if unit == "-" else unit


def headed(label: str, unit: str) -> str:
    """The head of values in the unit in which people read them."""
    return f"{label} {large(None, unit)[1]}".strip()


def measured(
    value: float | None,
    unit: str,
    like: float | None = None,
    units: Units = LARGE_UNITS,
) -> str:
    """A value in SI as text with its unit: that in which another
    one was written, if it was; with digits that tell both apart.
    """
    number, name = large(value, unit, units)
    other = large(like, unit, units)[0]
    if value is not None and isinstance(like, Written) and like.unit:
        name = like.unit
        number, other = (each / si_factor(name, unit) for each in (value, like))
    text = shown_beside(number, other)
    return text if value is None or not name else f"{text} {name}"


def percent(part: float, whole: float) -> str:
    """A share of a whole."""
    return f"{100.0 * part / whole:.1f} %" if whole else "-"


_PIECE = 512  # rows
_QUOTED = re.compile(r'[,"\n\r]')


class Column(NamedTuple):
    """One column of a table; a value that does not exist is None, and an empty cell."""

    name: str
    unit: str
    values: Iterable[Any] | NDArray[Any]
    label: str = ""  # what readers see above it, with the unit that they see
    form: Callable[[Any], str] | None = None  # text of a value for readers

    @property
    def title(self) -> str:
        """Name and unit, ``-`` for a number without one."""
        return f"{self.name} [{self.unit}]"

    def texts(self) -> list[str]:
        """Texts of the values for readers: by default four digits,
        thousands of large units.
        """
        form = self.form or (lambda value: shown(large(value, self.unit)[0]))
        return [form(value) for value in _one_by_one(self.values)]


@dataclass(frozen=True)
class Table:
    """Columns as readers see them."""

    columns: Sequence[Column]
    words: int = 1  # first columns that hold words, which may be broken; numbers follow
    # first columns that say what a row is about, and begin each part of a wide table
    keys: int = 1

    @classmethod
    def of_texts(
        cls,
        heads: Sequence[str],
        rows: Iterable[Sequence[str]],
        *,
        words: int = 1,
        keys: int = 1,
    ) -> Table:
        """A table whose rows are texts already."""
        cells = list(zip(*rows, strict=True)) or [()] * len(heads)
        columns = [
            Column(h, "-", each, h, str) for h, each in zip(heads, cells, strict=True)
        ]
        return cls(columns, words, keys)

    @classmethod
    def listing(cls, rows: Iterable[tuple[str, str | None]]) -> Table:
        """Names and what they stand for, without heads; not of
        what stands for nothing.
        """
        return cls.of_texts(
            ("", ""), [(name, text) for name, text in rows if text], words=2
        )

    @property
    def heads(self) -> list[str]:
        """Labels of the columns."""
        return [column.label for column in self.columns]

    def __len__(self) -> int:
        return len(list(self.columns[0].values))

    def first(self, rows: int) -> Table:
        """The table with so many of its rows."""
        few = [each._replace(values=list(each.values)[:rows]) for each in self.columns]
        return replace(self, columns=few)

    def without(self, heads: Collection[str]) -> Table:
        """The table without columns of these heads."""
        return replace(
            self, columns=[each for each in self.columns if each.label not in heads]
        )

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """Texts of each row."""
        return list(zip(*(column.texts() for column in self.columns), strict=True))


class Heading(str):
    """A title above tables."""

    __slots__ = ()


Part = Table | Heading | str
"""A part of what a command shows: a plain text is a remark between tables."""


def columns_of(heads: str, rows: Iterable[Sequence[Any]]) -> list[Column]:
    """Columns from rows; heads as a file has them, `time [s], kind`, a
    plain number without unit.

    >>> [column.title for column in columns_of("time [s], kind", [])]
    ['time [s]', 'kind [-]']
    """
    parts = [head.removesuffix("]").partition(" [") for head in heads.split(", ")]
    cells = list(zip(*rows, strict=True)) or [()] * len(parts)
    return [
        Column(name, unit or "-", values)
        for (name, _, unit), values in zip(parts, cells, strict=True)
    ]


def picked(columns: Iterable[Column], *names: str) -> list[Column]:
    """The columns of these names, in this order."""
    known = {column.name: column for column in columns}
    return [known[name] for name in names]


def csv_text(columns: Sequence[Column]) -> str:
    """The columns as CSV; numbers with ten significant digits, quotes
    where a cell needs them.
    """
    return "".join(csv_lines(columns))


def csv_lines(columns: Sequence[Column]) -> Iterator[str]:
    """CSV in pieces of some lines, for tables that are too long
    to be in memory as text.
    """
    yield ",".join(_cell(column.title) for column in columns) + "\n"
    cells = [iter(_one_by_one(column.values)) for column in columns]
    while any(pieces := [list(islice(values, _PIECE)) for values in cells]):
        forms, values = zip(*map(_formed, pieces), strict=True)
        line = ",".join(forms) + "\n"
        yield "".join(line % row for row in zip(*values, strict=True))


def _formed(values: list[Any]) -> tuple[str, list[Any]]:
    """A form for each of some cells, and what is to be put into it;
    numbers as `_cell` has them.
    """
    if set(map(type, values)) == {float} and math.isfinite(
        sum(values)
    ):  # then each is finite
        return "%.10g", [value + 0.0 for value in values]
    return "%s", list(map(_cell, values))


def records(columns: Sequence[Column]) -> list[dict[str, Any]]:
    """Rows for a JSON document: values by the names of their columns."""
    names = [column.name for column in columns]
    cells = zip(*(_one_by_one(column.values) for column in columns), strict=True)
    return [dict(zip(names, row, strict=True)) for row in cells]


def _one_by_one(values: Iterable[Any] | NDArray[Any]) -> Iterator[Any]:
    if not hasattr(values, "tolist"):  # numpy need not be there
        yield from values
        return
    array = cast("NDArray[Any]", values)
    # Piece by piece, since as objects numbers take four times the memory.
    for start in range(0, len(array), _PIECE):
        yield from array[start : start + _PIECE].tolist()


def _cell(value: object) -> str:
    if isinstance(value, float):
        return format(value + 0.0, ".10g") if math.isfinite(value) else ""
    if value is None:
        return ""
    text = (
        json.dumps(value) if isinstance(value, bool | list | tuple | dict) else str(value)
    )
    return '"' + text.replace('"', '""') + '"' if _QUOTED.search(text) else text
