"""Energy of a lane, relative to the ground, and its flows (Theory (8.1), (8.2))."""

from __future__ import annotations

from rpscli.physics.core.compile import by_record, compiled
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import NODES, WEIGHTS, integral, sine_cosine, value
from rpscli.physics.planar.bed.passages import potential
from rpscli.physics.planar.bed.terms import lift_arm
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_lift,
    contact_arm,
    contact_height,
    lifted_mass,
    modal_terms,
    phase_constants,
    rotation_terms,
    tilting_energy,
)


@compiled
def relative_momentum(s: Record, l: int) -> float:
    """1^T M v' [kg m/s]: that of the floors relative to the cap beam."""
    momentum = 0.0
    for r in range(s.n):
        momentum += s.Gamma[r, l] * s.dq[0, r, l]
    return momentum


@compiled
def building_energy(s: Record, l: int, beam_velocity: float) -> float:
    """Kinetic and strain energy of the floors [J], the cap beam moving at u_b'."""
    energy = float(0.5 * s.floors_mass[l] * (beam_velocity * beam_velocity))
    for r in range(s.n):
        q, dq = s.q[r, l], s.dq[0, r, l]
        energy += 0.5 * (dq * dq + s.omega2[r, l] * (q * q))
    return energy + beam_velocity * relative_momentum(s, l)


@compiled
def uplifted_energy(s: Record, l: int, system: Record) -> float:
    """Kinetic, strain and potential energy of the uplifted structure without devices [J]."""
    theta_dot, phase = s.theta_dot[l], phase_constants(s, l)
    sine, cosine = sine_cosine(s.theta[l])
    B, C = contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)
    lift = s.diameter[l] * cap_beam_lift(phase, cosine, sine)
    lifted = potential(s, l, system, lifted_mass(s, l) * s.gravity[l], lift)
    beam_velocity = s.side[l] * s.diameter[l] * C * theta_dot
    moving = tilting_energy(s, l, B, C, theta_dot) + building_energy(s, l, beam_velocity)
    return float(lifted) + moving


@by_record
def powers_within(s: Record, l: int, t: float) -> tuple[float, float]:
    """Power of the ground and of the dampers [W], a fraction t of the step after its start."""
    terms = rotation_terms(s, l)
    theta, theta_dot = s.theta[l] + s.step[l] * integral(terms, t), value(terms, t)
    sine, cosine = sine_cosine(theta)
    phase = phase_constants(s, l)
    B, C = contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)
    mass = lifted_mass(s, l)
    momentum, damped = mass * s.side[l] * s.diameter[l] * C * theta_dot, 0.0
    for r in range(s.n):
        dq = value(modal_terms(s, r, l), t)
        momentum += s.Gamma[r, l] * dq
        damped += s.two_xi_omega[r, l] * (dq * dq)
    time = s.time[l] + t * s.step[l]
    a_g = s.a_g[l] + s.a_g_slope[l] * time
    a_v = s.g_up[l] + s.g_up_slope[l] * time - s.gravity[l]
    B = lift_arm(s, l, theta, B)
    supplied = a_g * momentum + a_v * mass * s.diameter[l] * B * theta_dot
    return -supplied, damped


@compiled
def book_energy(s: Record, l: int, fraction: float) -> None:
    """Book what flows in the first part of the step.

    The flows are integrated by a rule of their own, so that the audit can show something: it does
    not know that the motion balances them.
    """
    for i in range(len(NODES)):
        supplied, damped = powers_within(s, l, fraction * NODES[i])
        s.energy_input[l] += fraction * s.step[l] * WEIGHTS[i] * supplied
        s.energy_damped[l] += fraction * s.step[l] * WEIGHTS[i] * damped
