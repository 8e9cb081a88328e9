"""Taylor terms of what devices do, order after order behind those of the tilt.

Coefficients are those of powers of t/h, as in `equation_of_motion`. Of a device whose force is a
function of x alone the derivatives along x are known at the start of the step; their terms follow
by the chain rule, D_k' = D_(k+1) x'. A power of a series is the usual recurrence, which divides by
the velocity: near its zero steps are short, and up to `linear_speed` the power is linear.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.elongation import expand_opening
from rpscli.physics.devices.forces import cap_beam_path, resistance, tension
from rpscli.physics.state import ORDER, STOP, TENDON, VISCOUS, WORKING, Record


@compiled
def begin_devices(s: Record) -> None:
    """Terms of order 0, in lanes with devices."""
    for l in range(s.lanes):
        if s.devices[l] == 0:
            continue
        path, rate, _ = cap_beam_path(s, l, s.theta[l], s.theta_dot[l])
        s.path[l], s.advance_terms[0, l] = path, rate
        resisting, tense, stiffness = 0.0, 0.0, 0.0
        if s.tendons[l] > 0:
            expand_opening(s, l)
        for i in range(s.devices[l]):
            own = resistance(s, l, i, path, rate)
            resisting += own
            s.power_terms[i, 0, l] = own
            if s.device_kind[i, l] == TENDON:
                tense += s.columns[l] * tension(s, l, i, s.opening_terms[0, l])
                if s.device_branch[i, l] == WORKING:
                    stiffness += s.columns[l] * s.device_constants[i, 1, l]
        s.resistance_terms[0, l], s.tension[l], s.tendon_stiffness[l] = resisting, tense, stiffness


@compiled
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
        if kind == VISCOUS:
            resisting += extend_power(s, l, i, m)
        elif kind == STOP and s.device_branch[i, l] == WORKING:
            resisting += s.device_constants[i, 1, l] * path + s.device_constants[i, 2, l] * advance
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
    s.opening_terms[m, l] = part * longer
    turning = s.tension[l] * s.lever_terms[0, m, l]
    for j in range(1, m + 1):
        tense = s.tendon_stiffness[l] * s.opening_terms[j, l]
        turning += tense * s.lever_terms[0, m - j, l]
    return float(turning)


@compiled
def extend_power(s: Record, l: int, i: int, m: int) -> float:
    """Term of order m of a viscous damper's resistance [N]."""
    constant, exponent = s.device_constants[i, 0, l], s.device_constants[i, 1, l]
    rate, speed = s.advance_terms[0, l], s.linear_speed[l]
    if exponent == 1.0 or abs(rate) <= speed:
        return float(constant * speed ** (exponent - 1.0) * s.advance_terms[m, l])
    term = 0.0
    for j in range(1, m + 1):
        part = exponent * j - (m - j)
        term += part * s.advance_terms[j, l] * s.power_terms[i, m - j, l]
    s.power_terms[i, m, l] = term / (m * rate)
    return float(s.power_terms[i, m, l])
