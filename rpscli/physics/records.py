"""Layout of structured records in memory: their types, arrays, the scratch of a thread.

Sizes are part of a record's type: `ways`, the horizontal directions in which the ground
moves, and the lanes are so known when the kernel is compiled, which is one source for all
of them.
"""

from __future__ import annotations

from functools import cache
from threading import local
from typing import Any, TypeAlias

import numpy as np

from rpscli.constants import MOST_STOREYS
from rpscli.physics.interface import RESULT
from rpscli.physics.state import (
    KEPT,
    PADDING,
    SLOTS,
    STATE,
    STATES,
    WHOLE,
    Field,
    Record,
)
from rpscli.physics.tableau import END

STOREYS_THAT_YIELD = {
    *(
        "strength",
        "stiffness",
        "mark",
        "middle",
        "middle_most",
        "middle_least",
        "drift_most",
    ),
    *("yielded", "first_yield", "new_freed", "slipping"),
}
"""Fields of modes that say something where storeys may yield."""

OVERLAYS = "words", "device_words", "mode_words", "storey_words"
"""Fields that overlay others of a state: by them a lane is copied, see `record_type`."""


def kind_of_field(field: Field) -> int:
    """0 of numbers of all lanes; from 1 on of one, as `OVERLAYS`;
    behind them what is scratch.
    """
    if not field.sizes:
        return 0
    *sizes, last = field.sizes.split()
    if field.name in STOREYS_THAT_YIELD:
        return 4
    if last != "lanes" or "stages" in sizes or field.name.startswith("new_"):
        return 1 + len(OVERLAYS)
    if "rows" in sizes:
        return 3 if len(sizes) == 1 else 1 + len(OVERLAYS)
    return 2 if f"{SLOTS}" in sizes else 1


@cache
def record_type(
    fields: tuple[Field, ...], ways: int = 1, lanes: int = 1
) -> np.dtype[Any]:
    """The type of a record of such fields, for so many directions and lanes.

    Fields of one shape stand together, and single numbers before all: a loop over lanes
    then writes before or behind what it reads, which the compiler can tell. Then come
    those that a lane keeps from step to step: of itself and of its devices (`words`,
    `device_words`: number, lane), of its modes and of storeys that yield (`mode_words`,
    `storey_words`: field, mode, lane).
    """
    sizes = {
        "ways": ways,
        "axes": ways + 1,
        "lanes": lanes + PADDING,
        "modes": MOST_STOREYS + PADDING,
        "rows": (ways + 1) * MOST_STOREYS + PADDING,
        "stages": END + 1,
        "demands": 2 * (2 * ways - 1),
    }
    kinds = {field: kind_of_field(field) if fields is STATE else 0 for field in fields}
    ordered = sorted(
        fields, key=lambda field: (kinds[field], len(field.sizes.split()), field.sizes)
    )
    of = dict[str, Location]()
    end = 0
    before = 0
    for field in ordered:
        number = np.int64 if field.unit == WHOLE else np.float64
        kind = np.dtype(
            (number, tuple(int(sizes.get(z, z)) for z in field.sizes.split()))
        )
        if kinds[field] != before:  # and then all do, of many lanes
            end = -(-end // LINE) * LINE
        before = kinds[field]
        begin = end
        of[field.name] = kind, begin
        end = begin + kind.itemsize
    if fields is STATE:
        of |= overlays(of)
    if fields in (STATE, RESULT):
        of["kept"] = overlay([of[field.name] for field in KEPT])
    return record_of(of)


LINE = 64
"""Bytes of a line of the processor's cache, with which the fields of all lanes begin."""


def record_of(fields: dict[str, Location]) -> np.dtype[Any]:
    """The type of a record with fields of kinds at offsets."""
    kinds, offsets = zip(*fields.values(), strict=True)
    return np.dtype({"names": [*fields], "formats": [*kinds], "offsets": [*offsets]})


Location: TypeAlias = tuple[np.dtype[Any], int]
"""A field's type and where it begins."""


def overlays(of: dict[str, Location]) -> dict[str, Location]:
    """The fields by which a lane is copied."""
    found = {}
    for kind, name in enumerate(OVERLAYS, 1):
        members = [of[field.name] for field in STATE if kind_of_field(field) == kind]
        found[name] = overlay(members, each=kind > 2)
    return found


def overlay(members: list[Location], *, each: bool = False) -> Location:
    """Words of fields that stand together: as rows of lanes, or
    `each` as a table of its own.
    """
    shape = members[0][0].shape
    words = sum(member.itemsize for member, _ in members) // 8
    rows = (words // shape[-1], shape[-1]) if shape else (words,)
    kind = np.dtype((np.int64, (len(members), *shape) if each else rows))
    return kind, min(offset for _, offset in members)


PAGE = 4096
"""Bytes of a page of memory. numpy begins an array anywhere; begun within a page,
a lane may take half as long again, as its rows fall on other lines of the
processor's cache in each process."""


def records(
    fields: tuple[Field, ...], count: int = 1, ways: int = 1, lanes: int = 1
) -> Record:
    """An array (count,) of records of zeros that begins with a page."""
    kind = record_type(fields, ways, lanes)
    size = kind.itemsize * count
    room = np.zeros(size + PAGE, np.uint8)
    first = -room.ctypes.data % PAGE
    return room[first : first + size].view(kind).view(np.recarray)


_kept = local()


def scratch(ways: int, lanes: int) -> Record:
    """States that this thread keeps, with whatever their last use left
    there (1,) or (STATES,).

    A state takes megabytes: made anew for each short history, it would
    take as long as the history.
    """
    kept = vars(_kept)
    name = f"{ways} {lanes}"
    if name not in kept:
        kept[name] = records(STATE, 1 if lanes == 1 else STATES, ways, lanes)
    return kept[name]
