"""Uplift from a bed, contact with it again, and what happens in between (Theory, section 12)."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.quintic import lower_hull, peak_in_step
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import NODES, WEIGHTS, value
from rpscli.physics.planar.bed import with_bed
from rpscli.physics.planar.bed.passages import PATCH_LEFT, first_phase
from rpscli.physics.planar.bed.terms import FIRST
from rpscli.physics.planar.energy import uplifted_energy
from rpscli.physics.planar.equation_of_motion import rotation_terms, tilting_energy
from rpscli.physics.planar.state import AFTER_PHASE_CHANGE, BEDDED, IMPACT, UPLIFT
from rpscli.physics.planar.steps import path_of, tilt_at
from rpscli.physics.planar.transitions import add_floor_velocity, enter_phase


@with_bed(otherwise=False)
def pass_on_bed(s: Record, l: int, system: Record, log: Record, kind: int) -> bool:
    """Uplift from a bed, or contact with it again: True if it was one of both."""
    if system.compliant == 0 or kind not in (UPLIFT, IMPACT, PATCH_LEFT):
        return False
    s.restart_after[l] = AFTER_PHASE_CHANGE
    if kind == PATCH_LEFT:
        enter_phase(s, l, system, s.phase[l])
        return True
    if s.theta[l] < 0.0:  # over to the other side
        s.side[l], s.theta_dot[l] = -s.side[l], -s.theta_dot[l]
        s.direction[l] = -s.direction[l]
    s.theta[l] = system.bed_uplift
    raise_largest(s, l, s.theta[l], time_of(s, l))
    before, change = s.theta_dot[l], system.lifts
    beam = s.side[l] * s.diameter[l] * system.bed_height * before
    if kind == IMPACT:
        change = system.restitution / change
        half_width = system.R * math.sin(system.alpha)
        per_speed = math.sqrt(2.0 * half_width / (system.gravity * system.bed_uplift))
        s.impact_number[l] = max(s.impact_number[l], per_speed * abs(before))
    enter_phase(s, l, system, BEDDED if kind == IMPACT else first_phase(system))
    if s.root[l] > 0.0:
        s.pace[l] = FIRST * s.uplifted_step[l]
    # Floors keep their velocities: relative to the beam they gain what it loses.
    s.theta_dot[l], lost = change * before, 0.0
    add_floor_velocity(s, l, (1.0 - change) * beam)
    if kind == IMPACT:  # A just outside of phi_u is A_u/j^2
        C = system.bed_height
        lost = tilting_energy(s, l, 0.0, C, before / system.lifts)
        lost -= tilting_energy(s, l, 0.0, C, s.theta_dot[l])
    s.energy_lost[l] += lost
    side = s.side[l]
    rotation, after = side * s.theta[l], side * s.theta_dot[l]
    log_event(s, l, log, time_of(s, l), kind, rotation, side * before, after, lost)
    return True


@compiled
def raise_largest(s: Record, l: int, x: float, time: float) -> None:
    """Raise the largest tilt."""
    if x > s.max_theta[l]:
        s.max_theta[l], s.max_theta_time[l] = x, time


@with_bed()
def observe_bed(s: Record, l: int, fraction: float) -> None:
    """What a step in full contact adds, but for tilts to the lane's own side.

    Time, the largest tilt to the other side, and what the bed dissipates.
    """
    if s.bed_k[l] == 0.0:
        return
    h, terms = fraction * s.step[l], rotation_terms(s, l)
    s.bedded_time[l] += h
    per_rate = 0.25 * s.columns_mass[l] * s.diameter[l] * s.diameter[l] * s.bed_c[l]
    if s.audited > 0:
        for i in range(len(NODES)):
            rate = value(terms, fraction * NODES[i])
            s.bed_energy[l] += h * WEIGHTS[i] * per_rate * (rate * rate)
    path = path_of(s, l)
    if min(lower_hull(path), path[0]) >= -s.max_theta[l]:
        return
    over = (-path[0], -path[1], -path[2], -path[3], -path[4], -path[5])
    t, height = fraction, -(s.next_theta[l] if fraction == 1.0 else tilt_at(s, l, fraction))
    if s.theta_dot[l] < 0.0 < s.next_theta_dot[l]:
        t, height = peak_in_step(over)
    if t <= fraction:
        raise_largest(s, l, height, s.interval_start[l] + (s.time[l] + t * s.step[l]))


REST_EVERY = 8
"""As in `full_contact.follow`."""


@with_bed(otherwise=False)
def rests_on_bed(s: Record, l: int, system: Record) -> bool:
    """Whether free vibration in full contact can bring nothing new: energy bounds all of it.

    All springs together hold no more than the energy, nor do all masses: with E = v^2/2 the tilt is
    below v/sqrt(N m_c R^2 k), a storey's shear below v sqrt(k_i), and the force of mode r below
    w_r v, with what its dampers add at velocities against the beam of v (1 + Gamma/sqrt(m_0)).
    """
    free = s.interval[l] + 1 - s.npts[l]
    if system.until_rest == 0 or free <= 0 or free % REST_EVERY != 0 or s.phase[l] != BEDDED:
        return False
    v = math.sqrt(2.0 * uplifted_energy(s, l, system))
    per_tilt = 0.5 * s.diameter[l] * math.sqrt(s.columns_mass[l])
    farthest = v / (per_tilt * math.sqrt(system.bed_k))
    if farthest >= min(system.bed_uplift, s.max_theta[l]):
        return False
    C = system.bed_height
    A = s.io_1[l] + s.one_4gamma[l] * C * C
    per_beam = s.diameter[l] * C / (per_tilt * math.sqrt(A))  # 1/sqrt(m_0)
    for i in range(s.n):
        stiffness, spring, damper, beam = 0.0, 0.0, 0.0, 0.0
        for r in range(s.n):
            shear = system.storey_shear_of[r, i] / system.omega[r]
            force = system.phi[r, i] * system.omega[r]
            damped = system.phi[r, i] * system.two_xi_omega[r]
            stiffness, spring = stiffness + shear * shear, spring + force * force
            damper += damped * damped
            beam += abs(damped * system.Gamma[r]) * per_beam
        acceleration = math.sqrt(spring) + math.sqrt(damper) + beam
        if v * math.sqrt(stiffness) > s.storey_shear[l, i]:
            return False
        if v * acceleration > s.floor_acceleration[l, i]:
            return False
    return True
