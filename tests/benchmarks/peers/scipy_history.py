"""One history by `solve_ivp`, as it is usually written: RK45, steps of a sample or less, events.

Full contact is exact and compiled, so that what is timed is the uplifted motion. One
pitfall is avoided: behind an impact the first step is shorter than the excursion, since `solve_ivp`
takes a state that begins at theta = 0 and ends below it for an event at the start.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.peers.rocking import (
    Floats,
    Landing,
    PeerHistory,
    Phase,
    Rocking,
    compiled,
    fixed_base_of,
    rates,
    stand,
)

RightHandSide = Callable[[float, Floats, Floats, float, float, Phase], Floats]
"""Of time, state, record, its time step, the side of the tilt, and the phase's constants."""

IMPACT, ARC_END, OVERTURNED = range(3)
TOLERANCE = 1e-8  # 1e-6 is three times faster and wrong by 1e-4 to 1e-2


def python_rates(podium: Rocking) -> RightHandSide:
    """The right-hand side in numpy."""

    def right_hand_side(
        t: float, y: Floats, record: Floats, dt: float, side: float, phase: Phase
    ) -> Floats:
        i = min(int(t / dt), len(record) - 2)
        across = record[i] + (t / dt - i) * (record[i + 1] - record[i])
        return rates(y, side * across, phase, podium)

    return right_hand_side


def compiled_rates(podium: Rocking) -> RightHandSide:
    """The same, compiled by numba with the podium's numbers as constants."""
    inner = compiled(rates)
    R, alpha, level, gravity, limit = podium[:3] + podium[-2:]
    Io, gamma, eta, columns, masses, stiffnesses, a0, a1, e = podium[5:-2]

    def right_hand_side(
        t: float, y: Floats, record: Floats, dt: float, side: float, phase: Phase
    ) -> Floats:
        i = min(int(t / dt), len(record) - 2)
        across = record[i] + (t / dt - i) * (record[i + 1] - record[i])
        numbers = Rocking(
            R, alpha, level, phase, phase, Io, gamma, eta, columns,
            masses, stiffnesses, a0, a1, e, gravity, limit,
        )  # fmt: skip
        return inner(y, side * across, phase, numbers)

    return compiled(right_hand_side)


def event_at(row: int, level: float, direction: float, *, terminal: bool = True) -> Any:
    """The event of `solve_ivp` that a row of the state passes a level."""

    def event(t: float, y: Floats, *_: object) -> float:
        return float(y[row]) - level

    marked: Any = event
    marked.direction, marked.terminal = direction, terminal
    return marked


class ScipyRocking:
    """One podium under `solve_ivp`."""

    def __init__(self, podium: Rocking, dt: float, right_hand_side: RightHandSide) -> None:
        self.podium, self.right_hand_side = podium, right_hand_side
        self.landing = Landing(podium)
        self._record: Floats = np.zeros(2)
        self._dt, self._end = dt, 0.0
        self._base = fixed_base_of(podium, dt)
        self._peak, self._impacts = 0.0, 0

    def history(self, record: Floats) -> PeerHistory:
        """One history from rest to the end of the record; infinite rotation if it overturns."""
        podium, n, dt = self.podium, len(self.podium.masses), self._dt
        self._record, self._end = np.array(record), (len(record) - 1) * dt
        y, z = np.zeros(2 * n + 2), np.zeros(2 * n)
        self._peak, self._impacts = 0.0, 0
        interval, after = 0, 0.0
        while interval < len(record) - 1:
            interval, after, side = stand(z, self._record, interval, after, self._base)
            if side == 0.0:
                break
            y[:] = 0.0
            y[1 : n + 1], y[n + 2 :] = side * z[:n], side * z[n:]
            t, side, y = self._fly(interval * dt + after, side, y)
            z[:n] = side * y[1 : n + 1]
            z[n:] = side * (y[n + 2 :] - 2.0 * podium.R * np.cos(podium.alpha) * y[n + 1])
            interval = int(t / dt) if t < self._end else len(record)
            after = t - interval * dt
        return PeerHistory(self._peak, self._impacts)

    def _fly(self, t: float, side: float, y: Floats) -> tuple[float, float, Floats]:
        """From an uplift to re-contact or the end: time, side and state."""
        podium, phase, first = self.podium, self.podium.rolling, self._dt
        while t < self._end:
            t, y, event = self._until_event(t, y, side, phase, first)
            first = self._dt
            if event == IMPACT:
                self._impacts += 1
                stays = self.landing.land(y, side * self._across(t))
                side, phase = -side, podium.rolling
                if stays:
                    break
                if self.landing.back > 0.0:
                    first = min(first, 0.5 * float(y[len(y) // 2]) / self.landing.back)
            elif event == ARC_END:
                phase = podium.rocking if phase is podium.rolling else podium.rolling
            elif event == OVERTURNED:
                self._peak = np.inf
                return self._end, side, y
        return t, side, y

    def _until_event(
        self, t: float, y: Floats, side: float, phase: Phase, first: float
    ) -> tuple[float, Floats, int]:
        """Time and state at the first terminal event, and its number; -1 at the end."""
        podium = self.podium
        away = 1.0 if phase is podium.rolling else -1.0
        found: Any = solve_ivp(
            self.right_hand_side,
            (t, self._end),
            y,
            args=(self._record, self._dt, side, phase),
            events=(
                event_at(0, 0.0, -1.0),
                event_at(0, podium.level, away),
                event_at(0, podium.limit, 1.0),
                event_at(len(y) // 2, 0.0, -1.0, terminal=False),
            ),
            first_step=min(first, self._end - t),
            max_step=self._dt,
            rtol=TOLERANCE,
            atol=1e-3 * TOLERANCE,
        )
        highest = [state[0] for state in found.y_events[3]]
        self._peak = float(max(self._peak, found.y[0, -1], *highest))
        events = [k for k in range(3) if len(found.t_events[k])]
        return float(found.t[-1]), found.y[:, -1].copy(), events[0] if events else -1

    def _across(self, t: float) -> float:
        """The ground's acceleration."""
        record = self._record
        i = min(int(t / self._dt), len(record) - 2)
        return float(record[i] + (t / self._dt - i) * (record[i + 1] - record[i]))
