"""Storeys that yield: springs with a strength and kinematic
hardening (Theory, section 15).

A storey's elastic range has a middle c: k |d - c| <= F. While it yields towards its
mark, 1 or -1, the middle follows the drift at F/k, else it rests. Its plastic drift is
delta = (1 - h) c, its shear k (d - delta). The modes of the elastic building feel k
delta as a load, `freed`.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.energy import slip_energy
from rpscli.physics.ground import time_of
from rpscli.physics.lane import lanes_of, ways_of
from rpscli.physics.state import Floats, Record
from rpscli.physics.tableau import SQUARED, TIMES


@compiled
def middle_with(s: Record, l: int, r: int, elastic: float) -> float:
    """c of a storey whose drift times k is known [m]."""
    mark = s.mark[r, l]
    if mark == 0:
        return s.middle[r, l]  # type: ignore[no-any-return]
    return (elastic - mark * s.strength[r, l]) / s.stiffness[r, l]  # type: ignore[no-any-return]


@compiled
def slip_force(s: Record, l: int, r: int, elastic: float) -> float:
    """k delta of a storey whose drift times k is known [N]."""
    free = 1.0 - s.hardening[l]
    return free * s.stiffness[r, l] * middle_with(s, l, r, elastic)  # type: ignore[no-any-return]


@compiled
def base_slip(s: Record, l: int, axis: int, elastic: float) -> float:
    """Part of the base shear of the modes that the first storey's plastic drift takes
    away [N].
    """
    return slip_force(s, l, axis * s.n, elastic) if s.yields[l] > 0 else 0.0


@compiled
def free_rows(
    s: Record, l: int, system: Record, axis: int, shears: Floats, forces: Floats
) -> None:
    """Take plastic drifts out of rows of k d and of floor
    accelerations, whose sign is -1 (n,).
    """
    below = 0.0
    for i in range(s.n - 1, -1, -1):
        slip = slip_force(s, l, axis * s.n + i, shears[i])
        shears[i] -= slip
        forces[i] -= (slip - below) / system.mass[i]
        below = slip


@compiled
def drift_of(
    s: Record, l: int, system: Record, axis: int, i: int, end: int
) -> tuple[float, float, float]:
    """A storey's drift times k with two derivatives, at the start (0)
    or the end (1) of a step.
    """
    d = 0.0
    rate = 0.0
    bend = 0.0
    for of in range(s.n):
        r = axis * s.n + of
        each = system.storey_shear_of[of, i]
        if end > 0:
            d = d + each * s.new_q[r, l]
            rate = rate + each * s.new_dq[r, l]
            bend -= each * (s.Gamma[r, l] * s.new_shaking[axis, l] + s.force[r, l])
        else:
            force = (
                s.omega2[r, l] * s.q[r, l]
                + s.two_xi_omega[r, l] * s.dq[r, l]
                - s.freed[r, l]
            )
            d = d + each * s.q[r, l]
            rate = rate + each * s.dq[r, l]
            bend -= each * (s.Gamma[r, l] * s.shaking[axis, l] + force)
    return d, rate, bend


@compiled
def mode_at_stage(s: Record, l: int, r: int, k: int) -> float:
    """Displacement of a mode at stage k."""
    far = 0.0
    for j in range(k):
        far += SQUARED[k, j] * s.ddq[j, r, l]
    return s.q[r, l] + s.h[l] * (TIMES[k] * s.dq[r, l] + s.h[l] * far)  # type: ignore[no-any-return]


@compiled
def free_storeys(s: Record, systems: Record, k: int) -> None:
    """Take the load of plastic drifts from modal forces and base shears at stage k."""
    n = s.n
    for l in range(lanes_of(s)):
        if s.yields[l] == 0:
            continue
        for axis in range(ways_of(s)):
            system = systems[s.system[l] + axis]
            elastic = s.elastic[axis]
            for i in range(n if s.marked[l] > 0 else 1):
                elastic[i] = 0.0
                for of in range(n if s.mark[axis * n + i, l] != 0 else 0):
                    q = mode_at_stage(s, l, axis * n + of, k)
                    elastic[i] += system.storey_shear_of[of, i] * q
            if s.marked[l] > 0:
                write_load(s, l, system, axis, elastic)
            s.new_V[axis, l] -= base_slip(s, l, axis, elastic[0])
            for r in range(axis * n, (axis + 1) * n):
                s.force[r, l] -= s.new_freed[r, l]


@compiled
def write_load(s: Record, l: int, system: Record, axis: int, elastic: Floats) -> None:
    """Write to `new_freed` the load of plastic drifts under drifts times k (n,)."""
    n = s.n
    free = 1.0 - s.hardening[l]
    for of in range(n):
        s.new_freed[axis * n + of, l] = 0.0
    for i in range(n):
        slip = free * middle_with(s, l, axis * n + i, elastic[i])
        for of in range(n):
            s.new_freed[axis * n + of, l] += system.storey_shear_of[of, i] * slip


@compiled
def slip_rates(s: Record, l: int, axis: int, end: int) -> None:
    """Take what the first storey yields by from the rates of the
    base shear (`slipping`).
    """
    rate = 0.0
    bend = 0.0
    for r in range(axis * s.n, (axis + 1) * s.n):
        if end > 0:
            ddq = -(s.Gamma[r, l] * s.new_shaking[axis, l]) - s.force[r, l]
            rate += s.slipping[r, l] * s.new_dq[r, l]
        else:
            ddq = -(s.Gamma[r, l] * s.shaking[axis, l]) + s.freed[r, l]
            ddq -= s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[r, l]
            rate += s.slipping[r, l] * s.dq[r, l]
        bend += s.slipping[r, l] * ddq
    if end > 0:
        s.new_dV[axis, l] = s.new_dV[axis, l] - rate
        s.new_ddV[axis, l] = s.new_ddV[axis, l] - bend
    else:
        s.dV[axis, l] = s.dV[axis, l] - rate
        s.ddV[axis, l] = s.ddV[axis, l] - bend


@compiled
def load_storeys(s: Record, l: int, system: Record, axis: int) -> None:
    """Begin a history with storeys that have not yielded."""
    if axis == 0:
        s.hardening[l] = system.hardening
        s.yields[l] = system.yields
        s.marked[l] = 0
        s.energy_yielded[l] = 0.0
        s.taken[l] = 0.0
    for i in range(system.n):
        r = axis * system.n + i
        s.stiffness[r, l] = system.stiffness[i]
        s.strength[r, l] = system.strength[i]
        s.mark[r, l] = 0
        s.middle[r, l] = 0.0
        s.freed[r, l] = 0.0
        s.new_freed[r, l] = 0.0
        s.slipping[r, l] = 0.0
        s.middle_most[r, l] = 0.0
        s.middle_least[r, l] = 0.0
        s.yielded[r, l] = 0.0
        s.first_yield[r, l] = -1.0
        s.drift_most[r, l] = 0.0


@compiled
def keep_slips(s: Record, l: int, systems: Record) -> None:
    """Have yielding storeys follow the step just accepted, and book what that took."""
    n = s.n
    free = 1.0 - s.hardening[l]
    for axis in range(ways_of(s)):
        system = systems[axis]
        elastic = s.elastic[axis]
        for i in range(n):
            r = axis * n + i
            elastic[i], _, _ = drift_of(s, l, system, axis, i, 0)
            if s.mark[r, l] == 0:
                continue
            c = middle_with(s, l, r, elastic[i])
            took = s.strength[r, l] * free * abs(c - s.middle[r, l])
            s.middle[r, l] = c
            s.yielded[r, l] = s.yielded[r, l] + took
            s.energy_yielded[l] += took
            s.middle_most[r, l] = max(s.middle_most[r, l], c)
            s.middle_least[r, l] = min(s.middle_least[r, l], c)
            s.drift_most[r, l] = max(s.drift_most[r, l], abs(elastic[i]))
        write_load(s, l, system, axis, elastic)
        for r in range(axis * n, (axis + 1) * n):
            s.freed[r, l] = s.new_freed[r, l]
    sum_taken(s, l)


@compiled
def sum_taken(s: Record, l: int) -> None:
    """Sum what plastic drifts of first storeys take from the base shears."""
    free = 1.0 - s.hardening[l]
    s.taken[l] = 0.0
    for axis in range(ways_of(s)):
        s.taken[l] += free * s.stiffness[axis * s.n, l] * abs(s.middle[axis * s.n, l])


@compiled
def turn_storey(s: Record, l: int, systems: Record, which: int) -> None:
    """A storey begins to yield, to the side that `which` names, or no longer does."""
    r = which // 2
    n = s.n
    if s.mark[r, l] != 0:
        set_mark(s, l, systems[r // n], r, 0)
        return
    set_mark(s, l, systems[r // n], r, 1 if which % 2 > 0 else -1)
    if s.first_yield[r, l] < 0.0:
        s.first_yield[r, l] = time_of(s, l)


@compiled
def set_mark(s: Record, l: int, system: Record, r: int, mark: int) -> None:
    """Have a storey yield to a side, or no more (0)."""
    s.marked[l] += abs(mark) - abs(s.mark[r, l])
    s.mark[r, l] = mark
    if r % s.n == 0:
        free = (1.0 - s.hardening[l]) * abs(mark)
        for of in range(s.n):
            s.slipping[r + of, l] = free * system.storey_shear_of[of, 0]


JUMPED = 1e-9
"""Of its strength: a storey that yields is so near to it, unless the beam has jumped."""


@compiled
def review_storeys(s: Record, l: int, systems: Record) -> bool:
    """Marks and ranges after the beam may have jumped, in velocity or
    way; True if any changed.

    A storey that now drifts back, or is no longer at its strength, does not yield; one
    beyond its strength has yielded by what it is.
    """
    n = s.n
    changed = False
    for r in range(ways_of(s) * n if s.yields[l] > 0 else 0):
        axis = r // n
        F = s.strength[r, l]
        k = s.stiffness[r, l]
        d, rate, _ = drift_of(s, l, systems[axis], axis, r % n, 0)
        off = d - k * s.middle[r, l]
        mark = s.mark[r, l]
        if mark != 0 and (mark * rate < 0.0 or mark * off < F * (1.0 - JUMPED)):
            set_mark(s, l, systems[axis], r, 0)
            changed = True
        if abs(off) > F * (1.0 + JUMPED):
            yield_at_once(s, l, systems[axis], r, (d - math.copysign(F, off)) / k, abs(d))
            changed = True
    return changed


@compiled
def yield_at_once(
    s: Record, l: int, system: Record, r: int, middle: float, drift: float
) -> None:
    """Move the middle of a storey's range, and book what its springs lose."""
    n = s.n
    before = slip_energy(s, l)
    moved = (1.0 - s.hardening[l]) * (middle - s.middle[r, l])
    s.middle[r, l] = middle
    sum_taken(s, l)
    for of in range(n):
        row = r // n * n + of
        s.freed[row, l] += system.storey_shear_of[of, r % n] * moved
        s.new_freed[row, l] = s.freed[row, l]
    took = before - slip_energy(s, l)
    s.yielded[r, l] = s.yielded[r, l] + took
    s.energy_yielded[l] = s.energy_yielded[l] + took
    s.middle_most[r, l] = max(s.middle_most[r, l], middle)
    s.middle_least[r, l] = min(s.middle_least[r, l], middle)
    s.drift_most[r, l] = max(s.drift_most[r, l], drift)
    if s.first_yield[r, l] < 0.0:
        s.first_yield[r, l] = time_of(s, l)
