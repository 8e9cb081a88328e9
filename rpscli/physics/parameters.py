"""What the kernels are told: plain floats and arrays in named tuples."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.geometry import Phase

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Podium(NamedTuple):
    """The rocking storey and how its motion is followed; letters as in Theory, sections 1 and 2.

    `flight_rate` and `contact_rate` are the least numbers of steps a second, uplifted and in full
    contact; each interval of a record is divided evenly. `last_term` bounds the last term of an
    uplifted step's series over its first three. `bounces` is what the impacts left out at
    re-contact add to the floors' velocity, over the cap beam's.
    """

    R: float
    alpha: float
    beta: float
    theta_cr: float
    theta_limit: float
    rolling: Phase
    rocking: Phase
    Io: float
    gamma: float
    eta: float
    columns_mass: float
    cap_beam_mass: float
    floors_mass: float
    gravity: float
    restitution: float
    floors_jump: float
    flight_rate: float
    contact_rate: float
    last_term: float
    recontact_tolerance: float
    bounces: float
    max_events: float
    initial_rotation: float
    free_vibration: float
    until_rest: float


def podium_numbers(podium: Podium) -> list[float]:
    """The row of numbers of a podium, see `podium_layout`: its fields, phases spread out."""
    numbers: list[float] = []
    for value in podium:
        numbers.extend(value if isinstance(value, Phase) else [float(value)])
    return numbers


class Systems(NamedTuple):
    """Structures of the same number of floors n, stacked along the first axis.

    podium
        (S, 33): a row of `podium_numbers` each.
    column
        (S, rows): what stands in the buffer of a lane before a history, see `layout`.
    modes
        (S, 25 + 2 n, n): what stands in its modal rows, see `contact_layout`.
    """

    podium: Floats
    column: Floats
    modes: Floats


(
    SYSTEM,  # number of the structure
    RECORD,  # offset of the record in the store of all records
    NPTS,
    VERTICAL,  # offset of the vertical record, or -1
) = range(4)
SCALE, DT = range(2)


class Points(NamedTuple):
    """The histories to run: `integers` (P, 4), columns SYSTEM to VERTICAL; `numbers` (P, 2)."""

    integers: Integers
    numbers: Floats


class Results(NamedTuple):
    """What is written for each history, and, for the first one, its samples and event log.

    `numbers` (points, 14 + 2 n) and `integers` (points, 12): columns `layout.OUT_...`.
    `samples` (rows, 7 + 2 n) and `log` (rows, 6): give no rows to keep none; events beyond the
    log's rows are only counted.
    """

    numbers: Floats
    integers: Integers
    samples: Floats
    log: Floats


Count: TypeAlias = tuple[tuple[()], ...]
"""As many empty entries: of such a tuple the compiler knows the length, and hands on nothing."""

Size: TypeAlias = Count | NDArray[np.int8]


class Shape(NamedTuple):
    """Sizes that the compiler may know: each is the length of an entry.

    A tuple's length is part of its type, so a kernel called with a tuple is compiled for that
    length; an array's length is read at run time, and one kernel serves all.

    floors
        n.
    stride
        L, the lanes that the buffer is made for.
    lanes
        Lanes that move together: all, or one.
    alone
        Not empty: one lane of several moves by itself.
    audit
        Not empty: integrate the energy flows.
    """

    floors: Size
    stride: Count
    lanes: Count
    alone: Count
    audit: Count


class Block(NamedTuple):
    """What is known of the instants of a block of steps in full contact, see `contact`.

    `rows` is flat: entry ``row * COLUMNS + k``. `modes` (n, 3, COLUMNS) holds the
    rows of modes.
    """

    rows: Floats
    modes: Floats


class Lanes(NamedTuple):
    """Everything that histories need while they run, lane by lane: see `layout` and `contact`.

    `numbers` (L, rows) and `blocks` (L, blocks, n) are views of the flat `buffer`. `podium`
    (L, 33) are the numbers of `Podium`, `modes` (L, 25 + 2 n, n) the modal rows of full contact;
    its `block` and `piece` (6,) are scratch; `acceleration` holds all records end to end, linear
    between samples; the samples and the log are those of `Results`.
    """

    buffer: Floats
    numbers: Floats
    blocks: Floats
    integers: Integers
    podium: Floats
    modes: Floats
    block: Block
    piece: Floats
    acceleration: Floats
    samples: Floats
    log: Floats
