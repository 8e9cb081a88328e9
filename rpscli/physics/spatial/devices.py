"""Devices of a storey that tilts to any side (Theory (13.18)).

Stops and tendons know the tilt alone: the planar code follows them, and finds where their laws
change. Dampers are vectors, P = -c |v|^(a-1) v with v = u_b', and stand in z beside V. Their law
has a kink at v = 0 only, which steps approach by parts of |v|; below `linear_speed` it is linear.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.lanes import log_event, time_of
from rpscli.physics.core.records import ORDER, Floats, Record
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.devices.events import LEAST_STEP
from rpscli.physics.planar.devices.flows import store_devices
from rpscli.physics.planar.devices.forces import begin_lane, extend_lane, is_vector, set_devices
from rpscli.physics.planar.devices.rest import force_at_rest
from rpscli.physics.planar.state import (
    BEYOND,
    DAMPER_COEFFICIENT,
    DAMPER_EXPONENT,
    STOP,
    STOP_MET,
    WORKING,
)
from rpscli.physics.spatial.equation_of_motion import Place, place_of, rates_now

APPROACH, LINEAR = 0.7, 4.0
"""A step may change v by this part of |v|, or lead from below `linear_speed` to so many of it."""


@with_devices()
def begin_devices_3d(s: Record) -> None:
    """Terms of order 0, in lanes with devices; what pushes at the start of the step."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            at, direction = place_of(s, l, s.theta[l]), (s.cos_phi[l], s.sin_phi[l])
            set_push(s, l, at, s.theta[l], direction, (s.theta_dot[l], s.turning[l]), 0.0)
            begin_lane(s, l)
            moment = at.C * s.resistance_terms[0, l]
            if s.tendons[l] > 0:
                moment += s.tension[l] * s.lever_terms[0, 0, l] / s.diameter[l]
            s.device_terms[0, l] = -s.shear_factor[l] * moment
            add_dampers(s, l, 0)


@with_devices()
def extend_devices_3d(s: Record, m: int) -> None:
    """Terms of order m, in lanes with devices; those of z are known but for their part."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            s.C_terms[m, l] = s.D_terms[m, l]
            extend_lane(s, l, m)
            add_dampers(s, l, m)


@compiled
def add_dampers(s: Record, l: int, m: int) -> None:
    """Add the terms of order m of what dampers push to those of z."""
    speed, speed2, drag = (m + 1) / s.step[l] * s.diameter[l], 0.0, 0.0
    x, y = s.v_terms[0], s.v_terms[1]
    x[m, l], y[m, l] = speed * s.u_b_terms[0, m + 1, l], speed * s.u_b_terms[1, m + 1, l]
    for j in range(m + 1):
        speed2 += x[j, l] * x[m - j, l] + y[j, l] * y[m - j, l]
    s.speed2_terms[m, l] = speed2
    for i in range(s.devices[l]):
        if is_vector(s, l, i):
            drag += s.law[i, DAMPER_COEFFICIENT, l] * power_term(s, l, i, m)
    s.drag_terms[m, l] = drag
    for j in range(m + 1):
        push = s.shear_factor[l] * s.drag_terms[j, l]
        s.z_terms[0, m, l] -= push * x[m - j, l]
        s.z_terms[1, m, l] -= push * y[m - j, l]


@compiled
def power_term(s: Record, l: int, i: int, m: int) -> float:
    """Term of order m of |v|^(a-1), a power of |v|^2."""
    squares, terms, least = s.speed2_terms, s.power_terms[i], s.linear_speed[l]
    power, square, term = 0.5 * (s.law[i, DAMPER_EXPONENT, l] - 1.0), squares[0, l], 0.0
    if m == 0:
        term = max(square, least * least) ** power
    elif power != 0.0 and square > least * least:
        for j in range(1, m + 1):
            term += (power * j - (m - j)) * squares[j, l] * terms[m - j, l]
        term /= m * square
    terms[m, l] = term
    return float(term)


@with_devices()
def set_push(
    s: Record,
    l: int,
    at: Place,
    theta: float,
    direction: tuple[float, float],
    rates: tuple[float, float],
    dampers: float,
) -> None:
    """Write what devices push and pull the cap beam with, with their dampers (1) or without (0)."""
    set_devices(s, l, theta, rates[0])
    along, across = s.diameter[l] * at.C * rates[0], s.diameter[l] * at.u * rates[1]
    speed = max(math.sqrt(along * along + across * across), s.linear_speed[l])
    drag = 0.0
    for i in range(s.devices[l]):
        if is_vector(s, l, i):
            power = speed ** (s.law[i, DAMPER_EXPONENT, l] - 1.0)
            drag += dampers * s.law[i, DAMPER_COEFFICIENT, l] * power
    out, aside = s.next_push[l] - drag * along, -drag * across
    s.push_x[l] = out * direction[0] - aside * direction[1]
    s.push_y[l] = out * direction[1] + aside * direction[0]
    s.pull[l] = s.next_pull[l]


@compiled
def rates_with_devices(s: Record, l: int) -> tuple[float, float, float, float]:
    """p, w, p' and w' of the present state."""
    p, w, p_rate, w_rate = rates_now(s, l)
    more = added_rates(s, l, p, w)
    return p, w, p_rate + more[0], w_rate + more[1]


@with_devices(otherwise=(0.0, 0.0))
def added_rates(s: Record, l: int, p: float, w: float) -> tuple[float, float]:
    """What devices add to p' and w' of the present state."""
    at = place_of(s, l, s.theta[l])
    set_push(s, l, at, s.theta[l], (1.0, 0.0), (p, w), 1.0)
    damped = s.push_x[l] - s.next_push[l]
    moment = s.next_device[l] + s.shear_factor[l] * at.C * damped
    return moment / at.A, s.shear_factor[l] * at.u * s.push_y[l] / at.J


@with_devices()
def store_devices_3d(
    s: Record,
    l: int,
    sample: Floats,
    theta: float,
    rates: tuple[float, float],
) -> None:
    """Keep what devices do at a tilt and its rates, resultants; sets push and pull."""
    direction = s.cos_phi[l], s.sin_phi[l]
    set_push(s, l, place_of(s, l, theta), theta, direction, rates, 1.0)
    kept = s.theta[l], s.theta_dot[l]
    s.theta[l], s.theta_dot[l] = theta, rates[0]
    store_devices(s, l, sample, rates[1])
    s.theta[l], s.theta_dot[l] = kept


@with_devices()
def check_speeds(s: Record) -> None:
    """Withdraw the acceptance of steps that change v too much for a power of it."""
    for l in range(s.lanes):
        x, y, least, first = 0.0, 0.0, s.linear_speed[l], math.sqrt(s.speed2_terms[0, l])
        for m in range(1, ORDER + 1):
            x, y = x + s.v_terms[0, m, l], y + s.v_terms[1, m, l]
        room = APPROACH * first if first > least else LINEAR * least
        kinks = (s.kinks[l] > 0.0) & (s.step[l] > LEAST_STEP * s.dt[l])
        if kinks & (not x * x + y * y <= room * room):
            s.too_long[l], s.accepted[l], s.peak_inside[l] = 1.0, 0.0, 0.0


@with_devices()
def load_3d(s: Record, l: int) -> None:
    """Kinks lie where v = 0, not where the tilt turns as in one plane."""
    s.kinks[l], s.nonsmooth_damper[l] = s.nonsmooth_damper[l], 0.0


@with_devices()
def take_up_stops(s: Record, l: int, log: Record) -> None:
    """At a closest approach: what moves outwards again is met by stops that had let go."""
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP and s.device_branch[i, l] == BEYOND:
            s.device_branch[i, l] = WORKING
            log_event(s, l, log, time_of(s, l), STOP_MET, s.theta[l], 0.0, 0.0, 0.0)
    mark_azimuth(s, l, log)


@with_devices()
def mark_azimuth(s: Record, l: int, log: Record) -> None:
    """Note the azimuth of the last event, which planar code has logged."""
    row = -1
    for i in range(s.events.shape[1]):
        row += s.events[l, i]
    if 0 <= row < log.shape[0]:
        log[row].azimuth = math.atan2(s.sin_phi[l], s.cos_phi[l])


@with_devices(otherwise=0.0)
def held_3d(s: Record, l: int) -> float:
    """What stops and tendons add to the limit of |z| [1/s2]; over A it is what they slow by."""
    return float(s.shear_factor[l] * force_at_rest(s, l)[0])
