"""Eight histories at once by heyoka's batch mode: its own lanes, beside ours.

Each lane has its own time, phase and record. What stands between two steps (samples, impacts, full
contact, the next history of a lane that is done) is compiled, so that Python only calls `step`.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.compiled import compiled
from benchmarks.peers.heyoka_history import (
    ACROSS,
    ASIDE,
    CURVE,
    LEVEL,
    SHIFT,
    SLOPE,
    SQUARE,
    P,
    Q,
    equations,
    seconds_a_call,
)
from benchmarks.peers.landing import Landing
from benchmarks.peers.rocking import Floats, PeerHistory, Phase, Rocking
from benchmarks.peers.standing import FixedBase, fixed_base_of, stand

LANES = 8
ON_EVENT = 1e-13
"""A step that ends so near to an event ended because of it."""
SIDE, LEFT, X, W, PEAK = range(5)
HISTORY, INTERVAL, IMPACTS = range(3)


Counts = NDArray[np.int64]


class Lanes(NamedTuple):
    """Where each lane is, and what the histories left."""

    numbers: Floats
    """(LANES, 5): side, time to the next sample, tilt and rate behind the last step, peak."""
    counts: Counts
    """(LANES, 3): history (-1 once there is none), interval of the record, impacts."""
    begun: Counts
    """(1,): histories that have begun."""
    rotations: Floats
    impacts: Counts


class Rules(NamedTuple):
    """What is constant: `Landing` and the phases, as numbers."""

    restitution: float
    jump: float
    negligible: float
    restoring: float
    turning: float
    ground: float
    building: Floats
    beam: float
    left_out: float
    rolling: Phase
    rocking: Phase
    level: float
    limit: float


def rules_of(podium: Rocking) -> Rules:
    """The numbers of one podium."""
    landing = Landing(podium)
    return Rules(
        landing.restitution,
        landing.jump,
        landing.negligible,
        landing.restoring,
        landing.turning,
        landing.ground,
        landing.building,
        landing.beam,
        landing.left_out,
        podium.rolling,
        podium.rocking,
        podium.level,
        podium.limit,
    )


@compiled
def _enter(pars: Floats, lane: int, phase: Phase) -> None:
    p, q, c, u0 = phase
    pars[P, lane], pars[Q, lane], pars[CURVE, lane], pars[SHIFT, lane] = p, q, c, u0
    pars[SQUARE, lane] = p * p + q * q - c * c


@compiled
def _highest(x0: float, w0: float, x1: float, w1: float, h: float) -> float:
    """The largest tilt of a step by its cubic Hermite interpolant."""
    if not w1 <= 0.0 < w0:
        return max(x0, x1)
    # w(z) = w0 + b z + c z^2 on [0, 1]
    rise = 6.0 * (x1 - x0) / h
    b, c = rise - 4.0 * w0 - 2.0 * w1, 3.0 * (w0 + w1) - rise
    z = 2.0 * w0 / (math.sqrt(max(b * b - 4.0 * c * w0, 0.0)) - b)
    return max(x0 + h * z * (w0 + z * (0.5 * b + z * c / 3.0)), x1)


@compiled
def _land(y: Floats, lane: int, across: float, rules: Rules) -> bool:
    """`Landing.land`, for one lane."""
    n = y.shape[0] // 2 - 1
    arrival = y[n + 1, lane]
    rate = -rules.restitution * arrival
    for i in range(1, n + 1):
        y[i, lane] = -y[i, lane]
        y[n + 1 + i, lane] = rules.jump * arrival - y[n + 1 + i, lane]
    y[0, lane], y[n + 1, lane] = 0.0, rate
    back = rules.restoring + rules.turning * rate * rate - rules.ground * across
    for i in range(2 * n + 2):
        back -= rules.building[i] * y[i, lane]
    y[0, lane] = ASIDE
    stays = back > 0.0 and rate * rate < rules.negligible * back
    if stays:
        for i in range(n + 2, 2 * n + 2):
            y[i, lane] += rules.left_out * rate
    return bool(stays)


@compiled
def _after_step(
    y: Floats, pars: Floats, lane: int, now: float, h: float, lanes: Lanes, rules: Rules, dt: float
) -> bool:
    """Events and samples behind a step; whether the storey has come to stand."""
    n = y.shape[0] // 2 - 1
    state, count = lanes.numbers[lane], lanes.counts[lane]
    x, w = y[0, lane], y[n + 1, lane]
    state[PEAK] = max(state[PEAK], _highest(state[X], state[W], x, w, h))
    state[LEFT] -= h
    stands = False
    if abs(x) < ON_EVENT and w < 0.0:
        count[IMPACTS] += 1
        stands = _land(y, lane, pars[ACROSS, lane] + pars[SLOPE, lane] * now, rules)
        state[SIDE] = -state[SIDE]
    elif abs(x - rules.level) < ON_EVENT:
        if w > 0.0:
            _enter(pars, lane, rules.rocking)
            y[0, lane] = rules.level + ASIDE
        else:
            _enter(pars, lane, rules.rolling)
            y[0, lane] = rules.level - ASIDE
    state[X], state[W] = y[0, lane], y[n + 1, lane]
    if state[LEFT] <= 0.0 and not stands:
        count[INTERVAL] += 1
        state[LEFT] = dt
    return stands


@compiled
def _next_flight(
    y: Floats, pars: Floats, lane: int, z: Floats, lanes: Lanes, records: Floats,
    base: FixedBase, rules: Rules,
) -> None:  # fmt: skip
    """From full contact to the next uplift, of this history or of a next one."""
    n = y.shape[0] // 2 - 1
    state, count = lanes.numbers[lane], lanes.counts[lane]
    last = records.shape[1] - 1
    while True:
        if count[INTERVAL] < last:
            after = base.dt - state[LEFT]
            record = records[count[HISTORY]]
            interval, after, side = stand(z, record, count[INTERVAL], after, base)
            count[INTERVAL] = interval
            if side != 0.0:
                break
        lanes.rotations[count[HISTORY]] = state[PEAK]
        lanes.impacts[count[HISTORY]] = count[IMPACTS]
        if lanes.begun[0] == records.shape[0]:
            count[HISTORY] = -1
            return
        count[HISTORY], count[INTERVAL], count[IMPACTS] = lanes.begun[0], 0, 0
        lanes.begun[0] += 1
        state[PEAK], state[LEFT] = 0.0, base.dt
        z[:] = 0.0
    state[SIDE], state[LEFT], state[X], state[W] = side, base.dt - after, ASIDE, 0.0
    y[0, lane], y[n + 1, lane] = ASIDE, 0.0
    for i in range(n):
        y[1 + i, lane], y[n + 2 + i, lane] = side * z[i], side * z[n + i]
    _enter(pars, lane, rules.rolling)


@compiled
def serve(
    y: Floats, pars: Floats, times: Floats, steps: Floats, most: Floats, z: Floats, lanes: Lanes,
    records: Floats, base: FixedBase, rules: Rules,
) -> bool:  # fmt: skip
    """Between two steps of all lanes: fill their longest next steps; whether any goes on."""
    n = y.shape[0] // 2 - 1
    busy = False
    for lane in range(LANES):
        state, count = lanes.numbers[lane], lanes.counts[lane]
        most[lane] = 0.0
        if count[HISTORY] < 0:
            continue
        now, rests = times[lane], False
        if state[SIDE] == 0.0:  # nothing has begun yet
            rests, z[:] = True, 0.0
        elif _after_step(y, pars, lane, now, steps[lane], lanes, rules, base.dt):
            rests = True
            for i in range(n):
                z[i] = state[SIDE] * y[1 + i, lane]
                z[n + i] = state[SIDE] * (y[n + 2 + i, lane] - rules.beam * y[n + 1, lane])
        elif y[0, lane] > rules.limit:
            state[PEAK], count[INTERVAL] = np.inf, records.shape[1]
        if rests or count[INTERVAL] >= records.shape[1] - 1:
            _next_flight(y, pars, lane, z, lanes, records, base, rules)
            if count[HISTORY] < 0:
                continue
        record, i = records[count[HISTORY]], count[INTERVAL]
        slope = state[SIDE] * (record[i + 1] - record[i]) / base.dt
        pars[SLOPE, lane] = slope
        reached = base.dt - state[LEFT]
        pars[ACROSS, lane] = state[SIDE] * record[i] + slope * (reached - now)
        most[lane] = state[LEFT]
        busy = True
    return busy


def server(podium: Rocking, dt: float) -> Callable[..., bool]:
    """`serve` with what is constant inside it: unpacking that at each call would cost 10 us."""
    base, rules = fixed_base_of(podium, dt), rules_of(podium)

    def with_constants(
        y: Floats, pars: Floats, times: Floats, steps: Floats, most: Floats, z: Floats,
        numbers: Floats, counts: Counts, begun: Counts, rotations: Floats, impacts: Counts,
        records: Floats,
    ) -> bool:  # fmt: skip
        lanes = Lanes(numbers, counts, begun, rotations, impacts)
        return serve(y, pars, times, steps, most, z, lanes, records, base, rules)

    return compiled(with_constants)


class HeyokaBatch:
    """A compiled integrator of eight lanes for one podium."""

    def __init__(self, podium: Rocking, dt: float, tol: float = 1e-4) -> None:
        import heyoka as hy

        self.dt, self.serve = dt, server(podium, dt)
        rows = 2 * len(podium.masses) + 2
        x = hy.make_vars("x")
        falls = hy.event_direction.negative
        self.integrator: Any = hy.taylor_adaptive_batch(
            equations(podium),
            np.zeros((rows, LANES)),
            pars=np.zeros((8, LANES)),
            tol=tol,
            force_avx512=True,
            t_events=[
                hy.t_event_batch(x, direction=falls, cooldown=0.0),
                hy.t_event_batch(x - hy.par[LEVEL], cooldown=0.0),
            ],
        )
        self.integrator.pars[LEVEL] = podium.level
        self.inside, self.steps = 0.0, 0

    def histories(self, records: Floats, *, clocked: bool = False) -> list[PeerHistory]:
        """All records, one a row; an infinite rotation is that of an overturned history."""
        count = len(records)
        lanes = Lanes(
            numbers=np.zeros((LANES, 5)),
            counts=np.zeros((LANES, 3), dtype=np.int64),
            begun=np.array([LANES]),
            rotations=np.zeros(count),
            impacts=np.zeros(count, dtype=np.int64),
        )
        lanes.counts[:, HISTORY] = np.arange(LANES)
        lanes.numbers[:, LEFT] = self.dt
        ta, serve, limits = self.integrator, self.serve, np.zeros(LANES)
        y, pars, step = ta.state, ta.pars, ta.step
        z = np.zeros(len(y) - 2)
        self.inside, self.steps = 0.0, 0
        times, steps = ta.time, ta.last_h
        while serve(y, pars, times, steps, limits, z, *lanes, records):
            if clocked:
                start = time.perf_counter()
                step(limits)
                self.inside += time.perf_counter() - start
            else:
                step(limits)
            self.steps += 1
            times, steps = ta.time, ta.last_h
        return [
            PeerHistory(float(r), int(i))
            for r, i in zip(lanes.rotations, lanes.impacts, strict=True)
        ]


def empty_batch_step_seconds() -> float:
    """What one call of `step` costs if there is next to nothing to integrate."""
    import heyoka as hy

    x, limits = hy.make_vars("x"), np.full(LANES, 1e-3)
    empty = hy.taylor_adaptive_batch([(x, 0.0 * x)], np.zeros((1, LANES)), tol=1e-4)
    return seconds_a_call(empty.step, limits)
