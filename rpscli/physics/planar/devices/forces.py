"""What devices do at a given motion (Theory (11.1) to (11.6)).

A horizontal device acts on the cap beam with P = -s times its resistance, a tendon with its tension
against the opening of both ends, rolling resistance with its moment against the tilt's rate. Which
branch of its law a device follows is part of the state, so that all of it is smooth within a step.
"""

from __future__ import annotations

import math

import numpy as np

from rpscli.physics.core.compile import compiled, compiled_with
from rpscli.physics.core.records import ORDER, TERMS, Record
from rpscli.physics.core.series import sine_cosine
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.equation_of_motion import (
    cap_beam_displacement,
    contact_height,
    phase_constants,
)
from rpscli.physics.planar.state import (
    DAMPER_COEFFICIENT,
    DAMPER_EXPONENT,
    FRICTION,
    FRICTION_FORCE,
    IDLE,
    STOP,
    STOP_DAMPING,
    STOP_GAP,
    STOP_STIFFNESS,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_STIFFNESS,
    TENDON_YIELD,
    VISCOUS,
    WORKING,
)


@compiled
def resistance(s: Record, l: int, i: int, path: float, rate: float) -> float:
    """Resistance -s P of a horizontal device, 0 of others [N]."""
    kind = s.device_kind[i, l]
    if kind == VISCOUS:
        exponent = s.law[i, DAMPER_EXPONENT, l] - 1.0
        return float(
            s.law[i, DAMPER_COEFFICIENT, l] * rate * max(abs(rate), s.linear_speed[l]) ** exponent
        )
    if kind == FRICTION:
        return float(s.direction[l] * s.law[i, FRICTION_FORCE, l])
    if kind == STOP and s.device_branch[i, l] == WORKING:
        beyond = path - s.law[i, STOP_GAP, l]
        return float(s.law[i, STOP_STIFFNESS, l] * beyond + s.law[i, STOP_DAMPING, l] * rate)
    return 0.0


@compiled
def tension(s: Record, l: int, i: int, e: float) -> float:
    """Tension of one tendon of a device that is one [N], at its elongation e [m]; else 0 [e m]."""
    if s.device_kind[i, l] != TENDON or s.device_branch[i, l] == IDLE:
        return 0.0
    if s.device_branch[i, l] == WORKING:
        stretch = e - s.permanent[i, l]
        return float(s.law[i, TENDON_PRESTRESS, l] + s.law[i, TENDON_STIFFNESS, l] * stretch)
    return float(s.law[i, TENDON_YIELD, l])


@compiled
def cap_beam_path(s: Record, l: int, theta: float, theta_dot: float) -> tuple[float, float, float]:
    """|u_b| [m], its rate [m/s], and C, at a tilt in the present phase."""
    sine, cosine = sine_cosine(theta)
    phase = phase_constants(s, l)
    C = contact_height(phase, cosine, sine)
    path = s.diameter[l] * cap_beam_displacement(phase, theta, cosine, sine)
    return path, s.diameter[l] * C * theta_dot, C


@with_devices()
def set_devices(s: Record, l: int, theta: float, theta_dot: float) -> None:
    """What the devices of a lane do at a tilt and its rate; writes `next_device`, push and pull."""
    path, rate, C = cap_beam_path(s, l, theta, theta_dot)
    e, lever, sin_psi, cos_psi = tendon_elongation(s, l, theta)
    resisting, tense = 0.0, 0.0
    for i in range(s.devices[l]):
        if not is_vector(s, l, i):
            resisting += resistance(s, l, i, path, rate)
        tense += s.columns[l] * tension(s, l, i, e)
    moment = tense * lever + s.direction[l] * s.friction_moment[l]
    s.next_device[l] = -s.shear_factor[l] * (C * resisting + moment / s.diameter[l])
    s.next_push[l] = -s.side[l] * (resisting + tense * sin_psi)
    s.next_pull[l] = tense * cos_psi


@with_devices()
def set_devices_at_ends(s: Record) -> None:
    """The same at the ends of the steps of all lanes."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            set_devices(s, l, s.next_theta[l], s.next_theta_dot[l])


# How a tendon in the axis of a column is stretched by the tilt (Theory (11.7) to (11.10)).
#
# The middle of either end moves by (M_1, M_2) from where it stood; with E its distance from there a
# tendon is longer by e = 2 E. Seen from the contact, which lies B + r x from that place along the
# ground while rolling and B + r beta while rocking, de/dx = 2 cos(psi) times that distance, psi
# being the angle of (M_1, M_2) with the vertical.

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
NODES = tuple(float(0.5 + 0.5 * node) for node in _NODES)
WEIGHTS = tuple(float(0.5 * weight) for weight in _WEIGHTS)
"""Gauss and Legendre's rule over [0, 1]: exact to rounding for cos(x s), sin(x s) up to x = 3."""


@compiled
def tendon_elongation(s: Record, l: int, x: float) -> tuple[float, float, float, float]:
    """Elongation e of a tendon, de/dx, and sine and cosine of psi, at a tilt x in its phase."""
    sine, cosine = sine_cosine(x)
    B, r = s.half_width[l], s.arc_radius[l]
    reach = B + r * x
    across, upwards = B * (1.0 - cosine) + r * (x - sine), B * sine + r * (1.0 - cosine)
    if s.phase_c[l] == 0.0 and s.arc_end[l] > 0.0:
        sine_end, cosine_end = sine_cosine(s.arc_end[l])
        reach = B + r * s.arc_end[l]
        along, above = B + r * sine_end, r * (1.0 - cosine_end)
        across = reach - (along * cosine + above * sine)
        upwards = along * sine - above * cosine
    distance = math.sqrt(across * across + upwards * upwards)
    sin_psi, cos_psi = 0.0, 1.0
    if distance > 0.0:
        sin_psi, cos_psi = across / distance, upwards / distance
    return 2.0 * distance, 2.0 * cos_psi * reach, sin_psi, cos_psi


@compiled
def expand_from_upright(s: Record, l: int) -> None:
    """Write (E/x)^2 in powers of x - x_0 to row 2 of `local`, while rolling or on flat ends.

    E has a zero at x = 0, where the tilt begins: M_1/x and M_2/x do not, with sin(x)/x and
    (1 - cos x)/x as means of cos(x s) and sin(x s) over s from 0 to 1.
    """
    x, B, r = s.theta[l], s.half_width[l], s.arc_radius[l]
    one, two, square = s.local[0], s.local[1], s.local[2]
    for k in range(TERMS + 1):
        one[k], two[k], square[k] = 0.0, 0.0, 0.0
    for i in range(len(NODES)):
        sine, cosine = sine_cosine(x * NODES[i])
        power = WEIGHTS[i]
        for k in range(TERMS + 1):
            one[k] += power * sine
            two[k] += power * cosine
            sine, cosine = cosine, -sine
            power *= NODES[i] / (k + 1.0)
    for k in range(TERMS + 1):
        across = B * one[k] - r * two[k] + (r if k == 0 else 0.0)
        one[k], two[k] = across, B * two[k] + r * one[k]
    for k in range(TERMS + 1):
        for j in range(k + 1):
            square[k] += one[j] * one[k - j] + two[j] * two[k - j]


@compiled
def expand_beyond_arc(s: Record, l: int) -> None:
    """Write E^2 in powers of x - x_0 to row 2 of `local`, while rocking about the end of an arc."""
    B, r, square = s.half_width[l], s.arc_radius[l], s.local[2]
    sine, cosine = sine_cosine(s.arc_end[l])
    reach, along, above = B + r * s.arc_end[l], B + r * sine, r * (1.0 - cosine)
    sine, cosine = sine_cosine(s.theta[l])
    part = 1.0
    for k in range(TERMS + 1):
        square[k] = -2.0 * reach * (along * cosine + above * sine) * part
        sine, cosine = cosine, -sine
        part /= k + 1.0
    square[0] += reach * reach + along * along + above * above


@compiled
def expand_elongation(s: Record, l: int) -> None:
    """Write e, de/dx and the derivatives of that at the start of the step."""
    from_upright = s.phase_c[l] > 0.0 or s.arc_end[l] == 0.0
    if from_upright:
        expand_from_upright(s, l)
    else:
        expand_beyond_arc(s, l)
    square, root = s.local[2], s.local[3]
    root[0] = math.sqrt(square[0])
    for k in range(1, TERMS + 1):
        rest = square[k]
        for j in range(1, k):
            rest -= root[j] * root[k - j]
        root[k] = rest / (2.0 * root[0])
    x, factorial = s.theta[l], 1.0
    s.elongation_terms[0, l] = 2.0 * (x * root[0] if from_upright else root[0])
    for k in range(1, TERMS + 1):
        factorial *= k
        distance = x * root[k] + root[k - 1] if from_upright else root[k]
        s.lever_terms[k - 1, 0, l] = 2.0 * factorial * distance


# Taylor terms of what devices do, order after order behind those of the tilt.
#
# Coefficients are those of powers of t/h, as in `equation_of_motion`. Of a device whose force is a
# function of x alone the derivatives along x are known at the start of the step; their terms follow
# by the chain rule, D_k' = D_(k+1) x'. A power of a series is the usual recurrence, which divides
# by the velocity: near its zero steps are short, and up to `linear_speed` the power is linear.


@with_devices()
def begin_devices(s: Record) -> None:
    """Terms of order 0, in lanes with devices."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            begin_lane(s, l)


@compiled
def begin_lane(s: Record, l: int) -> None:
    """The same for one lane."""
    path, rate, _ = cap_beam_path(s, l, s.theta[l], s.theta_dot[l])
    s.path[l], s.advance_terms[0, l] = path, rate
    resisting, tense, stiffness = 0.0, 0.0, 0.0
    if s.tendons[l] > 0:
        expand_elongation(s, l)
    for i in range(s.devices[l]):
        if is_vector(s, l, i):
            continue
        own = resistance(s, l, i, path, rate)
        resisting += own
        s.power_terms[i, 0, l] = own
        if s.device_kind[i, l] == TENDON:
            tense += s.columns[l] * tension(s, l, i, s.elongation_terms[0, l])
            if s.device_branch[i, l] == WORKING:
                stiffness += s.columns[l] * s.law[i, TENDON_STIFFNESS, l]
    s.resistance_terms[0, l], s.tension[l], s.tendon_stiffness[l] = resisting, tense, stiffness


@compiled_with("cos_phi", otherwise=False)
def is_vector(s: Record, l: int, i: int) -> bool:
    """Whether a device resists along its velocity in x and y, of a tilt to any side."""
    return bool(s.device_kind[i, l] == VISCOUS)


@with_devices()
def extend_devices(s: Record, m: int) -> None:
    """Terms of order m, in lanes with devices: all those of the tilt up to m are known."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            extend_lane(s, l, m)


@compiled
def extend_lane(s: Record, l: int, m: int) -> None:
    """The same for one lane."""
    part, advance = s.step[l] / m, 0.0
    for j in range(m + 1):
        advance += s.C_terms[j, l] * s.dtheta_terms[m - j, l]
    advance *= s.diameter[l]
    s.advance_terms[m, l] = advance
    path = part * s.advance_terms[m - 1, l]
    resisting = 0.0
    for i in range(s.devices[l]):
        kind = s.device_kind[i, l]
        if is_vector(s, l, i):
            continue
        if kind == VISCOUS:
            resisting += extend_power(s, l, i, m)
        elif kind == STOP and s.device_branch[i, l] == WORKING:
            resisting += s.law[i, STOP_STIFFNESS, l] * path + s.law[i, STOP_DAMPING, l] * advance
    s.resistance_terms[m, l] = resisting
    moment = 0.0
    for j in range(m + 1):
        moment += s.C_terms[j, l] * s.resistance_terms[m - j, l]
    if s.tendons[l] > 0:
        moment += extend_tendons(s, l, m) / s.diameter[l]
    s.device_terms[m, l] = -s.shear_factor[l] * moment


@compiled
def extend_tendons(s: Record, l: int, m: int) -> float:
    """Term of order m of what all tendons turn the columns back with [N m]."""
    part, longer = s.step[l] / m, 0.0
    for k in range(ORDER + 1 - m):
        term = 0.0
        for j in range(m):
            term += s.lever_terms[k + 1, j, l] * s.dtheta_terms[m - 1 - j, l]
        s.lever_terms[k, m, l] = part * term
    for j in range(m):
        longer += s.lever_terms[0, j, l] * s.dtheta_terms[m - 1 - j, l]
    s.elongation_terms[m, l] = part * longer
    turning = s.tension[l] * s.lever_terms[0, m, l]
    for j in range(1, m + 1):
        tense = s.tendon_stiffness[l] * s.elongation_terms[j, l]
        turning += tense * s.lever_terms[0, m - j, l]
    return float(turning)


@compiled
def extend_power(s: Record, l: int, i: int, m: int) -> float:
    """Term of order m of a viscous damper's resistance [N]."""
    constant, exponent = (s.law[i, DAMPER_COEFFICIENT, l], s.law[i, DAMPER_EXPONENT, l])
    rate, speed = s.advance_terms[0, l], s.linear_speed[l]
    if exponent == 1.0 or abs(rate) <= speed:
        return float(constant * speed ** (exponent - 1.0) * s.advance_terms[m, l])
    term = 0.0
    for j in range(1, m + 1):
        part = exponent * j - (m - j)
        term += part * s.advance_terms[j, l] * s.power_terms[i, m - j, l]
    s.power_terms[i, m, l] = term / (m * rate)
    return float(s.power_terms[i, m, l])
