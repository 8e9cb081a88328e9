"""A Runge-Kutta step of the slab and its modes (`tableau`), modes first at each stage."""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.state import Floats, Record
from rpscli.physics.tableau import END, ERROR, SQUARED, STAGES, TIMES, USED
from rpscli.physics.twist.slab import book, find

NOISE = 1e-13
"""Of the weight's moment: what of the difference of both rules is rounding."""


@compiled
def advance_modes(s: Record, modes: Record, offset: Floats, k: int) -> None:
    """Lead all modes to stage k."""
    h = s.h
    for r in range(modes.shape[0]):
        m = modes[r]
        shaken = 0.0
        for axis in range(3):
            shaken += m.Gamma[axis] * s.shaking[axis]
        m.ddq[k - 1] = -shaken - m.force
        far = 0.0
        fast = 0.0
        for j in range(k):
            if USED[k, j]:
                far += SQUARED[k, j] * m.ddq[j]
                fast += STAGES[k, j] * m.ddq[j]
        m.new_q = m.q + h * (TIMES[k] * m.dq + h * far)
        m.new_dq = m.dq + h * fast
    set_forces(s, modes, offset)


@compiled
def set_forces(s: Record, modes: Record, offset: Floats) -> None:
    """Forces of modes at a stage, and what they push the slab with.

    Springs and dampers act at the centre of stiffness, where a storey's drift is that of
    its modes in x or y and a part of those in twist (17.7).
    """
    n = modes.shape[0] // 3
    for axis in range(3):
        s.V[axis] = 0.0
    for r in range(3 * n):
        m = modes[r]
        m.drift = m.new_q
        m.drifts = m.new_dq
        for k in range(n if r < 2 * n else 0):
            m.drift += offset[r, k] * modes[2 * n + k].new_q
            m.drifts += offset[r, k] * modes[2 * n + k].new_dq
        m.force = m.omega2 * m.drift + m.two_xi_omega * m.drifts
    for k in range(n):
        turned = modes[2 * n + k]
        for r in range(2 * n):
            turned.force += offset[r, k] * modes[r].force
    for r in range(3 * n):
        for axis in range(3):
            s.V[axis] += modes[r].Gamma[axis] * modes[r].force


@compiled
def advance_slab(s: Record, k: int) -> None:
    """Lead the slab's ways to stage k."""
    h = s.h
    for axis in range(3):
        far = 0.0
        fast = 0.0
        for j in range(k):
            if USED[k, j]:
                far += SQUARED[k, j] * s.bends[j, axis]
                fast += STAGES[k, j] * s.bends[j, axis]
        s.new_way[axis] = s.way[axis] + h * (TIMES[k] * s.rate[axis] + h * far)
        s.new_rate[axis] = s.rate[axis] + h * fast


@compiled
def renew(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Accelerations at the present state and time: what the next step begins with."""
    for axis in range(3):
        s.new_way[axis] = s.way[axis]
        s.new_rate[axis] = s.rate[axis]
    for r in range(modes.shape[0]):
        m = modes[r]
        m.new_q = m.q
        m.new_dq = m.dq
    set_forces(s, modes, offset)
    find(s, columns, dampers, 0.0)
    for axis in range(3):
        s.bend[axis] = s.new_bend[axis]
    s.away = math.sqrt(s.way[0] * s.way[0] + s.way[1] * s.way[1])
    s.leaving = s.way[0] * s.rate[0] + s.way[1] * s.rate[1]
    for i in range(columns.shape[0]):
        c = columns[i]
        c.away = math.sqrt(c.u_x * c.u_x + c.u_y * c.u_y)
        c.leaving = c.u_x * c.w_x + c.u_y * c.w_y


@compiled
def take_step(
    s: Record, columns: Record, modes: Record, dampers: Record, offset: Floats
) -> None:
    """Take a step of length h from the present state, which `renew` has prepared."""
    renew(s, columns, modes, dampers, offset)
    for axis in range(3):
        s.bends[0, axis] = s.bend[axis]
    for k in range(4):
        s.power[k] = 0.0
    book(s, columns, modes, dampers, 0.0, STAGES[END, 0])
    for k in range(1, END + 1):
        advance_modes(s, modes, offset, k)
        advance_slab(s, k)
        find(s, columns, dampers, TIMES[k])
        for axis in range(3):
            s.bends[k, axis] = s.new_bend[axis]
        if k < END:
            book(s, columns, modes, dampers, TIMES[k], STAGES[END, k])
    s.error = error_of(s)


@compiled
def error_of(s: Record) -> float:
    """Difference of the rules of order 6 and 5 in the slab's rates, over what it may
    be.
    """
    missed = 0.0
    speed = 0.0
    for axis in range(3):
        arm = s.radius if axis == 2 else 1.0
        error = 0.0
        for k in range(END + 1):
            error += ERROR[k] * s.bends[k, axis]
        missed += (arm * error) * (arm * error)
        faster = s.h * (abs(s.bend[axis]) + abs(s.new_bend[axis]))
        fast = arm * (abs(s.rate[axis]) + abs(s.new_rate[axis]) + faster)
        speed += fast * fast
    limit = s.step_error * math.sqrt(speed) + NOISE * s.h * s.gravity
    return float(s.h * math.sqrt(missed) / limit)
