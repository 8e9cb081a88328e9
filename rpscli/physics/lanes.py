"""Which lanes a loop goes over, told so that the compiler can turn it into vector instructions.

It does so where it sees that no index is negative (Python counts those from the end) and none
overflows: hence the bounds.
"""

from __future__ import annotations

from rpscli.physics.parameters import Shape
from rpscli.physics.part import part

MOST_FLOORS = 10_000


@part
def first_lane(shape: Shape, lane: int) -> int:
    """Where the lanes begin: at `lane` if it is one of many that moves alone, else at 0."""
    return max(lane, 0) if len(shape.alone) > 0 and len(shape.stride) > 1 else 0


@part
def lane_count(shape: Shape) -> int:
    """Lanes that move together."""
    return len(shape.lanes)


@part
def floor_count(shape: Shape) -> int:
    """Floors, at most `MOST_FLOORS`."""
    return max(min(len(shape.floors), MOST_FLOORS), 0)


@part
def written(x: float) -> float:
    """The same number, to be written wherever it came from (but -0 becomes 0).

    What is either new or what stood there before invites the compiler to write only the new ones,
    lane by lane; processors take ten times as long for that as for writing all.
    """
    return x + 0.0
