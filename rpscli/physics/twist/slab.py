"""The slab's equation of motion: columns, storeys and dampers on three ways (17.6)."""

from __future__ import annotations

import math
from typing import TypeAlias

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.laws.geometry import Phase
from rpscli.physics.laws.head import head_of, tilt_at
from rpscli.physics.laws.place import (
    UPRIGHT,
    ColumnConstants,
    Ends,
    Place,
    length,
    place_in_space,
    sines,
)
from rpscli.physics.state import Record
from rpscli.physics.twist.seats import set_loads, strain_of_seats


@inlined
def phase_of(c: Record) -> Phase:
    """Constants of the phase of motion that a column is in."""
    rolls = c.rolls > 0.0
    return Phase(
        c.rolling[0] if rolls else c.rocking[0],
        c.rolling[1] if rolls else c.rocking[1],
        c.rolling[2] if rolls else c.rocking[2],
        c.rolling[3] if rolls else c.rocking[3],
        c.rolling[4] if rolls else c.rocking[4],
    )


@inlined
def constants_of(c: Record) -> ColumnConstants:
    """Inertia and spin of a column."""
    rolls = c.rolls > 0.0
    return ColumnConstants(
        c.io_1,
        c.i_3,
        c.one,
        c.both,
        c.sin_a,
        c.spin,
        rolls,
        c.sin_beta,
        c.excess_beta,
        0.0,
    )


@inlined
def place_at(c: Record, x: float) -> Place:
    """Geometry and inertia of a column at a tilt."""
    rigid = Ends(0.0, 0.0, 0.0, 0.0, 0.0)
    return place_in_space(constants_of(c), phase_of(c), rigid, max(x, UPRIGHT), 0.0, 0.0)


@compiled
def place_heads(s: Record, columns: Record) -> None:
    """Displacement, velocity, tilt and lift of each head, of `new_way` and `new_rate`."""
    cos_psi = math.cos(s.new_way[2])
    sin_psi = math.sin(s.new_way[2])
    half = math.sin(0.5 * s.new_way[2])
    less = 2.0 * half * half
    for i in range(columns.shape[0]):
        c = columns[i]
        c.u_x = s.new_way[0] - less * c.x - sin_psi * c.y
        c.u_y = s.new_way[1] + sin_psi * c.x - less * c.y
        c.w_x = s.new_rate[0] - s.new_rate[2] * (sin_psi * c.x + cos_psi * c.y)
        c.w_y = s.new_rate[1] + s.new_rate[2] * (cos_psi * c.x - sin_psi * c.y)
        away = length(c.u_x, c.u_y)
        c.tilt = tilt_at(phase_of(c), away / c.diameter, c.tilt)
        c.lift = lift_at(c, c.tilt) - c.tan_a * (away - length(away, s.bowl) + s.bowl)


@inlined
def lift_at(c: Record, x: float) -> float:
    """v_b at a tilt [m], without loss near upright."""
    phase = phase_of(c)
    sine, less, _ = sines(x)
    return float(c.diameter * ((phase.v0 - phase.q) + phase.p * sine + phase.q * less))


@compiled
def find(s: Record, columns: Record, dampers: Record, at: float) -> None:
    """Accelerations of the slab at a stage, from `new_way`, `new_rate` and V."""
    place_heads(s, columns)
    set_loads(s, columns)
    time = s.time + at * s.h
    for axis in range(2):
        s.shaking[axis] = s.a_g[axis] + time * s.a_g_slope[axis]
    s.shaking[2] = 0.0
    for k in range(6):
        s.M[k] = s.inertia if k == TURNS else 0.0
    for k in range(3):
        s.push[k] = s.V[k]
    s.push[2] -= pivoting(s)
    cosine = math.cos(s.new_way[2])
    sine = math.sin(s.new_way[2])
    for i in range(columns.shape[0]):
        add_column(s, columns[i], cosine, sine)
    for i in range(dampers.shape[0]):
        d = dampers[i]
        g_x = cosine * d.x - sine * d.y
        g_y = sine * d.x + cosine * d.y
        p_x, p_y = push_of_damper(s, d, g_x, g_y)
        add_push(s, p_x, p_y, g_x, g_y)
    bend = 0.0, 0.0, 0.0
    if s.stands == 0:
        M = s.M[0], s.M[1], s.M[2], s.M[3], s.M[4], s.M[5]
        bend = solved(M, (s.push[0], s.push[1], s.push[2]))
    for axis, found in ((0, bend[0]), (1, bend[1]), (2, bend[2])):
        s.new_bend[axis] = found
        s.shaking[axis] += found


TURNS = 5
"""Place of psi psi among the masses."""


@inlined
def add_push(s: Record, p_x: float, p_y: float, d_x: float, d_y: float) -> None:
    """Add a push on the slab at a place from its centre."""
    s.push[0] += p_x
    s.push[1] += p_y
    s.push[2] += d_x * p_y - d_y * p_x


@inlined
def add_column(s: Record, c: Record, cosine: float, sine: float) -> None:
    """Add the masses of a column's head, and what it pushes the slab with."""
    place = place_at(c, c.tilt)
    head = head_of(place, c.diameter, s.bowl, (c.u_x, c.u_y), (c.w_x, c.w_y))
    d_x = cosine * c.x - sine * c.y
    d_y = sine * c.x + cosine * c.y
    square = s.new_rate[2] * s.new_rate[2]
    held = c.load * head.arm
    p_x = c.mass * (square * (head.xx * d_x + head.xy * d_y) - head.c_x)
    p_y = c.mass * (square * (head.xy * d_x + head.yy * d_y) - head.c_y)
    p_x -= held * head.out_x + c.carried * s.shaking[0]
    p_y -= held * head.out_y + c.carried * s.shaking[1]
    add_push(s, p_x, p_y, d_x, d_y)
    m_x = head.xy * d_x - head.xx * d_y  # M J Q d
    m_y = head.yy * d_x - head.xy * d_y
    s.M[0] += c.mass * head.xx
    s.M[1] += c.mass * head.xy
    s.M[2] += c.mass * head.yy
    s.M[3] += c.mass * m_x
    s.M[4] += c.mass * m_y
    s.M[TURNS] += c.mass * (d_x * m_y - d_y * m_x)


@inlined
def push_of_damper(s: Record, d: Record, g_x: float, g_y: float) -> tuple[float, float]:
    """Force of a damper on the slab, at a place from its centre [N]."""
    v_x = s.new_rate[0] - s.new_rate[2] * g_y
    v_y = s.new_rate[1] + s.new_rate[2] * g_x
    drag = d.constant + d.friction / math.sqrt(v_x * v_x + v_y * v_y + s.slow * s.slow)
    return -drag * v_x, -drag * v_y


@inlined
def pivoting(s: Record) -> float:
    """Torque of friction where ends pivot [N m]; below `creeps` it is viscous."""
    fast = s.new_rate[2]
    return s.pivot * fast / math.sqrt(fast * fast + s.creeps * s.creeps)  # type: ignore[no-any-return]


Masses: TypeAlias = tuple[float, float, float, float, float, float]


@inlined
def solved(M: Masses, push: tuple[float, float, float]) -> tuple[float, float, float]:
    """What a push makes of masses xx, xy, yy, x psi, y psi, psi psi (Cholesky)."""
    l_xx = math.sqrt(M[0])
    l_xy = M[1] / l_xx
    l_yy = math.sqrt(M[2] - l_xy * l_xy)
    l_xt = M[3] / l_xx
    l_yt = (M[4] - l_xy * l_xt) / l_yy
    rest = M[5] - l_xt * l_xt - l_yt * l_yt
    y_x = push[0] / l_xx
    y_y = (push[1] - l_xy * y_x) / l_yy
    turn = (push[2] - l_xt * y_x - l_yt * y_y) / rest
    along_y = (y_y - l_yt * turn) / l_yy
    return (y_x - l_xy * along_y - l_xt * turn) / l_xx, along_y, turn


@compiled
def book(s: Record, columns: Record, modes: Record, dampers: Record, at: float,
         weight: float) -> None:  # fmt: skip
    """Add the powers of a stage, with the weight of the step's rule."""
    time = s.time + at * s.h
    a_x = s.a_g[0] + time * s.a_g_slope[0]
    a_y = s.a_g[1] + time * s.a_g_slope[1]
    p_x = 0.0
    p_y = 0.0
    for i in range(columns.shape[0] if s.stands == 0 else 0):
        p_x += columns[i].carried * columns[i].w_x
        p_y += columns[i].carried * columns[i].w_y
    damped = 0.0
    for r in range(modes.shape[0]):
        m = modes[r]
        p_x += m.Gamma[0] * total_rate(s, m)
        p_y += m.Gamma[1] * total_rate(s, m)
        damped += m.two_xi_omega * m.drifts * m.drifts
    turned = 0.0
    if s.stands == 0:
        turned = pivoting(s) * s.new_rate[2]
    braked = 0.0
    turn_x = math.cos(s.new_way[2])
    turn_y = math.sin(s.new_way[2])
    for i in range(dampers.shape[0] if s.stands == 0 else 0):
        d = dampers[i]
        g_x = turn_x * d.x - turn_y * d.y
        g_y = turn_y * d.x + turn_x * d.y
        f_x, f_y = push_of_damper(s, d, g_x, g_y)
        braked -= f_x * (s.new_rate[0] - s.new_rate[2] * g_y)
        braked -= f_y * (s.new_rate[1] + s.new_rate[2] * g_x)
    s.power[0] -= weight * (a_x * p_x + a_y * p_y)
    s.power[1] += weight * damped
    s.power[2] += weight * turned
    s.power[3] += weight * braked


@inlined
def total_rate(s: Record, m: Record) -> float:
    """Velocity of a mode with what the slab adds to it over the ground."""
    moved = m.Gamma[0] * s.new_rate[0] + m.Gamma[1] * s.new_rate[1]
    return m.new_dq + (moved + m.Gamma[2] * s.new_rate[2])  # type: ignore[no-any-return]


@compiled
def kinetic(s: Record) -> float:
    """Kinetic energy of slab and columns at the present rates [J]."""
    r = s.rate
    energy = 0.5 * (s.M[0] * r[0] * r[0] + s.M[2] * r[1] * r[1] + s.M[5] * r[2] * r[2])
    return float(energy + s.M[1] * r[0] * r[1] + (s.M[3] * r[0] + s.M[4] * r[1]) * r[2])


@compiled
def energy_of(s: Record, columns: Record, modes: Record) -> float:
    """Energy over the ground at the present state [J], which `renew` has prepared."""
    energy = 0.0
    if s.stands == 0:
        energy = kinetic(s) + strain_of_seats(s, columns)
    for k in range(modes.shape[0]):
        m = modes[k]
        fast = total_rate(s, m)
        energy += 0.5 * (fast * fast + m.omega2 * m.drift * m.drift)
    return energy
