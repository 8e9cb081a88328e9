"""Taylor series of the uplifted motion over a step.

With B' = (c - C) x', C' = B x' and the ground's acceleration linear in time, every term of the
motion follows from those before it by sums of products (A. Jorba and M. Zou, Exp. Math. 14 (2005)
99-117; Theory, section 10). Coefficients are those of powers of t/h, h the step: f = f_0 + f_1 t/h
+ ..., so that a term is what it adds to the end, and derivatives are m/h times the next term:

    B_m = -(h/m) sum (C - c)_j x'_(m-1-j)           C_m = (h/m) sum B_j x'_(m-1-j)
    A_m = 2 c (1 + 4 gamma) C_m + 4 gamma eta sum B_j B_(m-j)
    sum (m + j)/2 A_(m-j) x'_j = -h R_(m-1)         from A x'' + A' x'/2 = -R
    R = (1 + 2 gamma + 2 gamma eta) B (g + a_v)/R + C s (a_g/R (1 + 2 gamma) - 2 V/(N m_c R))
    q'_m = -Gamma (h/m a_g + s 2R sum C_j x'_(m-j))_m - (h/m) pull_(m-1)

No term is computed twice, an event is a root of a polynomial, and where the step ends is free to
choose afterwards.
"""

from __future__ import annotations

from rpscli.physics.acceleration import accelerate
from rpscli.physics.lanes import floor_count, lane_count
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    ACTIONS,
    ARC,
    BASE_SHEAR,
    BEAM,
    BUILDING,
    DIAMETER,
    DQ,
    DRAG,
    FORCING,
    HEIGHT,
    HEIGHTS,
    INERTIAS,
    LEVER,
    LEVERS,
    NEXT_DQ,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    PARTICIPATION,
    PER_INERTIA,
    PULL,
    PUSH,
    RATE,
    RATES,
    SCALARS,
    SHEAR,
    SIDE,
    SQUARE,
    STEP,
    TILT,
    TIME,
    TURN,
    UPWARDS,
    UPWARDS_SLOPE,
    WEIGHT,
    Q,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part


@lane_routine
def step(b: Floats, shape: Shape) -> None:
    """Advance all lanes, each by its own step.

    Reads the state (rows TILT to BASE_SHEAR, blocks Q and DQ); leaves it, and writes the series
    (rows from RATES on, blocks from DQ on) and the end of the step: rows from NEXT_TILT on, blocks
    NEXT_Q, NEXT_DQ and PULL.
    """
    begin_series(b, shape)
    extend(b, shape, 1)
    extend(b, shape, 2)
    extend(b, shape, 3)
    extend(b, shape, 4)
    extend(b, shape, 5)
    extend(b, shape, 6)
    extend(b, shape, 7)
    add_up(b, shape)
    accelerate(b, shape, 0, 1.0)


@part
def begin_series(b: Floats, shape: Shape) -> None:
    """Terms of order 0: the state.

    Its pull is formed again: a step may be repeated, and then PULL is already that of its end.
    """
    n, L = floor_count(shape), len(shape.stride)
    for l in range(lane_count(shape)):
        b[RATES * L + l] = b[RATE * L + l]
        b[LEVERS * L + l] = b[LEVER * L + l]
        b[HEIGHTS * L + l] = b[HEIGHT * L + l]
        ground = b[ACROSS * L + l] + b[ACROSS_SLOPE * L + l] * b[TIME * L + l]
        action = ground * b[PUSH * L + l] - b[BASE_SHEAR * L + l] * b[SHEAR * L + l]
        b[ACTIONS * L + l] = b[SIDE * L + l] * action
    for r in range(n):
        row = (SCALARS + r) * L
        for l in range(lane_count(shape)):
            b[row + PULL * n * L + l] = (
                b[row + SQUARE * n * L + l] * b[row + Q * n * L + l]
                + b[row + DRAG * n * L + l] * b[row + DQ * n * L + l]
            )


@part
def extend(b: Floats, shape: Shape, m: int) -> None:
    """Terms of order m. The compiler is to know m, so that its sums have no loop."""
    extend_tilt(b, shape, m)
    extend_modes(b, shape, m)


@part
def extend_tilt(b: Floats, shape: Shape, m: int) -> None:
    """Terms of order m of the contact geometry and of x', and what they ask of the floors."""
    L, k = len(shape.stride), m - 1
    for l in range(lane_count(shape)):
        h = b[STEP * L + l]
        part = h * (1.0 / m)
        B, C = b[LEVERS * L + l], b[HEIGHTS * L + l]
        arc, building = b[ARC * L + l], b[BUILDING * L + l]
        rate, late = b[RATES * L + l], b[(RATES + k) * L + l]
        turns = (C - arc) * late + products(b, L, l, HEIGHTS, RATES, k)
        rises = B * late + products(b, L, l, LEVERS, RATES, k)
        if m > 1:
            turns += b[(HEIGHTS + k) * L + l] * rate
            rises += b[(LEVERS + k) * L + l] * rate
        lever, height = -part * turns, part * rises
        square = 2.0 * B * lever + products(b, L, l, LEVERS, LEVERS, m)
        b[(LEVERS + m) * L + l] = lever
        b[(HEIGHTS + m) * L + l] = height
        b[(INERTIAS + m) * L + l] = 2.0 * arc * b[BEAM * L + l] * height + building * square
        if m == 1:
            turn = h * b[TURN * L + l]
            ground = b[ACROSS * L + l] + b[ACROSS_SLOPE * L + l] * b[TIME * L + l]
        else:
            upwards = b[UPWARDS * L + l] + b[UPWARDS_SLOPE * L + l] * b[TIME * L + l]
            climb = h * b[UPWARDS_SLOPE * L + l]
            weights = upwards * b[(LEVERS + k) * L + l] + climb * b[(LEVERS + k - 1) * L + l]
            force = b[WEIGHT * L + l] * weights + b[(HEIGHTS + k) * L + l] * b[ACTIONS * L + l]
            force += products(b, L, l, HEIGHTS, ACTIONS, k)
            per_inertia = b[PER_INERTIA * L + l]
            turn = -(per_inertia * part * C) * b[(ACTIONS + k) * L + l] - per_inertia * (
                part * force + inertial(b, L, l, m)
            )
            ground = h * b[ACROSS_SLOPE * L + l] if m == 2 else 0.0
        b[(RATES + m) * L + l] = turn
        across = b[SIDE * L + l] * b[DIAMETER * L + l]
        path = height * rate + products(b, L, l, HEIGHTS, RATES, m)
        b[FORCING * L + l] = (across * C) * turn + (across * path + part * ground)


@part
def products(b: Floats, L: int, l: int, one: int, other: int, m: int) -> float:
    """The sum of one_j other_(m-j) over 0 < j < m, by series that begin in these rows."""
    total = 0.0
    if m > 1:
        total += b[(one + 1) * L + l] * b[(other + m - 1) * L + l]
    if m > 2:
        total += b[(one + 2) * L + l] * b[(other + m - 2) * L + l]
    if m > 3:
        total += b[(one + 3) * L + l] * b[(other + m - 3) * L + l]
    if m > 4:
        total += b[(one + 4) * L + l] * b[(other + m - 4) * L + l]
    if m > 5:
        total += b[(one + 5) * L + l] * b[(other + m - 5) * L + l]
    if m > 6:
        total += b[(one + 6) * L + l] * b[(other + m - 6) * L + l]
    return total


@part
def inertial(b: Floats, L: int, l: int, m: int) -> float:
    """The sum of (m + j)/2m A_(m-j) x'_j over 0 <= j < m."""
    total = float(0.5 * b[(INERTIAS + m) * L + l] * b[RATES * L + l])
    if m > 1:
        total += (0.5 * (m + 1) / m) * b[(INERTIAS + m - 1) * L + l] * b[(RATES + 1) * L + l]
    if m > 2:
        total += (0.5 * (m + 2) / m) * b[(INERTIAS + m - 2) * L + l] * b[(RATES + 2) * L + l]
    if m > 3:
        total += (0.5 * (m + 3) / m) * b[(INERTIAS + m - 3) * L + l] * b[(RATES + 3) * L + l]
    if m > 4:
        total += (0.5 * (m + 4) / m) * b[(INERTIAS + m - 4) * L + l] * b[(RATES + 4) * L + l]
    if m > 5:
        total += (0.5 * (m + 5) / m) * b[(INERTIAS + m - 5) * L + l] * b[(RATES + 5) * L + l]
    if m > 6:
        total += (0.5 * (m + 6) / m) * b[(INERTIAS + m - 6) * L + l] * b[(RATES + 6) * L + l]
    return total


@part
def extend_modes(b: Floats, shape: Shape, m: int) -> None:
    """Terms of order m of the modes, their pull, and with it the action on the tilt."""
    n, L = floor_count(shape), len(shape.stride)
    shear = (ACTIONS + m) * L
    for l in range(lane_count(shape)):
        b[shear + l] = 0.0
    threes = n - n % 3
    for r in range(0, threes, 3):
        row = (SCALARS + r) * L
        for l in range(lane_count(shape)):
            b[shear + l] += (
                extend_mode(b, n, L, row + l, l, m)
                + extend_mode(b, n, L, row + L + l, l, m)
                + extend_mode(b, n, L, row + 2 * L + l, l, m)
            )
    for r in range(threes, n):
        row = (SCALARS + r) * L
        for l in range(lane_count(shape)):
            b[shear + l] += extend_mode(b, n, L, row + l, l, m)
    for l in range(lane_count(shape)):
        ground = b[STEP * L + l] * b[ACROSS_SLOPE * L + l] * b[PUSH * L + l] if m == 1 else 0.0
        side = b[SIDE * L + l]
        b[shear + l] = side * ground - (side * b[SHEAR * L + l]) * b[shear + l]


@part
def extend_mode(b: Floats, n: int, L: int, at: int, l: int, m: int) -> float:
    """Terms of order m of a mode whose rows begin at entry `at`; returns what it adds to V."""
    part, blocks = b[STEP * L + l] * (1.0 / m), n * L
    participation, pulls = b[at + PARTICIPATION * blocks], at + PULL * blocks
    q = part * b[at + (DQ + m - 1) * blocks]
    dq = -participation * b[FORCING * L + l] - part * b[pulls]
    pull = b[at + DRAG * blocks] * dq + b[at + SQUARE * blocks] * q
    b[at + (DQ + m) * blocks] = dq
    b[pulls] = pull
    return float(participation * pull)


@part
def add_up(b: Floats, shape: Shape) -> None:
    """The end of the step: the sum of all terms."""
    n, L = floor_count(shape), len(shape.stride)
    for l in range(lane_count(shape)):
        h = b[STEP * L + l]
        way, rate = sums(b, RATES * L + l, L)
        b[NEXT_TILT * L + l] = b[TILT * L + l] + h * way
        b[NEXT_RATE * L + l] = rate
    for r in range(n):
        row = (SCALARS + r) * L
        for l in range(lane_count(shape)):
            way, rate = sums(b, row + DQ * n * L + l, n * L)
            b[row + NEXT_Q * n * L + l] = b[row + Q * n * L + l] + b[STEP * L + l] * way
            b[row + NEXT_DQ * n * L + l] = rate


@part
def sums(b: Floats, at: int, stride: int) -> tuple[float, float]:
    """Integral over t/h from 0 to 1, and value at 1, of a series that begins at entry `at`."""
    t0, t1, t2 = b[at], b[at + stride], b[at + 2 * stride]
    t3, t4, t5 = b[at + 3 * stride], b[at + 4 * stride], b[at + 5 * stride]
    t6, t7 = b[at + 6 * stride], b[at + 7 * stride]
    late = t7 * 0.125 + t6 * (1.0 / 7.0) + t5 * (1.0 / 6.0) + t4 * 0.2
    way = late + t3 * 0.25 + t2 * (1.0 / 3.0) + t1 * 0.5 + t0
    return way, t7 + t6 + t5 + t4 + t3 + t2 + t1 + t0
