"""Blocks of exact steps in full contact that gives way (Theory, section 12).

Full contact on a bed is linear, so that a step maps the state, and the ground's motion over it, by
a matrix that `analyses.kernels.bed_maps` makes and that stands behind the records. The state holds
theta, theta', then q and q' of each mode; behind it stand the ground's acceleration and slope, with
zeros up to whole vectors. Blocks are whole intervals in
which the tilt surely stays below phi_u; the interval in which it may not is left to Taylor steps,
as is the motion beyond. What is seen of a block is that of `full_contact.demands`.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import enter_interval, set_ground_of_block
from rpscli.physics.core.quintic import Quintic, lower_hull, peak_in_step, quintic, upper_hull
from rpscli.physics.core.records import INSTANTS, Floats, Record
from rpscli.physics.core.series import NODES, WEIGHTS, cubic
from rpscli.physics.planar.bed import with_bed
from rpscli.physics.planar.bed_events import REST_EVERY, raise_largest, rests_on_bed
from rpscli.physics.planar.demands import set_below_all_maxima, whole_vectors
from rpscli.physics.planar.equation_of_motion import lifted_mass
from rpscli.physics.planar.full_contact.demands import (
    contacts_may_rise,
    may_raise,
    observe_contacts,
    raise_floors_of_block,
)
from rpscli.physics.planar.full_contact.modal_block import sum_modes
from rpscli.physics.planar.run import Output
from rpscli.physics.planar.samples import PASSED, store_row, store_sample
from rpscli.physics.planar.state import AFTER_PHASE_CHANGE, BEDDED, GOES_ON, IS_OVER
from rpscli.physics.planar.steps import plan_steps

PROBE = 8
"""Steps of the first block: strong motion soon lifts again."""


@with_bed(otherwise=False)
def stands_on_bed(s: Record, l: int) -> bool:
    """Whether a lane is in full contact that exact steps can follow."""
    return bool(s.phase[l] == BEDDED and s.bed_map[l] >= 0)


@with_bed(otherwise=IS_OVER)
def follow_on_bed(
    s: Record, l: int, system: Record, block: Record, acceleration: Floats, output: Output
) -> int:
    """Follow a lane from a sample on, while nothing can happen: GOES_ON or IS_OVER."""
    h, each, ahead = s.contact_step[l], int(s.contact_steps[l]), PROBE
    set_below_all_maxima(s, l, system)
    load_maps(s, l, block, acceleration)
    state_to_block(s, l, block)
    over, whole = False, True
    while whole and not over and s.stop == 0:
        free = s.interval[l] + 1 - s.npts[l]
        left = min(s.intervals[l] - s.interval[l], REST_EVERY - free % REST_EVERY)
        most = max(ahead // each, 1)
        steps = each * min(left if free >= 0 else -free, most)
        set_ground_of_block(s, l, block, acceleration, h, each, steps, s.record[l])
        for k in range(steps):
            map_state(s, block, 0, k, k + 1)
        unfold(s, l, system, block, steps)
        taken = each * (first_alarm(s, l, block, h, steps) // each)
        whole, ahead = taken == steps, min(2 * ahead, INSTANTS - 1)
        if taken > 0:
            observe(s, l, system, block, h, taken)
            over = accept(s, l, system, block, acceleration, output, taken)
    for k in range(INSTANTS):
        block.across[k], block.across_rate[k] = 0.0, 0.0
    s.restart_after[l] = AFTER_PHASE_CHANGE
    plan_steps(s, l)
    return IS_OVER if over else GOES_ON


@compiled
def state_to_block(s: Record, l: int, block: Record) -> None:
    """Begin with the state of the lane."""
    first = block.standing[0]
    first[0], first[1] = s.side[l] * s.theta[l], s.side[l] * s.theta_dot[l]
    for r in range(s.n):
        first[2 * r + 2], first[2 * r + 3] = s.q[r, l], s.dq[0, r, l]


@compiled
def state_from_block(s: Record, l: int, block: Record, k: int) -> None:
    """Make the state after k steps that of the lane."""
    s.theta[l], s.theta_dot[l] = s.side[l] * block.tilt[k], s.side[l] * block.tilt_rate[k]
    s.theta_ddot[l] = s.side[l] * block.tilt_bend[k]
    for r in range(s.n):
        s.q[r, l], s.dq[0, r, l] = block.qs[r, k], block.dqs[r, k]


@compiled
def load_maps(s: Record, l: int, block: Record, maps: Floats) -> None:
    """Take over the matrix of a whole step and, where energy is audited, those to the nodes."""
    width, columns = whole_vectors(2 * s.n + 2), 4 * ((2 * s.n + 7) // 4)
    start = s.bed_map[l]
    for which in range(1 + len(NODES) * s.audited):
        for j in range(columns):
            for i in range(width):
                block.bed_maps[which, j, i] = maps[start + i]
            start += width


@compiled
def map_state(s: Record, block: Record, which: int, k: int, into: int) -> None:
    """Write the state `into` a row: that after k steps, mapped by a whole step or to a node."""
    size = 2 * s.n + 2
    now, then, step = block.standing[k], block.standing[into], block.bed_maps[which]
    now[size], now[size + 1] = block.a_g[k], block.a_g_slope[k]
    width = whole_vectors(size)
    for i in range(width):
        then[i] = 0.0
    for j in range(0, size + 2, 4):
        a, b, c, d = now[j], now[j + 1], now[j + 2], now[j + 3]
        for i in range(width):
            then[i] += (a * step[j, i] + b * step[j + 1, i]) + (
                c * step[j + 2, i] + d * step[j + 3, i]
            )


@compiled
def unfold(s: Record, l: int, system: Record, block: Record, steps: int) -> None:
    """Write what the instants of a block hold, as `modal_block.follow_modes` does at rest."""
    for k in range(steps + 1):
        row = block.standing[k]
        block.tilt[k], block.tilt_rate[k] = row[0], row[1]
        for r in range(s.n):
            block.qs[r, k], block.dqs[r, k] = row[2 * r + 2], row[2 * r + 3]
    for k in range(INSTANTS):
        block.V[k] = 0.0
    for r in range(s.n):
        Gamma, omega2, two_xi_omega = system.Gamma[r], system.omega2[r], system.two_xi_omega[r]
        for k in range(INSTANTS):
            force = omega2 * block.qs[r, k] + two_xi_omega * block.dqs[r, k]
            block.V[k] += Gamma * force
    C, k_bed, c_bed = system.bed_height, system.bed_k, system.bed_c
    per_A, beam = 1.0 / (s.io_1[l] + s.one_4gamma[l] * (C * C)), s.diameter[l] * C
    for k in range(INSTANTS):
        action = s.ground_over_R[l] * block.a_g[k] - s.shear_factor[l] * block.V[k]
        springs = k_bed * block.tilt[k] + c_bed * block.tilt_rate[k]
        block.tilt_bend[k] = -(springs + C * action) * per_A
        block.across[k] = beam * block.tilt_bend[k]
        block.ground[k] = block.a_g[k]
        block.a_g[k] += block.across[k]  # what shakes the building
    sum_modes(block, system)
    for k in range(INSTANTS):
        action = s.ground_over_R[l] * block.a_g_slope[k] - s.shear_factor[l] * block.dV[k]
        springs = k_bed * block.tilt_rate[k] + c_bed * block.tilt_bend[k]
        block.across_rate[k] = -beam * (springs + C * action) * per_A


@compiled
def path_of_block(block: Record, h: float, k: int) -> Quintic:
    """The tilt in the step after k others, of length h [s]."""
    x, v, a = block.tilt, block.tilt_rate, block.tilt_bend
    return quintic(h, x[k], v[k], a[k], x[k + 1], v[k + 1], a[k + 1])


@compiled
def first_alarm(s: Record, l: int, block: Record, h: float, steps: int) -> int:
    """Steps, of so many of length h [s], before the first that may leave full contact."""
    limit = s.theta_high[l]
    for k in range(INSTANTS):
        path = path_of_block(block, h, k)
        farthest = max(upper_hull(path), path[0], -lower_hull(path), -path[0])
        block.largest[k] = farthest
        block.alarm[k] = 0.0 if farthest < limit else 1.0
    for k in range(steps):
        if block.alarm[k] > 0.0:
            return k
    return steps


@compiled
def observe(s: Record, l: int, system: Record, block: Record, h: float, steps: int) -> None:
    """Raise what is largest by the first steps of the block, of length h [s]."""
    s.bedded_time[l] += steps * h
    for k in range(steps):
        if block.largest[k] > s.max_theta[l]:
            raise_tilt(s, l, path_of_block(block, h, k), k, h, block.tilt_rate[k])
    if may_raise(s, l, block, h, steps):
        shears, accelerations = s.storey_shear[l], s.floor_acceleration[l]
        raise_floors_of_block(block, system, shears, accelerations, h, steps)
        set_below_all_maxima(s, l, system)
    for k in range(INSTANTS):
        block.a_g[k] = block.ground[k]
        block.push[k], block.push_within[k] = 0.0, 0.0
    if contacts_may_rise(s, l, block, 0.0, h, steps):
        observe_contacts(s, l, block, system, 0.0, h, steps)


@compiled
def raise_tilt(s: Record, l: int, path: Quintic, k: int, h: float, rate: float) -> None:
    """Raise the largest tilt, to either side, by that of the step after k others."""
    sign = 1.0 if path[0] + path[5] >= 0.0 else -1.0
    over = (
        sign * path[0], sign * path[1], sign * path[2],
        sign * path[3], sign * path[4], sign * path[5],
    )  # fmt: skip
    t, height = 1.0, over[5]
    if sign * rate > 0.0 and over[4] > over[5]:
        t, height = peak_in_step(over)
    raise_largest(s, l, height, s.interval_start[l] + (k + t) * h)


@compiled
def accept(
    s: Record,
    l: int,
    system: Record,
    block: Record,
    acceleration: Floats,
    output: Output,
    taken: int,
) -> bool:
    """Make the state after some steps of the block that of the lane; True if its history ends."""
    first, each = s.interval[l], int(s.contact_steps[l])
    if s.audited > 0:
        for k in range(taken):
            s.interval[l] = first + k // each
            book_step(s, l, block, k)
            store_within_step(s, l, system, block, output, k)
            if (k + 1) % each == 0:
                s.interval[l] = first + (k + 1) // each
                state_from_block(s, l, block, k + 1)
                store_sample(s, l, system, output)
    state_from_block(s, l, block, taken)
    for i in range(whole_vectors(2 * s.n + 2)):
        block.standing[0, i] = block.standing[taken, i]
    over = enter_interval(s, l, acceleration, first + taken // each)
    return over or rests_on_bed(s, l, system)


@compiled
def book_step(s: Record, l: int, block: Record, k: int) -> None:
    """Book the flows of energy in the step after k others, by Gauss's rule on exact states."""
    h, node = s.contact_step[l], block.standing[INSTANTS]
    beam = s.diameter[l] * s.phase_c[l]
    per_rate = 0.25 * s.columns_mass[l] * s.diameter[l] * s.diameter[l] * s.bed_c[l]
    for i in range(len(NODES)):
        map_state(s, block, i + 1, k, INSTANTS)
        momentum, damped = lifted_mass(s, l) * beam * node[1], 0.0
        for r in range(s.n):
            rate = node[2 * r + 3]
            momentum += s.Gamma[r, l] * rate
            damped += s.two_xi_omega[r, l] * (rate * rate)
        a_g, part = block.a_g[k] + block.a_g_slope[k] * (h * NODES[i]), h * WEIGHTS[i]
        s.energy_input[l] -= part * a_g * momentum
        s.energy_damped[l] += part * damped
        s.bed_energy[l] += part * per_rate * (node[1] * node[1])


@compiled
def store_within_step(
    s: Record, l: int, system: Record, block: Record, output: Output, k: int
) -> None:
    """Keep the states at the even parts of the interval that the step after k others passes."""
    h, part = s.contact_step[l], s.dt[l] / output.finer
    begin = (k % int(s.contact_steps[l])) * h
    for j in range(max(math.ceil(begin / part - PASSED), 1), output.finer):
        t = (j * part - begin) / h
        if t >= 1.0 - PASSED * part / h:
            break
        v0, v1 = h * block.tilt_rate[k], h * block.tilt_rate[k + 1]
        x, change = cubic(block.tilt[k], block.tilt[k + 1], v0, v1, t)
        s.theta[l], s.theta_dot[l] = s.side[l] * x, s.side[l] * change / h
        bend = block.tilt_bend[k] + t * (block.tilt_bend[k + 1] - block.tilt_bend[k])
        s.theta_ddot[l] = s.side[l] * bend
        for r in range(s.n):
            v0, v1 = h * block.dqs[r, k], h * block.dqs[r, k + 1]
            q, change = cubic(block.qs[r, k], block.qs[r, k + 1], v0, v1, t)
            s.looked_at[0, r], s.looked_at[1, r] = q, change / h
        store_row(s, l, system, output, s.interval[l] * output.finer + j)
