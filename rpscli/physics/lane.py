"""One lane of many: what its own events and its full contact are written with.

The steps of all lanes run over the flat buffer; whatever is particular to one lane goes through
views of the same numbers, in which the lane is left out.
"""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.parameters import Block, Floats, Integers, Lanes
from rpscli.physics.part import part


class Lane(NamedTuple):
    """A lane: entry l of the arrays of `Lanes`, and what all lanes share.

    `numbers` (rows,) and `blocks` (blocks, n) are indexed by `layout`, `whole` by its whole
    numbers, `podium` by `podium_layout`, `modes` (rows, n) and `block` by `contact_layout`.
    """

    numbers: Floats
    blocks: Floats
    whole: Integers
    podium: Floats
    modes: Floats
    block: Block
    piece: Floats
    acceleration: Floats
    samples: Floats
    log: Floats


@part
def lane_of(lanes: Lanes, l: int) -> Lane:
    """Views of lane l."""
    return Lane(
        lanes.numbers[l],
        lanes.blocks[l],
        lanes.integers[l],
        lanes.podium[l],
        lanes.modes[l],
        lanes.block,
        lanes.piece,
        lanes.acceleration,
        lanes.samples,
        lanes.log,
    )
