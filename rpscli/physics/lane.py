"""A lane: its numbers by the names that laws know, and what the
laws say of it (`laws`).
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from rpscli.physics.compile import compiled, fma, inlined
from rpscli.physics.laws import geometry, plane_bed
from rpscli.physics.laws.contacts import Masses, normal_forces, shears
from rpscli.physics.laws.motion import (
    beam_across,
    beam_along,
    bed_across,
    bed_along,
    bend_across,
    bend_along,
    felt_gravity,
    lift_of,
    push,
    weight_arms,
)
from rpscli.physics.laws.place import (
    UPRIGHT,
    ColumnConstants,
    Ends,
    Place,
    across,
    along,
    length,
    place_in_plane,
    place_in_space,
    sines,
    turned,
)
from rpscli.physics.state import FULL_CONTACT, PADDING, STUCK, Floats, Record

Vector: TypeAlias = tuple[float, float]
"""Components in x and y."""

patch_at = inlined(plane_bed.patch)


@inlined
def ways_of(s: Record) -> int:
    """Horizontal directions in which the ground moves; known to the compiler."""
    return s.tilt.shape[0]  # type: ignore[no-any-return]


@inlined
def lanes_of(s: Record) -> int:
    """Lanes of a state; known to the compiler."""
    return s.x.shape[0] - PADDING  # type: ignore[no-any-return]


@compiled
def stands(s: Record, l: int) -> bool:
    """True if the tilt of a lane is held: on rigid ends upright, or by friction."""
    return bool(s.phase[l] == FULL_CONTACT or s.phase[l] == STUCK)


# Directions: a vector has two components, in one plane the second is 0.


@inlined
def vector(s: Record, field: Floats, l: int) -> Vector:
    """A vector of a lane in x and y, of a field that has a row a direction."""
    return field[0, l], (field[1, l] if ways_of(s) == 2 else 0.0)


@inlined
def set_vector(s: Record, field: Floats, l: int, x: float, y: float) -> None:
    """Set it."""
    field[0, l] = x
    if ways_of(s) == 2:
        field[1, l] = y


@inlined
def shears_of(s: Record, field: Floats, l: int) -> tuple[float, float, float]:
    """Base shears of a lane in x, in y and upwards, of a field that has a row an axis."""
    x, y = vector(s, field, l)
    return x, y, field[ways_of(s), l]


@inlined
def resultant(s: Record, x: float, y: float) -> float:
    """Size of a vector."""
    return abs(x) if ways_of(s) == 1 else length(x, y)


@inlined
def azimuth_along(s: Record, x: float, y: float) -> float:
    """Azimuth of a vector, from x towards y [rad]; 0 in one plane."""
    return 0.0 if ways_of(s) == 1 else math.atan2(y, x)


@inlined
def sign_of(s: Record, l: int) -> float:
    """Sign of what is known along the tilt: in one plane s, else 1."""
    return s.side[l] if ways_of(s) == 1 else 1.0


@inlined
def is_cone(s: Record, l: int) -> bool:
    """True if a lane passes upright as a cone's tip: rigid ends that tilt to any side."""
    return False if ways_of(s) == 1 else s.cone[l] > 0.0


# Tilt and rate.


@inlined
def tilt_of(s: Record, l: int) -> Vector:
    """The tilt vector at the start of the step."""
    return vector(s, s.tilt, l)


@inlined
def rate_of(s: Record, l: int) -> Vector:
    """Its rate."""
    return vector(s, s.tilt_rate, l)


@inlined
def new_tilt_of(s: Record, l: int) -> Vector:
    """The tilt vector at a stage of the step, and at its end."""
    return vector(s, s.new_tilt, l)


@inlined
def new_rate_of(s: Record, l: int) -> Vector:
    """Its rate."""
    return vector(s, s.new_tilt_rate, l)


class Polar(NamedTuple):
    """A tilt and its rate along it and across; upright the azimuth is 0."""

    x: float  # along its side in one plane
    n: float  # cosine and sine of the azimuth
    t: float
    p: float  # rate along the tilt, and across it
    q: float


@inlined
def polar(s: Record, l: int, tilt: Vector, rate: Vector) -> Polar:
    """A tilt vector and its rate along it and across."""
    if ways_of(s) == 1:
        side = s.side[l]
        return Polar(side * tilt[0], side, 0.0, side * rate[0], 0.0)
    x = length(tilt[0], tilt[1])
    n, t = (tilt[0] / x, tilt[1] / x) if x > 0.0 else (1.0, 0.0)
    return Polar(x, n, t, along(n, t, rate[0], rate[1]), across(n, t, rate[0], rate[1]))


# Geometry and inertia.


@inlined
def phase_of(s: Record, l: int) -> geometry.Phase:
    """Constants of a lane's phase of motion."""
    return geometry.Phase(s.p[l], s.q0[l], s.c[l], s.u0[l], s.v0[l])


@inlined
def column_of(s: Record, l: int) -> ColumnConstants:
    """Inertia and spin of a lane's columns."""
    return ColumnConstants(
        s.io_1[l],
        s.i_3[l],
        s.one[l],
        s.one[l] + s.four[l],
        s.sin_a[l],
        s.spin[l],
        s.rolls[l] > 0.0,
        s.sin_beta[l],
        s.excess_beta[l],
        s.turned[l],
    )


@inlined
def ends_of(s: Record, l: int) -> Ends:
    """Ends that a lane stands on."""
    return Ends(s.bed_k[l], s.bed_c[l], s.rim[l], s.sink[l], s.root[l])


@inlined
def patch(s: Record, l: int, x: float) -> tuple[float, float]:
    """w and its slope, while a plane end lifts (12.6); else 0."""
    lifts = (s.root[l] > 0.0) & (x > 0.0)
    w, slope = patch_at(x if lifts else 1.0, s.bed_u[l], s.fade[l])
    return (w if lifts else 0.0), (slope if lifts else 0.0)


@inlined
def place_with(s: Record, l: int, x: float, w: float, dw: float) -> Place:
    """Geometry and inertia of a lane at a tilt, where the patch is known."""
    if ways_of(s) == 1:
        sine, less, _ = sines(x)
        return place_in_plane(
            column_of(s, l), phase_of(s, l), s.root[l], sine, less, w, dw
        )
    return place_in_space(
        column_of(s, l), phase_of(s, l), ends_of(s, l), max(x, UPRIGHT), w, dw
    )


@compiled
def place_of(s: Record, l: int, x: float) -> Place:
    """Geometry and inertia of a lane at a tilt."""
    w, dw = patch(s, l, x)
    return place_with(s, l, x, w, dw)


# What acts.


@inlined
def ground_at(s: Record, l: int, axis: int, time: float) -> float:
    """a_g at a time of the interval [m/s2]."""
    return s.a_g[axis, l] + time * s.a_g_slope[axis, l]  # type: ignore[no-any-return]


@inlined
def g_up_at(s: Record, l: int, time: float) -> float:
    """The sum g + a_v at a time of the interval [m/s2]."""
    return s.g_up[l] + time * s.g_up_slope[l]  # type: ignore[no-any-return]


@inlined
def ground_of(s: Record, l: int, time: float) -> Vector:
    """a_g in x and y at a time of the interval [m/s2]."""
    start = vector(s, s.a_g, l)
    slope = vector(s, s.a_g_slope, l)
    return start[0] + time * slope[0], start[1] + time * slope[1]


@inlined
def pushed_by(s: Record, l: int, force: float) -> float:
    """The z of a horizontal force at the cap beam [1/s2]."""
    return s.share[l] * force  # type: ignore[no-any-return]


@inlined
def z_of(s: Record, l: int, force: float, a_g: float) -> float:
    """The z of a horizontal force at the cap beam and of the
    ground's acceleration [1/s2].
    """
    return push(s.share[l], force, s.load[l], a_g)


@inlined
def z_vector(s: Record, l: int, force: Vector, a_g: Vector) -> Vector:
    """z in x and y."""
    return z_of(s, l, force[0], a_g[0]), z_of(s, l, force[1], a_g[1])


@inlined
def z_at(s: Record, l: int, end: int) -> tuple[Vector, Vector]:
    """z in x and y of what is not friction, at the start of the step (0) or
    at its end (1) [1/s2]; and its rate.
    """
    a_g = ground_of(s, l, s.time[l] + end * s.h[l])
    V = vector(s, s.new_V, l) if end > 0 else vector(s, s.V, l)
    dV = vector(s, s.new_dV, l) if end > 0 else vector(s, s.dV, l)
    return z_vector(s, l, V, a_g), z_vector(s, l, dV, vector(s, s.a_g_slope, l))


@inlined
def force_of(s: Record, l: int, pushed: float, a_g: float) -> float:
    """The horizontal force at the cap beam under which R z is `pushed` [N]."""
    per_share = 2.0 / (s.diameter[l] * s.share[l])
    return float(pushed * per_share + s.load[l] / s.share[l] * a_g)


@inlined
def felt(s: Record, l: int, g_up: float, V_up: float) -> float:
    """g_f, what contacts feel of g + a_v [m/s2], under forces V_up of
    the floors' springs [N].
    """
    return felt_gravity(s.gravity[l], g_up, s.spared[l], s.floors_mass[l], V_up)


@compiled
def felt_at(s: Record, l: int, end: int) -> tuple[float, float, float]:
    """g_f with two derivatives, at the start of the step (0) or at its end (1)."""
    up = ways_of(s)
    time = s.time[l] + end * s.h[l]
    spared = s.spared[l]
    slope = s.g_up_slope[l]
    V = s.V[up, l]
    dV = s.dV[up, l]
    ddV = s.ddV[up, l]
    if end > 0:
        V = s.new_V[up, l]
        dV = s.new_dV[up, l]
        ddV = s.new_ddV[up, l]
    g_felt = felt(s, l, g_up_at(s, l, time), V)
    return g_felt, slope - spared * (s.floors_mass[l] * slope + dV), -spared * ddV


@inlined
def mode_acceleration(s: Record, r: int, l: int, axis: int) -> float:
    """Acceleration of a mode at the start of the step."""
    force = (
        fma(s.omega2[r, l], s.q[r, l], s.two_xi_omega[r, l] * s.dq[r, l]) - s.freed[r, l]
    )
    return fma(-s.Gamma[r, l], s.shaking[axis, l], -force)


# How it responds.


class Motion(NamedTuple):
    """Accelerations of a tilt that is free, and of the cap beam."""

    bend_x: float  # of the tilt vector [rad/s2]
    bend_y: float
    beam_x: float  # u_b'' [m/s2]
    beam_y: float
    lift: float  # v_b'' [m/s2]
    a: float  # x'' [rad/s2]


class Response(NamedTuple):
    """Accelerations of a lane's storey and the ground, under base shears at a time."""

    a_x: float  # a_g [m/s2]
    a_y: float
    g_up: float  # g + a_v [m/s2]
    bend_x: float  # of the tilt vector [rad/s2]
    bend_y: float
    beam_x: float  # u_b'' [m/s2]
    beam_y: float
    lift: float  # v_b'' [m/s2]
    a: float  # x'' [rad/s2]


@inlined
def respond(
    s: Record,
    l: int,
    at: Place,
    w: float,
    tilt: Polar,
    V: tuple[float, float, float],
    time: float,
) -> Response:
    """The equation of motion of a lane under base shears in x, in y and upwards [N].

    At a place and a rate of the tilt, a time of the interval [s],
    and what devices now do.
    """
    a_g = ground_of(s, l, time)
    drive = vector(s, s.drive, l)
    z = z_vector(s, l, (V[0] + drive[0], V[1] + drive[1]), a_g)
    g_up = g_up_at(s, l, time)
    g_felt = felt(s, l, g_up, V[2])
    arms = weight_arms(at, ends_of(s, l), s.weigh[l], w, s.gravity[l], g_felt)
    if ways_of(s) == 1:
        found = move_in_plane(s, l, at, arms, tilt, z)
    else:
        found = move_to_any_side(s, l, at, arms, tilt, z)
    moves = s.moves[l] > 0.0
    return Response(
        a_g[0],
        a_g[1],
        g_up,
        found.bend_x if moves else 0.0,
        found.bend_y if moves else 0.0,
        found.beam_x if moves else 0.0,
        found.beam_y if moves else 0.0,
        found.lift if moves else 0.0,
        found.a if moves else 0.0,
    )


@inlined
def move_in_plane(
    s: Record, l: int, at: Place, arms: float, tilt: Polar, z: Vector
) -> Motion:
    """Motion of a free tilt in one plane, of what weight turns it back by."""
    p = tilt.p
    diameter = s.diameter[l]
    held = arms + bed_along(ends_of(s, l), tilt.x, p) - s.turning[l]
    out = bend_along(at, held, p, tilt.q, along(tilt.n, tilt.t, z[0], 0.0))
    beam = tilt.n * beam_along(at, diameter, out, p, tilt.q)
    lift = lift_of(at, diameter, out, p)
    return Motion(tilt.n * out, 0.0, beam, 0.0, lift, out)


@inlined
def move_to_any_side(
    s: Record, l: int, at: Place, arms: float, tilt: Polar, z: Vector
) -> Motion:
    """Motion of a free tilt to any side."""
    x, n, t, _, _ = tilt
    diameter = s.diameter[l]
    ends = ends_of(s, l)
    leans = x > 0.0  # upright no square depends on the direction, which is any
    arms = arms if leans else 0.0
    p = tilt.p if leans else 0.0
    q = tilt.q if leans else 0.0
    held = arms + bed_along(ends, x, tilt.p) - s.turning[l]
    out = bend_along(at, held, p, q, along(n, t, z[0], z[1]))
    per_x = 1.0 / (x if leans else 1.0)
    held = bed_across(ends, per_x, tilt.q) - s.turning_across[l]
    aside = bend_across(at, held, p, q, across(n, t, z[0], z[1]))
    bend_x, bend_y = turned(n, t, out, aside)
    beam_out = beam_along(at, diameter, out, p, q)
    beam_aside = beam_across(at, diameter, aside, p, q)
    beam_x, beam_y = turned(n, t, beam_out, beam_aside)
    a = out + tilt.q * tilt.q * per_x
    lift = lift_of(at, diameter, a, tilt.p)
    return Motion(bend_x, bend_y, beam_x, beam_y, lift, a)


@inlined
def velocity_with(s: Record, l: int, at: Place, tilt: Polar) -> Vector:
    """u_b' in x and in y at a place and a rate of the tilt [m/s]."""
    out = s.diameter[l] * at.C * tilt.p
    aside = s.diameter[l] * at.h * tilt.q
    if ways_of(s) == 1:
        return out * tilt.n, 0.0
    return turned(tilt.n, tilt.t, out, aside)


@inlined
def masses_of(s: Record, l: int) -> Masses:
    """Masses of a lane's storey."""
    return Masses(s.columns_mass[l], s.cap_beam_mass[l], s.floors_mass[l], s.riding[l])


@inlined
def pushed_beam(s: Record, l: int, V: Vector, now: Polar) -> Vector:
    """Push on the cap beam in x and y: base shears, devices and tendons [N]."""
    drive = vector(s, s.drive, l)
    V_x = V[0] + drive[0] + s.tied[l] * now.n
    return V_x, V[1] + drive[1] + s.tied[l] * now.t


@inlined
def contact_forces(
    s: Record,
    l: int,
    beam: float,
    lift: float,
    V: float,
    a_g: float,
    up: tuple[float, float],
) -> tuple[float, float, float, float]:
    """F and N of all columns together at their upper and lower ends, in
    one direction [N] (8.4).

    Of u_b'', v_b'', what pushes the beam and the ground; `up` are g + a_v and V_up.
    """
    F, F_bottom = shears(masses_of(s, l), beam, a_g, V)
    N, N_bottom = normal_forces(
        masses_of(s, l), s.gravity[l], up[0], lift, up[1], s.pull[l]
    )
    return F, F_bottom, N, N_bottom


@inlined
def without_shock(s: Record, l: int, x: float, rate: Vector) -> float:
    """0 where a motion is part of a pass that takes less than
    `shock_time`: an impact's impulse.

    Beam and columns are turned over within it; forces of contacts are then
    those of a beam that keeps its velocity, and what turns it is added
    afterwards, if it is known (13.19).
    """
    own = s.shock_time[l]
    short = own * own * (rate[0] * rate[0] + rate[1] * rate[1]) > x * x
    return 0.0 if is_cone(s, l) & short else 1.0
