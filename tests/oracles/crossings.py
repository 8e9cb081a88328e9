"""Steps of DOP853, and roots found between turning points, so that none can hide in a pair."""

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

Array = NDArray[np.float64]

DEGREE = 7  # of the dense output of DOP853
NODES = np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(1, DEGREE + 1) / DEGREE))
_FIT = np.linalg.inv(NODES[:, None] ** np.arange(1, DEGREE + 1))


class Curve:
    """A polynomial on [0, 1], by its rising coefficients.

    `end` is the value at 1 from which the next piece will start: if rounding puts the polynomial on
    the other side of a level, the end is the crossing.
    """

    def __init__(self, rising, end=None):
        self.rising, self.end = rising, float(np.sum(rising)) if end is None else end

    @classmethod
    def through(cls, values):
        """Of degree 7 through values at 0 and at the nodes, and what follows from another one at 1.

        The value at 0 is kept exactly: a step that starts on an event starts on it exactly.
        """
        start = values[0]
        return cls(
            np.concatenate(([start], _FIT @ (values[1:-1] - start))), float(values[-1])
        )

    @cached_property
    def noise(self):
        """Of rounding: what starts on a level with no slope seems to wave about it."""
        return 1e-12 * float(np.sum(np.abs(self.rising[1:])))

    @cached_property
    def pieces(self):
        """0, the turning points inside (0, 1), 1."""
        slope = self.rising[1:] * np.arange(1, len(self.rising))
        if abs(slope[0]) > np.sum(np.abs(slope[1:])):
            return [0.0, 1.0]  # the slope cannot change its sign
        roots = np.roots(slope[::-1])
        # a double root is returned as a pair just off the real axis; a break too many does no harm
        inside = roots.real[
            (np.abs(roots.imag) < 1e-6) & (roots.real > 0.0) & (roots.real < 1.0)
        ]
        return [0.0, *sorted(float(root) for root in inside), 1.0]

    def highest(self, until):
        """The largest value at a turning point up to there, or at the start."""
        turns = np.array([z for z in self.pieces if z <= until])
        return float(np.max(np.polynomial.polynomial.polyval(turns, self.rising)))

    def crossing(self, level, direction, noise=0.0):
        """The least argument in (0, 1] where the level is passed downwards (-1) or upwards (+1).

        A start on the level itself is no crossing. The curve must have been off the level by more
        than `noise` before.
        """
        shifted = self.rising.copy()
        shifted[0] -= level

        def excess(z):
            return direction * float(np.polynomial.polynomial.polyval(z, shifted))

        values = [*(excess(z) for z in self.pieces[:-1]), direction * (self.end - level)]
        for i, (right, b) in enumerate(zip(self.pieces[1:], values[1:], strict=True)):
            if values[i] < -noise and b >= 0.0:
                if excess(right) <= 0.0:
                    return right
                return float(
                    brentq(excess, self.pieces[i], right, xtol=1e-15, rtol=1e-14)
                )
        return None


class Step(NamedTuple):
    """From `start` on for h; states at its start, at the nodes and at its end in columns."""

    start: float
    h: float
    states: Array


class Stepper:
    """A state y that goes through intervals of a record by DOP853."""

    y: Array
    rtol: float
    tolerance: Array
    step = np.inf  # the last free step

    def solver(self, rates, start, end):
        first = min(self.step, end - start)
        atol = self.tolerance
        return DOP853(
            rates, start, self.y, end, rtol=self.rtol, atol=atol, first_step=first
        )

    def advanced(self, solver):
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"DOP853: {message}")

    def steps(self, rates, duration):
        """Each is taken when the next one is asked for."""
        solver = self.solver(rates, 0.0, duration)
        while solver.status == "running":
            self.advanced(solver)
            assert solver.t_old is not None
            h = solver.t - solver.t_old
            inner = solver.dense_output()(solver.t_old + h * NODES)
            yield Step(solver.t_old, h, np.column_stack((self.y, inner, solver.y)))
            self.y = np.asarray(solver.y).copy()
            # the last step of an interval is cut short by its end, not by the error
            cut = solver.t >= duration
            self.step = max(h, min(self.step, 10.0 * h)) if cut else h

    def meet(self, rates, miss, step, at):
        """Integrate to an event itself: the dense output is less accurate than the step.

        Returns its time; y is the state there.
        """
        begin, tau, apart = self.y, at * step.h, 1e-7 * step.h
        correction = np.inf
        for _ in range(12):
            self.y = begin
            arrival = (
                self.solver(rates, step.start, step.start + tau) if tau > 0.0 else None
            )
            while arrival and arrival.status == "running":
                self.advanced(arrival)
            y = np.asarray(arrival.y if arrival else begin, dtype=np.float64).copy()
            moved = apart * rates(step.start + tau, y)
            change = (miss(y + moved) - miss(y - moved)) / (2.0 * apart)
            correction = -miss(y) / change if change else 0.0
            if abs(correction) < 1e-12 * step.h:
                break
            tau = min(max(tau + correction, 0.0), step.h)
        if abs(correction) > max(1e-9 * step.h, 1e-12):
            raise RuntimeError("no convergence to an event")
        self.y = y
        return step.start + tau
