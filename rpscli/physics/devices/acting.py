"""Joint action of all devices of a lane.

Linear dampers, friction and rolling resistance are sums of a lane, and lanes act
together. What has branches or powers is looked at device by device.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.devices.device import is_apart
from rpscli.physics.devices.table import (
    drag_of,
    load_device,
    power_of,
    resistance_of,
    tension_of,
)
from rpscli.physics.devices.worked import Worked, worked
from rpscli.physics.lane import (
    Polar,
    lanes_of,
    new_rate_of,
    new_tilt_of,
    place_with,
    polar,
    pushed_by,
    rate_of,
    set_vector,
    tilt_of,
    ways_of,
)
from rpscli.physics.laws.place import Place, length, turned
from rpscli.physics.state import Record

STOP_SPEED = 5e-3
"""Of that at which sliding begins: what slides more slowly to any side is
stopped, or turned to where it is pushed. A step may err by a fiftieth of it,
however slow the motion is."""

STOP_SPEED_OF_PASSES = 1e-9
SLOW_RATE = 1e-3
"""Of sqrt(g R), and of sqrt(g/R): the same of rigid ends. What passes upright asks for
velocities in proportion, except where it tilts more slowly than this."""


@inlined
def has_friction(s: Record, l: int) -> bool:
    """True if something holds the tilt at rest."""
    return s.friction_force[l] + s.friction_moment[l] > 0.0  # type: ignore[no-any-return]


@compiled
def load_devices(s: Record, l: int, system: Record) -> None:
    """Begin a history with its devices as they are at rest and upright."""
    s.devices[l] = system.devices
    s.columns[l] = system.columns
    s.tendons[l] = 0
    s.linear_speed[l] = system.linear_speed
    s.direction[l] = 1.0
    s.viscous[l] = 0.0
    s.friction_force[l] = 0.0
    s.friction_moment[l] = 0.0
    s.kinks[l] = 0.0
    s.turning[l] = 0.0
    s.turning_across[l] = 0.0
    s.tied[l] = 0.0
    s.pull[l] = 0.0
    s.branched[l] = 0.0
    s.drag_branched[l] = 0.0
    s.stop_force[l] = 0.0
    s.tendon_moment[l] = 0.0
    s.least_height[l] = math.inf
    s.start_speed[l] = system.start_speed
    for axis in range(ways_of(s)):
        s.drive[axis, l] = 0.0
    for i in range(system.devices):
        load_device(s, l, i, system)
    s.stop_speed[l] = STOP_SPEED * system.start_speed
    error = 0.02 * s.stop_speed[l] / s.diameter[l]
    if system.alpha > 0.0 and system.compliant == 0:
        s.stop_speed[l] = STOP_SPEED_OF_PASSES * math.sqrt(system.gravity * system.R)
        error = system.step_error * SLOW_RATE * math.sqrt(system.gravity / system.R)
    s.least_error[l] = error if ways_of(s) == 2 and has_friction(s, l) else 0.0


@inlined
def paces(
    s: Record, l: int, at: Place, tilt: Polar
) -> tuple[float, float, float, float, float]:
    """u_b' along the tilt, across it, and its size [m/s]; rates
    against which friction acts.

    These are of dampers [m/s] and of rolling resistance [rad/s]; in one plane they have
    the sign of `direction`.
    """
    out = s.diameter[l] * at.C * tilt.p
    aside = s.diameter[l] * at.h * tilt.q
    if ways_of(s) == 1:
        return out, 0.0, abs(out), s.direction[l] * out, s.direction[l] * tilt.p
    speed = length(out, aside)
    return out, aside, speed, speed, length(tilt.p, tilt.q)


@inlined
def push_by_devices(s: Record, l: int, at: Place, tilt: Polar) -> None:
    """Write what the devices of a lane do at a place and rate: `drive` and `turning`."""
    u_out, u_aside, speed, _, swing = paces(s, l, at, tilt)
    drag = s.drag_branched[l] + s.viscous[l]
    resisting = s.stop_force[l]
    moves = s.moves[l] > 0.0
    rolls = s.direction[l] * s.friction_moment[l]
    aside_rolls = 0.0
    if ways_of(s) == 1:
        resisting += s.direction[l] * s.friction_force[l]
    else:
        drag += s.friction_force[l] / max(speed, 1e-150)
        per_rate = s.friction_moment[l] / max(swing, 1e-300)
        rolls = per_rate * tilt.p
        aside_rolls = per_rate * tilt.q
    moment = s.tendon_moment[l] + rolls
    diameter = s.diameter[l]
    s.turning[l] = -pushed_by(s, l, moment) / diameter if moves else 0.0
    s.turning_across[l] = -pushed_by(s, l, aside_rolls) / diameter if moves else 0.0
    out = -(drag * u_out + resisting)
    push_x, push_y = turned(tilt.n, tilt.t, out, -drag * u_aside)
    set_vector(s, s.drive, l, push_x if moves else 0.0, push_y if moves else 0.0)


@compiled
def act_branched(s: Record, l: int, at: Worked) -> None:
    """Write the sums of what has branches or powers, and of tendons `tied` and `pull`."""
    speed = math.sqrt(at.along * at.along + at.across * at.across)
    drag = 0.0
    resisting = 0.0
    tense = 0.0
    for i in range(s.devices[l]):
        if is_apart(s, l, i):
            drag += drag_of(s, l, i, at.path, speed)
            resisting += resistance_of(s, l, i, at.path, at.along)
            tense += s.columns[l] * tension_of(s, l, i, at.e)
    s.drag_branched[l] = drag
    s.stop_force[l] = resisting
    s.tendon_moment[l] = tense * at.lever
    s.tied[l] = -tense * at.sin_psi
    s.pull[l] = tense * at.cos_psi


@compiled
def act(s: Record, l: int, tilt: tuple[float, float], rate: tuple[float, float]) -> None:
    """Write what all devices of a lane do at a tilt and its rate."""
    if s.branched[l] > 0.0:
        act_branched(s, l, worked(s, l, tilt, rate))
    now = polar(s, l, tilt, rate)
    push_by_devices(s, l, place_with(s, l, now.x, 0.0, 0.0), now)


@inlined
def add_work(s: Record, l: int, at: Place, tilt: Polar, weight: float) -> float:
    """Add what flows at an instant to the means of the step; |u_b'| [m/s]."""
    _, _, speed, pace, swing = paces(s, l, at, tilt)
    s.mean_square[l] += weight * (speed * speed)
    s.mean_pace[l] += weight * pace
    s.mean_swing[l] += weight * swing
    return speed


@compiled
def begin_work(s: Record, weight: float) -> None:
    """Begin the means of the step with what is worked at its start."""
    for l in range(lanes_of(s)):
        now = polar(s, l, tilt_of(s, l), rate_of(s, l))
        s.mean_square[l] = 0.0
        s.mean_pace[l] = 0.0
        s.mean_swing[l] = 0.0
        add_work(s, l, place_with(s, l, now.x, 0.0, 0.0), now, weight)
    for l in range(lanes_of(s)):
        if s.branched[l] > 0.0:
            at = worked(s, l, tilt_of(s, l), rate_of(s, l))
            for i in range(s.devices[l]):
                s.device_work[i, l] = weight * power_of(s, l, i, at)


@compiled
def act_branched_at_stage(s: Record, weight: float) -> None:
    """`act_branched` at a stage of the step, in all lanes that have
    such; adds to their work.
    """
    for l in range(lanes_of(s)):
        if s.branched[l] > 0.0:
            at = worked(s, l, new_tilt_of(s, l), new_rate_of(s, l))
            act_branched(s, l, at)
            for i in range(s.devices[l]):
                s.device_work[i, l] += weight * power_of(s, l, i, at)


@inlined
def power_in_step(s: Record, l: int, i: int) -> float:
    """Mean of what a device dissipated in the step just taken [W]."""
    mean = (
        s.square_constant[i, l] * s.mean_square[l]
        + s.pace_constant[i, l] * s.mean_pace[l]
    )
    mean += s.swing_constant[i, l] * s.mean_swing[l]
    return s.device_work[i, l] if is_apart(s, l, i) else mean  # type: ignore[no-any-return]
