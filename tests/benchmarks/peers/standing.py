"""Full contact for the peers: the linear building, solved exactly, compiled.

What remains of a peer's time is then its uplifted motion: the comparison favours the peers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from benchmarks.peers.compiled import compiled
from benchmarks.peers.rocking import Floats, Rocking

ORDER = 12  # of the Taylor series within a sampling interval
PARTS = 16  # of an interval in which the first uplift is looked for


class FixedBase(NamedTuple):
    """z' = flow z + ground a_g for z = [v, v'], and the push q = push . z - own a_g.

    `swing` and `kick` are push . flow and push . ground, for the rate of the push.
    `over`, `level` and `ramp` are the exact map over one sampling interval of `dt`.
    """

    flow: Floats
    ground: Floats
    push: Floats
    swing: Floats
    kick: float
    own: float
    lift: float
    dt: float
    over: Floats
    level: Floats
    ramp: Floats


def fixed_base_of(podium: Rocking, dt: float) -> FixedBase:
    """Matrices of the building on a fixed base."""
    n = len(podium.masses)
    between = np.eye(n) - np.eye(n, k=-1)
    stiffness = between.T @ np.diag(podium.stiffnesses) @ between
    damping = podium.a0 * np.diag(podium.masses) + podium.a1 * stiffness
    flow = np.zeros((2 * n, 2 * n))
    flow[:n, n:] = np.eye(n)
    flow[n:, :n] = -stiffness / podium.masses[:, None]
    flow[n:, n:] = -damping / podium.masses[:, None]
    ground = np.r_[np.zeros(n), -np.ones(n)]
    whole = np.zeros((2 * n + 2, 2 * n + 2))
    whole[: 2 * n, : 2 * n] = flow
    whole[: 2 * n, 2 * n] = ground
    whole[2 * n, 2 * n + 1] = 1.0
    exact = expm(whole * dt)[: 2 * n]
    gamma, eta = podium.gamma, podium.eta
    share = 2.0 * gamma * eta / podium.masses.sum()
    push = share * np.r_[stiffness.sum(axis=0), damping.sum(axis=0)]
    return FixedBase(
        flow=flow,
        ground=ground,
        push=push,
        swing=push @ flow,
        kick=float(push @ ground),
        own=1.0 + 2.0 * gamma,
        lift=podium.gravity * np.tan(podium.alpha) * (1.0 + 2.0 * gamma * (1.0 + eta)),
        dt=dt,
        over=np.ascontiguousarray(exact[:, : 2 * n]),
        level=exact[:, 2 * n].copy(),
        ramp=exact[:, 2 * n + 1].copy(),
    )


@compiled
def _series(z: Floats, across: float, slope: float, base: FixedBase) -> Floats:
    """Taylor coefficients of z(t), one row a power."""
    terms = np.empty((ORDER + 1, len(z)))
    terms[0] = z
    for k in range(ORDER):
        terms[k + 1] = base.flow @ terms[k]
        if k == 0:
            terms[k + 1] += base.ground * across
        elif k == 1:
            terms[k + 1] += base.ground * slope
        terms[k + 1] /= k + 1.0
    return terms


@compiled
def _dot(a: Floats, b: Floats) -> float:
    total = 0.0
    for k in range(len(a)):
        total += a[k] * b[k]
    return total


@compiled
def _value(coefficients: Floats, t: float) -> float:
    total = 0.0
    for k in range(len(coefficients) - 1, -1, -1):
        total = total * t + coefficients[k]
    return total


@compiled
def _first_uplift(q: Floats, lift: float, h: float) -> tuple[float, float]:
    """The first time in [0, h] at which |q| passes `lift`, and the side; side 0 if none."""
    for part in range(PARTS):
        low, high = h * part / PARTS, h * (part + 1) / PARTS
        end = _value(q, high)
        if abs(end) < lift:
            continue
        side = 1.0 if end > 0.0 else -1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            if side * _value(q, middle) > lift:
                high = middle
            else:
                low = middle
        return high, side
    return h, 0.0


@compiled
def stand(
    z: Floats, record: Floats, interval: int, after: float, base: FixedBase
) -> tuple[int, float, float]:
    """Advance z from `after` seconds into an interval to the next uplift, or to the record's end.

    Returns the interval, the time into it and the side of uplift (0: the end of the record).
    """
    following = np.empty_like(z)
    q = _dot(base.push, z) - base.own * (
        record[interval] + after * (record[interval + 1] - record[interval]) / base.dt
    )
    for i in range(interval, len(record) - 1):
        slope = (record[i + 1] - record[i]) / base.dt
        start = after if i == interval else 0.0
        across = record[i] + slope * start
        swing = _dot(base.swing, z) + base.kick * across - base.own * slope
        for k in range(len(z)):
            following[k] = _dot(base.over[k], z) + base.level[k] * across + base.ramp[k] * slope
        later = _dot(base.push, following) - base.own * record[i + 1]
        room = base.lift - max(abs(q), abs(later))
        if start > 0.0 or room < 0.5 * base.dt * abs(swing):
            terms = _series(z, across, slope, base)
            powers = terms @ base.push
            powers[0] -= base.own * across
            powers[1] -= base.own * slope
            h, side = _first_uplift(powers, base.lift, base.dt - start)
            for k in range(len(z)):
                z[k] = _value(terms[:, k], h)
            if side != 0.0:
                return i, start + h, side
            q = _dot(base.push, z) - base.own * record[i + 1]
        else:
            z[:] = following
            q = later
    return len(record) - 1, 0.0, 0.0
