"""Full contact by heyoka as well: what a user of that library alone would run."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.peers.rocking import Floats
from benchmarks.peers.standing import FixedBase

ACROSS, SLOPE = range(2)  # parameters
UPLIFTS = {-1: 1.0, -2: -1.0}
"""Side of the uplift for what a step returns where it ended at one of its two events."""


class HeyokaStanding:
    """A compiled integrator of the building on a fixed base, with uplift as its terminal event."""

    def __init__(self, base: FixedBase, tol: float) -> None:
        import heyoka as hy

        n = len(base.push) // 2
        self.dt = base.dt
        names = [f"{kind}{i}" for kind in "uv" for i in range(n)]
        z = hy.make_vars(*names) if n > 0 else []
        across = hy.par[ACROSS] + hy.par[SLOPE] * hy.time

        def weighted(row: Floats) -> Any:
            return hy.sum([float(w) * x for w, x in zip(row, z, strict=True) if w != 0.0])

        rates = [*z[n:], *(weighted(base.flow[n + i]) - across for i in range(n))]
        push = weighted(base.push) - base.own * across
        self.integrator = hy.taylor_adaptive(
            list(zip(z, rates, strict=True)),
            np.zeros(2 * n),
            pars=np.zeros(2),
            tol=tol,
            t_events=[
                hy.t_event(base.lift - sign * push, direction=hy.event_direction.negative)
                for sign in UPLIFTS.values()
            ],
        )

    def stand(
        self, z: Floats, slopes: list[float], intercepts: list[float], interval: int, after: float
    ) -> tuple[int, float, float]:
        """The same as `standing.stand`, for a record of given slopes and values at time zero."""
        ta, dt = self.integrator, self.dt
        step, pars = ta.step, ta.pars
        ta.state[:] = z
        ta.time = interval * dt + after
        ta.reset_cooldowns()
        left = dt - after
        for i in range(interval, len(slopes)):
            pars[ACROSS], pars[SLOPE] = intercepts[i], slopes[i]
            while left > 0.0:
                outcome, h = step(left)
                left -= h
                if left > 0.0 and (side := UPLIFTS.get(int(outcome), 0.0)) != 0.0:
                    z[:] = ta.state
                    return i, dt - left, side
            left = dt
        z[:] = ta.state
        return len(slopes), 0.0, 0.0
