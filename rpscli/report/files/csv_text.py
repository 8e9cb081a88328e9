"""Tables as CSV: a header of names with units, and one row a line."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PIECE = 4096  # rows


class Column(NamedTuple):
    """One column of a table; a value that does not exist is None, and an empty cell."""

    name: str
    unit: str
    values: Iterable[float | int | str | None] | NDArray[Any]

    @property
    def title(self) -> str:
        """Name and unit, ``-`` for a number without one."""
        return f"{self.name} [{self.unit}]"


def columns_of(heads: Mapping[str, str], rows: Iterable[Sequence[Any]]) -> list[Column]:
    """Columns with these names and units from the rows of a table."""
    cells = list(zip(*rows, strict=True)) or [()] * len(heads)
    return [Column(*head, values) for head, values in zip(heads.items(), cells, strict=True)]


def csv_text(columns: Sequence[Column]) -> str:
    """The table; numbers with ten significant digits.

    >>> print(csv_text([Column("time", "s", [0.0, 0.5]), Column("kind", "-", ["impact", None])]))
    time [s],kind [-]
    0,impact
    0.5,
    <BLANKLINE>
    """
    return "".join(csv_lines(columns))


def csv_lines(columns: Sequence[Column]) -> Iterator[str]:
    """The same table line by line, for those that are too long to be in memory as text."""
    cells = [map(_cell, _one_by_one(column.values)) for column in columns]
    yield ",".join(column.title for column in columns) + "\n"
    for row in zip(*cells, strict=True):
        yield ",".join(row) + "\n"


def quoted(value: object) -> float | int | str | None:
    """A value for a cell of a CSV file; text with commas in quotes."""
    if value is None or isinstance(value, int | float):
        return value
    text = value if isinstance(value, str) else json.dumps(value)
    if any(sign in text for sign in ',"\n'):
        return '"' + text.replace('"', '""') + '"'
    return text


def _one_by_one(values: Iterable[object] | NDArray[Any]) -> Iterator[object]:
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
    return "" if value is None else str(value)
