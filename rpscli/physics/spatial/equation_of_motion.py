"""The equation of motion of a tilt to any side, with its Taylor terms (Theory (13.4), (13.5)).

The tilt x >= 0 leans towards the azimuth phi; p = x', w = phi', e_r and e_t are the directions of
the azimuth and across it. Over N m_c R^2, with A, B, C as in one plane and u = |u_b|/2R,

    A p' + A'(x) p^2/2 = -B (g + a_v) (1 + 2 gamma + 2 gamma eta)/R + C (z . e_r) + H w^2
    L' = u (z . e_t),   L = J w,   z = 2 (V + P)/(N m_c R) - (1 + 2 gamma) a/R
    J = (Io - 1) sin^2 x + i_3 G^2 + (1 + 4 gamma) u^2,   H = J'(x)/2
    q_r'' + w_r^2 q_r + 2 xi_r w_r q_r' = -Gamma_r (a + u_b''),   u_b = 2 R u e_r   in x, and in y

V is the building's base shear and P what devices push the cap beam with, vectors as z and a. G is
what columns spin by, so that nothing slides. The series go on as those of the planar kernel, with
sums of products of what is known. Positions lead velocities by an order.
"""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.core.compile import compiled, fma, inlined
from rpscli.physics.core.records import ORDER, Floats, Record
from rpscli.physics.core.series import Terms, sine_cosine
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.equation_of_motion import inertia, inertia_slope, phase_constants
from rpscli.physics.planar.state import ROLLING
from rpscli.physics.planar.transitions import enter_phase
from rpscli.physics.spatial.state import UPRIGHT_TILT


@compiled
def enter_phase_3d(s: Record, l: int, system: Record, phase: int) -> None:
    """Set the constants of a phase of motion, and the range that the tilt has in it."""
    enter_phase(s, l, system, phase)
    s.theta_low[l] = max(s.theta_low[l], UPRIGHT_TILT)
    P, Q, c, u0 = s.phase_p[l], s.phase_q[l], s.phase_c[l], s.phase_u0[l]
    k, sine, _ = system.rolling[2], *sine_cosine(system.beta)
    arm = system.rolling[0]  # sin(alpha)
    s.spin_0[l], s.spin_1[l], s.spin[l] = arm, k, k
    if phase != ROLLING:
        s.spin_0[l], s.spin_1[l] = arm + k * sine, 0.0
        s.spin[l] = k * (system.beta - sine) / (arm + k * sine) if system.beta > 0.0 else 0.0
    s.A_cos2[l], s.A_sin2[l] = 0.5 * (P * P - Q * Q), P * Q
    beam, axial = s.one_4gamma[l], s.inertia_axial[l]
    s.H_sin[l], s.H_cos[l] = beam * (u0 * P - c * Q) + axial, -beam * (u0 * Q + c * P)
    s.H_sin2[l] = 0.5 * (s.io_1[l] - axial - beam * (P * P - Q * Q))
    s.H_cos2[l], s.H_x[l] = beam * P * Q, beam * c * c


MOST = 1023
"""No building has more storeys: a number masked by this, the compiler knows not to be negative."""


class Place(NamedTuple):
    """What follows from a tilt alone."""

    sine: float
    cosine: float
    B: float
    C: float
    u: float
    A: float
    J: float
    H: float
    G: float
    g_slope: float  # of what G is more than 1 - cos x


@inlined
def place_of(s: Record, l: int, x: float) -> Place:
    """What follows from a tilt in the present phase; nothing cancels towards x = 0."""
    P, Q, c = s.phase_p[l], s.phase_q[l], s.phase_c[l]
    sine, cosine = sine_cosine(x)
    half, _ = sine_cosine(0.5 * x)
    versed = 2.0 * half * half
    B, C = P * cosine + Q * sine, c + (P * sine - Q * cosine)
    u = (s.phase_u0[l] - P) + (P * versed + c * x) - Q * sine
    spin_1, base = s.spin_1[l], s.spin_0[l] + s.spin_1[l] * sine
    rolls = spin_1 > 0.0
    g = s.spin[l] * ((x - sine) / base if rolls else 1.0)
    g_slope = spin_1 * (versed - g * cosine) / base
    G = versed + g
    A = inertia(s.io_1[l], s.one_4gamma[l], s.four_gamma_eta[l], B * B + C * C, B)
    i_1, i_3, beam = s.io_1[l], s.inertia_axial[l], s.one_4gamma[l]
    J = i_1 * sine * sine + i_3 * G * G + beam * u * u
    H = i_1 * sine * cosine + i_3 * G * (sine + g_slope) + beam * u * C
    return Place(sine, cosine, B, C, u, A, J, H, G, g_slope)


# Taylor terms.


@inlined
def begin_terms(s: Record, lanes: int) -> None:
    """Terms of order 0: the state, and what follows from it."""
    begin_modes(s, lanes, 0)
    begin_modes(s, lanes, 1)
    for l in range(lanes):
        x = s.theta[l]
        at = place_of(s, l, x)
        cos_phi, sin_phi = s.cos_phi[l], s.sin_phi[l]
        s.tilt_terms[0, l], s.sin_terms[0, l], s.cos_terms[0, l] = x, at.sine, at.cosine
        s.sin2_terms[0, l] = 2.0 * at.sine * at.cosine
        s.cos2_terms[0, l] = 1.0 - 2.0 * at.sine * at.sine
        s.D_terms[0, l], s.u_terms[0, l] = at.C - s.phase_c[l], at.u
        s.e_terms[0, 0, l], s.e_terms[1, 0, l] = cos_phi, sin_phi
        s.B_terms[0, l], s.C_terms[0, l], s.A_terms[0, l] = at.B, at.C, at.A
        s.H_terms[0, l], s.J_terms[0, l] = at.H, at.J
        s.g_terms[0, l], s.g_slope_terms[0, l] = at.G - (1.0 - at.cosine), at.g_slope
        s.per_A[l], s.per_J[l] = 1.0 / at.A, 1.0 / at.J
        s.turning[l] = s.angular_momentum[l] * s.per_J[l]
        s.dtheta_terms[0, l], s.turning_terms[0, l] = s.theta_dot[l], s.turning[l]
        s.momentum_terms[0, l] = s.angular_momentum[l]
        time = s.time[l]
        s.z_terms[0, 0, l] = push_term(s, l, s.shear[0, l], s.a_g[l] + s.a_g_slope[l] * time)
        s.z_terms[1, 0, l] = push_term(s, l, s.shear[1, l], s.a_g_y[l] + s.a_g_y_slope[l] * time)
        s.u_b_terms[0, 0, l], s.u_b_terms[1, 0, l] = at.u * cos_phi, at.u * sin_phi
        s.C_e_terms[0, 0, l], s.C_e_terms[1, 0, l] = at.C * cos_phi, at.C * sin_phi
    extend_positions(s, lanes, 1)


@inlined
def begin_modes(s: Record, lanes: int, axis: int) -> None:
    """The forces of modes in a direction, and their sum V."""
    half = s.storeys & MOST
    for l in range(lanes):
        s.shear[axis, l] = 0.0
    for i in range(half):
        r = half * axis + i
        for l in range(lanes):
            damping = s.two_xi_omega[r, l] * s.dq[0, r, l]
            s.modal_force[r, l] = fma(s.omega2[r, l], s.q[r, l], damping)
            s.shear[axis, l] = fma(s.Gamma[r, l], s.modal_force[r, l], s.shear[axis, l])


@inlined
def push_term(s: Record, l: int, V: float, a_g: float) -> float:
    """z from shear or device force V [N] and a_g [m/s2] [1/s2]."""
    return float(s.shear_factor[l] * V - s.ground_over_R[l] * a_g)


@inlined
def extend_positions(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of what depends on positions, from velocities up to order m - 1.

    Inner loops are long, and one in each loop over lanes: the compiler is to unroll them once it
    knows m, not before, and not too late for vector instructions.
    """
    k = m - 1
    for l in range(lanes):
        part = s.step[l] * (1.0 / m)
        sine, cosine, sine2, cosine2 = 0.0, 0.0, 0.0, 0.0
        cos_phi, sin_phi, J = 0.0, 0.0, 0.0
        for j in range(m):
            p, w = s.dtheta_terms[k - j, l], s.turning_terms[k - j, l]
            sine = fma(s.cos_terms[j, l], p, sine)
            cosine = fma(s.sin_terms[j, l], p, cosine)
            sine2 = fma(s.cos2_terms[j, l], p, sine2)
            cosine2 = fma(s.sin2_terms[j, l], p, cosine2)
            cos_phi = fma(s.e_terms[1, j, l], w, cos_phi)
            sin_phi = fma(s.e_terms[0, j, l], w, sin_phi)
            J = fma(s.H_terms[j, l], p, J)
        x, sine, cosine = part * s.dtheta_terms[k, l], part * sine, -part * cosine
        sine2, cosine2 = 2.0 * part * sine2, -2.0 * part * cosine2
        P, Q, c = s.phase_p[l], s.phase_q[l], s.phase_c[l]
        D, u = P * sine - Q * cosine, c * x - Q * sine - P * cosine
        s.tilt_terms[m, l], s.sin_terms[m, l], s.cos_terms[m, l] = x, sine, cosine
        s.sin2_terms[m, l], s.cos2_terms[m, l] = sine2, cosine2
        s.e_terms[0, m, l], s.e_terms[1, m, l] = -part * cos_phi, part * sin_phi
        s.D_terms[m, l], s.u_terms[m, l] = D, u
        if m <= ORDER:
            s.B_terms[m, l], s.J_terms[m, l] = P * cosine + Q * sine, 2.0 * part * J
            vertical = s.A_cos2[l] * cosine2 + s.A_sin2[l] * sine2
            A = 2.0 * c * s.one_4gamma[l] * D
            s.A_terms[m, l] = A + s.four_gamma_eta[l] * vertical
    extend_products(s, lanes, m, 0)
    extend_products(s, lanes, m, 1)
    if m <= ORDER:
        extend_inertia(s, lanes, m)


@inlined
def extend_products(s: Record, lanes: int, m: int, axis: int) -> None:
    """Terms of order m of u and C along an axis."""
    for l in range(lanes):
        u_b, C_e = 0.0, s.phase_c[l] * s.e_terms[axis, m, l]
        for j in range(m + 1):
            e = s.e_terms[axis, m - j, l]
            u_b, C_e = fma(s.u_terms[j, l], e, u_b), fma(s.D_terms[j, l], e, C_e)
        s.u_b_terms[axis, m, l] = u_b
        s.beam[axis, l] = m / s.step[l] * s.diameter[l] * u_b
        if m <= ORDER:
            s.C_e_terms[axis, m, l] = C_e


@inlined
def extend_inertia(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of H, and of G and dG/dx, to which spin on arcs adds."""
    for l in range(lanes):
        along = 0.0
        for j in range(m + 1):
            along = fma(s.tilt_terms[m - j, l], s.D_terms[j, l], along)
        H = s.H_sin[l] * s.sin_terms[m, l] + s.H_cos[l] * s.cos_terms[m, l]
        H += s.H_sin2[l] * s.sin2_terms[m, l] + s.H_cos2[l] * s.cos2_terms[m, l]
        H += s.H_x[l] * s.tilt_terms[m, l] + s.one_4gamma[l] * s.phase_c[l] * along
        s.H_terms[m, l] = H
    for l in range(lanes):
        spin_1, crossed, slope, more = s.spin_1[l], 0.0, 0.0, 0.0
        for j in range(1, m):
            sine, cosine = s.sin_terms[j, l], s.cos_terms[j, l]
            g_j, other, slope_j = s.g_terms[j, l], s.g_terms[m - j, l], s.g_slope_terms[m - j, l]
            crossed = fma(sine, other, crossed)
            slope = fma(sine, slope_j, slope)
            slope = fma(other, cosine, slope)
            more = fma(g_j - cosine, slope_j, more)
        sine, cosine = s.sin_terms[m, l], s.cos_terms[m, l]
        sine_0, cosine_0 = s.sin_terms[0, l], s.cos_terms[0, l]
        g_0, slope_0 = s.g_terms[0, l], s.g_slope_terms[0, l]
        per = 1.0 / (s.spin_0[l] + spin_1 * sine_0)
        crossed += g_0 * sine
        g = spin_1 * (s.tilt_terms[m, l] - sine - crossed) * per
        slope += cosine + g_0 * cosine + g * cosine_0 + sine * slope_0
        slope *= -spin_1 * per
        more += slope + (g_0 - cosine_0) * slope + (g - cosine) * slope_0 + crossed + g * sine_0
        s.g_terms[m, l], s.g_slope_terms[m, l] = g, slope
        s.H_terms[m, l] += s.inertia_axial[l] * more


@with_devices(otherwise=0.0)
def tilt_term(s: Record, k: int, l: int) -> float:
    """Term of what devices add to the tilt's equation beside z."""
    return float(s.device_terms[k, l])


@inlined
def extend_tilt(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of p, L and w."""
    k = m - 1
    for l in range(lanes):
        h = s.step[l]
        part = h * (1.0 / m)
        p, w, w_last = s.dtheta_terms[0, l], s.turning_terms[0, l], s.turning_terms[k, l]
        z_x, z_y = s.z_terms[0, 0, l], s.z_terms[1, 0, l]
        pushes = z_x * s.C_e_terms[0, k, l] + z_y * s.C_e_terms[1, k, l]
        turns = z_y * s.u_b_terms[0, k, l] - z_x * s.u_b_terms[1, k, l]
        inertial, slowed, w2 = 0.5 * s.A_terms[m, l] * p, s.J_terms[m, l] * w, w * w_last
        for j in range(1, m):
            z_x, z_y = s.z_terms[0, j, l], s.z_terms[1, j, l]
            pushes = fma(z_x, s.C_e_terms[0, k - j, l], pushes)
            pushes = fma(z_y, s.C_e_terms[1, k - j, l], pushes)
            pushes = fma(s.H_terms[j, l], s.w2_terms[k - j, l], pushes)
            turns = fma(z_y, s.u_b_terms[0, k - j, l], turns)
            turns = fma(-z_x, s.u_b_terms[1, k - j, l], turns)
            w2 = fma(s.turning_terms[j, l], s.turning_terms[k - j, l], w2)
            A = (0.5 * (m + j) / m) * s.A_terms[m - j, l]
            inertial = fma(A, s.dtheta_terms[j, l], inertial)
            slowed = fma(s.J_terms[m - j, l], s.turning_terms[j, l], slowed)
        s.w2_terms[k, l] = w2
        pushes = fma(s.H_terms[0, l], w2, pushes)
        g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
        before = s.B_terms[k - 1, l] if m > 1 else 0.0
        weights = g_up * s.B_terms[k, l] + h * s.g_up_slope[l] * before
        force = s.weight_over_R[l] * weights - pushes - tilt_term(s, k, l)
        s.dtheta_terms[m, l] = -s.per_A[l] * (part * force + inertial)
        momentum = part * turns
        s.momentum_terms[m, l] = momentum
        s.turning_terms[m, l] = s.per_J[l] * (momentum - slowed)


@inlined
def extend_modes(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of the modes, their forces, and with V of z; u_b' is known to order m."""
    extend_modes_along(s, lanes, m, 0, s.a_g, s.a_g_slope)
    extend_modes_along(s, lanes, m, 1, s.a_g_y, s.a_g_y_slope)


@inlined
def extend_modes_along(
    s: Record, lanes: int, m: int, axis: int, a_g: Floats, a_g_slope: Floats
) -> None:
    """The same in a direction."""
    for l in range(lanes):
        h, slope, s.shear[axis, l] = s.step[l], a_g_slope[l], 0.0
        ground = a_g[l] + slope * s.time[l] if m == 1 else (h * slope if m == 2 else 0.0)
        s.beam[axis, l] += h * (1.0 / m) * ground
    half = s.storeys & MOST
    for i in range(half):
        r = half * axis + i
        for l in range(lanes):
            part, Gamma = s.step[l] * (1.0 / m), s.Gamma[r, l]
            q = part * s.dq[m - 1, r, l]
            dq = fma(-Gamma, s.beam[axis, l], -part * s.modal_force[r, l])
            force = fma(s.two_xi_omega[r, l], dq, s.omega2[r, l] * q)
            s.dq[m, r, l] = dq
            s.modal_force[r, l] = force
            s.shear[axis, l] = fma(Gamma, force, s.shear[axis, l])
    for l in range(lanes):
        rise = s.step[l] * a_g_slope[l] if m == 1 else 0.0
        s.z_terms[axis, m, l] = push_term(s, l, s.shear[axis, l], rise)


# The motion within a step.


@compiled
def turning_terms(s: Record, l: int) -> Terms:
    """Terms of w of a lane."""
    d = s.turning_terms
    return d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]


@compiled
def momentum_terms(s: Record, l: int) -> Terms:
    """Terms of L of a lane."""
    d = s.momentum_terms
    return d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]


@compiled
def pair_within(terms: Floats, l: int, t: float) -> tuple[float, float]:
    """A pair of series (2, orders, lanes) a fraction t into the step."""
    x, y = 0.0, 0.0
    for m in range(terms.shape[1] - 1, -1, -1):
        x, y = x * t + terms[0, m, l], y * t + terms[1, m, l]
    return x, y


@compiled
def direction_at(s: Record, l: int, t: float) -> tuple[float, float]:
    """Cosine and sine of the azimuth a fraction t into the step."""
    return pair_within(s.e_terms, l, t)


@compiled
def beam_motion(
    s: Record, l: int, at: Place, p: float, w: float
) -> tuple[float, float, float, float]:
    """u_b [m] and u_b' [m/s] in x and in y, at the present azimuth."""
    cos_phi, sin_phi, diameter = s.cos_phi[l], s.sin_phi[l], s.diameter[l]
    out, along, across = diameter * at.u, diameter * at.C * p, diameter * at.u * w
    return (
        out * cos_phi,
        out * sin_phi,
        along * cos_phi - across * sin_phi,
        along * sin_phi + across * cos_phi,
    )


@compiled
def beam_now(s: Record, l: int) -> tuple[float, float, float, float]:
    """The same of the present state, whose w follows from L."""
    at = place_of(s, l, s.theta[l])
    return beam_motion(s, l, at, s.theta_dot[l], s.angular_momentum[l] / at.J)


@compiled
def rates_now(s: Record, l: int) -> tuple[float, float, float, float]:
    """p, w, p' and w' of the present state, without devices."""
    at = place_of(s, l, s.theta[l])
    p, w = s.theta_dot[l], s.angular_momentum[l] / at.J
    z_x, z_y = renew_push(s, l)
    cosine, sine = s.cos_phi[l], s.sin_phi[l]
    slope = inertia_slope(s.one_4gamma[l], s.four_gamma_eta[l], phase_constants(s, l), at.B, at.C)
    weights = (s.g_up[l] + s.g_up_slope[l] * s.time[l]) * s.weight_over_R[l]
    along, across = z_x * cosine + z_y * sine, z_y * cosine - z_x * sine
    p_rate = (at.C * along + at.H * w * w - slope * p * p - at.B * weights) / at.A
    return p, w, p_rate, (at.u * across - 2.0 * at.H * p * w) / at.J


@compiled
def renew_push(s: Record, l: int) -> tuple[float, float]:
    """z of the present state, without devices: V anew, and the ground [1/s2]."""
    half, time, V_x, V_y = s.storeys, s.time[l], 0.0, 0.0
    for r in range(s.n):
        force = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[0, r, l]
        if r < half:
            V_x += s.Gamma[r, l] * force
        else:
            V_y += s.Gamma[r, l] * force
    return (
        push_term(s, l, V_x, s.a_g[l] + s.a_g_slope[l] * time),
        push_term(s, l, V_y, s.a_g_y[l] + s.a_g_y_slope[l] * time),
    )
