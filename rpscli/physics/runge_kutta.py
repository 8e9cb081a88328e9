"""One step of Verner's explicit Runge-Kutta method of order 6, first same as last.

J. H. Verner, Numerically optimal Runge-Kutta pairs with interpolants, Numer. Algorithms 53 (2010)
383-396: the "most robust" pair of orders 6(5), nine stages. The embedded formula of order 5 is
not needed: the step follows the record's samples.

The equations are of second order, so a stage's slopes are its velocities and accelerations. Each
lane has its own step length, phase and side.
"""

from __future__ import annotations

from rpscli.physics.acceleration import accelerate
from rpscli.physics.lanes import floor_count, lane_count
from rpscli.physics.layout import (
    ACCELERATION,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    GIVEN,
    GIVEN_FIRST,
    GIVEN_MEAN,
    POSITION,
    SCALARS,
    STEPS,
    TAKEN,
    TAKEN_FIRST,
    TAKEN_MEAN,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part

EVALUATIONS = 8
"""Accelerations of one step when the first are known."""

# Where in the step its stages stand; what each weighs in those after it, and in the end. Weights
# that are zero are left out.
C2, C3, C4, C5, C6, C7 = 9 / 50, 1 / 6, 1 / 4, 53 / 100, 3 / 5, 4 / 5
A21 = 9 / 50
A31, A32 = 29 / 324, 25 / 324
A41, A43 = 1 / 16, 3 / 16
A51, A53, A54 = 79129 / 250000, -261237 / 250000, 19663 / 15625
A61, A63, A64, A65 = 1336883 / 4909125, -25476 / 30875, 194159 / 185250, 8225 / 78546
A71, A73, A74 = -2459386 / 14727375, 19504 / 30875, 2377474 / 13615875
A75, A76 = -6157250 / 5773131, 902 / 735
A81, A83, A84 = 2699 / 7410, -252 / 1235, -1393253 / 3993990
A85, A86, A87 = 236875 / 72618, -135 / 49, 15 / 22
B1, B4, B6, B7, B8 = 11 / 144, 256 / 693, 125 / 504, 125 / 528, 5 / 72


@lane_routine
def step(b: Floats, shape: Shape) -> None:
    """Advance all lanes, each by its own step.

    The coordinates of all lanes stand one after the other, so one loop combines the slopes of
    them all; the block STEPS repeats the step length for each coordinate to that end.

    Reads the state (blocks POSITION, VELOCITY, ACCELERATION); leaves it, and writes the end of the
    step to the blocks AHEAD, AHEAD_RATE and AHEAD_ACCELERATION; where energy is audited, its mean
    flows over the step to GIVEN_MEAN and TAKEN_MEAN.
    """
    n, L = floor_count(shape), len(shape.stride)
    start, size = SCALARS * L, (n + 1) * L
    step = start + STEPS * size
    x, dx = start + AHEAD * size, start + AHEAD_RATE * size
    ddx = start + AHEAD_ACCELERATION * size
    x1, v1, a1 = start + POSITION * size, start + VELOCITY * size, start + ACCELERATION * size
    v3, v4, v5, v6, v7 = v1 + size, v1 + 2 * size, v1 + 3 * size, v1 + 4 * size, v1 + 5 * size
    a3, a4, a5, a6, a7 = a1 + size, a1 + 2 * size, a1 + 3 * size, a1 + 4 * size, a1 + 5 * size
    for i in range(size):
        h = b[step + i] * A21
        b[x + i] = b[x1 + i] + h * b[v1 + i]
        b[dx + i] = b[v1 + i] + h * b[a1 + i]
    accelerate(b, shape, 0, C2)
    start_powers(b, shape, B1)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[x + i] = b[x1 + i] + h * (A31 * b[v1 + i] + A32 * v)
        b[dx + i] = b[v1 + i] + h * (A31 * b[a1 + i] + A32 * a)
    accelerate(b, shape, 0, C3)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v3 + i], b[a3 + i] = v, a
        b[x + i] = b[x1 + i] + h * (A41 * b[v1 + i] + A43 * v)
        b[dx + i] = b[v1 + i] + h * (A41 * b[a1 + i] + A43 * a)
    accelerate(b, shape, 0, C4)
    weigh_powers(b, shape, B4)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v4 + i], b[a4 + i] = v, a
        b[x + i] = b[x1 + i] + h * (A51 * b[v1 + i] + A53 * b[v3 + i] + A54 * v)
        b[dx + i] = b[v1 + i] + h * (A51 * b[a1 + i] + A53 * b[a3 + i] + A54 * a)
    accelerate(b, shape, 0, C5)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v5 + i], b[a5 + i] = v, a
        b[x + i] = b[x1 + i] + h * (A61 * b[v1 + i] + A63 * b[v3 + i] + A64 * b[v4 + i] + A65 * v)
        b[dx + i] = b[v1 + i] + h * (A61 * b[a1 + i] + A63 * b[a3 + i] + A64 * b[a4 + i] + A65 * a)
    accelerate(b, shape, 0, C6)
    weigh_powers(b, shape, B6)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v6 + i], b[a6 + i] = v, a
        b[x + i] = b[x1 + i] + h * (
            A71 * b[v1 + i] + A73 * b[v3 + i] + A74 * b[v4 + i] + A75 * b[v5 + i] + A76 * v
        )
        b[dx + i] = b[v1 + i] + h * (
            A71 * b[a1 + i] + A73 * b[a3 + i] + A74 * b[a4 + i] + A75 * b[a5 + i] + A76 * a
        )
    accelerate(b, shape, 0, C7)
    weigh_powers(b, shape, B7)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v7 + i], b[a7 + i] = v, a
        b[x + i] = b[x1 + i] + h * (
            A81 * b[v1 + i]
            + A83 * b[v3 + i]
            + A84 * b[v4 + i]
            + A85 * b[v5 + i]
            + A86 * b[v6 + i]
            + A87 * v
        )
        b[dx + i] = b[v1 + i] + h * (
            A81 * b[a1 + i]
            + A83 * b[a3 + i]
            + A84 * b[a4 + i]
            + A85 * b[a5 + i]
            + A86 * b[a6 + i]
            + A87 * a
        )
    accelerate(b, shape, 0, 1.0)
    weigh_powers(b, shape, B8)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[x + i] = b[x1 + i] + h * (
            B1 * b[v1 + i] + B4 * b[v4 + i] + B6 * b[v6 + i] + B7 * b[v7 + i] + B8 * v
        )
        b[dx + i] = b[v1 + i] + h * (
            B1 * b[a1 + i] + B4 * b[a4 + i] + B6 * b[a6 + i] + B7 * b[a7 + i] + B8 * a
        )
    accelerate(b, shape, 0, 1.0)


@part
def start_powers(b: Floats, shape: Shape, weight: float) -> None:
    """Begin the mean of the energy flows over a step with those at its start."""
    L = len(shape.stride)
    if len(shape.audit) > 0:
        for l in range(lane_count(shape)):
            b[GIVEN_MEAN * L + l] = weight * b[GIVEN_FIRST * L + l]
            b[TAKEN_MEAN * L + l] = weight * b[TAKEN_FIRST * L + l]


@part
def weigh_powers(b: Floats, shape: Shape, weight: float) -> None:
    """Add the energy flows of the present stage: the same quadrature as that of the motion."""
    L = len(shape.stride)
    if len(shape.audit) > 0:
        for l in range(lane_count(shape)):
            b[GIVEN_MEAN * L + l] += weight * b[GIVEN * L + l]
            b[TAKEN_MEAN * L + l] += weight * b[TAKEN * L + l]
