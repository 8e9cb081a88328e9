"""Geometry and inertia at a tilt."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.physics.compile import inlined
from rpscli.physics.laws.geometry import Phase, contact_arm, contact_height, inertia

inlined(contact_arm)
inlined(contact_height)
inlined(inertia)

S3, S5, S7, S9, S11, S13, S15, S17, S19 = (
    1 / math.factorial(k) * (-1) ** (k // 2 + 1) for k in range(3, 20, 2)
)
C2, C4, C6, C8, C10, C12, C14, C16, C18, C20 = (
    1 / math.factorial(k) * (-1) ** (k // 2 + 1) for k in range(2, 21, 2)
)


@inlined
def sines(x: float) -> tuple[float, float, float]:
    """sin x, 1 - cos x and x - sin x by their series, without loss near zero [rad].

    They leave less than 5e-16 for |x| <= pi/2, which no standing column exceeds. Terms
    are added in pairs, and pairs of pairs (G. Estrin, 1960): what follows waits for
    five operations, not ten.
    """
    z = x * x
    z2 = z * z
    z4 = z2 * z2
    low = (S3 + z * S5) + (S7 + z * S9) * z2
    high = (S11 + z * S13) + (S15 + z * S17) * z2
    excess = x * z * ((low + high * z4) + S19 * z4 * z4)
    low = (C2 + z * C4) + (C6 + z * C8) * z2
    high = (C10 + z * C12) + (C14 + z * C16) * z2
    return x - excess, z * ((low + high * z4) + (C18 + z * C20) * z4 * z4), excess


@inlined
def length(x: float, y: float) -> float:
    """Length of a vector."""
    return math.sqrt(x * x + y * y)


@inlined
def along(n: float, t: float, x: float, y: float) -> float:
    """The part of a vector along an azimuth of cosine n and sine t."""
    return x * n + y * t


@inlined
def across(n: float, t: float, x: float, y: float) -> float:
    """And across it."""
    return y * n - x * t


@inlined
def turned(n: float, t: float, out: float, aside: float) -> tuple[float, float]:
    """A vector in x and y, of its parts along an azimuth and across it."""
    return out * n - aside * t, out * t + aside * n


class ColumnConstants(NamedTuple):
    """Inertia of columns and what they carry, over N m_c R^2, and the
    spin of a column's ends.
    """

    io_1: float  # Io - 1
    i_3: float  # I_3/(m_c R^2)
    one: float  # 1 + 4 gamma, pushed with the cap beam
    both: float  # and what is lifted with it
    sin_a: float  # sin(alpha)
    spin: float  # k while rolling: columns spin by (13.1)
    rolls: bool  # on the arcs
    sin_beta: float  # of the end of the arcs
    excess_beta: float  # beta - sin(beta)
    turned: float  # keeps K continuous at phi_u of a bed, times x^2


class Ends(NamedTuple):
    """Effects of a bed: stiffness, damping in full contact, and how a plane end lifts."""

    k: float  # in full contact [1/s2], else 0
    c: float  # damping there [1/s], else 0
    rim: float  # c phi_u beyond it, against what goes round [rad/s], else 0
    sink: float  # while a plane end lifts [sqrt(rad)], else 0
    root: float  # likewise


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
def place_in_plane(
    column: ColumnConstants,
    phase: Phase,
    root: float,
    sine: float,
    less: float,
    w: float,
    dw: float,
) -> Place:
    """A tilt in one plane, of which sine and 1 - cosine are
    given, under a patch w (12.6).
    """
    B = contact_arm(phase, 1.0 - less, sine)
    C = contact_height(phase, 1.0 - less, sine)
    Bv = B - root * w
    Bv_slope = (phase.c - C) - root * dw
    A = inertia(column.io_1, column.one, column.both, C * C, Bv * Bv)
    D = column.one * (C * B) + column.both * (Bv * Bv_slope)
    return Place(B, C, Bv, Bv_slope, A, D, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def spun(
    column: ColumnConstants, sine: float, less: float, excess: float
) -> tuple[float, float]:
    """G and its slope: how columns spin as the tilt goes round (13.1)."""
    base = column.sin_a + column.spin * (sine if column.rolls else column.sin_beta)
    more = column.spin * (excess if column.rolls else column.excess_beta)
    more /= base if base > 0.0 else 1.0
    slope = column.spin * (less - more * (1.0 - less)) / (base if column.rolls else 1.0)
    return less + more, sine + (slope if column.rolls else 0.0)


@inlined
def place_in_space(
    column: ColumnConstants, phase: Phase, ends: Ends, x: float, w: float, dw: float
) -> Place:
    """A tilt to any side."""
    sine, less, excess = sines(x)
    at = place_in_plane(column, phase, ends.root, sine, less, w, dw)
    per_x = 1.0 / x
    sine_x = sine * per_x
    less_x = less * per_x
    excess_x = excess * per_x
    gap = (
        phase.p * (sine - less_x)
        + phase.q * (less - excess_x)
        - (phase.u0 - phase.p) * per_x
    )
    h = at.C - gap
    G, G_slope = spun(column, sine, less, excess)
    G_x = G * per_x
    flat = less - excess_x
    i_3 = column.i_3
    io_1 = column.io_1
    one = column.one
    turned = column.turned * (per_x * per_x)
    K = io_1 * (sine_x * sine_x) + i_3 * (G_x * G_x) + one * (h * h) + turned
    K_slope = -io_1 * sine_x * flat + i_3 * G_x * (G_slope - G_x) + one * h * gap - turned
    cone = i_3 * (G_x * G_x) - io_1 * excess_x * (1.0 + sine_x) + turned
    cone = cone - one * gap * (h + at.C) - column.both * (at.Bv * at.Bv)
    bedded = ends.k > 0.0
    return Place(
        at.B,
        at.C,
        at.Bv,
        at.Bv_slope,
        at.A,
        at.D,
        h,
        gap * per_x,
        at.A if bedded else K,
        0.0 if bedded else 2.0 * per_x * K_slope,
        0.0 if bedded else per_x * cone,
        0.0 if bedded else G,
        0.0 if bedded else G_slope,
    )
