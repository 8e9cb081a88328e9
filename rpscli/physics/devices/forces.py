"""What devices do at a given motion (Theory, section 11).

A horizontal device acts on the cap beam with P = -s times its resistance, a tendon with its tension
against the opening of both ends, rolling resistance with its moment against the tilt's rate. Which
branch of its law a device follows is part of the state, so that all of it is smooth within a step.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.devices.elongation import opening
from rpscli.physics.equation_of_motion import (
    cap_beam_displacement,
    contact_height,
    phase_constants,
)
from rpscli.physics.formulae.trigonometry import sine_cosine
from rpscli.physics.state import FRICTION, IDLE, STOP, TENDON, VISCOUS, WORKING, Record


@compiled
def resistance(s: Record, l: int, i: int, path: float, rate: float) -> float:
    """Resistance -s P of a horizontal device, 0 of others [N].

    Parameters
    ----------
    path, rate
        |u_b| [m] and its rate [m/s].
    """
    kind = s.device_kind[i, l]
    if kind == VISCOUS:
        exponent = s.device_constants[i, 1, l] - 1.0
        return float(
            s.device_constants[i, 0, l] * rate * max(abs(rate), s.linear_speed[l]) ** exponent
        )
    if kind == FRICTION:
        return float(s.direction[l] * s.device_constants[i, 0, l])
    if kind == STOP and s.device_branch[i, l] == WORKING:
        beyond = path - s.device_constants[i, 0, l]
        return float(s.device_constants[i, 1, l] * beyond + s.device_constants[i, 2, l] * rate)
    return 0.0


@compiled
def tension(s: Record, l: int, i: int, e: float) -> float:
    """Tension of one tendon of a device that is one [N], at its elongation e [m]; else 0.

    Parameters
    ----------
    e
        Elongation of a tendon [m].
    """
    if s.device_kind[i, l] != TENDON or s.device_branch[i, l] == IDLE:
        return 0.0
    if s.device_branch[i, l] == WORKING:
        stretch = e - s.permanent[i, l]
        return float(s.device_constants[i, 0, l] + s.device_constants[i, 1, l] * stretch)
    return float(s.device_constants[i, 2, l])


@compiled
def cap_beam_path(s: Record, l: int, theta: float, theta_dot: float) -> tuple[float, float, float]:
    """|u_b| [m], its rate [m/s], and C, at a tilt in the present phase.

    Parameters
    ----------
    theta, theta_dot
        Tilt x [rad] and its rate [rad/s].
    """
    sine, cosine = sine_cosine(theta)
    phase = phase_constants(s, l)
    C = contact_height(phase, cosine, sine)
    path = s.diameter[l] * cap_beam_displacement(phase, theta, cosine, sine)
    return path, s.diameter[l] * C * theta_dot, C


@compiled
def set_devices(s: Record, l: int, theta: float, theta_dot: float) -> None:
    """What the devices of a lane do at a tilt and its rate; writes `next_device`, push and pull.

    Parameters
    ----------
    theta, theta_dot
        Tilt x [rad] and its rate [rad/s].
    """
    path, rate, C = cap_beam_path(s, l, theta, theta_dot)
    e, lever, lean, rise = opening(s, l, theta)
    resisting, tense = 0.0, 0.0
    for i in range(s.devices[l]):
        resisting += resistance(s, l, i, path, rate)
        tense += s.columns[l] * tension(s, l, i, e)
    moment = tense * lever + s.direction[l] * s.friction_moment[l]
    s.next_device[l] = -s.shear_factor[l] * (C * resisting + moment / s.diameter[l])
    s.next_push[l] = -s.side[l] * (resisting + tense * lean)
    s.next_pull[l] = tense * rise


@compiled
def set_devices_at_ends(s: Record) -> None:
    """The same at the ends of the steps of all lanes."""
    for l in range(s.lanes):
        if s.devices[l] > 0:
            set_devices(s, l, s.next_theta[l], s.next_theta_dot[l])
