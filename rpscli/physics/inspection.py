"""Looking at a step that was taken: does it hold an event; what does it demand; take it over.

Everything here runs over lanes together and without branches: a lane that must not be touched is
masked by its row QUIET.
"""

from __future__ import annotations

import math

from rpscli.physics.events import Quintic, lower_hull, quintic, upper_hull
from rpscli.physics.lanes import floor_count, lane_count, written
from rpscli.physics.layout import (
    ARC,
    ATTEND,
    CAP_BEAM_MASS,
    CLEARED,
    COLUMNS_MASS,
    CRITICAL_TIME,
    DIAMETER,
    DQ,
    FLOORS_MASS,
    FRICTION_BOTTOM,
    FRICTION_TOP,
    GROUND,
    GROUND_UPWARDS,
    HIGH,
    LAST_TERM,
    LEFT,
    LOW,
    NEXT_BASE_SHEAR,
    NEXT_DQ,
    NEXT_HEIGHT,
    NEXT_LEVER,
    NEXT_Q,
    NEXT_RATE,
    NEXT_TILT,
    NEXT_TURN,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    ORDER,
    PEAK,
    PEAK_TIME,
    PULL,
    PULLED,
    PULLED_REACH,
    PULLED_WEIGHT,
    QUIET,
    RAISE,
    RATE,
    RATES,
    ROUGH,
    SCALARS,
    SEEN,
    SIDE,
    STANDARD_GRAVITY,
    START,
    STATE,
    STEP,
    STEPS,
    STRAIN,
    STRAIN_REACH,
    STRAIN_WEIGHT,
    THETA_CR,
    TILT,
    TIME,
    TURN,
    WATCH,
    Q,
)
from rpscli.physics.parameters import Floats, Shape
from rpscli.physics.part import lane_routine, part

MOST_STEPS = 4096.0
"""An interval is not divided further than that."""


@part
def tilt_path(b: Floats, L: int, l: int) -> Quintic:
    """The tilt of a lane over the step just taken."""
    return quintic(
        b[STEP * L + l],
        b[TILT * L + l],
        b[RATE * L + l],
        b[TURN * L + l],
        b[NEXT_TILT * L + l],
        b[NEXT_RATE * L + l],
        b[NEXT_TURN * L + l],
    )


@lane_routine
def search_events(b: Floats, shape: Shape) -> None:
    """Look for events in the step just taken.

    Writes ROUGH: 1 where the last term of the tilt's series says that the step is too long for it;
    QUIET: 1 where it is not, and the tilt surely stays in the range of its phase, and is finite;
    SEEN: 1 where a quiet step ends at a sample of the record; and WATCH: 1 where a quiet step may
    hold the largest tilt so far inside, or passes theta_cr for the first time.
    """
    L = len(shape.stride)
    for l in range(lane_count(shape)):
        path = tilt_path(b, L, l)
        lowest, highest = min(lower_hull(path), path[0]), max(upper_hull(path), path[0])
        inside = (lowest >= b[LOW * L + l]) & (highest <= b[HIGH * L + l])
        cleared = (b[CLEARED * L + l] > 0.0) & (abs(path[5]) < math.inf)
        first = abs(b[RATES * L + l]) + abs(b[(RATES + 1) * L + l]) + abs(b[(RATES + 2) * L + l])
        last = abs(b[(RATES + ORDER) * L + l])
        rough = (last > b[LAST_TERM * L + l] * first) & (b[LEFT * L + l] < MOST_STEPS)
        quiet = (cleared | inside) & (not rough)
        turning = (b[RATE * L + l] > 0.0) & (b[NEXT_RATE * L + l] < 0.0)
        higher = turning & (highest > b[PEAK * L + l])
        passing = (path[5] > b[THETA_CR * L + l]) & (b[CRITICAL_TIME * L + l] < 0.0)
        b[ROUGH * L + l] = 1.0 if rough else 0.0
        b[QUIET * L + l] = 1.0 if quiet else 0.0
        b[SEEN * L + l] = 1.0 if quiet & (b[LEFT * L + l] == 1.0) else 0.0
        b[WATCH * L + l] = 1.0 if quiet & (higher | passing) else 0.0


@part
def contact_forces(
    cap_beam: float,
    floors: float,
    columns: float,
    across: float,
    upwards: float,
    V: float,
    ground: float,
    gravity: float,
) -> tuple[float, float, float, float]:
    """Forces of all columns together on the beam, and of the ground on the columns [N].

    Parameters
    ----------
    cap_beam, floors, columns
        m_b, M_tot, N m_c [kg].
    across, upwards
        u_b'' and v_b'' relative to the ground [m/s2].
    V
        Base shear of the building, springs and dampers [N].
    ground, gravity
        a_g and g + a_v [m/s2].

    Returns
    -------
    F_top, F_bot, N_top, N_bot (Theory, section 8).
    """
    shear_top = cap_beam * (across + ground) - V
    shear_bottom = shear_top + columns * (0.5 * across + ground)
    normal_top = (cap_beam + floors) * (gravity + upwards)
    normal_bottom = normal_top + columns * (gravity + 0.5 * upwards)
    return shear_top, shear_bottom, normal_top, normal_bottom


@part
def friction(shear: float, normal: float) -> float:
    """|F|/N; infinite once the contact is lost."""
    return abs(shear) / normal if normal > 0.0 else math.inf


@lane_routine
def observe(b: Floats, shape: Shape) -> None:
    """Raise the demands of lanes whose quiet step ends at a sample of the record.

    The largest tilt is that of every step; `peak` sees to those that hold it inside. For storey
    shears and floor accelerations see `floor_demands`: RAISE becomes 1 where any may be raised.
    """
    n, L = floor_count(shape), len(shape.stride)
    for l in range(lane_count(shape)):
        b[STRAIN * L + l], b[PULLED * L + l] = 0.0, 0.0
    for r in range(n):
        row = (SCALARS + r) * L
        for l in range(lane_count(shape)):
            q, pull = b[row + NEXT_Q * n * L + l], b[row + PULL * n * L + l]
            b[STRAIN * L + l] += b[row + STRAIN_WEIGHT * n * L + l] * (q * q)
            b[PULLED * L + l] += b[row + PULLED_WEIGHT * n * L + l] * (pull * pull)
    for l in range(lane_count(shape)):
        strained = b[STRAIN * L + l] > b[STRAIN_REACH * L + l]
        pulled = b[PULLED * L + l] > b[PULLED_REACH * L + l]
        b[RAISE * L + l] = b[SEEN * L + l] if strained | pulled else 0.0
    for l in range(lane_count(shape)):
        rate, turn = b[NEXT_RATE * L + l], b[NEXT_TURN * L + l]
        B, C, c = b[NEXT_LEVER * L + l], b[NEXT_HEIGHT * L + l], b[ARC * L + l]
        across = b[SIDE * L + l] * b[DIAMETER * L + l] * (C * turn + B * (rate * rate))
        upwards = b[DIAMETER * L + l] * (B * turn + (c - C) * (rate * rate))
        raise_contacts(b, L, l, b[SEEN * L + l], across, upwards, b[NEXT_BASE_SHEAR * L + l])
    for l in range(lane_count(shape)):
        tilt = b[NEXT_TILT * L + l]
        higher = (b[QUIET * L + l] > b[WATCH * L + l]) & (tilt > b[PEAK * L + l])
        time = b[START * L + l] + (b[TIME * L + l] + b[STEP * L + l])
        b[PEAK * L + l] = written(tilt if higher else b[PEAK * L + l])
        b[PEAK_TIME * L + l] = written(time if higher else b[PEAK_TIME * L + l])


@part
def contact_measures(
    cap_beam: float,
    floors: float,
    columns: float,
    across: float,
    upwards: float,
    V: float,
    ground: float,
    ground_upwards: float,
    gravity: float,
) -> tuple[float, float, float, float]:
    """Friction demands |F|/N and normal forces over the weight on them, upper and lower ends.

    Parameters as in `contact_forces`, and the standard gravity g. Where no mass stands on the
    columns their upper ends demand nothing: friction 0, normal force infinite.
    """
    upper, lower = cap_beam + floors, cap_beam + floors + columns
    shear_top, shear_bottom, normal_top, normal_bottom = contact_forces(
        cap_beam, floors, columns, across, upwards, V, ground, ground_upwards
    )
    top = friction(shear_top, normal_top) if upper > 0.0 else 0.0
    light_top = normal_top / (upper * gravity) if upper > 0.0 else math.inf
    return top, friction(shear_bottom, normal_bottom), light_top, normal_bottom / (lower * gravity)


@part
def raise_contacts(
    b: Floats, L: int, l: int, look: float, across: float, upwards: float, V: float
) -> None:
    """Raise friction demands and lower least normal forces of a lane, where look > 0."""
    seen = look > 0.0
    top, bottom, light_top, light_bottom = contact_measures(
        b[CAP_BEAM_MASS * L + l],
        b[FLOORS_MASS * L + l],
        b[COLUMNS_MASS * L + l],
        across,
        upwards,
        V,
        b[GROUND * L + l],
        b[GROUND_UPWARDS * L + l],
        b[STANDARD_GRAVITY * L + l],
    )
    # What is not looked at counts as nothing; without branches, so that lanes go together.
    row = FRICTION_TOP * L + l
    b[row] = written(max(b[row], top if seen else 0.0))
    row = FRICTION_BOTTOM * L + l
    b[row] = written(max(b[row], bottom if seen else 0.0))
    row = NORMAL_TOP * L + l
    b[row] = written(min(b[row], light_top if seen else math.inf))
    row = NORMAL_BOTTOM * L + l
    b[row] = written(min(b[row], light_bottom if seen else math.inf))


@lane_routine
def take_over(b: Floats, shape: Shape) -> None:
    """Make the end of a quiet step the state of its lane."""
    n, L = floor_count(shape), len(shape.stride)
    for i in range(STATE):
        keep_end(b, shape, TILT + i, NEXT_TILT + i)
    for r in range(n):
        keep_end(b, shape, SCALARS + Q * n + r, SCALARS + NEXT_Q * n + r)
    for r in range(n):
        keep_end(b, shape, SCALARS + DQ * n + r, SCALARS + NEXT_DQ * n + r)
    for l in range(lane_count(shape)):
        quiet = b[QUIET * L + l] > 0.0
        b[TIME * L + l] += b[STEP * L + l] if quiet else 0.0
        left = b[LEFT * L + l] - (1.0 if quiet else 0.0)
        b[LEFT * L + l] = left
        b[ATTEND * L + l] = 0.0 if quiet & (left > 0.0) else 1.0
        b[CLEARED * L + l] = 0.0
        b[STEPS * L + l] += 1.0


@part
def keep_end(b: Floats, shape: Shape, state: int, end: int) -> None:
    """Copy a row of the step's end to that of its start."""
    L = len(shape.stride)
    for l in range(lane_count(shape)):
        # Adding zero keeps the compiler from choosing between addresses, lane by lane.
        old, new = b[state * L + l], b[end * L + l] + 0.0
        b[state * L + l] = new if b[QUIET * L + l] > 0.0 else old
