"""One step of the explicit Runge-Kutta pair of Dormand and Prince, order 5, first same as last.

J. R. Dormand and P. J. Prince, A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6
(1980) 19-26. The embedded formula of order 4 is not needed: the step follows the record's samples.

The equations are of second order, so a stage's slopes are its velocities and accelerations. Each
lane has its own step length, phase and side.
"""

from __future__ import annotations

from rpscli.physics.acceleration import accelerate
from rpscli.physics.jit import kernel, merged
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

EVALUATIONS = 6
"""Accelerations of one step when the first are known."""


@kernel
def step(b: Floats, shape: Shape, size: int) -> None:
    """Advance all lanes, each by its own step.

    The coordinates of all lanes stand one after the other, so one loop combines the slopes of
    them all; the block STEPS repeats the step length for each coordinate to that end.

    Reads the state (blocks POSITION, VELOCITY, ACCELERATION); leaves it, and writes the end of the
    step to the blocks AHEAD, AHEAD_RATE and AHEAD_ACCELERATION; where energy is audited, its mean
    flows over the step to GIVEN_MEAN and TAKEN_MEAN. `size` is (n + 1) L, told apart
    from the shape so that the loops stay loops, quick to compile.
    """
    n, L = floor_count(shape), len(shape.stride)
    start, block = SCALARS * L, (n + 1) * L
    step = start + STEPS * block
    x, dx = start + AHEAD * block, start + AHEAD_RATE * block
    ddx = start + AHEAD_ACCELERATION * block
    x1, v1, a1 = start + POSITION * block, start + VELOCITY * block, start + ACCELERATION * block
    v2, v3, v4, v5 = v1 + block, v1 + 2 * block, v1 + 3 * block, v1 + 4 * block
    a2, a3, a4, a5 = a1 + block, a1 + 2 * block, a1 + 3 * block, a1 + 4 * block
    for i in range(size):
        h = b[step + i] * (1 / 5)
        b[x + i] = b[x1 + i] + h * b[v1 + i]
        b[dx + i] = b[v1 + i] + h * b[a1 + i]
    accelerate(b, shape, 0, 1 / 5)
    start_powers(b, shape, 35 / 384)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v2 + i], b[a2 + i] = v, a
        b[x + i] = b[x1 + i] + h * ((3 / 40) * b[v1 + i] + (9 / 40) * v)
        b[dx + i] = b[v1 + i] + h * ((3 / 40) * b[a1 + i] + (9 / 40) * a)
    accelerate(b, shape, 0, 3 / 10)
    weigh_powers(b, shape, 500 / 1113)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v3 + i], b[a3 + i] = v, a
        b[x + i] = b[x1 + i] + h * ((44 / 45) * b[v1 + i] - (56 / 15) * b[v2 + i] + (32 / 9) * v)
        b[dx + i] = b[v1 + i] + h * ((44 / 45) * b[a1 + i] - (56 / 15) * b[a2 + i] + (32 / 9) * a)
    accelerate(b, shape, 0, 4 / 5)
    weigh_powers(b, shape, 125 / 192)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v4 + i], b[a4 + i] = v, a
        b[x + i] = b[x1 + i] + h * (
            (19372 / 6561) * b[v1 + i]
            - (25360 / 2187) * b[v2 + i]
            + (64448 / 6561) * b[v3 + i]
            - (212 / 729) * v
        )
        b[dx + i] = b[v1 + i] + h * (
            (19372 / 6561) * b[a1 + i]
            - (25360 / 2187) * b[a2 + i]
            + (64448 / 6561) * b[a3 + i]
            - (212 / 729) * a
        )
    accelerate(b, shape, 0, 8 / 9)
    weigh_powers(b, shape, -2187 / 6784)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[v5 + i], b[a5 + i] = v, a
        b[x + i] = b[x1 + i] + h * (
            (9017 / 3168) * b[v1 + i]
            - (355 / 33) * b[v2 + i]
            + (46732 / 5247) * b[v3 + i]
            + (49 / 176) * b[v4 + i]
            - (5103 / 18656) * v
        )
        b[dx + i] = b[v1 + i] + h * (
            (9017 / 3168) * b[a1 + i]
            - (355 / 33) * b[a2 + i]
            + (46732 / 5247) * b[a3 + i]
            + (49 / 176) * b[a4 + i]
            - (5103 / 18656) * a
        )
    accelerate(b, shape, 0, 1.0)
    weigh_powers(b, shape, 11 / 84)
    for i in range(size):
        h, v, a = b[step + i], b[dx + i], b[ddx + i]
        b[x + i] = b[x1 + i] + h * (
            (35 / 384) * b[v1 + i]
            + (500 / 1113) * b[v3 + i]
            + (125 / 192) * b[v4 + i]
            - (2187 / 6784) * b[v5 + i]
            + (11 / 84) * v
        )
        b[dx + i] = b[v1 + i] + h * (
            (35 / 384) * b[a1 + i]
            + (500 / 1113) * b[a3 + i]
            + (125 / 192) * b[a4 + i]
            - (2187 / 6784) * b[a5 + i]
            + (11 / 84) * a
        )
    accelerate(b, shape, 0, 1.0)


@merged
def start_powers(b: Floats, shape: Shape, weight: float) -> None:
    """Begin the mean of the energy flows over a step with those at its start."""
    L = len(shape.stride)
    if len(shape.audit) > 0:
        for l in range(lane_count(shape)):
            b[GIVEN_MEAN * L + l] = weight * b[GIVEN_FIRST * L + l]
            b[TAKEN_MEAN * L + l] = weight * b[TAKEN_FIRST * L + l]


@merged
def weigh_powers(b: Floats, shape: Shape, weight: float) -> None:
    """Add the energy flows of the present stage: the same quadrature as that of the motion."""
    L = len(shape.stride)
    if len(shape.audit) > 0:
        for l in range(lane_count(shape)):
            b[GIVEN_MEAN * L + l] += weight * b[GIVEN * L + l]
            b[TAKEN_MEAN * L + l] += weight * b[TAKEN * L + l]
