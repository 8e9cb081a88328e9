"""Looking at a step that was taken: does it hold an event; what does it demand; take it over.

Everything here runs over lanes together and without branches: a lane that must not be touched is
masked by its row QUIET.
"""

from __future__ import annotations

import math

from rpscli.physics.events import Quintic, lower_hull, quintic, upper_hull
from rpscli.physics.jit import kernel
from rpscli.physics.layout import (
    ACCELERATION,
    AHEAD,
    AHEAD_ACCELERATION,
    AHEAD_RATE,
    ARC,
    AT_SAMPLE,
    BASE,
    BASE_SHEAR,
    CAP_BEAM_MASS,
    COLUMNS_MASS,
    DIAMETER,
    FLOOR_ACCELERATION,
    FLOORS_MASS,
    FRICTION_BOTTOM,
    FRICTION_TOP,
    GROUND,
    GROUND_UPWARDS,
    HEIGHT,
    HIGH,
    LEVER,
    LOCATING,
    LOW,
    NORMAL_BOTTOM,
    NORMAL_TOP,
    POSITION,
    QUIET,
    SCALARS,
    SIDE,
    STANDARD_GRAVITY,
    STEP,
    STIFFNESS,
    STOREY_SHEAR,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Shape


@kernel
def tilt_path(b: Floats, n: int, L: int, l: int) -> Quintic:
    """The tilt of a lane over the step just taken."""
    return quintic(
        b[STEP * L + l],
        b[(SCALARS + POSITION * (n + 1)) * L + l],
        b[(SCALARS + VELOCITY * (n + 1)) * L + l],
        b[(SCALARS + ACCELERATION * (n + 1)) * L + l],
        b[(SCALARS + AHEAD * (n + 1)) * L + l],
        b[(SCALARS + AHEAD_RATE * (n + 1)) * L + l],
        b[(SCALARS + AHEAD_ACCELERATION * (n + 1)) * L + l],
    )


@kernel
def search_events(b: Floats, shape: Shape) -> None:
    """Write QUIET: 1 where the tilt surely stays in the range of its phase, and is finite."""
    n, L = len(shape.floors), len(shape.stride)
    for l in range(len(shape.lanes)):
        path = tilt_path(b, n, L, l)
        lowest, highest = min(lower_hull(path), path[0]), max(upper_hull(path), path[0])
        inside = lowest >= b[LOW * L + l] and highest <= b[HIGH * L + l]
        cleared = b[LOCATING * L + l] < 0.0 and math.isfinite(path[5])
        cruising = b[LOCATING * L + l] == 0.0
        b[QUIET * L + l] = 1.0 if cleared or (cruising and inside) else 0.0


@kernel
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


@kernel
def friction(shear: float, normal: float) -> float:
    """|F|/N; infinite once the contact is lost."""
    return abs(shear) / normal if normal > 0.0 else math.inf


@kernel
def observe(b: Floats, shape: Shape) -> None:
    """Raise the demands of lanes whose quiet step ends at a sample of the record."""
    n, L = len(shape.floors), len(shape.stride)
    rows = (n + 1) * L
    block = SCALARS * L
    for i in range(n):
        here = block + AHEAD * rows + (i + 1) * L
        below = here - L if i > 0 else BASE * L
        acceleration = block + AHEAD_ACCELERATION * rows + (i + 1) * L
        k = block + STIFFNESS * rows + i * L
        shears = block + STOREY_SHEAR * rows + i * L
        accelerations = block + FLOOR_ACCELERATION * rows + i * L
        for l in range(len(shape.lanes)):
            seen = b[QUIET * L + l] * b[AT_SAMPLE * L + l] > 0.0
            shear = abs(b[k + l] * (b[here + l] - b[below + l]))
            absolute = abs(b[acceleration + l] + b[GROUND * L + l])
            b[shears + l] = shear if seen and shear > b[shears + l] else b[shears + l]
            higher = seen and absolute > b[accelerations + l]
            b[accelerations + l] = absolute if higher else b[accelerations + l]
    velocity = block + AHEAD_RATE * rows
    tilting = block + AHEAD_ACCELERATION * rows
    for l in range(len(shape.lanes)):
        look = b[QUIET * L + l] * b[AT_SAMPLE * L + l]
        rate, acceleration = b[velocity + l], b[tilting + l]
        B, C, c = b[LEVER * L + l], b[HEIGHT * L + l], b[ARC * L + l]
        across = b[SIDE * L + l] * b[DIAMETER * L + l] * (C * acceleration + B * (rate * rate))
        upwards = b[DIAMETER * L + l] * (B * acceleration + (c - C) * (rate * rate))
        raise_contacts(b, L, l, look, across, upwards, b[BASE_SHEAR * L + l])


@kernel
def raise_contacts(
    b: Floats, L: int, l: int, look: float, across: float, upwards: float, V: float
) -> None:
    """Raise friction demands and lower least normal forces of a lane, where look > 0."""
    seen = look > 0.0
    cap_beam, floors = b[CAP_BEAM_MASS * L + l], b[FLOORS_MASS * L + l]
    columns, g = b[COLUMNS_MASS * L + l], b[STANDARD_GRAVITY * L + l]
    upper, lower = cap_beam + floors, cap_beam + floors + columns
    shear_top, shear_bottom, normal_top, normal_bottom = contact_forces(
        cap_beam,
        floors,
        columns,
        across,
        upwards,
        V,
        b[GROUND * L + l],
        b[GROUND_UPWARDS * L + l],
    )
    loaded = seen and upper > 0.0
    top, bottom = friction(shear_top, normal_top), friction(shear_bottom, normal_bottom)
    light_top = normal_top / (upper * g) if upper > 0.0 else math.inf
    light_bottom = normal_bottom / (lower * g)
    row = FRICTION_TOP * L + l
    b[row] = top if loaded and top > b[row] else b[row]
    row = FRICTION_BOTTOM * L + l
    b[row] = bottom if seen and bottom > b[row] else b[row]
    row = NORMAL_TOP * L + l
    b[row] = light_top if loaded and light_top < b[row] else b[row]
    row = NORMAL_BOTTOM * L + l
    b[row] = light_bottom if seen and light_bottom < b[row] else b[row]


@kernel
def take_over(b: Floats, shape: Shape) -> None:
    """Make the end of a quiet step the state of its lane."""
    n, L = len(shape.floors), len(shape.stride)
    rows = (n + 1) * L
    for state, ahead in (
        (POSITION, AHEAD),
        (VELOCITY, AHEAD_RATE),
        (ACCELERATION, AHEAD_ACCELERATION),
    ):
        start, end = SCALARS * L + state * rows, SCALARS * L + ahead * rows
        for c in range(0, rows, L):
            for l in range(len(shape.lanes)):
                i = c + l
                b[start + i] = b[end + i] if b[QUIET * L + l] > 0.0 else b[start + i]
