"""Rows of samples: the motion at the record's samples, and at even parts between them."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.devices.acting import act
from rpscli.physics.devices.seen import store_devices
from rpscli.physics.devices.table import stored_in
from rpscli.physics.devices.worked import worked
from rpscli.physics.energy import RATES, beam_at, beam_lift, energy_at, look_at
from rpscli.physics.friction import push_at_rest
from rpscli.physics.lane import (
    Polar,
    Response,
    Vector,
    azimuth_along,
    contact_forces,
    patch,
    place_with,
    polar,
    pushed_beam,
    rate_of,
    respond,
    sign_of,
    tilt_of,
    ways_of,
    without_shock,
)
from rpscli.physics.quintic import slope, value
from rpscli.physics.run import KernelOutput
from rpscli.physics.state import FULL_CONTACT, Record
from rpscli.physics.storeys import base_slip, free_rows, middle_with, slip_force
from rpscli.physics.within import mode_path, tilt_within

PASSED = 1e-9
"""Of a part of the interval: what is passed by less is met."""


@compiled
def store_sample(s: Record, l: int, systems: Record, output: KernelOutput) -> None:
    """Keep the state at the start of the present interval, if there is room."""
    look_at(s, l)
    row = s.interval[l] * output.finer
    write_row(s, l, systems, output, row, tilt_of(s, l), rate_of(s, l), s.time[l])


@compiled
def store_within(s: Record, l: int, systems: Record, output: KernelOutput) -> None:
    """Keep the states at the even parts of the interval that
    the step just taken passes.
    """
    h = s.h[l]
    part = s.dt[l] / output.finer
    if h <= 0.0:
        return
    for j in range(max(math.ceil(s.time[l] / part - PASSED), 1), output.finer):
        t = (j * part - s.time[l]) / h
        if t * h >= h - PASSED * part:
            break
        for axis in range(s.axes):
            for i in range(s.n):
                r = axis * s.n + i
                q = mode_path(s, r, l, axis)
                s.seen_modes[2 * axis, i] = value(q, t)
                s.seen_modes[2 * axis + 1, i] = slope(q, t) / h
        tilt, rate = tilt_within(s, l, t)
        row = s.interval[l] * output.finer + j
        write_row(s, l, systems, output, row, tilt, rate, s.time[l] + t * h)


@compiled
def shear_of_row(s: Record, l: int, systems: Record, axis: int) -> float:
    """Base shear of the modes that stand in `seen_modes` [N]."""
    V = 0.0
    elastic = 0.0
    for i in range(s.n):
        r = axis * s.n + i
        q = s.seen_modes[2 * axis, i]
        dq = s.seen_modes[2 * axis + 1, i]
        V += s.Gamma[r, l] * (s.omega2[r, l] * q + s.two_xi_omega[r, l] * dq)
        elastic += systems[axis].storey_shear_of[i, 0] * q
    return V - base_slip(s, l, axis, elastic) if axis < ways_of(s) else V


@compiled
def elastic_of_row(s: Record, system: Record, axis: int, i: int) -> float:
    """A storey's drift times k of the modes that stand in `seen_modes` [N]."""
    elastic = 0.0
    for of in range(s.n):
        elastic += system.storey_shear_of[of, i] * s.seen_modes[2 * axis, of]
    return elastic


@compiled
def slip_energy_of_row(s: Record, l: int, system: Record, axis: int) -> float:
    """Change of the energy of springs by plastic drifts [J], see `laws.slip_energy`."""
    energy = 0.0
    for i in range(s.n):
        r = axis * s.n + i
        elastic = elastic_of_row(s, system, axis, i)
        middle = middle_with(s, l, r, elastic)
        energy += slip_force(s, l, r, elastic) * (
            0.5 * middle - elastic / s.stiffness[r, l]
        )
    return energy


@compiled
def write_row(
    s: Record,
    l: int,
    systems: Record,
    output: KernelOutput,
    row: int,
    tilt: Vector,
    rate: Vector,
    time: float,
) -> None:
    """Keep a motion of a lane, whose modes stand in `seen_modes`."""
    if row >= output.samples.shape[0]:
        return
    sample = output.samples[row]
    now = polar(s, l, tilt, rate)
    V = write_shears(s, l, systems, sample)
    stored = 0.0
    if s.devices[l] > 0:
        act(s, l, tilt, rate)
        share = push_at_rest(s, l, (V[0], V[1]), time, V[2]) if s.moves[l] == 0.0 else 0.0
        at = worked(s, l, tilt, rate)
        store_devices(s, l, at, share, output.devices[row])
        for i in range(s.devices[l]):
            stored += stored_in(s, l, i, at)
    w, dw = patch(s, l, now.x)
    place = place_with(s, l, now.x, w, dw)
    motion = respond(s, l, place, w, now, V, time)
    write_tilt(s, l, systems[0], sample, now, motion.a)
    sample.height = s.diameter[l] * place.C
    write_energies(s, l, systems, sample)
    sample.energy_stored += energy_at(s, l, systems[0], tilt, rate) + stored
    stays = without_shock(s, l, now.x, rate)
    pushed = pushed_beam(s, l, (V[0], V[1]), now)
    write_contacts(s, l, sample, motion, stays, pushed, V[2])
    beam = beam_at(s, l, tilt, rate)
    for axis in range(ways_of(s)):
        sample.beam[axis] = beam[axis]
    for axis in range(s.axes):
        rates = beam[RATES + axis]
        write_floors(s, l, systems[axis], output, row, axis, beam[axis], rates)


@compiled
def write_shears(
    s: Record, l: int, systems: Record, sample: Record
) -> tuple[float, float, float]:
    """Keep the base shears of a motion; they are in x, in y and upwards [N]."""
    up = ways_of(s)
    for axis in range(up):
        sample.base_shear[axis] = shear_of_row(s, l, systems, axis)
    V_up = shear_of_row(s, l, systems, up) if s.axes > up else 0.0
    return sample.base_shear[0], sample.base_shear[1], V_up


@compiled
def write_tilt(
    s: Record, l: int, system: Record, sample: Record, now: Polar, a: float
) -> None:
    """Keep a tilt, its rate and its acceleration, and how high it lifts the beam."""
    x = now.x
    sign = sign_of(s, l)
    moves = s.phase[l] != FULL_CONTACT
    leans = moves and x > 0.0
    sample.phase = s.phase[l]
    sample.theta = sign * x if moves else 0.0
    sample.theta_dot = sign * now.p if moves else 0.0
    sample.theta_ddot = sign * a
    sample.azimuth = azimuth_along(s, now.n, now.t) if leans else 0.0
    sample.turning = now.q / x if leans else 0.0
    sample.lift = beam_lift(s, l, system, x) if moves else 0.0


@compiled
def write_contacts(
    s: Record,
    l: int,
    sample: Record,
    motion: Response,
    stays: float,
    pushed: Vector,
    V_up: float,
) -> None:
    """Keep the forces of contacts, without those of a shock where `stays` is 0."""
    beam = motion.beam_x, motion.beam_y
    ground = motion.a_x, motion.a_y
    lift = stays * motion.lift
    up = motion.g_up, V_up
    for axis in range(ways_of(s)):
        faster = stays * beam[axis]
        F, F_bottom, N, N_bottom = contact_forces(
            s, l, faster, lift, pushed[axis], ground[axis], up
        )
        sample.shear_top[axis] = F
        sample.shear_bottom[axis] = F_bottom
        sample.normal_top = N
        sample.normal_bottom = N_bottom


@compiled
def write_energies(s: Record, l: int, systems: Record, sample: Record) -> None:
    """Keep the energies of a lane so far, and what plastic drifts store."""
    sample.energy_input = s.energy_input[l]
    sample.energy_damped = s.energy_damped[l]
    sample.energy_upwards = s.energy_upwards[l]
    sample.energy_yielded = s.energy_yielded[l]
    sample.energy_lost = s.energy_lost[l]
    sample.energy_bed = s.bed_energy[l]
    sample.energy_stored = 0.0
    for axis in range(ways_of(s) if s.yields[l] > 0 else 0):
        sample.energy_stored += slip_energy_of_row(s, l, systems[axis], axis)


@compiled
def write_floors(
    s: Record,
    l: int,
    system: Record,
    output: KernelOutput,
    row: int,
    axis: int,
    beam: float,
    velocity: float,
) -> None:
    """Keep ways, velocities and absolute accelerations of the floors along an axis."""
    n = s.n
    yields = s.yields[l] > 0 and axis < ways_of(s)
    shears = s.freeing[0]
    forces = s.freeing[1]
    for i in range(n):
        shears[i] = elastic_of_row(s, system, axis, i) if yields else 0.0
        forces[i] = 0.0
        slip = 0.0
        if yields:
            slip = (
                slip_force(s, l, axis * n + i, shears[i]) / s.stiffness[axis * n + i, l]
            )
        output.floors[row, 3, n * axis + i] = slip
    if yields:
        free_rows(s, l, system, axis, shears, forces)
    for i in range(n):
        u = beam
        du = velocity
        ddu = 0.0 - forces[i]
        for of in range(n):
            r = axis * n + of
            shape = system.phi[of, i]
            q = s.seen_modes[2 * axis, of]
            dq = s.seen_modes[2 * axis + 1, of]
            u = u + shape * q
            du = du + shape * dq
            ddu -= shape * (s.omega2[r, l] * q + s.two_xi_omega[r, l] * dq)
        at = n * axis + i
        output.floors[row, 0, at] = u
        output.floors[row, 1, at] = du
        output.floors[row, 2, at] = ddu
