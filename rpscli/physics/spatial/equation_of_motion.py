"""The equation of motion of a tilt to any side, with its Taylor terms (Theory, section 14).

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

from rpscli.physics.core.compile import compiled, inlined
from rpscli.physics.core.records import ORDER, Record
from rpscli.physics.core.series import Terms, sine_cosine
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
    B, C = P * cosine + Q * sine, c + P * sine - Q * cosine
    u = (s.phase_u0[l] - P) + P * versed + c * x - Q * sine
    spin_1, base = s.spin_1[l], s.spin_0[l] + s.spin_1[l] * sine
    rolls = spin_1 > 0.0
    g = s.spin[l] * ((x - sine) / base if rolls else 1.0)
    g_slope = spin_1 * (versed - g * cosine) / base
    G = versed + g
    A = inertia(s.io_1[l], s.one_4gamma[l], s.four_gamma_eta[l], B * B + C * C, B)
    J = s.io_1[l] * sine * sine + s.inertia_axial[l] * G * G + s.one_4gamma[l] * u * u
    H = s.io_1[l] * sine * cosine + s.inertia_axial[l] * G * (sine + g_slope)
    return Place(sine, cosine, B, C, u, A, J, H + s.one_4gamma[l] * u * C, G, g_slope)


# Taylor terms.


@inlined
def begin_terms(s: Record, lanes: int) -> None:
    """Terms of order 0: the state, and what follows from it."""
    for l in range(lanes):
        s.V_term[l], s.V_y_term[l] = 0.0, 0.0
    half = s.storeys
    for r in range(s.n):
        for l in range(lanes):
            s.modal_force[r, l] = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[0, r, l]
    add_shears(s, lanes, half)
    for l in range(lanes):
        x = s.theta[l]
        at = place_of(s, l, x)
        cos_phi, sin_phi = s.cos_phi[l], s.sin_phi[l]
        s.tilt_terms[0, l], s.sin_terms[0, l], s.cos_terms[0, l] = x, at.sine, at.cosine
        s.sin2_terms[0, l] = 2.0 * at.sine * at.cosine
        s.cos2_terms[0, l] = 1.0 - 2.0 * at.sine * at.sine
        s.D_terms[0, l], s.u_terms[0, l] = at.C - s.phase_c[l], at.u
        s.cos_phi_terms[0, l], s.sin_phi_terms[0, l] = cos_phi, sin_phi
        s.u_cos_terms[0, l], s.u_sin_terms[0, l] = at.u * cos_phi, at.u * sin_phi
        s.C_cos_terms[0, l], s.C_sin_terms[0, l] = at.C * cos_phi, at.C * sin_phi
        s.B_terms[0, l], s.C_terms[0, l], s.A_terms[0, l] = at.B, at.C, at.A
        s.H_terms[0, l], s.J_terms[0, l] = at.H, at.J
        s.g_terms[0, l], s.g_slope_terms[0, l] = at.G - (1.0 - at.cosine), at.g_slope
        s.per_A[l], s.per_J[l] = 1.0 / at.A, 1.0 / at.J
        s.turning[l] = s.angular_momentum[l] * s.per_J[l]
        s.dtheta_terms[0, l], s.turning_terms[0, l] = s.theta_dot[l], s.turning[l]
        s.momentum_terms[0, l] = s.angular_momentum[l]
        s.V[l], s.V_y[l] = s.V_term[l], s.V_y_term[l]
        time = s.time[l]
        s.z_x_terms[0, l] = push_term(s, l, s.V[l], s.a_g[l] + s.a_g_slope[l] * time)
        s.z_y_terms[0, l] = push_term(s, l, s.V_y[l], s.a_g_y[l] + s.a_g_y_slope[l] * time)
    extend_positions(s, lanes, 1)


@inlined
def add_shears(s: Record, lanes: int, half: int) -> None:
    """Add up the terms of V in x and in y."""
    for r in range(half):
        for l in range(lanes):
            s.V_term[l] += s.Gamma[r, l] * s.modal_force[r, l]
    for r in range(half, s.n):
        for l in range(lanes):
            s.V_y_term[l] += s.Gamma[r, l] * s.modal_force[r, l]


@inlined
def push_term(s: Record, l: int, V: float, a_g: float) -> float:
    """z from shear or device force V [N] and a_g [m/s2] [1/s2]."""
    return float(s.shear_factor[l] * V - s.ground_over_R[l] * a_g)


@inlined
def extend_positions(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of what depends on positions, from velocities up to order m - 1."""
    k = m - 1
    for l in range(lanes):
        part = s.step[l] * (1.0 / m)
        x, sine, cosine, sine2, cosine2, cos_phi, sin_phi = (
            part * s.dtheta_terms[k, l],
            *(
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ),
        )
        for j in range(m):
            p, w = s.dtheta_terms[k - j, l], s.turning_terms[k - j, l]
            sine += s.cos_terms[j, l] * p
            cosine += s.sin_terms[j, l] * p
            sine2 += s.cos2_terms[j, l] * p
            cosine2 += s.sin2_terms[j, l] * p
            cos_phi += s.sin_phi_terms[j, l] * w
            sin_phi += s.cos_phi_terms[j, l] * w
        sine, cosine, sine2, cosine2 = (
            part * sine,
            -part * cosine,
            2.0 * part * sine2,
            -2.0 * part * cosine2,
        )
        cos_phi, sin_phi = -part * cos_phi, part * sin_phi
        P, Q, c = s.phase_p[l], s.phase_q[l], s.phase_c[l]
        D, u = P * sine - Q * cosine, c * x - Q * sine - P * cosine
        s.tilt_terms[m, l], s.sin_terms[m, l], s.cos_terms[m, l] = x, sine, cosine
        s.sin2_terms[m, l], s.cos2_terms[m, l] = sine2, cosine2
        s.cos_phi_terms[m, l], s.sin_phi_terms[m, l] = cos_phi, sin_phi
        s.D_terms[m, l], s.u_terms[m, l] = D, u
        u_cos, u_sin = 0.0, 0.0
        for j in range(m + 1):
            u_cos += s.u_terms[j, l] * s.cos_phi_terms[m - j, l]
            u_sin += s.u_terms[j, l] * s.sin_phi_terms[m - j, l]
        s.u_cos_terms[m, l], s.u_sin_terms[m, l] = u_cos, u_sin
        speed = m / s.step[l] * s.diameter[l]
        s.beam_x[l], s.beam_y[l] = speed * u_cos, speed * u_sin
        if m <= ORDER:
            s.B_terms[m, l], s.C_terms[m, l] = P * cosine + Q * sine, D
            s.A_terms[m, l] = 2.0 * c * s.one_4gamma[l] * D + s.four_gamma_eta[l] * (
                s.A_cos2[l] * cosine2 + s.A_sin2[l] * sine2
            )
            C_cos, C_sin, along, J = 0.0, 0.0, 0.0, 0.0
            for j in range(m + 1):
                C_cos += s.C_terms[j, l] * s.cos_phi_terms[m - j, l]
                C_sin += s.C_terms[j, l] * s.sin_phi_terms[m - j, l]
                along += s.tilt_terms[j, l] * s.D_terms[m - j, l]
            for j in range(m):
                J += s.H_terms[j, l] * s.dtheta_terms[k - j, l]
            s.C_cos_terms[m, l], s.C_sin_terms[m, l] = C_cos, C_sin
            s.J_terms[m, l] = 2.0 * part * J
            H = s.H_sin[l] * sine + s.H_cos[l] * cosine + s.H_sin2[l] * sine2
            H += s.H_cos2[l] * cosine2 + s.H_x[l] * x + s.one_4gamma[l] * c * along
            s.H_terms[m, l] = H + s.inertia_axial[l] * spin_term(s, l, m)


@inlined
def spin_term(s: Record, l: int, m: int) -> float:
    """What spin on arcs adds to the term of order m of H, over i_3; writes G and dG/dx."""
    spin_1, per = s.spin_1[l], 1.0 / (s.spin_0[l] + s.spin_1[l] * s.sin_terms[0, l])
    arc = 1.0 if spin_1 > 0.0 else 0.0
    g = (arc * s.spin[l]) * (s.tilt_terms[m, l] - s.sin_terms[m, l])
    for j in range(1, m + 1):
        g -= spin_1 * s.sin_terms[j, l] * s.g_terms[m - j, l]
    s.g_terms[m, l] = g * per
    slope = s.cos_terms[m, l]
    for j in range(m + 1):
        slope += s.g_terms[j, l] * s.cos_terms[m - j, l]
    slope *= -spin_1
    for j in range(1, m + 1):
        slope -= spin_1 * s.sin_terms[j, l] * s.g_slope_terms[m - j, l]
    s.g_slope_terms[m, l] = slope * per
    more = s.g_slope_terms[m, l]
    for j in range(m + 1):
        G = s.g_terms[j, l] - s.cos_terms[j, l]
        more += G * s.g_slope_terms[m - j, l] + s.g_terms[j, l] * s.sin_terms[m - j, l]
    return float(more)


@inlined
def extend_tilt(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of p, L and w."""
    k = m - 1
    for l in range(lanes):
        h = s.step[l]
        part = h * (1.0 / m)
        pushes, turns, w2 = 0.0, 0.0, 0.0
        for j in range(m):
            z_x, z_y = s.z_x_terms[j, l], s.z_y_terms[j, l]
            pushes += z_x * s.C_cos_terms[k - j, l] + z_y * s.C_sin_terms[k - j, l]
            turns += z_y * s.u_cos_terms[k - j, l] - z_x * s.u_sin_terms[k - j, l]
            w2 += s.turning_terms[j, l] * s.turning_terms[k - j, l]
        s.w2_terms[k, l] = w2
        for j in range(m):
            pushes += s.H_terms[j, l] * s.w2_terms[k - j, l]
        inertial, slowed = 0.0, 0.0
        for j in range(m):
            inertial += (0.5 * (m + j) / m) * s.A_terms[m - j, l] * s.dtheta_terms[j, l]
            slowed += s.J_terms[m - j, l] * s.turning_terms[j, l]
        g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
        before = s.B_terms[k - 1, l] if m > 1 else 0.0
        weights = g_up * s.B_terms[k, l] + h * s.g_up_slope[l] * before
        weights *= s.weight_over_R[l]
        s.dtheta_terms[m, l] = -s.per_A[l] * (part * (weights - pushes) + inertial)
        s.momentum_terms[m, l] = part * turns
        s.turning_terms[m, l] = s.per_J[l] * (part * turns - slowed)


@inlined
def extend_modes(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of the modes, their forces, and with V of z; u_b' is known to order m."""
    for l in range(lanes):
        part, time, h = s.step[l] * (1.0 / m), s.time[l], s.step[l]
        a_x = (
            s.a_g[l] + s.a_g_slope[l] * time if m == 1 else (h * s.a_g_slope[l] if m == 2 else 0.0)
        )
        a_y = s.a_g_y[l] + s.a_g_y_slope[l] * time
        a_y = a_y if m == 1 else (h * s.a_g_y_slope[l] if m == 2 else 0.0)
        s.beam_x[l] += part * a_x
        s.beam_y[l] += part * a_y
        s.V_term[l], s.V_y_term[l] = 0.0, 0.0
    half = s.storeys
    for r in range(half):
        for l in range(lanes):
            s.V_term[l] += extended_mode(s, r, l, m, s.beam_x[l])
    for r in range(half, s.n):
        for l in range(lanes):
            s.V_y_term[l] += extended_mode(s, r, l, m, s.beam_y[l])
    for l in range(lanes):
        rise = s.step[l] if m == 1 else 0.0
        s.z_x_terms[m, l] = push_term(s, l, s.V_term[l], rise * s.a_g_slope[l])
        s.z_y_terms[m, l] = push_term(s, l, s.V_y_term[l], rise * s.a_g_y_slope[l])


@inlined
def extended_mode(s: Record, r: int, l: int, m: int, beam: float) -> float:
    """Write the term of order m of a mode; returns its part of V."""
    part, Gamma = s.step[l] * (1.0 / m), s.Gamma[r, l]
    q = part * s.dq[m - 1, r, l]
    dq = -Gamma * beam - part * s.modal_force[r, l]
    force = s.two_xi_omega[r, l] * dq + s.omega2[r, l] * q
    s.dq[m, r, l] = dq
    s.modal_force[r, l] = force
    return float(Gamma * force)


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
    """p, w, p' and w' of the present state, devices as they push at the step's start."""
    at = place_of(s, l, s.theta[l])
    p, w = s.theta_dot[l], s.angular_momentum[l] / at.J
    z_x, z_y = renew_push(s, l)
    z_x, z_y = z_x + s.shear_factor[l] * s.push_x[l], z_y + s.shear_factor[l] * s.push_y[l]
    cosine, sine = s.cos_phi[l], s.sin_phi[l]
    slope = inertia_slope(s.one_4gamma[l], s.four_gamma_eta[l], phase_constants(s, l), at.B, at.C)
    weights = (s.g_up[l] + s.g_up_slope[l] * s.time[l]) * s.weight_over_R[l]
    along, across = z_x * cosine + z_y * sine, z_y * cosine - z_x * sine
    p_rate = (at.C * along + at.H * w * w - slope * p * p - at.B * weights) / at.A
    return p, w, p_rate, (at.u * across - 2.0 * at.H * p * w) / at.J


@compiled
def renew_push(s: Record, l: int) -> tuple[float, float]:
    """z of the present state, without devices: V anew, and the ground [1/s2]."""
    half, V_x, V_y = s.storeys, 0.0, 0.0
    for r in range(s.n):
        force = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[0, r, l]
        if r < half:
            V_x += s.Gamma[r, l] * force
        else:
            V_y += s.Gamma[r, l] * force
    time = s.time[l]
    return (
        push_term(s, l, V_x, s.a_g[l] + s.a_g_slope[l] * time),
        push_term(s, l, V_y, s.a_g_y[l] + s.a_g_y_slope[l] * time),
    )
