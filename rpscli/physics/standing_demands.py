"""What a building in full contact demands, at all instants of a block at once."""

from __future__ import annotations

import math

from rpscli.physics.contact_layout import (
    AT,
    COLUMNS,
    FRICTION_BOTTOMS,
    FRICTION_TOPS,
    MODAL_PULL,
    MODAL_Q,
    NORMAL_BOTTOMS,
    NORMAL_TOPS,
    PULL,
    PULLED,
    PUSH,
    RISE,
    SEEN,
    SHAPES,
    SHEAR,
    STRAIN,
)
from rpscli.physics.floor_demands import reach_of
from rpscli.physics.inspection import contact_measures
from rpscli.physics.lane import Lane
from rpscli.physics.lanes import written
from rpscli.physics.layout import (
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    FLOOR_ACCELERATION,
    FLOORS_MASS,
    FRICTION_BOTTOM,
    FRICTION_TOP,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    PULLED_BOUND,
    PULLED_REACH,
    STANDARD_GRAVITY,
    STOREY_SHEAR,
    STRAIN_BOUND,
    STRAIN_REACH,
)
from rpscli.physics.parameters import Block, Floats
from rpscli.physics.part import lane_routine, part, routine


@part
def forget(block: Block) -> None:
    """Begin a time in full contact: nothing was demanded yet."""
    c = block.rows
    for k in range(COLUMNS):
        c[FRICTION_TOPS * COLUMNS + k], c[FRICTION_BOTTOMS * COLUMNS + k] = 0.0, 0.0
        c[NORMAL_TOPS * COLUMNS + k], c[NORMAL_BOTTOMS * COLUMNS + k] = math.inf, math.inf


@part
def mark_samples(c: Floats, first: int, last: int, each: int) -> None:
    """Write SEEN: 1 at the instants first, first + each, ... up to last."""
    for k in range(COLUMNS):
        c[SEEN * COLUMNS + k] = 0.0
    for k in range(first, last + 1, each):
        c[SEEN * COLUMNS + k] = 1.0


@part
def set_reach(lane: Lane) -> None:
    """Note what no storey and no floor has reached yet, see `floor_demands`."""
    s, x = lane.numbers, lane.blocks
    strain, pulled = math.inf, math.inf
    for i in range(x.shape[1]):
        shear, top = x[STOREY_SHEAR, i], x[FLOOR_ACCELERATION, i]
        strain = min(strain, reach_of(shear, x[STRAIN_BOUND, i]))
        pulled = min(pulled, reach_of(top, x[PULLED_BOUND, i]))
    s[STRAIN_REACH], s[PULLED_REACH] = strain, pulled


@lane_routine
def may_raise(c: Floats, strain: float, pulled: float) -> bool:
    """Whether a sample is strained or pulled by more than that, see `floor_demands`."""
    found = 0
    for k in range(COLUMNS):
        more = (c[STRAIN * COLUMNS + k] > strain) | (c[PULLED * COLUMNS + k] > pulled)
        found |= 1 if more & (c[SEEN * COLUMNS + k] > 0.0) else 0
    return found > 0


@routine
def observe_floors(block: Block, z: Floats, shears: Floats, accelerations: Floats) -> None:
    """Raise the largest storey shears and absolute floor accelerations (n,)."""
    c, n = block.rows, z.shape[1]
    threes = n - n % 3
    for i in range(n):
        for k in range(COLUMNS):
            c[SHEAR * COLUMNS + k], c[PULL * COLUMNS + k] = 0.0, 0.0
        for r in range(0, threes, 3):
            add_modes(block, z, i, r)
        for r in range(threes, n):
            qs, pulls = block.modes[r, MODAL_Q], block.modes[r, MODAL_PULL]
            shape, shear = z[SHAPES + r, i], z[SHAPES + n + r, i]
            for k in range(COLUMNS):
                c[SHEAR * COLUMNS + k] += shear * qs[k]
                c[PULL * COLUMNS + k] += shape * pulls[k]
        shears[i] = max(shears[i], largest_seen(c, SHEAR))
        accelerations[i] = max(accelerations[i], largest_seen(c, PULL))


@part
def largest_seen(c: Floats, row: int) -> float:
    """Largest absolute value of a row at samples; overwrites the row."""
    for k in range(COLUMNS):
        c[row * COLUMNS + k] = c[SEEN * COLUMNS + k] * abs(c[row * COLUMNS + k])
    half = COLUMNS // 2  # halved so that the compiler compares vectors
    while half >= 4:
        for k in range(half):
            one, other = c[row * COLUMNS + k], c[row * COLUMNS + half + k]
            c[row * COLUMNS + k] = written(max(one, other))
        half //= 2
    first = row * COLUMNS
    return float(max(c[first], c[first + 1], c[first + 2], c[first + 3]))


@part
def add_modes(block: Block, z: Floats, i: int, r: int) -> None:
    """Add what the modes r, r + 1 and r + 2 contribute at floor i: the sum waits in a register."""
    c, modes, n = block.rows, block.modes, z.shape[1]
    q0, q1, q2 = modes[r, MODAL_Q], modes[r + 1, MODAL_Q], modes[r + 2, MODAL_Q]
    a0, a1, a2 = modes[r, MODAL_PULL], modes[r + 1, MODAL_PULL], modes[r + 2, MODAL_PULL]
    row = SHAPES + n + r
    s0, s1, s2 = z[row, i], z[row + 1, i], z[row + 2, i]
    for k in range(COLUMNS):
        shear = c[SHEAR * COLUMNS + k]
        c[SHEAR * COLUMNS + k] = shear + s0 * q0[k] + s1 * q1[k] + s2 * q2[k]
    row = SHAPES + r
    s0, s1, s2 = z[row, i], z[row + 1, i], z[row + 2, i]
    for k in range(COLUMNS):
        pull = c[PULL * COLUMNS + k]
        c[PULL * COLUMNS + k] = pull + s0 * a0[k] + s1 * a1[k] + s2 * a2[k]


@lane_routine
def observe_contacts(c: Floats, s: Floats) -> None:
    """Raise friction demands and lower least normal forces, column by column.

    `s` are the numbers of the lane.
    """
    cap_beam, floors = s[CAP_BEAM_MASS], s[FLOORS_MASS]
    columns, gravity = s[COLUMNS_MASS], s[STANDARD_GRAVITY]
    for k in range(COLUMNS):
        seen, V = c[SEEN * COLUMNS + k] > 0.0, c[PUSH * COLUMNS + k]
        across, upwards = c[AT * COLUMNS + k], c[RISE * COLUMNS + k]
        top, bottom, light_top, light_bottom = contact_measures(
            cap_beam, floors, columns, 0.0, 0.0, V, across, upwards, gravity
        )
        row = FRICTION_TOPS * COLUMNS + k
        c[row] = written(max(c[row], top if seen else 0.0))
        row = FRICTION_BOTTOMS * COLUMNS + k
        c[row] = written(max(c[row], bottom if seen else 0.0))
        row = NORMAL_TOPS * COLUMNS + k
        c[row] = written(min(c[row], light_top if seen else math.inf))
        row = NORMAL_BOTTOMS * COLUMNS + k
        c[row] = written(min(c[row], light_bottom if seen else math.inf))


@routine
def hand_over(lane: Lane) -> None:
    """End a time in full contact: raise the demands of the lane by its own."""
    s, c = lane.numbers, lane.block.rows
    for k in range(COLUMNS):
        s[FRICTION_TOP] = max(s[FRICTION_TOP], c[FRICTION_TOPS * COLUMNS + k])
        s[FRICTION_BOTTOM] = max(s[FRICTION_BOTTOM], c[FRICTION_BOTTOMS * COLUMNS + k])
        s[NORMAL_TOP] = min(s[NORMAL_TOP], c[NORMAL_TOPS * COLUMNS + k])
        s[NORMAL_BOTTOM] = min(s[NORMAL_BOTTOM], c[NORMAL_BOTTOMS * COLUMNS + k])
