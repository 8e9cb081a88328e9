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


MOST = 1023
"""No building has more storeys: a number masked by this, the compiler knows not to be negative."""


@inlined
def dot(a: float, b: float, c: float, d: float) -> float:
    """Sum a b + c d, each product rounded by itself: alike in one lane and in all.

    Of several products in one sum the compiler may choose which it rounds with the sum; adding zero
    leaves it no choice. So do all sums of the step that more than one loop could share.
    """
    return (a * b + 0.0) + (c * d + 0.0)


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
    B, C = dot(P, cosine, Q, sine), c + dot(P, sine, -Q, cosine)
    u = (s.phase_u0[l] - P) + dot(P, versed, c, x) - (Q * sine + 0.0)
    spin_1, base = s.spin_1[l], s.spin_0[l] + s.spin_1[l] * sine
    rolls = spin_1 > 0.0
    g = s.spin[l] * ((x - sine) / base if rolls else 1.0)
    g_slope = spin_1 * (versed - g * cosine) / base
    G = versed + g
    A = inertia(s.io_1[l], s.one_4gamma[l], s.four_gamma_eta[l], dot(B, B, C, C), B)
    J = dot(s.io_1[l] * sine, sine, s.inertia_axial[l] * G, G) + s.one_4gamma[l] * u * u
    H = dot(s.io_1[l] * sine, cosine, s.inertia_axial[l] * G, sine + g_slope)
    return Place(sine, cosine, B, C, u, A, J, H + s.one_4gamma[l] * u * C, G, g_slope)


# Taylor terms.


@inlined
def begin_terms(s: Record, lanes: int) -> None:
    """Terms of order 0: the state, and what follows from it."""
    for l in range(lanes):
        s.V_term[l], s.V_y_term[l] = 0.0, 0.0
    for r in range(s.n):
        for l in range(lanes):
            omega2, damping = s.omega2[r, l], s.two_xi_omega[r, l]
            s.modal_force[r, l] = dot(omega2, s.q[r, l], damping, s.dq[0, r, l])
    add_shears(s, lanes)
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
def add_shears(s: Record, lanes: int) -> None:
    """Add up the terms of V in x and in y."""
    half = s.storeys & MOST
    for r in range(half):
        for l in range(lanes):
            s.V_term[l] += s.Gamma[r, l] * s.modal_force[r, l]
    for r in range(half):
        for l in range(lanes):
            s.V_y_term[l] += s.Gamma[half + r, l] * s.modal_force[half + r, l]


@inlined
def push_term(s: Record, l: int, V: float, a_g: float) -> float:
    """z from shear or device force V [N] and a_g [m/s2] [1/s2]."""
    return dot(s.shear_factor[l], V, -s.ground_over_R[l], a_g)


@inlined
def extend_positions(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of what depends on positions, from velocities up to order m - 1.

    Inner loops are few and long: the compiler is to unroll them once it knows m, not before.
    """
    k = m - 1
    for l in range(lanes):
        part = s.step[l] * (1.0 / m)
        sine, cosine, sine2, cosine2 = 0.0, 0.0, 0.0, 0.0
        cos_phi, sin_phi, J = 0.0, 0.0, 0.0
        for j in range(m):
            p, w = s.dtheta_terms[k - j, l], s.turning_terms[k - j, l]
            sine += s.cos_terms[j, l] * p
            cosine -= s.sin_terms[j, l] * p
            sine2 += s.cos2_terms[j, l] * p
            cosine2 -= s.sin2_terms[j, l] * p
            cos_phi -= s.sin_phi_terms[j, l] * w
            sin_phi += s.cos_phi_terms[j, l] * w
            J += s.H_terms[j, l] * p
        x, sine, cosine = part * s.dtheta_terms[k, l], part * sine, part * cosine
        sine2, cosine2 = 2.0 * part * sine2, 2.0 * part * cosine2
        P, Q, c = s.phase_p[l], s.phase_q[l], s.phase_c[l]
        D, u = dot(P, sine, -Q, cosine), dot(c, x, -Q, sine) - (P * cosine + 0.0)
        s.tilt_terms[m, l], s.sin_terms[m, l], s.cos_terms[m, l] = x, sine, cosine
        s.sin2_terms[m, l], s.cos2_terms[m, l] = sine2, cosine2
        s.cos_phi_terms[m, l], s.sin_phi_terms[m, l] = part * cos_phi, part * sin_phi
        s.D_terms[m, l], s.u_terms[m, l] = D, u
        if m <= ORDER:
            s.B_terms[m, l], s.J_terms[m, l] = dot(P, cosine, Q, sine), 2.0 * part * J
            vertical = dot(s.A_cos2[l], cosine2, s.A_sin2[l], sine2)
            s.A_terms[m, l] = dot(2.0 * c * s.one_4gamma[l], D, s.four_gamma_eta[l], vertical)
    extend_products(s, lanes, m)
    if m <= ORDER:
        extend_spin(s, lanes, m)


@inlined
def extend_products(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of u and C along both axes, and of H but for spin on arcs."""
    for l in range(lanes):
        c = s.phase_c[l]
        u_cos, u_sin, C_cos, C_sin, along = 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(m + 1):
            cos_phi, sin_phi = s.cos_phi_terms[m - j, l], s.sin_phi_terms[m - j, l]
            D, u = s.D_terms[j, l], s.u_terms[j, l]
            u_cos += u * cos_phi
            u_sin += u * sin_phi
            C_cos += D * cos_phi
            C_sin += D * sin_phi
            along += s.tilt_terms[m - j, l] * D
        s.u_cos_terms[m, l], s.u_sin_terms[m, l] = u_cos, u_sin
        speed = m / s.step[l] * s.diameter[l]
        s.beam_x[l], s.beam_y[l] = speed * u_cos + 0.0, speed * u_sin + 0.0
        if m <= ORDER:
            s.C_cos_terms[m, l] = C_cos + c * s.cos_phi_terms[m, l]
            s.C_sin_terms[m, l] = C_sin + c * s.sin_phi_terms[m, l]
            H = dot(s.H_sin[l], s.sin_terms[m, l], s.H_cos[l], s.cos_terms[m, l])
            H += s.H_sin2[l] * s.sin2_terms[m, l]
            H += s.H_cos2[l] * s.cos2_terms[m, l]
            H += s.H_x[l] * s.tilt_terms[m, l]
            s.H_terms[m, l] = H + s.one_4gamma[l] * c * along


@inlined
def extend_spin(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of what spin on arcs adds to G, dG/dx and H."""
    for l in range(lanes):
        spin_1, crossed, slope, more = s.spin_1[l], 0.0, 0.0, 0.0
        for j in range(1, m):
            sine, cosine = s.sin_terms[j, l], s.cos_terms[j, l]
            g_j, other, slope_j = s.g_terms[j, l], s.g_terms[m - j, l], s.g_slope_terms[m - j, l]
            crossed += sine * other
            slope += other * cosine
            slope += sine * slope_j
            more += (g_j - cosine) * slope_j
        sine, cosine = s.sin_terms[m, l], s.cos_terms[m, l]
        sine_0, cosine_0 = s.sin_terms[0, l], s.cos_terms[0, l]
        g_0, slope_0 = s.g_terms[0, l], s.g_slope_terms[0, l]
        per, rolls = 1.0 / (s.spin_0[l] + spin_1 * sine_0), 1.0 if spin_1 > 0.0 else 0.0
        crossed += g_0 * sine
        g = dot(rolls * s.spin[l], s.tilt_terms[m, l] - sine, -spin_1, crossed) * per
        slope += cosine + g_0 * cosine
        slope += g * cosine_0
        slope += sine * slope_0
        slope *= -spin_1 * per
        more += slope + (g_0 - cosine_0) * slope
        more += (g - cosine) * slope_0
        more += crossed + g * sine_0
        s.g_terms[m, l], s.g_slope_terms[m, l] = g, slope
        s.H_terms[m, l] += s.inertia_axial[l] * more


@inlined
def extend_tilt(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of p, L and w."""
    k = m - 1
    for l in range(lanes):
        h = s.step[l]
        part = h * (1.0 / m)
        p, w, w_last = s.dtheta_terms[0, l], s.turning_terms[0, l], s.turning_terms[k, l]
        z_x, z_y = s.z_x_terms[0, l], s.z_y_terms[0, l]
        pushes = dot(z_x, s.C_cos_terms[k, l], z_y, s.C_sin_terms[k, l])
        turns = dot(z_y, s.u_cos_terms[k, l], -z_x, s.u_sin_terms[k, l])
        inertial, slowed = 0.5 * s.A_terms[m, l] * p + 0.0, s.J_terms[m, l] * w + 0.0
        w2 = w * w_last + 0.0
        for j in range(1, m):
            z_x, z_y = s.z_x_terms[j, l], s.z_y_terms[j, l]
            pushes += z_x * s.C_cos_terms[k - j, l]
            pushes += z_y * s.C_sin_terms[k - j, l]
            pushes += s.H_terms[j, l] * s.w2_terms[k - j, l]
            turns += z_y * s.u_cos_terms[k - j, l]
            turns -= z_x * s.u_sin_terms[k - j, l]
            w2 += s.turning_terms[j, l] * s.turning_terms[k - j, l] + 0.0
            inertial += (0.5 * (m + j) / m) * s.A_terms[m - j, l] * s.dtheta_terms[j, l]
            slowed += s.J_terms[m - j, l] * s.turning_terms[j, l]
        s.w2_terms[k, l] = w2
        pushes += s.H_terms[0, l] * w2
        g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
        before = s.B_terms[k - 1, l] if m > 1 else 0.0
        weights = s.weight_over_R[l] * dot(g_up, s.B_terms[k, l], h * s.g_up_slope[l], before)
        s.dtheta_terms[m, l] = -s.per_A[l] * (part * (weights - pushes) + inertial)
        momentum = part * turns + 0.0
        s.momentum_terms[m, l] = momentum
        s.turning_terms[m, l] = s.per_J[l] * (momentum - slowed)


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
    half = s.storeys & MOST
    for r in range(half):
        for l in range(lanes):
            s.V_term[l] += extended_mode(s, r, l, m, s.beam_x[l])
    for r in range(half):
        for l in range(lanes):
            s.V_y_term[l] += extended_mode(s, half + r, l, m, s.beam_y[l])
    for l in range(lanes):
        rise = s.step[l] if m == 1 else 0.0
        s.z_x_terms[m, l] = push_term(s, l, s.V_term[l], rise * s.a_g_slope[l])
        s.z_y_terms[m, l] = push_term(s, l, s.V_y_term[l], rise * s.a_g_y_slope[l])


@inlined
def extended_mode(s: Record, r: int, l: int, m: int, beam: float) -> float:
    """Write the term of order m of a mode; returns its part of V."""
    part, Gamma = s.step[l] * (1.0 / m), s.Gamma[r, l]
    q = part * s.dq[m - 1, r, l]
    dq = dot(-Gamma, beam, -part, s.modal_force[r, l])
    force = dot(s.two_xi_omega[r, l], dq, s.omega2[r, l], q)
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
