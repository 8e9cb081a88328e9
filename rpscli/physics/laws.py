"""The equation of motion, each law once, as a value (Theory, sections 2, 12 and 13).

The tilt is a vector (a, b) = x (cos phi, sin phi); along it and across it its rate is p = x' and
q = x phi'. One plane is its first component alone, signed by the side s: x = s a may then pass
through zero, and nothing across it exists. With K = J/x^2, over N m_c R^2,

    A r''_n = C z_n - arms - bed - c_r p + G_n + [(K - A)/x + K'/2] q^2 - D p^2        D = A'/2
    K r''_t = h z_t - c_t q + G_t - K' p q                                             h = u/x
    u_b''   = 2 R (C r''_n + B p^2 + h' q^2) along it,  2 R (h r''_t + 2 h' p q) across it
    z       = 2 (V + P)/(N m_c R) - (1 + 2 gamma) a_g/R
    arms    = [(B - sink w) g + B_v (g_f - g)] (1 + 2 gamma + 2 gamma eta)/R,   B_v = B - root w
    g_f     = g + a_v, of floors on springs less than it by 2 [M_tot a_v + sum Gamma f]/(N m_c)
              over 1 + 2 gamma + 2 gamma eta: they press with M_tot g - sum Gamma f (14.3)

G is what tendons and rolling resistance do, P what dampers and stops push the cap beam with. Kept
beyond the ends of a phase of motion all is smooth, which is what the search of events needs.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from rpscli.physics import geometry, plane_bed
from rpscli.physics.compile import compiled, fma, inlined
from rpscli.physics.state import FULL_CONTACT, PADDING, STUCK, Record


@inlined
def ways_of(s: Record) -> int:
    """Horizontal directions in which the ground moves; known to the compiler."""
    return s.tilt.shape[0]  # type: ignore[no-any-return]


@inlined
def lanes_of(s: Record) -> int:
    """Lanes of a state; known to the compiler."""
    return s.x.shape[0] - PADDING  # type: ignore[no-any-return]


@inlined
def length(x: float, y: float) -> float:
    """Length of a vector."""
    return math.sqrt(x * x + y * y)


S3, S5, S7, S9, S11, S13, S15, S17, S19 = (
    1 / math.factorial(k) * (-1) ** (k // 2 + 1) for k in range(3, 20, 2)
)
C2, C4, C6, C8, C10, C12, C14, C16, C18, C20 = (
    1 / math.factorial(k) * (-1) ** (k // 2 + 1) for k in range(2, 21, 2)
)


@inlined
def sines(x: float) -> tuple[float, float, float]:
    """sin x, 1 - cos x and x - sin x by their series, without loss near zero [rad].

    They leave less than 5e-16 for |x| <= pi/2, which no standing column exceeds. Terms are added in
    pairs, and pairs of pairs (G. Estrin, 1960): what follows waits for five operations, not ten.
    """
    z = x * x
    z2 = z * z
    z4 = z2 * z2
    low, high = (S3 + z * S5) + (S7 + z * S9) * z2, (S11 + z * S13) + (S15 + z * S17) * z2
    excess = x * z * ((low + high * z4) + S19 * z4 * z4)
    low, high = (C2 + z * C4) + (C6 + z * C8) * z2, (C10 + z * C12) + (C14 + z * C16) * z2
    return x - excess, z * ((low + high * z4) + (C18 + z * C20) * z4 * z4), excess


contact_arm, contact_height = inlined(geometry.contact_arm), inlined(geometry.contact_height)
cap_beam_lift, inertia = geometry.cap_beam_lift, inlined(geometry.inertia)
patch_at, patch_integral = inlined(plane_bed.patch), plane_bed.patch_integral


@inlined
def patch(s: Record, l: int, x: float) -> tuple[float, float]:
    """w and its slope, while a plane end lifts (12.6); else 0."""
    lifts = (s.root[l] > 0.0) & (x > 0.0)
    w, slope = patch_at(x if lifts else 1.0, s.bed_u[l], s.fade[l])
    return (w if lifts else 0.0), (slope if lifts else 0.0)


@inlined
def phase_of(s: Record, l: int) -> geometry.Phase:
    """Constants of a lane's phase of motion."""
    return geometry.Phase(s.p[l], s.q0[l], s.c[l], s.u0[l], s.v0[l])


@inlined
def mode_acceleration(s: Record, r: int, l: int, axis: int) -> float:
    """Acceleration of a mode at the start of the step."""
    force = fma(s.omega2[r, l], s.q[r, l], s.two_xi_omega[r, l] * s.dq[r, l]) - s.freed[r, l]
    return fma(-s.Gamma[r, l], s.shaking[axis, l], -force)


@inlined
def felt(s: Record, l: int, g_up: float, V_up: float) -> float:
    """g_f, what contacts feel of g + a_v [m/s2], under forces V_up of the floors' springs [N]."""
    return g_up - s.spared[l] * (s.floors_mass[l] * (g_up - s.gravity[l]) + V_up)  # type: ignore[no-any-return]


@compiled
def felt_at(s: Record, l: int, end: int) -> tuple[float, float, float]:
    """g_f with two derivatives, at the start of the step (0) or at its end (1)."""
    up, time, spared = ways_of(s), s.time[l] + end * s.h[l], s.spared[l]
    g_up, slope = s.g_up[l] + time * s.g_up_slope[l], s.g_up_slope[l]
    V, dV, ddV = s.V[up, l], s.dV[up, l], s.ddV[up, l]
    if end > 0:
        V, dV, ddV = s.new_V[up, l], s.new_dV[up, l], s.new_ddV[up, l]
    return felt(s, l, g_up, V), slope - spared * (s.floors_mass[l] * slope + dV), -spared * ddV


class Place(NamedTuple):
    """Geometry and inertia at a tilt; lengths over R, ' by x."""

    B: float  # arm of the contact, B' = c - C
    C: float  # height of the cap beam's path
    Bv: float  # arm of the lift, and its slope
    Bv_slope: float
    A: float  # inertia against p, and D = A'/2
    D: float
    h: float  # u/x, and its slope
    dh: float
    K: float  # inertia against q, and its slope
    K_slope: float
    cone: float  # (K - A)/x
    G: float  # columns spin by G phi' against it, and the slope
    G_slope: float


UPRIGHT = 1e-30
"""Upright, for what is divided by the tilt [rad]."""


@inlined
def place_with(s: Record, l: int, x: float, w: float, dw: float) -> Place:
    """Geometry and inertia of a lane at a tilt, where the patch is known."""
    x = x if ways_of(s) == 1 else max(x, UPRIGHT)
    sine, less, excess = sines(x)
    phase = phase_of(s, l)
    p, q0 = phase.p, phase.q
    B, C = contact_arm(phase, 1.0 - less, sine), contact_height(phase, 1.0 - less, sine)
    B_slope, one, both = phase.c - C, s.one[l], s.one[l] + s.four[l]
    Bv, Bv_slope = B - s.root[l] * w, B_slope - s.root[l] * dw
    A = inertia(s.io_1[l], one, both, C * C, Bv * Bv)
    D = one * (C * B) + both * (Bv * Bv_slope)
    if ways_of(s) == 1:
        return Place(B, C, Bv, Bv_slope, A, D, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)
    io_1, i_3, per_x = s.io_1[l], s.i_3[l], 1.0 / x
    sine_x, less_x, excess_x = sine * per_x, less * per_x, excess * per_x
    gap = p * (sine - less_x) + q0 * (less - excess_x) - (s.u0[l] - p) * per_x
    h, rolls = C - gap, s.rolls[l] > 0.0
    base = s.sin_a[l] + s.spin[l] * (sine if rolls else s.sin_beta[l])
    more = s.spin[l] * (excess if rolls else s.excess_beta[l]) / (base if base > 0.0 else 1.0)
    slope = s.spin[l] * (less - more * (1.0 - less)) / (base if rolls else 1.0)
    slope = slope if rolls else 0.0
    G, G_slope = less + more, sine + slope
    G_x, flat = G * per_x, less - excess_x
    turned, bedded = s.turned[l] * (per_x * per_x), s.bed_k[l] > 0.0
    K = io_1 * (sine_x * sine_x) + i_3 * (G_x * G_x) + one * (h * h) + turned
    K_slope = -io_1 * sine_x * flat + i_3 * G_x * (G_slope - G_x) + one * h * gap - turned
    cone = i_3 * (G_x * G_x) - io_1 * excess_x * (1.0 + sine_x) + turned
    cone = cone - one * gap * (h + C) - both * (Bv * Bv)
    K, K_slope = (A if bedded else K), (0.0 if bedded else 2.0 * per_x * K_slope)
    cone, G, G_slope = (
        0.0 if bedded else per_x * cone,
        0.0 if bedded else G,
        0.0 if bedded else G_slope,
    )
    return Place(B, C, Bv, Bv_slope, A, D, h, gap * per_x, K, K_slope, cone, G, G_slope)


@compiled
def place_of(s: Record, l: int, x: float) -> Place:
    """Geometry and inertia of a lane at a tilt."""
    w, dw = patch(s, l, x)
    return place_with(s, l, x, w, dw)


class Motion(NamedTuple):
    """Accelerations of a lane's tilt, and what they make of the cap beam."""

    bend_x: float  # of the tilt vector [rad/s2]
    bend_y: float
    beam_x: float  # u_b'' [m/s2]
    beam_y: float
    lift: float  # v_b'' [m/s2]
    a: float  # x'' [rad/s2]


@inlined
def motion_at(
    s: Record,
    l: int,
    at: Place,
    w: float,
    tilt: tuple[float, float],
    rate: tuple[float, float],
    z: tuple[float, float],
    g_felt: float,
) -> Motion:
    """Accelerations at a tilt and its rate, under z [1/s2] and g_f [m/s2]."""
    gravity, diameter, moves = s.gravity[l], s.diameter[l], s.moves[l] > 0.0
    arms = ((at.B - s.sink[l] * w) * gravity + at.Bv * (g_felt - gravity)) * s.weigh[l]
    if ways_of(s) == 1:
        side = s.side[l]
        x, p = side * tilt[0], side * rate[0]
        held = arms + at.D * (p * p) + s.bed_k[l] * x + s.bed_c[l] * p - s.turning[l]
        a = (at.C * (side * z[0]) - held) / at.A
        beam = side * diameter * (at.C * a + at.B * (p * p))
        lift = diameter * (at.Bv * a + at.Bv_slope * (p * p))
        a, beam, lift = (a if moves else 0.0), (beam if moves else 0.0), (lift if moves else 0.0)
        return Motion(side * a, 0.0, beam, 0.0, lift, a)
    x = math.sqrt(tilt[0] * tilt[0] + tilt[1] * tilt[1])
    per_x = 1.0 / (x if x > 0.0 else 1.0)
    n, t = (tilt[0] * per_x if x > 0.0 else 1.0), tilt[1] * per_x
    p, q = rate[0] * n + rate[1] * t, rate[1] * n - rate[0] * t
    leans = x > 0.0  # upright nothing depends on the direction, which is any
    pp, qq, pq = (p * p if leans else 0.0), (q * q if leans else 0.0), (p * q if leans else 0.0)
    arms = arms if leans else 0.0
    held = arms + at.D * pp + s.bed_k[l] * x + s.bed_c[l] * p
    held -= (at.cone + 0.5 * at.K_slope) * qq + s.turning[l]
    out = (at.C * (z[0] * n + z[1] * t) - held) / at.A
    back = at.K_slope * pq + (s.bed_c[l] + s.rim[l] * per_x) * q - s.turning_across[l]
    across = (at.h * (z[1] * n - z[0] * t) - back) / at.K
    along = diameter * (at.C * out + at.B * pp + at.dh * qq)
    aside = diameter * (at.h * across + 2.0 * at.dh * pq)
    a = out + q * q * per_x
    lift = diameter * (at.Bv * a + at.Bv_slope * (p * p))
    return Motion(
        out * n - across * t if moves else 0.0,
        out * t + across * n if moves else 0.0,
        along * n - aside * t if moves else 0.0,
        along * t + aside * n if moves else 0.0,
        lift if moves else 0.0,
        a if moves else 0.0,
    )


# What follows from it: the cap beam's motion, energy, forces of contacts.


@inlined
def polar(
    s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]
) -> tuple[float, ...]:
    """x, cosine and sine of the azimuth, p and q; upright the azimuth is 0."""
    if ways_of(s) == 1:
        side = s.side[l]
        return side * tilt[0], side, 0.0, side * rate[0], 0.0
    x = math.sqrt(tilt[0] * tilt[0] + tilt[1] * tilt[1])
    n, t = (tilt[0] / x, tilt[1] / x) if x > 0.0 else (1.0, 0.0)
    return x, n, t, rate[0] * n + rate[1] * t, rate[1] * n - rate[0] * t


@inlined
def tilt_of(s: Record, l: int) -> tuple[float, float]:
    """The tilt vector at the start of the step."""
    return s.tilt[0, l], (s.tilt[1, l] if ways_of(s) == 2 else 0.0)


@inlined
def rate_of(s: Record, l: int) -> tuple[float, float]:
    """Its rate."""
    return s.tilt_rate[0, l], (s.tilt_rate[1, l] if ways_of(s) == 2 else 0.0)


@inlined
def new_tilt_of(s: Record, l: int) -> tuple[float, float]:
    """The tilt vector at a stage of the step, and at its end."""
    return s.new_tilt[0, l], (s.new_tilt[1, l] if ways_of(s) == 2 else 0.0)


@inlined
def new_rate_of(s: Record, l: int) -> tuple[float, float]:
    """Its rate."""
    return s.new_tilt_rate[0, l], (s.new_tilt_rate[1, l] if ways_of(s) == 2 else 0.0)


@inlined
def path_at(s: Record, l: int, x: float) -> float:
    """|u_b| over 2 R (1.4)."""
    sine, less, _ = sines(x)
    p, c = s.p[l], s.c[l]
    return float((s.u0[l] - p) + p * less + (c * x - s.q0[l] * sine))


Beam: TypeAlias = tuple[float, float, float, float, float, float]
"""Way of the cap beam in each of a state's axes [m], in x, perhaps y, and upwards, and from
`RATES` on its rates [m/s]. The way upwards is that of rigid ends, 0 on beds."""

RATES = 3


@compiled
def beam_at(s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]) -> Beam:
    """Way and velocity of the cap beam; zero in full contact on rigid ends."""
    if s.phase[l] == FULL_CONTACT:
        return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x, n, t, p, q = polar(s, l, tilt, rate)
    diameter, u, at = s.diameter[l], path_at(s, l, x), place_with(s, l, x, 0.0, 0.0)
    way, up, rise = diameter * u, 0.0, 0.0
    u_x, u_y = velocity_with(s, l, at, (n, t), (p, q))
    if s.axes > ways_of(s):
        up = lift_at(s, l, x) if s.bed_u[l] == 0.0 else 0.0
        rise = diameter * (place_of(s, l, x).Bv * p)
    if ways_of(s) == 1:
        return way * n, up, 0.0, u_x, rise, 0.0
    return way * n, way * t, up, u_x, u_y, rise


@inlined
def velocity_with(
    s: Record, l: int, at: Place, azimuth: tuple[float, float], rate: tuple[float, float]
) -> tuple[float, float]:
    """u_b' in x and in y, of rates p and q at an azimuth (n, t) [m/s]."""
    along, across = s.diameter[l] * at.C * rate[0], s.diameter[l] * at.h * rate[1]
    if ways_of(s) == 1:
        return along * azimuth[0], 0.0
    return (
        along * azimuth[0] - across * azimuth[1],
        along * azimuth[1] + across * azimuth[0],
    )


@compiled
def beam_now(s: Record, l: int) -> Beam:
    """The same at the start of the step."""
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
    """Rise of a compliant end beyond phi_u [m]: of the weight (`sink`), the beam (`root`)."""
    u, first = system.bed_uplift, system.rolling if system.beta > 0.0 else system.rocking
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
    unit, u = 0.5 * inertia_unit(s, l) * system.bed_k, system.bed_uplift
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
    """What plastic drifts change in the energy of elastic springs [J]."""
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
    """Write the modes at the start of the step to `looked_at`, a row of q and one of q' a way."""
    for axis in range(s.axes):
        for i in range(s.n):
            r = axis * s.n + i
            s.looked_at[2 * axis, i], s.looked_at[2 * axis + 1, i] = s.q[r, l], s.dq[r, l]


@compiled
def energy_at(
    s: Record, l: int, system: Record, tilt: tuple[float, float], rate: tuple[float, float]
) -> float:
    """Kinetic, potential and elastic energy without devices [J], of modes as `looked_at`."""
    beam, energy = beam_at(s, l, tilt, rate), 0.0
    for axis in range(s.axes):
        u = beam[RATES + axis]
        energy += 0.5 * s.floors_mass[l] * (u * u)
        for i in range(s.n):
            r, q, dq = axis * s.n + i, s.looked_at[2 * axis, i], s.looked_at[2 * axis + 1, i]
            energy += 0.5 * (dq * dq + s.omega2[r, l] * (q * q)) + u * (s.Gamma[r, l] * dq)
    if s.phase[l] == FULL_CONTACT:
        return float(energy)
    x, _, _, p, q = polar(s, l, tilt, rate)
    return float(
        energy + tilting_energy(s, l, place_of(s, l, x), p, q) + potential(s, l, system, x)
    )


@compiled
def total_energy(s: Record, l: int, system: Record) -> float:
    """The same at the start of the step, with what plastic drifts change."""
    look_at(s, l)
    energy = energy_at(s, l, system, tilt_of(s, l), rate_of(s, l))
    return energy + slip_energy(s, l)


@inlined
def contact_forces(
    s: Record, l: int, beam: float, lift: float, V: float, a_g: float, up: tuple[float, float]
) -> tuple[float, float, float, float]:
    """F and N of all columns together at their upper and lower ends, in one direction [N] (8.4).

    F acts to the right and N upwards on what is above; V is the base shear and what devices push
    the beam with, `up` are g + a_v and the force of the floors' springs.
    """
    g_up, borne = up[0], (s.floors_mass[l] - s.riding[l]) * s.gravity[l] - up[1]
    shear = s.cap_beam_mass[l] * (beam + a_g) - V
    shear_bottom = shear + s.columns_mass[l] * (0.5 * beam + a_g)
    normal = (s.cap_beam_mass[l] + s.riding[l]) * (g_up + lift) + s.pull[l] + borne
    return shear, shear_bottom, normal, normal + s.columns_mass[l] * (g_up + 0.5 * lift)


@inlined
def without_shock(s: Record, l: int, x: float, rate: tuple[float, float]) -> float:
    """0 where a motion is part of a pass that takes less than `shock_time`: an impact's impulse.

    Beam and columns are turned over within it; forces of contacts are then those of a beam that
    keeps its velocity, and what turns it is added afterwards, if it is known (13.19).
    """
    if ways_of(s) == 1:
        return 1.0
    own = s.shock_time[l] * s.cone[l]
    return 0.0 if own * own * (rate[0] * rate[0] + rate[1] * rate[1]) > x * x else 1.0


@compiled
def stands(s: Record, l: int) -> bool:
    """Whether the tilt of a lane is held: on rigid ends upright, or by friction."""
    return bool(s.phase[l] == FULL_CONTACT or s.phase[l] == STUCK)
