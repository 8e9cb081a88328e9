"""Energy of devices, and the largest forces and rates that they see."""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, compiled_with
from rpscli.physics.core.records import ORDER, Floats, Record
from rpscli.physics.core.series import NODES, WEIGHTS, Terms, integral, value
from rpscli.physics.planar.devices import with_devices
from rpscli.physics.planar.devices.events import watch_stop
from rpscli.physics.planar.devices.forces import (
    cap_beam_path,
    resistance,
    tendon_elongation,
    tension,
)
from rpscli.physics.planar.devices.rest import mobilised_friction
from rpscli.physics.planar.equation_of_motion import rotation_terms
from rpscli.physics.planar.state import (
    BEYOND,
    FRICTION,
    FULL_CONTACT,
    ROLLING_MOMENT,
    ROLLING_RESISTANCE,
    STOP,
    STOP_DAMPING,
    STOP_GAP,
    STOP_STIFFNESS,
    STUCK,
    TENDON,
    TENDON_PRESTRESS,
    TENDON_STIFFNESS,
    TENDON_YIELD,
    VISCOUS,
    WORKING,
)


@with_devices()
def book_devices(s: Record, l: int, fraction: float) -> None:
    """Book what the devices of a lane dissipate in the first part of its step."""
    terms = rotation_terms(s, l)
    for n in range(len(NODES)):
        t = fraction * NODES[n]
        theta_dot = value(terms, t)
        theta = s.theta[l] + s.step[l] * integral(terms, t)
        path, rate, _ = cap_beam_path(s, l, theta, theta_dot)
        speed = speed_of(s, l, path, rate, turning_at(s, l, t))
        _, lever, _, _ = tendon_elongation(s, l, theta)
        for i in range(s.devices[l]):
            kind, power = s.device_kind[i, l], 0.0
            if kind in (VISCOUS, FRICTION):
                power = resistance(s, l, i, path, speed) * speed
            elif kind == STOP:
                if s.device_branch[i, l] == WORKING:
                    power = s.law[i, STOP_DAMPING, l] * rate * rate
                elif s.device_branch[i, l] == BEYOND:  # it recovers by itself
                    beyond = path - s.law[i, STOP_GAP, l]
                    power = -s.law[i, STOP_STIFFNESS, l] * beyond * rate
            elif kind == ROLLING_RESISTANCE:
                power = s.direction[l] * s.law[i, ROLLING_MOMENT, l] * theta_dot
            elif s.device_branch[i, l] == BEYOND:
                power = s.columns[l] * s.law[i, TENDON_YIELD, l] * lever * theta_dot
            s.device_energy[i, l] += fraction * s.step[l] * WEIGHTS[n] * power


@compiled_with("turning_terms", otherwise=0.0)
def turning_at(s: Record, l: int, t: float) -> float:
    """w a fraction t into the step, of a tilt to any side."""
    w = 0.0
    for m in range(ORDER, -1, -1):
        w = w * t + s.turning_terms[m, l]
    return w


@compiled
def along_tilt(s: Record, l: int, path: float, rate: float, w: float) -> float:  # noqa: ARG001 -- called as `speed_of`
    """|u_b|' in one plane."""
    return rate


@compiled_with("turning_terms", otherwise=along_tilt)
def speed_of(s: Record, l: int, path: float, rate: float, w: float) -> float:  # noqa: ARG001
    """Velocity that dampers resist: |u_b'| of a tilt to any side."""
    return math.sqrt(rate * rate + path * w * (path * w))


@with_devices()
def observe_devices(s: Record, l: int, fraction: float) -> None:
    """Raise the largest forces and rates of devices by those of the first part of the step.

    At its end, and within it where the tilt turns, |u_b'| is largest, or the force of a stop is.
    """
    terms = rotation_terms(s, l)
    raise_within(s, l, fraction)
    if terms[0] > 0.0 and value(terms, fraction) < 0.0:
        raise_within(s, l, where_zero(terms, fraction))
    d = speed_terms(s)
    rate = d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]
    raise_where_level(s, l, rate, fraction)
    for i in range(s.devices[l]):
        if s.device_kind[i, l] == STOP and s.device_branch[i, l] == WORKING:
            watch_stop(s, l, i, 0)
            d = s.event_terms
            force = d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]
            raise_where_level(s, l, force, fraction)


@compiled
def advance_terms(s: Record) -> Floats:
    """Terms of |u_b|'."""
    terms: Floats = s.advance_terms
    return terms


@compiled_with("speed2_terms", otherwise=advance_terms)
def speed_terms(s: Record) -> Floats:
    """Terms of what is largest with the velocity of dampers."""
    terms: Floats = s.speed2_terms
    return terms


@compiled
def where_zero(c: Terms, fraction: float) -> float:
    """Where in the first part of the step a series passes through zero, once: bisection."""
    low, high = 0.0, fraction
    for _ in range(50):
        t = 0.5 * (low + high)
        if value(c, t) * c[0] > 0.0:
            low = t
        else:
            high = t
    return low


@compiled
def raise_where_level(s: Record, l: int, c: Terms, fraction: float) -> None:
    """Look at devices where a series has its extreme within the first part of the step."""
    rates = c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5], 6.0 * c[6], 7.0 * c[7], 0.0
    if rates[0] * value(rates, fraction) < 0.0:
        raise_within(s, l, where_zero(rates, fraction))


@compiled
def raise_within(s: Record, l: int, t: float) -> None:
    """Raise the largest forces and rates by those a fraction t into the step."""
    terms = rotation_terms(s, l)
    w = turning_at(s, l, t)
    raise_devices(s, l, s.theta[l] + s.step[l] * integral(terms, t), value(terms, t), w)


@with_devices()
def raise_devices(s: Record, l: int, theta: float, theta_dot: float, w: float) -> None:
    """Raise the largest forces and rates by those at a tilt and its rates."""
    path, rate, C = cap_beam_path(s, l, theta, theta_dot)
    e, lever, _, _ = tendon_elongation(s, l, theta)
    for i in range(s.devices[l]):
        force, speed, _ = device_at(s, l, i, path, rate, C, e, lever * theta_dot, w)
        s.device_force[i, l] = max(s.device_force[i, l], abs(force))
        s.device_velocity[i, l] = max(s.device_velocity[i, l], abs(speed))


@compiled
def device_at(
    s: Record,
    l: int,
    i: int,
    path: float,
    rate: float,
    C: float,
    e: float,
    e_rate: float,
    w: float,
) -> tuple[float, float, float]:
    """Force of a device, the rate at which it is worked, and its displacement.

    Of horizontal devices the resistance -s P with |u_b|; of a tendon the tension of one with its
    elongation; of rolling resistance the horizontal force that does the same, M/(2 R C).
    """
    kind = s.device_kind[i, l]
    if kind == TENDON:
        return tension(s, l, i, e), e_rate, e
    if kind == ROLLING_RESISTANCE:
        moment = s.direction[l] * s.law[i, ROLLING_MOMENT, l]
        return moment / (s.diameter[l] * C), rate, path
    speed = speed_of(s, l, path, rate, w) if kind == VISCOUS else rate
    return resistance(s, l, i, path, speed), speed, path


@compiled
def stored_in(s: Record, l: int, i: int, path: float, e: float) -> float:
    """Energy stored in a device over that at the start [J]; a yielded tendon's may be negative."""
    kind = s.device_kind[i, l]
    if kind == STOP:
        beyond = max(path - s.law[i, STOP_GAP, l], 0.0)
        return float(0.5 * s.law[i, STOP_STIFFNESS, l] * beyond * beyond)
    if kind == TENDON:
        tense, prestress = tension(s, l, i, e), s.law[i, TENDON_PRESTRESS, l]
        change = tense * tense - prestress * prestress
        return float(0.5 * s.columns[l] * change / s.law[i, TENDON_STIFFNESS, l])
    return 0.0


# What devices do at a sample of the record, and leave behind at the end.


@with_devices()
def store_devices(s: Record, l: int, sample: Floats, w: float) -> None:
    """Keep force, displacement, dissipated and stored energy of each device of a lane.

    Horizontal forces are those on the cap beam, positive to the right, and go with u_b; of a tendon
    the tension of one goes with its elongation. Friction at rest is what equilibrium asks for while
    the storey is stuck, and in full contact the least that it can be, see `rest`.
    """
    stuck, stands = s.phase[l] == STUCK, s.phase[l] == FULL_CONTACT
    path, rate, C = cap_beam_path(s, l, s.theta[l], s.theta_dot[l])
    e, lever, _, _ = tendon_elongation(s, l, s.theta[l])
    share = mobilised_friction(s, l) if stuck or stands else 0.0
    for i in range(s.devices[l]):
        kind, e_rate = s.device_kind[i, l], lever * s.theta_dot[l]
        force, _, displacement = device_at(s, l, i, path, rate, C, e, e_rate, w)
        if kind != TENDON:
            if (stuck or stands) and kind in (FRICTION, ROLLING_RESISTANCE):
                force *= share * s.direction[l]
                if stands and kind == ROLLING_RESISTANCE:
                    force = 0.0
            force, displacement = -s.side[l] * force, s.side[l] * displacement
        sample[0, i], sample[1, i] = force + 0.0, displacement + 0.0
        sample[2, i] = s.device_energy[i, l]
        sample[3, i] = stored_in(s, l, i, path, e)


@with_devices()
def leave_devices(s: Record, l: int, result: Record) -> None:
    """Write what the devices of a lane leave behind at the end of its history."""
    path, _, _ = cap_beam_path(s, l, s.theta[l], 0.0)
    e, _, _, _ = tendon_elongation(s, l, s.theta[l])
    for i in range(s.devices[l]):
        result.device_force[i] = s.device_force[i, l]
        result.device_velocity[i] = s.device_velocity[i, l]
        result.device_energy[i] = s.device_energy[i, l]
        result.device_stored[i] = stored_in(s, l, i, path, e)
        result.permanent[i] = s.permanent[i, l]
