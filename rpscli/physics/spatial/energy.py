"""Energy of a lane, relative to the ground, and its flows (Theory (13.2), (13.7))."""

from __future__ import annotations

from rpscli.physics.core.compile import compiled, variant
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import integral, value
from rpscli.physics.planar.energy import powers_within
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_lift,
    lifted_mass,
    modal_terms,
    phase_constants,
    rotation_terms,
)
from rpscli.physics.spatial.equation_of_motion import (
    Place,
    beam_motion,
    direction_at,
    place_of,
    turning_terms,
)


@compiled
def strain_energy(s: Record, l: int) -> float:
    """Energy of the building's springs [J]."""
    energy = 0.0
    for r in range(s.n):
        energy += 0.5 * s.omega2[r, l] * (s.q[r, l] * s.q[r, l])
    return energy


@compiled
def tilting_energy_3d(s: Record, l: int, at: Place) -> float:
    """Kinetic energy of columns and cap beam, and of the floors' vertical motion [J]."""
    p, L = s.theta_dot[l], s.angular_momentum[l]
    square = s.diameter[l] * s.diameter[l]
    return float(0.125 * s.columns_mass[l] * square * (at.A * p * p + L * L / at.J))


@compiled
def lifting_energy(s: Record, l: int, at: Place) -> float:
    """W v_b [J]."""
    lift = s.diameter[l] * cap_beam_lift(phase_constants(s, l), at.cosine, at.sine)
    return float(lifted_mass(s, l) * s.gravity[l] * lift)


@compiled
def uplifted_energy_3d(s: Record, l: int) -> float:
    """Kinetic, strain and potential energy of the tilted structure without devices [J]."""
    at, half = place_of(s, l, s.theta[l]), s.storeys
    _, _, u_x, u_y = beam_motion(s, l, at, s.theta_dot[l], s.angular_momentum[l] / at.J)
    moving = 0.5 * s.floors_mass[l] * (u_x * u_x + u_y * u_y)
    for r in range(s.n):
        dq = s.dq[0, r, l]
        moving += dq * (0.5 * dq + s.Gamma[r, l] * (u_x if r < half else u_y))
    return float(
        moving + strain_energy(s, l) + tilting_energy_3d(s, l, at) + lifting_energy(s, l, at)
    )


@variant(powers_within, "cos_phi")
def powers_within_3d(s: Record, l: int, t: float) -> tuple[float, float]:
    """Power of the ground and of the dampers [W], a fraction t of the step after its start."""
    h, mass, half, diameter = s.step[l], lifted_mass(s, l), s.storeys, s.diameter[l]
    rates = rotation_terms(s, l)
    p, w = value(rates, t), value(turning_terms(s, l), t)
    at = place_of(s, l, s.theta[l] + h * integral(rates, t))
    cos_phi, sin_phi = direction_at(s, l, t)
    along, across = diameter * at.C * p, diameter * at.u * w
    m_x = mass * (along * cos_phi - across * sin_phi)
    m_y = mass * (along * sin_phi + across * cos_phi)
    damped = 0.0
    for r in range(s.n):
        dq = value(modal_terms(s, r, l), t)
        damped += s.two_xi_omega[r, l] * (dq * dq)
        if r < half:
            m_x += s.Gamma[r, l] * dq
        else:
            m_y += s.Gamma[r, l] * dq
    time = s.time[l] + t * h
    a_v = s.g_up[l] + s.g_up_slope[l] * time - s.gravity[l]
    supplied = (s.a_g[l] + s.a_g_slope[l] * time) * m_x
    supplied += (s.a_g_y[l] + s.a_g_y_slope[l] * time) * m_y
    return -(supplied + a_v * mass * diameter * at.B * p), damped
