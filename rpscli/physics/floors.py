"""Demands of a step on storeys and floors, at its ends and within.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2
products a step, more than the motion itself. By Cauchy and Schwarz's inequality what
it changes by is bounded:

    (sum_r s_ir dq_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r dq_r^2)

whatever the weights g_r > 0. With dq what has changed since all storeys were last looked
at, no shear is raised while the last sum, which costs n, stays below the least

    (largest shear so far of storey i - its shear when last looked
    at)^2/(sum_r s_ir^2/g_r).

The same holds for floor accelerations, sums over the modal forces. Within a step of
length h a motion leaves the chord between its ends by h/8 of what its velocity changes
by, if it is a cubic; with a margin for what it is more, the same sum over that change
bounds the whole step. Only where that bound is passed the step is looked at.

Rows of demands are those of shears, then those of accelerations: in one plane one each;
of both components resultants, then x, then y, whose sums are added for resultants.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.lane import lanes_of, ways_of
from rpscli.physics.laws.place import length
from rpscli.physics.peaks import peak
from rpscli.physics.state import Floats, Record
from rpscli.physics.storeys import free_rows
from rpscli.physics.within import WITHIN, mode_within, parts_of

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""


@inlined
def rows_of(s: Record) -> int:
    """Rows of demands of a kind."""
    return 2 * ways_of(s) - 1


@inlined
def row_along(s: Record, axis: int) -> int:
    """The row of demands of a kind in a direction; in one plane the only one."""
    return 0 if ways_of(s) == 1 else 1 + axis


@inlined
def axis_of(j: int) -> int:
    """The direction of such a row."""
    return max(j - 1, 0)


@inlined
def is_resultant(s: Record, j: int) -> bool:
    """True if a row of demands is of resultants of both directions."""
    return False if ways_of(s) == 1 else j == 0


@inlined
def reach(one: float, other: float) -> float:
    """The square of a sum, from the squares."""
    return one + other + 2.0 * math.sqrt(one * other)


@inlined
def floors_may_rise(s: Record, l: int) -> bool:
    """True if the sums, and what they may be within the step, leave
    room for a larger demand.
    """
    rises = s.marked[l] > 0
    part = WITHIN / 8.0 * s.h[l]
    part *= part
    for j in range(rows_of(s)):
        shear = 0.0
        acceleration = 0.0
        bent = 0.0
        for axis in range(ways_of(s)):
            if j in (0, 1 + axis):
                shear += max(s.shear_before[axis, l], s.shear_sum[axis, l])
                acceleration += max(
                    s.acceleration_before[axis, l], s.acceleration_sum[axis, l]
                )
                bent += s.bent[axis, l]
        bent *= part
        rises |= reach(shear, bent) > s.room[j, l]
        rises |= reach(acceleration, bent * s.bend_ratio[l]) > s.room[rows_of(s) + j, l]
    return rises  # type: ignore[no-any-return]


@compiled
def observe_floors(s: Record) -> None:
    """Say in `demands_rise` where the demands of floors may be raised."""
    n = s.n
    lanes = lanes_of(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            s.shear_sum[axis, l] = 0.0
            s.acceleration_sum[axis, l] = 0.0
            s.bent[axis, l] = 0.0
        for r in range(axis * n, (axis + 1) * n):
            for l in range(lanes):
                q = s.new_q[r, l] - s.seen_q[r, l]
                force = s.force[r, l] - s.seen_force[r, l]
                lost = s.dq[r, l] - s.new_dq[r, l]
                s.shear_sum[axis, l] += s.shear_weight[r, l] * (q * q)
                s.acceleration_sum[axis, l] += s.acceleration_weight[r, l] * (
                    force * force
                )
                s.bent[axis, l] += s.shear_weight[r, l] * (lost * lost)
    for l in range(lanes):
        s.demands_rise[l] = 1.0 if floors_may_rise(s, l) else 0.0


@compiled
def bounds_of(systems: Record, axis: int, kind: int) -> Floats:
    """Of all storeys or floors what times their demand sums do
    not pass, in a direction.
    """
    system = systems[axis]
    return system.shear_bound_of if kind == 0 else system.acceleration_bound_of  # type: ignore[no-any-return]


@compiled
def raise_floors(s: Record, l: int, systems: Record) -> None:
    """Raise the demands of a lane's storeys and floors by those of the step just taken.

    By those at its end; and by those within, where they bulge enough above both ends.
    """
    n = s.n
    ways = ways_of(s)
    rows = s.seen
    within = False
    for axis in range(ways):
        system = systems[axis]
        shears = rows[2 * axis]
        accelerations = rows[2 * axis + 1]
        for i in range(n):
            shears[i] = 0.0
            accelerations[i] = 0.0
        for of in range(n):
            r = axis * n + of
            q = s.new_q[r, l]
            force = s.force[r, l]
            s.seen_q[r, l] = q
            s.seen_force[r, l] = force
            for i in range(n):
                shears[i] += system.storey_shear_of[of, i] * q
                accelerations[i] += system.phi[of, i] * force
        if s.yields[l] > 0:
            free_rows(s, l, system, axis, shears, s.freeing[0])
    for kind in range(2):
        for j in range(rows_of(s)):
            within |= raise_row(s, l, systems, kind, j)
    for axis in range(ways):
        s.shear_sum[axis, l] = 0.0
        s.acceleration_sum[axis, l] = 0.0
    if within and s.h[l] > 0.0:
        raise_floors_within(s, l, systems)


@compiled
def raise_row(s: Record, l: int, systems: Record, kind: int, j: int) -> bool:
    """Raise a row of demands by what they are now, and note it as the last that was seen.

    True if more may have been between; leaves the sum with which none rises from now on.
    """
    moved = 0.0
    bent = 0.0
    k = kind * rows_of(s) + j
    for axis in range(ways_of(s)):
        if j in (0, 1 + axis):
            moved += (
                s.acceleration_before[axis, l] if kind > 0 else s.shear_before[axis, l]
            )
            bent += s.bent[axis, l]
    bent *= s.bend_ratio[l] if kind > 0 else 1.0
    moved = math.sqrt(moved)
    bulge = WITHIN / 8.0 * s.h[l] * math.sqrt(bent)
    within = False
    room = math.inf
    for i in range(s.n):
        if is_resultant(s, j):
            here = length(s.seen[kind, i], s.seen[2 + kind, i])
            share = min(bounds_of(systems, 0, kind)[i], bounds_of(systems, 1, kind)[i])
        else:
            axis = axis_of(j)
            here = abs(s.seen[2 * axis + kind, i])
            share = bounds_of(systems, axis, kind)[i]
        most = s.largest[k, l, i]
        left = share * (most - here)
        before = share * (most - s.last[k, l, i]) - moved
        within |= min(left, before) < bulge
        s.largest[k, l, i] = max(most, here)
        s.last[k, l, i] = here
        room = min(room, max(left, 0.0))
    s.room[k, l] = SURELY * (room * room)
    return within


@compiled
def raise_floors_within(s: Record, l: int, systems: Record) -> None:
    """Raise the demands of floors by those at start, middle and end of a step, and of a
    parabola through them.
    """
    parts = parts_of(s, l)
    for part in range(parts):
        raise_floors_between(s, l, systems, part / parts, (part + 1) / parts)


@compiled
def raise_floors_between(
    s: Record, l: int, systems: Record, begin: float, end: float
) -> None:
    """Raise the demands of floors by those between fractions of the step."""
    n = s.n
    rows = s.between
    for axis in range(ways_of(s)):
        write_between(s, l, systems[axis], axis, begin, end)
    for kind in range(2):
        for j in range(rows_of(s)):
            k = kind * rows_of(s) + j
            x = 3 * kind + 6 * axis_of(j)
            for i in range(n):
                a = rows[x, i]
                b = rows[x + 1, i]
                c = rows[x + 2, i]
                if is_resultant(s, j):
                    a = length(a, rows[x + 6, i])
                    b = length(b, rows[x + 7, i])
                    c = length(c, rows[x + 8, i])
                s.largest[k, l, i] = max(s.largest[k, l, i], peak(a, b, c))


@compiled
def write_between(
    s: Record, l: int, system: Record, axis: int, begin: float, end: float
) -> None:
    """Write shears and accelerations at three instants of the step, of a direction."""
    n = s.n
    rows = s.between
    first = 6 * axis
    for k in range(first, first + 6):
        for i in range(n):
            rows[k, i] = 0.0
    for of in range(n):
        r = axis * n + of
        q0, v0 = mode_within(s, r, l, axis, begin)
        q, v = mode_within(s, r, l, axis, 0.5 * (begin + end))
        q1, v1 = mode_within(s, r, l, axis, end)
        omega2 = s.omega2[r, l]
        damping = s.two_xi_omega[r, l]
        f0 = omega2 * q0 + damping * v0
        f1 = omega2 * q1 + damping * v1
        f = omega2 * q + damping * v
        for i in range(n):
            shear = system.storey_shear_of[of, i]
            phi = system.phi[of, i]
            rows[first, i] += shear * q0
            rows[first + 1, i] += shear * q
            rows[first + 2, i] += shear * q1
            rows[first + 3, i] += phi * f0
            rows[first + 4, i] += phi * f
            rows[first + 5, i] += phi * f1
    for k in range(first, first + 3 if s.yields[l] > 0 else first):
        free_rows(s, l, system, axis, rows[k], rows[k + 3])


@compiled
def sums_at_start(s: Record, l: int) -> None:
    """Sum up how the modes changed since the last look, where a step begins anew."""
    for axis in range(ways_of(s)):
        shear = 0.0
        acceleration = 0.0
        for r in range(axis * s.n, (axis + 1) * s.n):
            force = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[r, l]
            force -= s.freed[r, l]
            q = s.q[r, l] - s.seen_q[r, l]
            force = force - s.seen_force[r, l]
            shear += s.shear_weight[r, l] * (q * q)
            acceleration += s.acceleration_weight[r, l] * (force * force)
        s.shear_before[axis, l] = shear
        s.acceleration_before[axis, l] = acceleration
