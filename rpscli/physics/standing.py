"""A lane in full contact: over the record's intervals until it uplifts or the history ends."""

from __future__ import annotations

import math

from rpscli.physics.contact import (
    DQ,
    DRAG,
    PART,
    PARTICIPATION,
    PULL,
    PULLS,
    SHAPES,
    SHEARS,
    WHOLE,
    Q,
    Stance,
    contact_energies,
    fill_transition,
    keep_end,
    push_of,
    step_contact,
)
from rpscli.physics.inspection import raise_contacts
from rpscli.physics.jit import kernel, part
from rpscli.physics.layout import (
    ACROSS,
    ACROSS_SLOPE,
    CONTACT_STEP,
    DAMPED,
    FAILED_NOT_FINITE,
    FLOOR_ACCELERATION,
    GROUND,
    GROUND_UPWARDS,
    INPUT,
    INTERVAL,
    INTERVAL_LENGTH,
    MASS,
    NPTS,
    OUTCOME,
    POSITION,
    SCALARS,
    STOREY_SHEAR,
    TIME,
    UPWARDS,
    UPWARDS_SLOPE,
    VELOCITY,
)
from rpscli.physics.parameters import Floats, Lanes, Shape
from rpscli.physics.progress import next_interval
from rpscli.physics.switch import lift_off
from rpscli.physics.table import podium_of


@part
def stance_of(lanes: Lanes, L: int, l: int) -> Stance:
    """Margin and ground motion of the present interval."""
    b, z = lanes.buffer, lanes.modes[l]
    podium = podium_of(lanes.podium, l)
    own, carried = 1.0 + 2.0 * podium.gamma, 2.0 * podium.gamma * podium.eta
    creep = 0.0
    for r in range(z.shape[1]):
        creep += z[PARTICIPATION, r] * z[PARTICIPATION, r] * z[DRAG, r]
    return Stance(
        own,
        carried / podium.floors_mass if z.shape[1] > 0 else 0.0,
        math.tan(podium.alpha) * (own + carried),
        creep,
        b[ACROSS * L + l],
        b[ACROSS_SLOPE * L + l],
        b[UPWARDS * L + l],
        b[UPWARDS_SLOPE * L + l],
    )


@part
def moved_on(stance: Stance, b: Floats, L: int, l: int) -> Stance:
    """The same margin under the ground motion of the interval that has begun."""
    return Stance(
        stance.own,
        stance.share,
        stance.lift,
        stance.creep,
        b[ACROSS * L + l],
        b[ACROSS_SLOPE * L + l],
        b[UPWARDS * L + l],
        b[UPWARDS_SLOPE * L + l],
    )


@part
def to_modes(lanes: Lanes, L: int, l: int) -> None:
    """Modal state of the floors: Phi^T M u."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    for r in range(n):
        q, dq = 0.0, 0.0
        for i in range(n):
            weight = z[SHAPES + r, i] * b[(SCALARS + MASS * (n + 1) + i) * L + l]
            q += weight * b[(SCALARS + POSITION * (n + 1) + i + 1) * L + l]
            dq += weight * b[(SCALARS + VELOCITY * (n + 1) + i + 1) * L + l]
        z[Q, r], z[DQ, r] = q, dq


@kernel
def to_floors(lanes: Lanes, L: int, l: int) -> None:
    """Floors of the modal state: Phi q; the storey does not tilt."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    u, du = SCALARS + POSITION * (n + 1), SCALARS + VELOCITY * (n + 1)
    for c in range(n + 1):
        b[(u + c) * L + l], b[(du + c) * L + l] = 0.0, 0.0
    for r in range(n):
        for i in range(n):
            b[(u + i + 1) * L + l] += z[SHAPES + r, i] * z[Q, r]
            b[(du + i + 1) * L + l] += z[SHAPES + r, i] * z[DQ, r]


@kernel
def observe_contact(lanes: Lanes, L: int, l: int) -> None:
    """Raise the demands of a lane in full contact; the modes' PULL is that of the moment."""
    b, z = lanes.buffer, lanes.modes[l]
    n = z.shape[1]
    for i in range(n):
        z[SHEARS, i], z[PULLS, i] = 0.0, 0.0
    V = 0.0
    for r in range(n):
        q, pull = z[Q, r], z[PULL, r]
        V += z[PARTICIPATION, r] * pull
        for i in range(n):
            z[SHEARS, i] += z[SHAPES + n + r, i] * q
            z[PULLS, i] += z[SHAPES + r, i] * pull
    for i in range(n):
        row = (SCALARS + STOREY_SHEAR * (n + 1) + i) * L + l
        b[row] = max(b[row], abs(z[SHEARS, i]))
        row = (SCALARS + FLOOR_ACCELERATION * (n + 1) + i) * L + l
        b[row] = max(b[row], abs(z[PULLS, i]))
    time = b[TIME * L + l]
    b[GROUND * L + l] = b[ACROSS * L + l] + b[ACROSS_SLOPE * L + l] * time
    b[GROUND_UPWARDS * L + l] = b[UPWARDS * L + l] + b[UPWARDS_SLOPE * L + l] * time
    raise_contacts(b, L, l, 1.0, 0.0, 0.0, V)


@kernel
def stand(lanes: Lanes, shape: Shape, l: int) -> bool:
    """Follow a lane in full contact; True if it uplifts, False if its history is over."""
    L = len(shape.stride)
    b, z = lanes.buffer, lanes.modes[l]
    dt, step = b[INTERVAL_LENGTH * L + l], b[CONTACT_STEP * L + l]
    stance, time = stance_of(lanes, L, l), b[TIME * L + l]
    push = push_of(z, Q, stance.across + stance.across_slope * time)
    while True:
        while dt - time > 1e-13 * dt:
            h, row = min(step, dt - time), WHOLE
            if abs(h - step) > 1e-12 * dt:
                row = PART
                fill_transition(z, h, row)
            advanced, side, push = step_contact(z, stance, time, h, row, push, lanes.piece)
            if len(shape.audit) > 0:
                across = stance.across + stance.across_slope * time
                given, damped = contact_energies(z, across, stance.across_slope, advanced)
                b[INPUT * L + l] += given
                b[DAMPED * L + l] += damped
            if not math.isfinite(push.bend + stance.across_slope):
                lanes.integers[l, OUTCOME] = FAILED_NOT_FINITE
                return False
            keep_end(z)
            time += advanced
            b[TIME * L + l] = time
            if side != 0.0:
                to_floors(lanes, L, l)
                lift_off(lanes, L, l, side)
                return True
        observe_contact(lanes, L, l)
        if lanes.samples.shape[0] > 0:
            to_floors(lanes, L, l)
        if next_interval(lanes, shape, l):
            return False
        stance, time = moved_on(stance, b, L, l), 0.0
        if lanes.integers[l, INTERVAL] + 1 == lanes.integers[l, NPTS]:
            push = push_of(z, Q, stance.across)  # the ground acceleration may jump to zero
