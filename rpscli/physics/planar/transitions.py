"""Impact at theta = 0, and re-contact (Theory (3.3), (4.7))."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.records import Record
from rpscli.physics.planar.bed.passages import bed_above, bed_below, enter_on_bed
from rpscli.physics.planar.energy import relative_momentum
from rpscli.physics.planar.equation_of_motion import tilting_energy
from rpscli.physics.planar.state import (
    AFTER_IMPACT,
    AFTER_PHASE_CHANGE,
    AFTER_UPLIFT,
    FULL_CONTACT,
    IMPACT,
    NO_EVENT,
    OVERTURNING,
    RECONTACT,
    ROCKING,
    ROCKING_TO_ROLLING,
    ROLLING,
    ROLLING_TO_ROCKING,
    UPLIFT,
)


@compiled
def add_floor_velocity(s: Record, l: int, change: float) -> None:
    """Add the same velocity to every floor, relative to the cap beam [m/s] [change m/s]."""
    for r in range(s.n):
        s.dq[0, r, l] += s.Gamma[r, l] * change


@compiled
def upright_energy(s: Record, l: int) -> float:
    """Kinetic energy of the tilt at x = 0 [J], where B = p and C = c - q."""
    return tilting_energy(s, l, s.phase_p[l], s.phase_c[l] - s.phase_q[l], s.theta_dot[l])


@compiled
def change_edge(s: Record, l: int, system: Record) -> float:
    """Impact: from the edge on one side to the other; returns the energy lost [J].

    theta'+ = e theta'-, and floors that move with the cap beam jump by
    -2 R cos(alpha) (1 - e) theta'- (Theory (4.7); paper, Eq. 6); those that do not keep their
    own velocity. The tilt x = |theta| starts again from exactly zero, upwards.
    """
    e, arm = system.restitution, 2.0 * system.R * math.cos(system.alpha)
    rate = s.side[l] * min(s.theta_dot[l], 0.0)
    lost = upright_energy(s, l)
    jump = -arm * (1.0 - e) * rate
    if system.floors_jump > 0:
        momentum = relative_momentum(s, l) + s.floors_mass[l] * (arm * rate + 0.5 * jump)
        lost -= jump * momentum
    else:
        add_floor_velocity(s, l, -jump)
    s.theta[l], s.theta_dot[l] = 0.0, e * abs(rate)
    s.side[l] = -s.side[l]
    return float(lost - upright_energy(s, l))


@compiled
def bounces_left_out(s: Record, l: int, system: Record) -> float:
    """What the bounces left out add to the floors' velocity, over u_b', as the rule asks for.

    Friction lets the beam come back with k of the rate with which it left: k = 1 without it, 0 if
    it holds the beam where it turns (Theory (11.17), (11.18)).
    """
    bounces = system.bounces
    if (
        bounces > 0.0
        and system.floors_jump > 0
        and s.friction_force[l] + s.friction_moment[l] > 0.0
    ):
        C = s.phase_c[l] - s.phase_q[l]
        moment = C * s.friction_force[l] + s.friction_moment[l] / s.diameter[l]
        friction = s.per_A[l] * s.shear_factor[l] * moment
        k = math.sqrt(max(0.0, 1.0 + 2.0 * friction / s.theta_ddot[l]))
        bounces = (1.0 + k) / (1.0 + system.restitution * k)
    return float(bounces)


@compiled
def recontact(s: Record, l: int, system: Record) -> float:
    """Full contact from now on; returns the energy lost [J].

    The floors lose the cap beam's velocity u_b' and keep the relative one; the bounces that are
    left out would have changed it, by a multiple of u_b', which is added where asked for. The
    acceleration of the lane is that after the last impact.
    """
    kept = bounces_left_out(s, l, system)
    beam = s.side[l] * 2.0 * system.R * math.cos(system.alpha) * s.theta_dot[l]
    carried = relative_momentum(s, l) + 0.5 * (1.0 + kept) * s.floors_mass[l] * beam
    lost = upright_energy(s, l) + (1.0 - kept) * beam * carried
    add_floor_velocity(s, l, kept * beam)
    s.theta[l], s.theta_dot[l] = 0.0, 0.0
    return float(lost)


@compiled
def is_negligible(system: Record, theta_dot: float, theta_ddot: float) -> bool:
    """Whether the excursion that begins with x' at x = 0 is too small to follow.

    Impacts accumulate: each excursion is e^2 times as high as the last. At constant deceleration
    it reaches x'^2/(2 |x''|).
    """
    least = system.recontact_tolerance * system.alpha
    return theta_ddot < 0.0 and bool(theta_dot**2 < 2.0 * abs(theta_ddot) * least)


@compiled
def apply_impact(s: Record, l: int, system: Record, log: Record) -> None:
    """Impact at theta = 0; without a flat part the same motion goes on, told of the other side."""
    enter_first_phase(s, l, system)
    if system.alpha == 0.0:
        s.side[l], s.theta[l], s.theta_dot[l] = -s.side[l], 0.0, max(-s.theta_dot[l], 0.0)
        s.restart_after[l] = AFTER_PHASE_CHANGE
        return
    arriving = s.side[l] * s.theta_dot[l]
    lost = change_edge(s, l, system)
    s.energy_lost[l] += lost
    if lost < 0.0:
        s.energy_created[l] -= lost
        s.creating_impacts[l] += 1
    leaving = s.side[l] * s.theta_dot[l]
    log_event(s, l, log, time_of(s, l), IMPACT, 0.0, arriving, leaving, lost)
    s.restart_after[l] = AFTER_IMPACT


@compiled
def comes_to_rest(s: Record, l: int, system: Record, log: Record) -> bool:
    """After an impact: lock the storey if the next excursion would be negligible."""
    if not is_negligible(system, s.theta_dot[l], s.theta_ddot[l]):
        return False
    rate = s.side[l] * s.theta_dot[l]
    lost = recontact(s, l, system)
    s.energy_lost[l] += lost
    log_event(s, l, log, time_of(s, l), RECONTACT, 0.0, rate, 0.0, lost)
    s.phase[l] = FULL_CONTACT
    return True


# The phases of uplifted motion, and where the tilt leaves them.


@compiled
def enter_phase(s: Record, l: int, system: Record, phase: int) -> None:
    """Set the constants of a phase of motion and the range that the tilt has in it."""
    s.phase[l] = phase
    constants = system.rolling if phase == ROLLING else system.rocking
    s.phase_p[l], s.phase_q[l], s.phase_c[l] = constants[0], constants[1], constants[2]
    s.phase_u0[l], s.phase_v0[l] = constants[3], constants[4]
    s.theta_low[l], s.theta_high[l] = system.beta, system.theta_limit
    if phase == ROLLING:
        s.theta_low[l], s.theta_high[l] = 0.0, min(system.beta, system.theta_limit)
    enter_on_bed(s, l, system, phase)


@compiled
def enter_first_phase(s: Record, l: int, system: Record) -> None:
    """Enter the phase in which a tilt grows from zero: rolling, unless the edges are sharp."""
    phase = ROLLING if system.beta > 0.0 else ROCKING
    if s.phase[l] != phase:
        enter_phase(s, l, system, phase)


@compiled
def event_below(s: Record, l: int, system: Record) -> int:
    """What happens where the tilt falls below the range of its phase."""
    kind = bed_below(s, l, system)
    if kind != NO_EVENT:
        return kind
    return ROCKING_TO_ROLLING if s.phase[l] == ROCKING and system.beta > 0.0 else IMPACT


@compiled
def event_above(s: Record, l: int, system: Record) -> int:
    """What happens where the tilt rises above the range of its phase."""
    kind = bed_above(s, l, system)
    if kind != NO_EVENT:
        return kind
    goes_on = s.phase[l] == ROLLING and system.beta < system.theta_limit
    return ROLLING_TO_ROCKING if goes_on else OVERTURNING


@compiled
def uplift(s: Record, l: int, system: Record, log: Record, side: float) -> None:
    """Leave full contact towards a side; the modes' state is set already."""
    s.side[l], s.restart_after[l] = side, AFTER_UPLIFT
    enter_first_phase(s, l, system)
    log_event(s, l, log, time_of(s, l), UPLIFT, 0.0, 0.0, 0.0, 0.0)
