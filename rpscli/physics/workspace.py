"""Room for the lanes: the only memory that the kernels write to besides the results."""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics import contact_layout
from rpscli.physics.contact_layout import COLUMNS, ROWS
from rpscli.physics.layout import BLOCKS, SCALARS, WHOLE_NUMBERS, rows
from rpscli.physics.parameters import Block, Floats, Lanes, Results, Shape
from rpscli.physics.podium_layout import PODIUM_NUMBERS

CACHE_LINE = 64
"""Bytes that the processor fetches at once. A vector of eight numbers fills a line; numpy begins
an array anywhere, and then each vector would be fetched twice."""


def zeros(*shape: int) -> Floats:
    """An array of zeros that begins with a line of the cache."""
    size, spare = math.prod(shape), CACHE_LINE // 8
    room = np.zeros(size + spare)
    first = -room.ctypes.data % CACHE_LINE // 8
    return room[first : first + size].reshape(shape)


def empty_lanes(acceleration: Floats, shape: Shape, results: Results) -> Lanes:
    """Lanes with nothing to do."""
    n, L = len(shape.floors), len(shape.stride)
    buffer = zeros(rows(n) * L)
    blocks = buffer[SCALARS * L :].reshape(BLOCKS + 2 * n, n, L)
    return Lanes(
        buffer=buffer,
        numbers=buffer[: SCALARS * L].reshape(SCALARS, L).T,
        blocks=np.moveaxis(blocks, -1, 0),
        integers=np.zeros((L, WHOLE_NUMBERS), np.int64),
        podium=np.zeros((L, PODIUM_NUMBERS)),
        modes=zeros(L, contact_layout.SHAPES + 2 * n, n),
        block=empty_block(n),
        piece=np.zeros(6),
        acceleration=acceleration,
        samples=results.samples,
        log=results.log,
    )


def empty_block(storeys: int) -> Block:
    """A block in full contact."""
    return Block(
        rows=zeros(ROWS * COLUMNS),
        modes=zeros(storeys, 3, COLUMNS),
    )
