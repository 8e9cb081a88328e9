"""Where a step is to end: found between its ends, then taken again to the root.

What is watched is smooth and leaves a range downwards: the tilt its phase's, the margin
of a storey at rest its zero, a device's value its branch. Hulls of the polynomials
through both ends tell, for all lanes together, which steps surely hold no event; only the
others are looked at alone. A step that is to end on an event is taken again, its length
corrected by Newton's method.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.acting import has_friction
from rpscli.physics.devices.branches import WATCHED, may_be_watched, slowing, watched
from rpscli.physics.friction import grip_at, is_gripped
from rpscli.physics.lane import (
    felt_at,
    g_up_at,
    ground_at,
    is_cone,
    lanes_of,
    pushed_by,
    rate_of,
    vector,
    ways_of,
    z_at,
    z_of,
)
from rpscli.physics.laws.place import length
from rpscli.physics.quintic import (
    NO_PASSAGE,
    Quintic,
    cubic,
    first_descent,
    lower_hull,
    offset,
    quintic,
    upper_hull,
)
from rpscli.physics.state import (
    NOTHING,
    STUCK,
    Record,
)
from rpscli.physics.storeys import drift_of

LEAST_STEP = 1e-13
"""Of the sampling interval: a step is not made shorter."""

ROUNDING = 1e-13
"""Share of the limit within which the margin at rest is zero. Were it the last bit that
decides, a motion whose peak is the limit itself would uplift and land again and again."""


@inlined
def path_of(s: Record, l: int) -> Quintic:
    """The tilt over the step just taken."""
    return quintic(s.h[l], s.x[l], s.v[l], s.a[l], s.new_x[l], s.new_v[l], s.new_a[l])


@inlined
def path_in_range(s: Record, l: int) -> tuple[Quintic, float, float]:
    """The tilt over the step and its range; the squares of both where it
    passes upright smoothly.

    There x = |r| turns at once, and what is smooth is its square.
    """
    if ways_of(s) == 1:
        return path_of(s, l), s.x_low[l], s.x_high[l]
    x = 0.0
    v = 0.0
    a = 0.0
    new_x = 0.0
    new_v = 0.0
    new_a = 0.0
    for axis in range(ways_of(s)):
        tilt = s.tilt[axis, l]
        rate = s.tilt_rate[axis, l]
        new_tilt = s.new_tilt[axis, l]
        new_rate = s.new_tilt_rate[axis, l]
        x = x + tilt * tilt
        v = v + tilt * rate
        a = a + rate * rate + tilt * s.bend[axis, l]
        new_x = new_x + new_tilt * new_tilt
        new_v = new_v + new_tilt * new_rate
        new_a += new_rate * new_rate + new_tilt * s.new_bend[axis, l]
    low = s.x_low[l] * abs(s.x_low[l])
    high = s.x_high[l] * s.x_high[l]
    x = min(max(x, low), high)  # what begins at an end is rounded
    as_cone = s.cone[l] > 0.0
    path = quintic(
        s.h[l],
        s.x[l] if as_cone else x,
        s.v[l] if as_cone else 2.0 * v,
        s.a[l] if as_cone else 2.0 * a,
        s.new_x[l] if as_cone else new_x,
        s.new_v[l] if as_cone else 2.0 * new_v,
        s.new_a[l] if as_cone else 2.0 * new_a,
    )
    return path, (s.x_low[l] if as_cone else low), (s.x_high[l] if as_cone else high)


@inlined
def push_path(s: Record, l: int, axis: int) -> Quintic:
    """R z over the step, what pushes a storey at rest [m/s2]."""
    R = 0.5 * s.diameter[l]
    h = s.h[l]
    slope = s.a_g_slope[axis, l]
    start = ground_at(s, l, axis, s.time[l])
    return quintic(
        h,
        R * z_of(s, l, s.V[axis, l], start),
        R * z_of(s, l, s.dV[axis, l], slope),
        R * pushed_by(s, l, s.ddV[axis, l]),
        R * z_of(s, l, s.new_V[axis, l], start + h * slope),
        R * z_of(s, l, s.new_dV[axis, l], slope),
        R * pushed_by(s, l, s.new_ddV[axis, l]),
    )


@inlined
def relief_path(s: Record, l: int) -> Quintic:
    """g + a_v less what contacts feel of it over the step [m/s2]: 0
    without springs upwards.
    """
    up = ways_of(s)
    spared = s.spared[l]
    h = s.h[l]
    mass = s.floors_mass[l]
    start = s.g_up[l] - s.gravity[l] + s.time[l] * s.g_up_slope[l]
    end = start + h * s.g_up_slope[l]
    rate = mass * s.g_up_slope[l]
    return quintic(
        h,
        spared * (mass * start + s.V[up, l]),
        spared * (rate + s.dV[up, l]),
        spared * s.ddV[up, l],
        spared * (mass * end + s.new_V[up, l]),
        spared * (rate + s.new_dV[up, l]),
        spared * s.new_ddV[up, l],
    )


@inlined
def surely_held(s: Record, l: int) -> bool:
    """True if the margin of a lane at rest surely stays positive over the step."""
    start = g_up_at(s, l, s.time[l])
    end = start + s.h[l] * s.g_up_slope[l]
    x = push_path(s, l, 0)
    relief = relief_path(s, l)
    most_spared = max(upper_hull(relief), relief[0])
    least_spared = min(lower_hull(relief), relief[0])
    right = min(s.limit_right[l] * start, s.limit_right[l] * end) + s.held_right[l]
    right -= max(s.limit_right[l] * most_spared, s.limit_right[l] * least_spared)
    if ways_of(s) == 2:
        y = push_path(s, l, 1)
        most = 0.0
        for i in range(6):
            off_x = x[i] - s.held_x[l]
            off_y = y[i] - s.held_y[l]
            most = max(most, off_x * off_x + off_y * off_y)
        # else what holds it moves
        steady = (start == s.gravity[l]) & (end == start) & (s.axes == 2)
        within = (right >= 0.0) & (most <= right * right)
        return within & (steady | (s.phase[l] != STUCK))  # type: ignore[no-any-return]
    left = min(s.limit_left[l] * start, s.limit_left[l] * end) + s.held_left[l]
    left -= max(s.limit_left[l] * most_spared, s.limit_left[l] * least_spared)
    held = (max(upper_hull(x), x[0]) <= right) & (-min(lower_hull(x), x[0]) <= left)
    return held  # type: ignore[no-any-return]  # noqa: RET504 -- bool() would be a branch


CIRCLING = 1e-9
"""Of the tilt's speed: what approaches upright by less goes
round it, but for rounding."""


@inlined
def falls(s: Record, l: int) -> bool:
    """True if a tilt to any side approaches upright at the start of the step."""
    x, y = rate_of(s, l)
    least = CIRCLING * CIRCLING * (x * x + y * y)
    v = s.v[l]
    return is_cone(s, l) & (v < 0.0) & (v * v > least)  # type: ignore[no-any-return]


@inlined
def check_steps(s: Record, systems: Record, stands: bool) -> None:
    """Accept the steps that are short enough and surely hold no event;
    of lanes that all stand.
    """
    if stands:
        for l in range(lanes_of(s)):
            held = surely_held(s, l) & (s.wanted[l] == NOTHING)
            s.accepted[l] = 1.0 if held else 0.0
    else:
        check_all_steps(s)
    if s.yielding > 0:
        for l in range(lanes_of(s)):
            if (
                s.yields[l] > 0
                and s.accepted[l] > 0.0
                and first_yield(s, l, systems)[0] <= 1.0
            ):
                s.accepted[l] = 0.0


@compiled
def check_all_steps(s: Record) -> None:
    """Check the steps of all lanes."""
    for l in range(lanes_of(s)):
        moves = s.moves[l] > 0.0
        path, low, high = path_in_range(s, l)
        lowest = min(lower_hull(path), path[0])
        highest = max(upper_hull(path), path[0])
        inside = (lowest >= low) & (highest <= high)
        inside &= (not falls(s, l)) | (s.new_v[l] < 0.0)
        clear = inside if moves else surely_held(s, l)
        short = (s.error[l] <= 1.0) | (s.h[l] <= LEAST_STEP * s.dt[l])
        s.accepted[l] = 1.0 if clear & short & (s.wanted[l] == NOTHING) else 0.0
    if s.equipped > 0:
        for l in range(lanes_of(s)):
            value, slope = slowing(s, l, 0)
            end, end_slope = slowing(s, l, 1)
            path = cubic(s.h[l], max(value, 0.0), slope, end, end_slope)
            stops = has_friction(s, l) & (min(lower_hull(path), path[0]) < 0.0)
            s.accepted[l] = 0.0 if stops & (s.moves[l] > 0.0) else s.accepted[l]
        for l in range(lanes_of(s)):
            if (
                s.branched[l] > 0.0
                and s.accepted[l] > 0.0
                and s.moves[l] > 0.0
                and may_change(s, l)
            ):
                s.accepted[l] = 0.0


UNLOADED = 1e-12
"""Of its strength: so much more yields a storey anew that has just
turned back, by rounding."""


@compiled
def storey_paths(s: Record, l: int, systems: Record, r: int) -> tuple[Quintic, Quintic]:
    """Values that fall below zero where a storey yields to the left or to the right, or
    no longer does.

    Cubics over the step: its force is so far from either strength; or
    both the rate of its drift.
    """
    axis = r // s.n
    i = r % s.n
    h = s.h[l]
    system = systems[s.system[l] + axis]
    F = s.strength[r, l] * (1.0 + UNLOADED)
    d0, v0, a0 = drift_of(s, l, system, axis, i, 0)
    d1, v1, a1 = drift_of(s, l, system, axis, i, 1)
    mark = s.mark[r, l]
    if mark != 0:
        path = cubic(h, max(mark * v0, 0.0), mark * a0, mark * v1, mark * a1)
        return path, path
    middle = s.stiffness[r, l] * s.middle[r, l]
    left = cubic(h, max(F + (d0 - middle), 0.0), v0, F + (d1 - middle), v1)
    return left, cubic(h, max(F - (d0 - middle), 0.0), -v0, F - (d1 - middle), -v1)


@compiled
def first_yield(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Fraction of the step at which a storey first yields or ends to,
    and which to which side.
    """
    first = NO_PASSAGE
    which = 0
    for r in range(ways_of(s) * s.n):
        left, right = storey_paths(s, l, systems, r)
        t = first_descent(left, s.piece)
        if t < first:
            first = t
            which = 2 * r
        t = first_descent(right, s.piece)
        if t < first:
            first = t
            which = 2 * r + 1
    return first, which


@compiled
def watched_path(s: Record, l: int, which: int) -> tuple[bool, Quintic]:
    """The cubic through a watched value at both ends; what has
    just changed begins at zero.
    """
    there, value, slope = watched(s, l, which, 0)
    if not there:
        return False, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    _, end, end_slope = watched(s, l, which, 1)
    return True, cubic(s.h[l], max(value, 0.0), slope, end, end_slope)


@compiled
def may_change(s: Record, l: int) -> bool:
    """True if a device may change its law in the step."""
    for which in range(WATCHED):
        if not may_be_watched(s, l, which):
            continue
        there, path = watched_path(s, l, which)
        if there and min(lower_hull(path), path[0]) < 0.0:
            return True
    return False


@compiled
def falls_low(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Fraction of the step at which a free tilt leaves its
    range downwards, if it does.
    """
    if s.moves[l] == 0.0:
        return NO_PASSAGE, 0
    path, low, _ = path_in_range(s, l)
    return first_descent(offset(path, 1.0, low), s.piece), 0


@compiled
def rises_high(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """And upwards."""
    if s.moves[l] == 0.0:
        return NO_PASSAGE, 0
    path, _, high = path_in_range(s, l)
    return first_descent(offset(path, -1.0, high), s.piece), 0


@compiled
def is_nearest(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Where a tilt to any side is nearest to upright."""
    if s.moves[l] > 0.0 and falls(s, l) and s.new_v[l] >= 0.0:
        return nearest(s, l), 0
    return NO_PASSAGE, 0


@compiled
def changes(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Where a device changes its law, and which watched value says so."""
    first = NO_PASSAGE
    which = 0
    for number in range(WATCHED if s.devices[l] > 0 and s.moves[l] > 0.0 else 0):
        there, path = watched_path(s, l, number)
        if there:
            t = first_descent(path, s.piece)
            if t < first:
                first = t
                which = number
    return first, which


@compiled
def yields_first(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Where a storey begins to yield or ends to, and which to which side."""
    if s.yields[l] == 0:
        return NO_PASSAGE, 0
    return first_yield(s, l, systems)


@compiled
def nearest(s: Record, l: int) -> float:
    """Fraction of the step at which x' rises through zero: by the
    cubic through x' and x''.
    """
    low = 0.0
    high = 1.0
    h = s.h[l]
    for _ in range(40):
        t = 0.5 * (low + high)
        r = 1.0 - t
        rate = r * r * (1.0 + 2.0 * t) * s.v[l] + t * t * (3.0 - 2.0 * t) * s.new_v[l]
        rate += h * t * r * (r * s.a[l] - t * s.new_a[l])
        if rate < 0.0:
            low = t
        else:
            high = t
    return high


@compiled
def let_go(s: Record, l: int, systems: Record) -> tuple[float, int]:
    """Where a storey at rest is no longer held: to the right (1), or to the left (-1)."""
    if s.moves[l] > 0.0:
        return NO_PASSAGE, 0
    if is_gripped(s, l):
        return first_descent(grip_path(s, l), s.piece), 1
    if ways_of(s) == 2:
        return first_descent(squared_margin(s, l), s.piece), 1
    x = push_path(s, l, 0)
    spared = relief_path(s, l)
    # Where gravity is lost both margins are negative at once: then the push decides.
    push = 0.0
    for i in range(6):
        push = push if push != 0.0 else x[i]
    likelier = -1 if push < 0.0 else 1
    first = NO_PASSAGE
    side = 0
    for sign in (likelier, -likelier):
        t = first_descent(margin_path(s, l, x, spared, sign), s.piece)
        if t < first:
            first = t
            side = sign
    return first, side


@inlined
def grip_path(s: Record, l: int) -> Quintic:
    """The cubic through the margins of a tilt that friction holds, to any side."""
    one = grip_at(s, l, 0)
    two = grip_at(s, l, 1)
    start = max(one.margin + one.late, 0.0)
    return cubic(s.h[l], start, one.slope, two.margin + two.late, two.slope)


@inlined
def limit_to(s: Record, l: int, side: int) -> tuple[float, float]:
    """The limit of R z to the right (1) or left (-1): what multiplies g_f, what adds."""
    factor = s.limit_right[l]
    held = s.held_right[l]
    if side < 0:
        factor = s.limit_left[l]
        held = s.held_left[l]
    return factor, held


@inlined
def margin_path(s: Record, l: int, x: Quintic, spared: Quintic, side: int) -> Quintic:
    """The limit to a side less R z to it, over the step in one plane.

    Of R z, and of what contacts are spared of g + a_v.
    """
    factor, held = limit_to(s, l, side)
    limit = factor * g_up_at(s, l, s.time[l])
    change = factor * (s.h[l] * s.g_up_slope[l])
    limit += ROUNDING * (abs(limit) + abs(held)) + held
    return (
        limit - side * x[0] - factor * spared[0],
        limit + 0.2 * change - side * x[1] - factor * spared[1],
        limit + 0.4 * change - side * x[2] - factor * spared[2],
        limit + 0.6 * change - side * x[3] - factor * spared[3],
        limit + 0.8 * change - side * x[4] - factor * spared[4],
        limit + change - side * x[5] - factor * spared[5],
    )


@compiled
def squared_margin(s: Record, l: int) -> Quintic:
    """The limit's square less that of R z, through both ends of the
    step with two derivatives.
    """
    h = s.h[l]
    R = 0.5 * s.diameter[l]
    ends = s.piece
    for end in range(2):
        factor = s.limit_right[l]
        g_felt, g_rate, bent = felt_at(s, l, end)
        limit = factor * g_felt + s.held_right[l]
        rise = factor * g_rate
        beyond = limit * (1.0 + ROUNDING)
        value = beyond * abs(beyond)
        slope = 2.0 * limit * rise
        bend = 2.0 * rise * rise
        bend += 2.0 * limit * (factor * bent)
        z, z_rate = z_at(s, l, end)
        ddV = vector(s, s.new_ddV, l) if end > 0 else vector(s, s.ddV, l)
        for axis in range(2):
            push = R * z[axis]
            rate = R * z_rate[axis]
            value -= push * push
            slope -= 2.0 * push * rate
            bend -= 2.0 * (rate * rate + push * (R * pushed_by(s, l, ddV[axis])))
        ends[3 * end] = value
        ends[3 * end + 1] = slope
        ends[3 * end + 2] = bend
    return quintic(h, ends[0], ends[1], ends[2], ends[3], ends[4], ends[5])


@compiled
def missing_low(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Amount by which the end of the step is still above the event, and its rate: of a
    tilt that falls.
    """
    return s.new_x[l] - s.x_low[l], s.new_v[l]


@compiled
def missing_high(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Of one that rises."""
    return s.x_high[l] - s.new_x[l], -s.new_v[l]


@compiled
def missing_nearest(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Of one that comes nearest to upright."""
    return -s.new_v[l], -s.new_a[l]


@compiled
def missing_change(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Of a device's watched value."""
    _, value, slope = watched(s, l, s.which[l], 1)
    return value, slope


@compiled
def missing_yield(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Of a storey that is to yield to a side, or no longer."""
    which = s.which[l]
    r = which // 2
    d, rate, bend = drift_of(s, l, systems[s.system[l] + r // s.n], r // s.n, r % s.n, 1)
    if s.mark[r, l] != 0:
        return s.mark[r, l] * rate, s.mark[r, l] * bend
    side = 1.0 if which % 2 > 0 else -1.0
    off = d - s.stiffness[r, l] * s.middle[r, l]
    return s.strength[r, l] * (1.0 + UNLOADED) - side * off, -side * rate


@compiled
def missing_let_go(s: Record, l: int, systems: Record) -> tuple[float, float]:
    """Of a storey at rest, to its side."""
    side = s.which[l]
    if is_gripped(s, l):
        grip = grip_at(s, l, 1)
        return grip.margin + grip.late, grip.slope
    R = 0.5 * s.diameter[l]
    g_felt, g_rate, _ = felt_at(s, l, 1)
    factor, held = limit_to(s, l, side)
    z, z_rate = z_at(s, l, 1)
    x = R * z[0]
    rate = R * z_rate[0]
    if ways_of(s) == 1:
        return factor * g_felt + held - side * x, factor * g_rate - side * rate
    y = R * z[1]
    size = length(x, y)
    growth = (x * rate + y * (R * z_rate[1])) / max(size, 1e-300)
    return factor * g_felt + held - size, factor * g_rate - growth
