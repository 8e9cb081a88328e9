"""Records: every number that kernels share has a name, sizes, a unit and a writer.

Lanes come last, so that a loop over them is one vector instruction; one record, so that the
compiler sees that its fields never overlap. Sizes are part of a record's type: a number of lanes,
and room for the modes of the highest building, of which the first ``n`` are used: memory that
nobody touches costs nothing, and one compilation serves every building. Never two sizes of one
record: numba names machine code after a number that the process gave to the type, so that code of
two sizes, compiled by two processes, is taken for the same.
"""

from __future__ import annotations

from functools import cache
from threading import local
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import MOST_STOREYS

Floats = NDArray[np.float64]
Record: TypeAlias = Any
"""One entry of an array of records: its fields are attributes, in Python as in machine code."""

ORDER = 7
"""Highest term of the Taylor series of the velocities; those of the positions have one more."""

TERMS = ORDER + 1
INSTANTS = 32
"""Instants of a block of steps in full contact, its start included."""

LANES = 32
"""Histories that one core follows at once. Loops over fewer are unrolled by the compiler before it
looks for vector instructions; more do not fit into the processor's first cache."""

SPREAD = 3
PADDING = 8
"""Rows that no mode uses, and entries that no lane uses. Without them the rows of one lane would
all fall into a few lines of the processor's cache, and drive each other out."""


NO_HISTORY = -1
"""`history` of a lane that has nothing left to do."""

NO_RECORD = -1
"""`vertical` of a history without vertical ground motion."""


WHOLE = "integer"
"""Unit of what is counted: such fields are integers."""


class Field(NamedTuple):
    """A field of a record: a number, or an array of the named sizes."""

    name: str
    sizes: str  # of its axes, by name or as a number; none of a number
    unit: str  # SI; ``-`` for plain numbers, ``mixed`` where entries or cases differ
    meaning: str  # symbol or formula, and words
    by: str = ""  # modules and folders of kernels that write it

    def __str__(self) -> str:
        """One line, as `describe` prints it."""
        sizes = f"({self.sizes})" if self.sizes else "number"
        writer = f"; by {self.by}" if self.by else ""
        return f"{self.name:22} {sizes:18} [{self.unit}] {self.meaning}{writer}"


SIZES = {
    "lanes": LANES + PADDING,
    "modes": MOST_STOREYS + SPREAD,
    "floors": MOST_STOREYS + PADDING,
    "rows": 2 * MOST_STOREYS + SPREAD,  # modes in x, then in y
    "terms": TERMS,
    "positions": TERMS + 1,
    "instants": INSTANTS,
    "ahead": INSTANTS + PADDING,
}
"""Axes by name; all others are given as a number."""


def _place(field: Field) -> tuple[bool, bool, int, str]:
    """Rows of lanes or instants first: each begins with a line of the cache."""
    names = field.sizes.replace("rows", "modes").split()
    return names in ([], ["modes"]), "modes" in names, len(names), field.sizes


@cache
def record_type(fields: tuple[Field, ...]) -> np.dtype[Any]:
    """The type of a record of such fields.

    Fields of one shape stand together, those of modes behind the others: a loop over a mode's lanes
    then writes either before or behind what it reads, which the compiler can check at once.
    """
    return np.dtype(
        [
            (
                field.name,
                np.int64 if field.unit == WHOLE else np.float64,
                tuple(int(SIZES.get(size, size)) for size in field.sizes.split()),
            )
            for field in sorted(fields, key=_place)
        ]
    )


PAGE = 4096
"""Bytes of a page of memory. numpy begins an array anywhere; begun within a page, a lane may take
half as long again, as its rows fall on other lines of the processor's cache in each process."""


def records(fields: tuple[Field, ...], count: int = 1) -> Record:
    """An array (count,) of records of zeros that begins with a page."""
    kind = record_type(fields)
    size = kind.itemsize * count
    room = np.zeros(size + PAGE, np.uint8)
    first = -room.ctypes.data % PAGE
    return room[first : first + size].view(kind).view(np.recarray)


_kept = local()


def scratch(fields: tuple[Field, ...], count: int = 1) -> Record:
    """An array of records that this thread keeps, with whatever its last use left there.

    A state is 1.5 MB: made anew for each short history, it would take as long as the history.
    """
    kept, table = vars(_kept), f"{id(fields)} {count}"  # tables live as long as the program
    if table not in kept:
        kept[table] = records(fields, count)
    return kept[table]


def describe(fields: tuple[Field, ...]) -> str:
    """A table of a record, for reading: ``print(describe(STATE))``."""
    return "\n".join(map(str, fields))
