"""A step that was taken: does it hold an event, is it short enough; then it is accepted.

All lanes together and without branches: a lane that must not be touched is masked by its
`accepted`. What is not accepted `waits` to be looked at alone.
"""

from __future__ import annotations

import math

from rpscli.physics.compile import compiled
from rpscli.physics.formulae.quintic import Quintic, lower_hull, quintic, upper_hull
from rpscli.physics.state import ORDER, Record

MOST_STEPS = 4096.0
"""An interval is not divided further than that."""


@compiled
def path_of(s: Record, l: int) -> Quintic:
    """The tilt of a lane over the step just taken."""
    return quintic(
        s.step[l],
        s.theta[l],
        s.theta_dot[l],
        s.theta_ddot[l],
        s.next_theta[l],
        s.next_theta_dot[l],
        s.next_theta_ddot[l],
    )


@compiled
def plan_steps(s: Record, l: int) -> None:
    """Length of the next steps: even parts of what is left of the interval.

    Nothing may be left after an event on the very sample; a step of length 0 then leads over.
    """
    left = s.dt[l] - s.time[l]
    steps = max(math.ceil(left / s.uplifted_step[l] - 1e-9), 1)
    s.step[l], s.steps_left[l] = max(left, 0.0) / steps, steps
    if s.kinked[l] > 0.0:
        shorten_step(s, l)


KINK = 0.25
"""Largest change of |u_b'| over a step, where a damper has a kink at its zero."""


@compiled
def shorten_step(s: Record, l: int) -> None:
    """Shorten the next step so that |u_b'| changes by a part of itself only, and plan one more."""
    rate = abs(s.theta_dot[l]) * s.C[l]
    change = abs(s.C[l] * s.theta_ddot[l] + s.B[l] * s.theta_dot[l] * s.theta_dot[l])
    least = s.linear_speed[l] / s.diameter[l]
    most = 2.0 * least if rate <= least else KINK * rate
    if change * s.step[l] > most:
        s.step[l], s.steps_left[l] = most / change, 2.0


ONE_BEFORE = 0.06
"""Of the term before the last: that of a step at its limit, in series of sines and exponentials.
The last term alone may pass through zero and hide what follows it."""


@compiled
def check_steps(s: Record) -> None:
    """Look at the steps just taken.

    `too_long`: the last terms of the tilt's series say that the step is too long for it.
    `accepted`: it is not, and the tilt surely stays in the range of its phase, and is finite.
    `peak_inside`: an accepted step that may hold the largest tilt so far, or passes theta_cr for
    the first time.
    """
    for l in range(s.lanes):
        path = path_of(s, l)
        lowest, highest = min(lower_hull(path), path[0]), max(upper_hull(path), path[0])
        inside = (lowest >= s.theta_low[l]) & (highest <= s.theta_high[l])
        cleared = (s.no_event[l] > 0.0) & (abs(path[5]) < math.inf)
        terms = s.dtheta_terms
        first = abs(terms[0, l]) + abs(terms[1, l]) + abs(terms[2, l])
        last = max(abs(terms[ORDER, l]), ONE_BEFORE * abs(terms[ORDER - 1, l]))
        # Where the tilt begins with t^3, at uplift, A has its terms 3, 6, ... and the series gaps.
        omitted = s.per_A[l] * abs(s.A_terms[ORDER - 1, l] * terms[2, l])
        last = max(last, omitted)
        too_long = (last > s.last_term[l] * first) & (s.steps_left[l] < MOST_STEPS)
        accepted = (cleared | inside) & (not too_long)
        turning = (s.theta_dot[l] > 0.0) & (s.next_theta_dot[l] < 0.0)
        higher = turning & (highest > s.max_theta[l])
        passing = (path[5] > s.theta_cr[l]) & (s.critical_time[l] < 0.0)
        s.too_long[l] = 1.0 if too_long else 0.0
        s.accepted[l] = 1.0 if accepted else 0.0
        s.at_sample[l] = 1.0 if accepted & (s.steps_left[l] == 1.0) else 0.0
        s.peak_inside[l] = 1.0 if accepted & (higher | passing) else 0.0


@compiled
def chosen(accepted: float, end: float, start: float) -> float:
    """The end of an accepted step, else its start.

    Parameters
    ----------
    accepted
        1 or 0.
    end, start
        In one unit.
    """
    # Adding zero keeps the compiler from choosing between addresses, lane by lane.
    new = end + 0.0
    return new if accepted > 0.0 else start


@compiled
def accept_steps(s: Record) -> None:
    """Make the ends of accepted steps the states of their lanes."""
    lanes = s.lanes
    for l in range(lanes):
        accepted = s.accepted[l]
        s.theta[l] = chosen(accepted, s.next_theta[l], s.theta[l])
        s.theta_dot[l] = chosen(accepted, s.next_theta_dot[l], s.theta_dot[l])
        s.theta_ddot[l] = chosen(accepted, s.next_theta_ddot[l], s.theta_ddot[l])
        s.B[l] = chosen(accepted, s.next_B[l], s.B[l])
        s.C[l] = chosen(accepted, s.next_C[l], s.C[l])
        s.per_A[l] = chosen(accepted, s.next_per_A[l], s.per_A[l])
        s.V[l] = chosen(accepted, s.next_V[l], s.V[l])
    for r in range(s.n):
        for l in range(lanes):
            s.q[r, l] = chosen(s.accepted[l], s.next_q[r, l], s.q[r, l])
            s.dq[0, r, l] = chosen(s.accepted[l], s.next_dq[r, l], s.dq[0, r, l])
    for l in range(lanes):
        accepted = s.accepted[l] > 0.0
        s.time[l] += s.step[l] if accepted else 0.0
        left = s.steps_left[l] - (1.0 if accepted else 0.0)
        s.steps_left[l] = left
        s.waits[l] = 0.0 if accepted & (left > 0.0) & (s.kinked[l] == 0.0) else 1.0
        s.no_event[l] = 0.0
        s.steps[l] += 1.0
