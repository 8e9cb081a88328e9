"""A Runge-Kutta step of all lanes together, each by a length of its own (`tableau`).

At rest the same step holds the tilt. Of each stage, modes come first: their displacements
give the base shear, with it the laws the acceleration of the tilt and of the cap beam,
and that what the modes do next. Sums are written as they are to be rounded: a history
does not know its company.
"""

from __future__ import annotations

import math

from rpscli.physics.bed import set_patches
from rpscli.physics.compile import compiled, fma, inlined
from rpscli.physics.devices.acting import (
    act,
    act_branched_at_stage,
    add_work,
    begin_work,
    push_by_devices,
)
from rpscli.physics.energy import inertia_unit, lifted_mass
from rpscli.physics.lane import (
    g_up_at,
    ground_at,
    lanes_of,
    mode_acceleration,
    new_rate_of,
    new_tilt_of,
    patch,
    place_with,
    polar,
    pushed_by,
    rate_of,
    respond,
    set_vector,
    shears_of,
    tilt_of,
    velocity_with,
    ways_of,
)
from rpscli.physics.laws.place import UPRIGHT, length
from rpscli.physics.state import Record
from rpscli.physics.storeys import free_storeys, slip_rates
from rpscli.physics.tableau import END, ERROR, SQUARED, STAGES, TIMES, USED


@inlined
def find(s: Record, at: float, weight: float, equipped: bool) -> None:
    """Accelerations of all lanes a part of the step behind its start, from
    `new_tilt` and the like.

    Reads `new_V`; writes `new_bend`, `new_shaking` and the polar values of the tilt, and
    adds to the work of devices.
    """
    up = ways_of(s)
    for l in range(lanes_of(s)):
        now = polar(s, l, new_tilt_of(s, l), new_rate_of(s, l))
        place = place_with(s, l, now.x, s.w[l], s.dw[l])
        if equipped:
            push_by_devices(s, l, place, now)
            s.new_height[l] = place.C
            s.new_speed[l] = add_work(s, l, place, now, weight)
        V = shears_of(s, s.new_V, l)
        found = respond(s, l, place, s.w[l], now, V, s.time[l] + at * s.h[l])
        s.new_shaking[up, l] = (found.g_up - s.gravity[l]) + found.lift
        set_vector(s, s.new_bend, l, found.bend_x, found.bend_y)
        shaking = found.a_x + found.beam_x, found.a_y + found.beam_y
        set_vector(s, s.new_shaking, l, shaking[0], shaking[1])
        s.new_x[l] = now.x
        s.new_v[l] = now.p
        s.new_a[l] = found.a
        s.new_lift[l] = found.lift
        if equipped:
            u_x, u_y = velocity_with(s, l, place, now)
            s.new_square_rate[l] = 2.0 * (u_x * found.beam_x + u_y * found.beam_y)
            s.new_quicker[l] = length(found.beam_x, found.beam_y)


@compiled
def accelerate(s: Record, at: float) -> None:
    """Accelerations at a stage of lanes without devices."""
    find(s, at, 0.0, False)


@compiled
def accelerate_equipped(s: Record, at: float, weight: float) -> None:
    """Accelerations at a stage of lanes with devices."""
    find(s, at, weight, True)


@inlined
def terms(s: Record, k: int) -> int:
    """Number of terms of the sums up to stage k: for loops over lanes a number that is
    known.
    """
    return END if lanes_of(s) > 1 else k


@inlined
def advance_mode(s: Record, r: int, l: int, axis: int, k: int) -> float:
    """Lead a mode of a lane to stage k; its part of the base shear there [N]."""
    h = s.h[l]
    omega2 = s.omega2[r, l]
    damping = s.two_xi_omega[r, l]
    q = s.q[r, l]
    dq = s.dq[r, l]
    ddq = fma(-s.Gamma[r, l], s.new_shaking[axis, l], -s.force[r, l])
    if k == 1:
        ddq = mode_acceleration(s, r, l, axis)
    s.ddq[k - 1, r, l] = ddq
    far = 0.0
    fast = 0.0
    for j in range(terms(s, k)):
        if USED[k, j]:
            term = ddq if j == k - 1 else s.ddq[j, r, l]
            far = fma(SQUARED[k, j], term, far)
            fast = fma(STAGES[k, j], term, fast)
    q = fma(h, fma(h, far, TIMES[k] * dq), q)
    dq = fma(h, fast, dq)
    force = fma(omega2, q, damping * dq)
    s.force[r, l] = force
    if k == END:
        s.new_q[r, l] = q
    if k == END or lanes_of(s) == 1:
        s.new_dq[r, l] = dq
    return s.Gamma[r, l] * force  # type: ignore[no-any-return]


@inlined
def advance_tilt(s: Record, l: int, axis: int, k: int) -> None:
    """Lead a component of a lane's tilt to stage k."""
    far = 0.0
    fast = 0.0
    h = s.h[l]
    rate = s.tilt_rate[axis, l]
    for j in range(terms(s, k)):
        if USED[k, j]:
            far = fma(SQUARED[k, j], s.bends[j, axis, l], far)
            fast = fma(STAGES[k, j], s.bends[j, axis, l], fast)
    s.new_tilt[axis, l] = fma(h, fma(h, far, TIMES[k] * rate), s.tilt[axis, l])
    s.new_tilt_rate[axis, l] = fma(h, fast, rate)


@inlined
def advance_to(s: Record, systems: Record, k: int) -> None:
    """Lead all lanes to stage k, modes first, and find their accelerations there."""
    n = s.n
    lanes = lanes_of(s)
    for axis in range(s.axes):
        for l in range(lanes):
            s.new_V[axis, l] = 0.0
        for r in range(axis * n, (axis + 1) * n):
            for l in range(lanes):
                s.new_V[axis, l] += advance_mode(s, r, l, axis, k)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            advance_tilt(s, l, axis, k)
    if s.yielding > 0:
        free_storeys(s, systems, k)
    find_accelerations(s, k)


@compiled
def find_accelerations(s: Record, k: int) -> None:
    """Accelerations of all lanes at stage k, and what flows there."""
    weight = STAGES[END, k] if k < END else 0.0
    if s.gives_way > 0:
        set_patches(s)
    if s.equipped > 0:
        act_branched_at_stage(s, weight)
        accelerate_equipped(s, TIMES[k], weight)
    else:
        accelerate(s, TIMES[k])
    for axis in range(ways_of(s)):
        for l in range(lanes_of(s)):
            s.bends[k, axis, l] = s.new_bend[axis, l]
    if lanes_of(s) == 1 and s.audited > 0:
        book_powers(s, TIMES[k], weight)


@compiled
def all_stages(s: Record, systems: Record) -> None:
    """All stages; of lanes side by side written out: the sums
    become vector instructions.
    """
    if lanes_of(s) == 1:
        for k in range(1, END + 1):
            advance_to(s, systems, k)
        return
    advance_to(s, systems, 1)
    advance_to(s, systems, 2)
    advance_to(s, systems, 3)
    advance_to(s, systems, 4)
    advance_to(s, systems, 5)
    advance_to(s, systems, 6)
    advance_to(s, systems, 7)
    advance_to(s, systems, 8)


@compiled
def take_steps(s: Record, systems: Record) -> None:
    """Take a step of all lanes: writes the end, and the error of the
    tilt over what it may be.
    """
    lanes = lanes_of(s)
    for axis in range(ways_of(s)):
        for l in range(lanes):
            s.bends[0, axis, l] = s.bend[axis, l]
    if s.equipped > 0:
        begin_work(s, STAGES[END, 0])
    if lanes == 1 and s.audited > 0:
        begin_powers(s)
    all_stages(s, systems)
    end_rates(s)
    for l in range(lanes):
        s.error[l] = error_of(s, l)


NOISE = 5e-13
"""Of what turns the columns back, and of what plastic drifts take from the base shear:
what of a difference of both rules is rounding."""


@inlined
def error_of(s: Record, l: int) -> float:
    """Difference of the rules of order 6 and 5 in the tilt's
    rate, over what it may be.
    """
    missed = 0.0
    speed = 0.0
    for axis in range(ways_of(s)):
        error = 0.0
        for k in range(END + 1):
            error = fma(ERROR[k], s.bends[k, axis, l], error)
        missed += error * error
        faster = s.h[l] * (abs(s.bend[axis, l]) + abs(s.new_bend[axis, l]))
        fast = abs(s.tilt_rate[axis, l]) + abs(s.new_tilt_rate[axis, l]) + faster
        speed += fast * fast
    limit = s.step_error[l] * math.sqrt(speed) + s.least_error[l]
    turned = NOISE * s.weigh[l] * s.gravity[l] * s.tan_a[l] + NOISE * pushed_by(
        s, l, s.taken[l]
    )
    limit += s.h[l] * (turned / s.one[l])
    return s.h[l] * math.sqrt(missed) / (limit if limit > 0.0 else 1.0)  # type: ignore[no-any-return]


@inlined
def end_rates(s: Record) -> None:
    """Rates of the base shear at the ends of steps (10.6); the
    second of buildings at rest.
    """
    n = s.n
    lanes = lanes_of(s)
    for axis in range(s.axes):
        for l in range(lanes):
            s.new_dV[axis, l] = 0.0
            s.new_ddV[axis, l] = 0.0
        for r in range(axis * n, (axis + 1) * n):
            for l in range(lanes):
                Gamma = s.Gamma[r, l]
                omega2 = s.omega2[r, l]
                damping = s.two_xi_omega[r, l]
                ddq = -(Gamma * s.new_shaking[axis, l]) - s.force[r, l]
                faster = omega2 * s.new_dq[r, l] + damping * ddq
                s.new_dV[axis, l] += Gamma * faster
                s.new_ddV[axis, l] += Gamma * (omega2 * ddq - damping * faster)
    for l in range(lanes if s.yielding > 0 else 0):
        for axis in range(ways_of(s) if s.marked[l] > 0 else 0):
            slip_rates(s, l, axis, 1)


@compiled
def renew(s: Record, l: int) -> None:
    """Accelerations of one lane at its present state and time: what
    the next step begins with.
    """
    now = polar(s, l, tilt_of(s, l), rate_of(s, l))
    up = ways_of(s)
    s.w[l], s.dw[l] = patch(s, l, now.x)
    if s.devices[l] > 0:
        act(s, l, tilt_of(s, l), rate_of(s, l))
    for axis in range(s.axes):
        force = 0.0
        for r in range(axis * s.n, (axis + 1) * s.n):
            f = fma(s.omega2[r, l], s.q[r, l], s.two_xi_omega[r, l] * s.dq[r, l])
            force += s.Gamma[r, l] * (f - s.freed[r, l])
        s.V[axis, l] = force
    place = place_with(s, l, now.x, s.w[l], s.dw[l])
    V = shears_of(s, s.V, l)
    found = respond(s, l, place, s.w[l], now, V, s.time[l])
    s.shaking[up, l] = (found.g_up - s.gravity[l]) + found.lift
    s.x[l] = now.x
    s.v[l] = now.p
    s.a[l] = found.a
    s.lift[l] = found.lift
    u_x, u_y = velocity_with(s, l, place, now)
    s.speed[l] = length(u_x, u_y)
    s.square_rate[l] = 2.0 * (u_x * found.beam_x + u_y * found.beam_y)
    s.quicker[l] = length(found.beam_x, found.beam_y)
    set_vector(s, s.bend, l, found.bend_x, found.bend_y)
    shaking = found.a_x + found.beam_x, found.a_y + found.beam_y
    set_vector(s, s.shaking, l, shaking[0], shaking[1])
    for axis in range(s.axes):
        s.dV[axis, l] = 0.0
        s.ddV[axis, l] = 0.0
        for r in range(axis * s.n, (axis + 1) * s.n):
            omega2 = s.omega2[r, l]
            damping = s.two_xi_omega[r, l]
            force = fma(omega2, s.q[r, l], damping * s.dq[r, l]) - s.freed[r, l]
            ddq = -(s.Gamma[r, l] * s.shaking[axis, l]) - force
            faster = omega2 * s.dq[r, l] + damping * ddq
            s.dV[axis, l] += s.Gamma[r, l] * faster
            s.ddV[axis, l] += s.Gamma[r, l] * (omega2 * ddq - damping * faster)
        if s.marked[l] > 0 and axis < ways_of(s):
            slip_rates(s, l, axis, 0)


# Where energy is audited its flows are integrated by the weights of the step (8.2).


@compiled
def book_power(
    s: Record,
    time: float,
    weight: float,
    tilt: tuple[float, float],
    rate: tuple[float, float],
) -> None:
    """Add the power of ground, dampers and bed in the only lane,
    its velocities in `new_dq`.
    """
    supplied = 0.0
    damped = 0.0
    upwards = 0.0
    moving = s.moves[0] > 0.0
    u_x = 0.0
    u_y = 0.0
    lift = 0.0
    bed = 0.0
    if moving:
        now = polar(s, 0, tilt, rate)
        w, dw = patch(s, 0, now.x)
        at = place_with(s, 0, now.x, w, dw)
        u_x, u_y = velocity_with(s, 0, at, now)
        lift = s.diameter[0] * at.Bv * now.p
        bed = s.bed_c[0] * (now.p * now.p + now.q * now.q)
        bed += s.rim[0] / max(now.x, UPRIGHT) * (now.q * now.q)
    for axis in range(ways_of(s)):
        velocity = u_x if axis == 0 else u_y
        momentum = lifted_mass(s, 0) * velocity
        for r in range(axis * s.n, (axis + 1) * s.n):
            momentum += s.Gamma[r, 0] * s.new_dq[r, 0]
            damped += s.two_xi_omega[r, 0] * (s.new_dq[r, 0] * s.new_dq[r, 0])
        supplied += ground_at(s, 0, axis, time) * momentum
    a_v = g_up_at(s, 0, time) - s.gravity[0]
    rising = lifted_mass(s, 0) * lift
    up = ways_of(s) * s.n
    for r in range(up, s.axes * s.n):
        rising += s.Gamma[r, 0] * s.new_dq[r, 0]
        upwards += s.two_xi_omega[r, 0] * (s.new_dq[r, 0] * s.new_dq[r, 0])
    supplied += a_v * rising
    s.power_input[0] -= weight * supplied
    s.power_damped[0] += weight * damped
    s.power_upwards[0] += weight * upwards
    s.power_bed[0] += weight * inertia_unit(s, 0) * bed


@compiled
def clear_powers(s: Record) -> None:
    """Nothing has flowed yet."""
    s.power_input[0] = 0.0
    s.power_damped[0] = 0.0
    s.power_bed[0] = 0.0
    s.power_upwards[0] = 0.0


@compiled
def begin_powers(s: Record) -> None:
    """Begin with those at the start of the step."""
    clear_powers(s)
    for r in range(s.axes * s.n):
        s.new_dq[r, 0] = s.dq[r, 0]
    book_power(s, s.time[0], STAGES[END, 0], tilt_of(s, 0), rate_of(s, 0))


@compiled
def book_powers(s: Record, at: float, weight: float) -> None:
    """Add those of a stage."""
    book_power(s, s.time[0] + at * s.h[0], weight, new_tilt_of(s, 0), new_rate_of(s, 0))
