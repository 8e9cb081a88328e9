"""The equation of motion: tilt of the storey, building modes (Theory (2.3), (10.1) to (10.6)).

The tilt is x = |theta| >= 0 and s = sign(theta); a motion to the left is the mirror image of one
to the right, so only the horizontal action carries s. The building is followed in the modes of its
fixed base, relative to the cap beam: v = Phi q with mass-normalised shapes and Gamma = Phi^T M 1.

    A x'' + D x'^2 = -B (g + a_v)(1 + 2 gamma + 2 gamma eta)/R - C action + G
    action = s (a_g (1 + 2 gamma)/R - 2 V/(N m_c R))
    q_r'' + f_r = -Gamma_r (a_g + u_b''),   f_r = w_r^2 q_r + 2 xi_r w_r q_r',   V = sum Gamma_r f_r

What couples the modes is the motion of the cap beam alone, so a storey more costs one mode more and
no matrix is formed. Everything that moves or weighs is written here, with its Taylor terms beside
it; G is what `devices` add, 0 without them. Kept beyond x = 0 and x = beta the right-hand side is
smooth, which is what the event location needs.

Taylor terms over a step h: coefficients are those of powers of t/h, f = f_0 + f_1 t/h + ..., so
that a term is what it adds to the end, and derivatives are m/h times the next term. With C' = B x'
and B' = (c - C) x' along the motion, and the ground's acceleration linear in time, every term
follows from those before it by sums of products (A. Jorba and M. Zou, Exp. Math. 14 (2005) 99-117):

    B_m = -(h/m) sum (C - c)_j x'_(m-1-j)           C_m = (h/m) sum B_j x'_(m-1-j)
    A_m = 2 c (1 + 4 gamma) C_m + 4 gamma eta sum B_j B_(m-j)
    sum (m + j)/2 A_(m-j) x'_j = -h R_(m-1)         from A x'' + A' x'/2 = -R
    q'_m = -Gamma (h/m a_g + s 2R sum C_j x'_(m-j))_m - (h/m) f_(m-1)
"""

from __future__ import annotations

import math
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.core.compile import compiled, inlined
from rpscli.physics.core.records import Record
from rpscli.physics.core.series import Terms, sine_cosine
from rpscli.physics.planar import geometry
from rpscli.physics.planar.bed.terms import (
    accelerate_on_bed,
    bear,
    inertia_on_bed,
    lift_product,
)
from rpscli.physics.planar.geometry import Phase

Number = TypeVar("Number", float, NDArray[np.float64])
"""Numbers in the kernels, arrays where samples follow from what was stored."""

contact_arm = compiled(geometry.contact_arm)
contact_height = compiled(geometry.contact_height)
squared_distance = compiled(geometry.squared_distance)
cap_beam_displacement = compiled(geometry.cap_beam_displacement)
cap_beam_lift = compiled(geometry.cap_beam_lift)


@compiled
def phase_constants(s: Record, l: int) -> Phase:
    """Constants of the phase of motion of a lane."""
    return Phase(s.phase_p[l], s.phase_q[l], s.phase_c[l], s.phase_u0[l], s.phase_v0[l])


# The terms of the equation.


@compiled
def inertia(io_1: float, one_4gamma: float, four_gamma_eta: float, S: Number, B: Number) -> Number:
    """A(x) = Io - 1 + (1 + 4 gamma) S + 4 gamma eta B^2 (paper, Table 1); numbers or arrays."""
    return io_1 + one_4gamma * S + four_gamma_eta * (B * B)


@compiled
def inertia_slope(
    one_4gamma: float, four_gamma_eta: float, phase: Phase, B: float, C: float
) -> float:
    """D(x) = A'(x)/2, with S' = 2 c B and B' = c - C.

    The paper's Table 1 lacks the factor 4 gamma eta in the rocking phase (c = 0).
    """
    return B * (one_4gamma * phase.c + four_gamma_eta * (phase.c - C))


@compiled
def horizontal_action(s: Record, l: int, a_g: float, V: float) -> float:
    """What acts horizontally on the storey, towards smaller x [1/s2] [a_g m/s2, V N]."""
    return float(s.side[l] * (a_g * s.ground_over_R[l] - V * s.shear_factor[l]))


@compiled
def rotation_acceleration(
    per_A: float,
    B: float,
    C: float,
    D: float,
    theta_dot: float,
    weight: float,
    action: float,
    device: float = 0.0,
) -> float:
    """x'' of the equation of motion (paper, Eq. 2) [rad/s2]."""
    return -(((B * weight + D * (theta_dot * theta_dot)) + C * action) - device) * per_A


@compiled
def cap_beam_acceleration(
    side: Number,
    diameter: float,
    c: Number,
    B: Number,
    C: Number,
    theta_dot: Number,
    theta_ddot: Number,
) -> tuple[Number, Number]:
    """u_b'' and v_b'' relative to the ground [m/s2] (Theory (8.6)); numbers or arrays."""
    square = theta_dot * theta_dot
    across = side * diameter * (C * theta_ddot + B * square)
    return across, diameter * (B * theta_ddot + (c - C) * square)


# Accelerations at the end of a step.


@compiled
def add_modal_force(s: Record, r: int, l: int) -> None:
    """f_r of a mode, and its part of V."""
    force = s.omega2[r, l] * s.next_q[r, l] + s.two_xi_omega[r, l] * s.next_dq[r, l]
    s.modal_force[r, l] = force
    s.next_V[l] += s.Gamma[r, l] * force


@inlined
def accelerate_rotation(s: Record, l: int, elapsed: float) -> None:
    """x'' and what it is made of, where V is known; see `accelerate`."""
    theta_dot = s.next_theta_dot[l]
    sine, cosine = sine_cosine(s.next_theta[l])
    phase = phase_constants(s, l)
    B, C = contact_arm(phase, cosine, sine), contact_height(phase, cosine, sine)
    time = s.time[l] + elapsed * s.step[l]
    a_g = s.a_g[l] + s.a_g_slope[l] * time
    g_up = s.g_up[l] + s.g_up_slope[l] * time
    S = squared_distance(phase, C)
    per_A = 1.0 / inertia(s.io_1[l], s.one_4gamma[l], s.four_gamma_eta[l], S, B)
    D = inertia_slope(s.one_4gamma[l], s.four_gamma_eta[l], phase, B, C)
    action = horizontal_action(s, l, a_g, s.next_V[l])
    s.next_theta_ddot[l] = rotation_acceleration(
        per_A, B, C, D, theta_dot, g_up * s.weight_over_R[l], action, s.next_device[l]
    )
    s.next_B[l], s.next_C[l], s.next_per_A[l] = B, C, per_A
    s.next_a_g[l], s.next_g_up[l] = a_g, g_up
    accelerate_on_bed(s, l, phase.c, B, C, action, g_up)


@compiled
def accelerate(s: Record) -> None:
    """Accelerations of all lanes at the ends of their steps.

    Reads `next_theta`, `next_theta_dot`, `next_q` and `next_dq`; writes `modal_force` and all else
    of the end of the step.
    """
    lanes = s.lanes
    for l in range(lanes):
        s.next_V[l] = 0.0
    for r in range(s.n):
        for l in range(lanes):
            add_modal_force(s, r, l)
    for l in range(lanes):
        accelerate_rotation(s, l, 1.0)


@compiled
def renew_accelerations(s: Record, l: int) -> None:
    """Accelerations of one lane at its present state and time."""
    s.next_theta[l], s.next_theta_dot[l], s.next_V[l] = s.theta[l], s.theta_dot[l], 0.0
    for r in range(s.n):
        s.next_q[r, l], s.next_dq[r, l] = s.q[r, l], s.dq[0, r, l]
        add_modal_force(s, r, l)
    accelerate_rotation(s, l, 0.0)
    s.theta_ddot[l], s.B[l], s.C[l] = s.next_theta_ddot[l], s.next_B[l], s.next_C[l]
    s.per_A[l], s.V[l] = s.next_per_A[l], s.next_V[l]


# The same as Taylor terms.


@compiled
def begin_terms(s: Record) -> None:
    """Terms of order 0: the state.

    Modal forces are formed again: a step may be repeated, and then they are already of its end.
    """
    lanes = s.lanes
    for l in range(lanes):
        s.dtheta_terms[0, l] = s.theta_dot[l]
        s.B_terms[0, l] = s.B[l]
        s.C_terms[0, l] = s.C[l]
        a_g = s.a_g[l] + s.a_g_slope[l] * s.time[l]
        s.action_terms[0, l] = horizontal_action(s, l, a_g, s.V[l])
    for r in range(s.n):
        for l in range(lanes):
            s.modal_force[r, l] = s.omega2[r, l] * s.q[r, l] + s.two_xi_omega[r, l] * s.dq[0, r, l]


@inlined
def extend_rotation(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of B, C, A and x', and what they ask of the modes."""
    k = m - 1
    for l in range(lanes):
        h = s.step[l]
        part = h * (1.0 / m)
        B, C, c = s.B_terms[0, l], s.C_terms[0, l], s.phase_c[l]
        first, last = s.dtheta_terms[0, l], s.dtheta_terms[k, l]
        sum_B, sum_C, sum_action = 0.0, 0.0, -s.device_terms[k, l]
        square, lifted, inertial, beam = 0.0, 0.0, 0.0, 0.0
        for j in range(1, m):
            sum_B += s.C_terms[j, l] * s.dtheta_terms[k - j, l]
            sum_C += s.B_terms[j, l] * s.dtheta_terms[k - j, l]
            sum_action += s.C_terms[j, l] * s.action_terms[k - j, l]
            square += s.B_terms[j, l] * s.B_terms[m - j, l]
            lifted += lift_product(s, l, j, m - j)
            inertial += (0.5 * (m + j) / m) * s.A_terms[m - j, l] * s.dtheta_terms[j, l]
            beam += s.C_terms[j, l] * s.dtheta_terms[m - j, l]
        B_m = -part * ((C - c) * last + sum_B)
        C_m = part * (B * last + sum_C)
        squares = 2.0 * B * B_m + square
        A_m = 2.0 * c * s.one_4gamma[l] * C_m + s.four_gamma_eta[l] * squares
        A_m, sum_action = bear(s, l, m, A_m, B_m, squares, lifted, sum_action)
        s.B_terms[m, l], s.C_terms[m, l], s.A_terms[m, l] = B_m, C_m, A_m
        g_up = s.g_up[l] + s.g_up_slope[l] * s.time[l]
        before = s.B_terms[k - 1, l] if m > 1 else 0.0
        weights = g_up * s.B_terms[k, l] + h * s.g_up_slope[l] * before
        force = s.weight_over_R[l] * weights + sum_action
        inertial += 0.5 * A_m * first
        # What was found last, the action of the modes, enters last.
        rate = -(s.per_A[l] * part * C) * s.action_terms[k, l] - s.per_A[l] * (
            part * force + inertial
        )
        rate = h * s.theta_ddot[l] if m == 1 else rate
        s.dtheta_terms[m, l] = rate
        a_g = s.a_g[l] + s.a_g_slope[l] * s.time[l]
        ground = a_g if m == 1 else (h * s.a_g_slope[l] if m == 2 else 0.0)
        across = s.side[l] * s.diameter[l]
        s.beam_velocity_term[l] = (across * C) * rate + (
            across * (C_m * first + beam) + part * ground
        )


@inlined
def extend_modes(s: Record, lanes: int, m: int) -> None:
    """Terms of order m of the modes, their forces, and with V the action on the storey."""
    for l in range(lanes):
        s.action_terms[m, l] = 0.0
    for r in range(s.n):
        for l in range(lanes):
            part, Gamma = s.step[l] * (1.0 / m), s.Gamma[r, l]
            q = part * s.dq[m - 1, r, l]
            dq = -Gamma * s.beam_velocity_term[l] - part * s.modal_force[r, l]
            force = s.two_xi_omega[r, l] * dq + s.omega2[r, l] * q
            s.dq[m, r, l] = dq
            s.modal_force[r, l] = force
            s.action_terms[m, l] += Gamma * force
    for l in range(lanes):
        s.action_terms[m, l] = action_term(s, l, m, s.action_terms[m, l])


@compiled
def action_term(s: Record, l: int, m: int, V_m: float) -> float:
    """Term of order m > 0 of `horizontal_action` [V_m N]."""
    ground = s.step[l] * s.a_g_slope[l] * s.ground_over_R[l] if m == 1 else 0.0
    side = s.side[l]
    return float(side * ground - (side * s.shear_factor[l]) * V_m)


# What follows from it: energy, the margin against uplift, contact forces.


@compiled
def tilting_energy(s: Record, l: int, B: float, C: float, theta_dot: float) -> float:
    """Kinetic energy of columns and cap beam, and of the floors' vertical motion [J]."""
    phase = phase_constants(s, l)
    S = squared_distance(phase, C)
    A = inertia(s.io_1[l], s.one_4gamma[l], s.four_gamma_eta[l], S, B)
    A = inertia_on_bed(s, l, s.theta[l], A, B)
    square = s.diameter[l] * s.diameter[l]
    return float(0.125 * s.columns_mass[l] * square * A * (theta_dot * theta_dot))


@compiled
def load_factors(gamma: float, eta: float) -> tuple[float, float]:
    """1 + 2 gamma and 2 gamma eta: columns with the cap beam, and the building, over N m_c / 2."""
    return 1.0 + 2.0 * gamma, 2.0 * gamma * eta


@compiled
def lifted_mass(s: Record, l: int) -> float:
    """Mass that moves with the cap beam, half of the columns' included [kg]."""
    return float(0.5 * s.columns_mass[l] + s.cap_beam_mass[l] + s.floors_mass[l])


@compiled
def uplift_push(ground_factor: float, shear_share: float, a_g: float, V: float) -> float:
    """q = -a_g (1 + 2 gamma) + 2 gamma eta V/M_tot, which uplifts beyond +- the limit [m/s2].

    It is -R times `horizontal_action` of the side to the right, at x = 0 (Theory (3.1));
    linear in a_g and V, so that it serves their derivatives too.
    """
    return shear_share * V - ground_factor * a_g


@compiled
def contact_forces(
    cap_beam: float,
    floors: float,
    columns: float,
    across: float,
    upwards: float,
    V: float,
    a_g: float,
    g_up: float,
    pull: float = 0.0,
) -> tuple[float, float, float, float]:
    """Forces of all columns together on the beam, and of the ground on the columns [N].

    Returns: F_top, F_bot, N_top, N_bot (Theory (8.4), (8.5)).
    """
    shear_top = cap_beam * (across + a_g) - V
    shear_bottom = shear_top + columns * (0.5 * across + a_g)
    normal_top = (cap_beam + floors) * (g_up + upwards) + pull
    normal_bottom = normal_top + columns * (g_up + 0.5 * upwards)
    return shear_top, shear_bottom, normal_top, normal_bottom


@compiled
def friction(shear: float, normal: float) -> float:
    """|F|/N, infinite once the contact is lost; without branches, so that lanes go together."""
    presses = normal > 0.0
    demand = abs(shear) / (normal if presses else 1.0)
    return demand if presses else math.inf


Measures: TypeAlias = tuple[float, float, float, float, float, float]
"""|F|/N, N over the weight and |F|, each at the upper and at the lower ends."""


@compiled
def contact_measures(
    cap_beam: float,
    floors: float,
    columns: float,
    across: float,
    upwards: float,
    V: float,
    a_g: float,
    g_up: float,
    gravity: float,
    pull: float = 0.0,
) -> Measures:
    """Friction demands |F|/N, normal forces over the weight on them, and |F|; upper, lower ends.

    Where no mass stands on the columns their upper ends demand nothing: friction 0, normal force
    infinite.
    """
    shear_top, shear_bottom, normal_top, normal_bottom = contact_forces(
        cap_beam, floors, columns, across, upwards, V, a_g, g_up, pull
    )
    return measures_of(
        cap_beam + floors, columns, gravity, shear_top, shear_bottom, normal_top, normal_bottom
    )


@compiled
def measures_of(
    upper: float,
    columns: float,
    gravity: float,
    shear_top: float,
    shear_bottom: float,
    normal_top: float,
    normal_bottom: float,
) -> Measures:
    """The same of forces [N], with the masses above the columns and of the columns [kg]."""
    lower = upper + columns
    loaded, demand = upper > 0.0, friction(shear_top, normal_top)
    light_top = normal_top / (upper * gravity if loaded else 1.0)
    return (
        demand if loaded else 0.0,
        friction(shear_bottom, normal_bottom),
        light_top if loaded else math.inf,
        normal_bottom / (lower * gravity),
        abs(shear_top),
        abs(shear_bottom),
    )


# The motion within a step: the polynomials that the Taylor step leaves behind.


@compiled
def rotation_terms(s: Record, l: int) -> Terms:
    """Terms of x' of a lane."""
    d = s.dtheta_terms
    return d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]


@compiled
def modal_terms(s: Record, r: int, l: int) -> Terms:
    """Terms of the velocity of mode r of a lane."""
    d = s.dq
    return (
        d[0, r, l],
        d[1, r, l],
        d[2, r, l],
        d[3, r, l],
        d[4, r, l],
        d[5, r, l],
        d[6, r, l],
        d[7, r, l],
    )
