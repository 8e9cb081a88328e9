"""Way, velocity and energy of a lane's storey and building."""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.lane import (
    phase_of,
    place_of,
    place_with,
    polar,
    rate_of,
    tilt_of,
    velocity_with,
    ways_of,
)
from rpscli.physics.laws.geometry import cap_beam_lift
from rpscli.physics.laws.place import Place, sines
from rpscli.physics.laws.plane_bed import patch_integral
from rpscli.physics.state import FULL_CONTACT, Record


@inlined
def path_at(s: Record, l: int, x: float) -> float:
    """|u_b| over 2 R (1.4)."""
    sine, less, _ = sines(x)
    p = s.p[l]
    c = s.c[l]
    return float((s.u0[l] - p) + p * less + (c * x - s.q0[l] * sine))


Beam: TypeAlias = tuple[float, float, float, float, float, float]
"""Way of the cap beam in each of a state's axes [m], in x, perhaps y, and upwards, and
from `RATES` on its rates [m/s]. The way upwards is that of rigid ends, 0 on beds."""

RATES = 3


@compiled
def beam_at(
    s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]
) -> Beam:
    """Way and velocity of the cap beam; zero in full contact on rigid ends."""
    if s.phase[l] == FULL_CONTACT:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    now = polar(s, l, tilt, rate)
    way = s.diameter[l] * path_at(s, l, now.x)
    up = 0.0
    rise = 0.0
    u_x, u_y = velocity_with(s, l, place_with(s, l, now.x, 0.0, 0.0), now)
    if s.axes > ways_of(s):
        up = lift_at(s, l, now.x) if s.bed_u[l] == 0.0 else 0.0
        rise = s.diameter[l] * (place_of(s, l, now.x).Bv * now.p)
    if ways_of(s) == 1:
        return way * now.n, up, 0.0, u_x, rise, 0.0
    return way * now.n, way * now.t, up, u_x, u_y, rise


@compiled
def beam_now(s: Record, l: int) -> Beam:
    """Displacement and velocity of the beam at the start of the step."""
    return beam_at(s, l, tilt_of(s, l), rate_of(s, l))


@compiled
def lifted_mass(s: Record, l: int) -> float:
    """Mass that moves with the cap beam, half of the columns' included [kg]."""
    return float(0.5 * s.columns_mass[l] + s.cap_beam_mass[l] + s.floors_mass[l])


@compiled
def inertia_unit(s: Record, l: int) -> float:
    """N m_c R^2 [kg m2]."""
    return float(0.25 * s.columns_mass[l] * (s.diameter[l] * s.diameter[l]))


@compiled
def tilting_energy(s: Record, l: int, at: Place, p: float, q: float) -> float:
    """Kinetic energy of columns and cap beam, and of the floors' rise with it [J]."""
    return float(0.5 * inertia_unit(s, l) * (at.A * (p * p) + at.K * (q * q)))


@compiled
def lift_at(s: Record, l: int, x: float) -> float:
    """v_b of rigid ends [m] (1.5)."""
    sine, less, _ = sines(x)
    return float(s.diameter[l] * cap_beam_lift(phase_of(s, l), 1.0 - less, sine))


@compiled
def risen(s: Record, l: int, system: Record, x: float, share: float) -> float:
    """Rise of a compliant end beyond phi_u [m]: of the weight
    (`sink`), the beam (`root`).
    """
    u = system.bed_uplift
    first = system.rolling if system.beta > 0.0 else system.rocking
    start = s.diameter[l] * (first[4] + first[0] * math.sin(u) - first[1] * math.cos(u))
    end = min(x, system.bed_full) if system.bed_full > 0.0 else x
    area = patch_integral(end, u, s.fade[l]) - patch_integral(u, u, s.fade[l])
    return float(lift_at(s, l, x) - start - s.diameter[l] * share * area)


@compiled
def beam_lift(s: Record, l: int, system: Record, x: float) -> float:
    """v_b at a tilt [m]."""
    if system.compliant == 0:
        return lift_at(s, l, x)
    return 0.0 if s.bed_k[l] > 0.0 else risen(s, l, system, x, system.root)


@compiled
def potential(s: Record, l: int, system: Record, x: float) -> float:
    """Energy of the weight, and of the bed of compliant ends [J]."""
    weight = lifted_mass(s, l) * s.gravity[l]
    if system.compliant == 0:
        return float(weight * lift_at(s, l, x))
    unit = 0.5 * inertia_unit(s, l) * system.bed_k
    u = system.bed_uplift
    if s.bed_k[l] > 0.0:
        return float(unit * (x * x))
    return float(unit * (u * u) + weight * risen(s, l, system, x, system.sink))


@compiled
def strain_energy(s: Record, l: int) -> float:
    """Energy of the building's springs, k (d - delta)^2/2 + k h/(1 - h) delta^2/2 [J]."""
    energy = 0.0
    for r in range(s.axes * s.n):
        energy += 0.5 * s.omega2[r, l] * (s.q[r, l] * s.q[r, l])
    return energy + slip_energy(s, l)


@compiled
def slip_energy(s: Record, l: int) -> float:
    """Change of the energy of elastic springs by plastic drifts [J]."""
    energy = 0.0
    for r in range(ways_of(s) * s.n if s.yields[l] > 0 else 0):
        back = (1.0 - s.hardening[l]) * s.stiffness[r, l] * s.middle[r, l]
        energy += 0.5 * back * s.middle[r, l] - s.freed[r, l] * s.q[r, l]
    return energy


@compiled
def relative_momentum(s: Record, l: int, axis: int) -> float:
    """1^T M v' [kg m/s] in a direction: that of the floors relative to the cap beam."""
    momentum = 0.0
    for r in range(axis * s.n, (axis + 1) * s.n):
        momentum += s.Gamma[r, l] * s.dq[r, l]
    return momentum


@compiled
def look_at(s: Record, l: int) -> None:
    """Write the modes at the start of the step to `seen_modes`, a row
    of q and one of q' a way.
    """
    for axis in range(s.axes):
        for i in range(s.n):
            r = axis * s.n + i
            s.seen_modes[2 * axis, i] = s.q[r, l]
            s.seen_modes[2 * axis + 1, i] = s.dq[r, l]


@compiled
def energy_at(
    s: Record,
    l: int,
    system: Record,
    tilt: tuple[float, float],
    rate: tuple[float, float],
) -> float:
    """Kinetic, potential and elastic energy without devices [J],
    of modes as `seen_modes`.
    """
    beam = beam_at(s, l, tilt, rate)
    energy = 0.0
    for axis in range(s.axes):
        u = beam[RATES + axis]
        energy += 0.5 * s.floors_mass[l] * (u * u)
        for i in range(s.n):
            r = axis * s.n + i
            q = s.seen_modes[2 * axis, i]
            dq = s.seen_modes[2 * axis + 1, i]
            energy += 0.5 * (dq * dq + s.omega2[r, l] * (q * q)) + u * (
                s.Gamma[r, l] * dq
            )
    if s.phase[l] == FULL_CONTACT:
        return float(energy)
    x, _, _, p, q = polar(s, l, tilt, rate)
    return float(
        energy
        + tilting_energy(s, l, place_of(s, l, x), p, q)
        + potential(s, l, system, x)
    )


@compiled
def total_energy(s: Record, l: int, system: Record) -> float:
    """Total energy at the start of the step, with what plastic drifts change."""
    look_at(s, l)
    energy = energy_at(s, l, system, tilt_of(s, l), rate_of(s, l))
    return energy + slip_energy(s, l)
