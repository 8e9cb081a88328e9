"""A step that was taken: does it hold an event, is it short enough; then it is accepted.

All lanes together and without branches: a lane that must not be touched is masked by its
`accepted`. What is not accepted `needs_attention` to be looked at alone.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import by_record, compiled, specialised
from rpscli.physics.core.quintic import Quintic, lower_hull, quintic, upper_hull
from rpscli.physics.core.records import LANES, ORDER, Record
from rpscli.physics.core.series import integral, slope, value
from rpscli.physics.planar.bed.terms import begin_bed, extend_bed, keep_pace
from rpscli.physics.planar.devices.forces import begin_devices, extend_devices, set_devices_at_ends
from rpscli.physics.planar.equation_of_motion import (
    accelerate,
    begin_terms,
    extend_modes,
    extend_rotation,
    modal_terms,
    rotation_terms,
)

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


@by_record
def plan_steps(s: Record, l: int) -> None:
    """Length of the next steps: even parts of what is left of the interval.

    Nothing may be left after an event on the very sample; a step of length 0 then leads over.
    """
    left = s.dt[l] - s.time[l]
    steps = max(math.ceil(left / s.uplifted_step[l] - 1e-9), 1)
    s.step[l], s.steps_left[l] = max(left, 0.0) / steps, steps
    if s.nonsmooth_damper[l] > 0.0:
        shorten_step(s, l)
    keep_pace(s, l)


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


LONGER = 1.3
"""A step over the one before it, where a damper has a kink. About its zero the force is so steep
that steps are thousands of times shorter than elsewhere: tried anew they are halved ten times."""


@compiled
def plan_next_step(s: Record, l: int) -> None:
    """Plan on behind an accepted step; of a lane with such a damper little longer than that one."""
    longest = LONGER * s.step[l]
    plan_steps(s, l)
    if s.nonsmooth_damper[l] > 0.0 and s.step[l] > longest:
        s.step[l], s.steps_left[l] = longest, 2.0


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
        s.peak_inside[l] = 1.0 if accepted & (higher | passing) else 0.0


@compiled
def chosen(accepted: float, end: float, start: float) -> float:
    """The end of an accepted step, else its start."""
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
        s.light[l] = chosen(accepted, s.next_light[l], s.light[l])
        s.drag[l] = chosen(accepted, s.next_drag[l], s.drag[l])
        s.shear_before[l] = chosen(accepted, s.shear_bound[l], s.shear_before[l])
        s.acceleration_before[l] = chosen(
            accepted, s.acceleration_bound[l], s.acceleration_before[l]
        )
    for r in range(s.n):
        for l in range(lanes):
            s.q[r, l] = chosen(s.accepted[l], s.next_q[r, l], s.q[r, l])
            s.dq[0, r, l] = chosen(s.accepted[l], s.next_dq[r, l], s.dq[0, r, l])
    for l in range(lanes):
        accepted = s.accepted[l] > 0.0
        s.time[l] += s.step[l] if accepted else 0.0
        left = s.steps_left[l] - (1.0 if accepted else 0.0)
        s.steps_left[l] = left
        s.needs_attention[l] = (
            0.0 if accepted & (left > 0.0) & (s.nonsmooth_damper[l] == 0.0) else 1.0
        )
        s.no_event[l] = 0.0
        s.steps[l] += 1.0


# A Taylor step of all lanes: no term is computed twice, an event is a root of a polynomial.


@compiled
def take_steps(s: Record) -> None:
    """Advance the lanes, each by its own step.

    Reads the motion at the start of the step, and leaves it; writes the Taylor terms and the end.
    """
    begin_terms(s)
    begin_devices(s)
    begin_bed(s)
    if s.lanes == 1:
        extend_all(s, 1)
    else:
        extend_all(s, LANES)
    add_terms(s)
    set_devices_at_ends(s)
    accelerate(s)


assert ORDER == 7, "orders are written out below"


@specialised
def extend_all(s: Record, lanes: int) -> None:
    """Terms of all orders, in all lanes.

    Written out: the compiler is to know lanes and orders, or it fears that terms overlap.
    """
    extend_bed(s, lanes, 1)
    extend_rotation(s, lanes, 1)
    extend_modes(s, lanes, 1)
    extend_devices(s, 1)
    extend_bed(s, lanes, 2)
    extend_rotation(s, lanes, 2)
    extend_modes(s, lanes, 2)
    extend_devices(s, 2)
    extend_bed(s, lanes, 3)
    extend_rotation(s, lanes, 3)
    extend_modes(s, lanes, 3)
    extend_devices(s, 3)
    extend_bed(s, lanes, 4)
    extend_rotation(s, lanes, 4)
    extend_modes(s, lanes, 4)
    extend_devices(s, 4)
    extend_bed(s, lanes, 5)
    extend_rotation(s, lanes, 5)
    extend_modes(s, lanes, 5)
    extend_devices(s, 5)
    extend_bed(s, lanes, 6)
    extend_rotation(s, lanes, 6)
    extend_modes(s, lanes, 6)
    extend_devices(s, 6)
    extend_bed(s, lanes, 7)
    extend_rotation(s, lanes, 7)
    extend_modes(s, lanes, 7)
    extend_devices(s, 7)


@compiled
def add_terms(s: Record) -> None:
    """The end of the step: the sum of all terms."""
    lanes, d, dq = s.lanes, s.dtheta_terms, s.dq
    for l in range(lanes):
        change, s.next_theta_dot[l] = sums(
            d[0, l], d[1, l], d[2, l], d[3, l], d[4, l], d[5, l], d[6, l], d[7, l]
        )
        s.next_theta[l] = s.theta[l] + s.step[l] * change
    for r in range(s.n):
        for l in range(lanes):
            change, s.next_dq[r, l] = sums(
                dq[0, r, l],
                dq[1, r, l],
                dq[2, r, l],
                dq[3, r, l],
                dq[4, r, l],
                dq[5, r, l],
                dq[6, r, l],
                dq[7, r, l],
            )
            s.next_q[r, l] = s.q[r, l] + s.step[l] * change


@compiled
def sums(
    t0: float, t1: float, t2: float, t3: float, t4: float, t5: float, t6: float, t7: float
) -> tuple[float, float]:
    """Integral over t/h from 0 to 1, and value at 1, of a series."""
    higher_terms = t7 * 0.125 + t6 * (1.0 / 7.0) + t5 * (1.0 / 6.0) + t4 * 0.2
    change = higher_terms + t3 * 0.25 + t2 * (1.0 / 3.0) + t1 * 0.5 + t0
    return change, t7 + t6 + t5 + t4 + t3 + t2 + t1 + t0


SETTLED = 1e-8
"""A correction so small leaves its square, less than rounding."""


@compiled
def fraction_at(s: Record, l: int, level: float, guess: float) -> float:
    """Fraction of the step at which the tilt is at a level: Newton's method from near it.

    A path that only grazes the level may have no root; the guess then stands.
    """
    t, h, terms = guess, s.step[l], rotation_terms(s, l)
    height = level - s.theta[l]
    for _ in range(8):
        advance = h * value(terms, t)
        change = (height - h * integral(terms, t)) / advance if advance != 0.0 else 2.0
        if not 0.0 <= t + change <= 1.0:
            break
        t += change
        if abs(change) < SETTLED:
            break
    return t


@compiled
def tilt_at(s: Record, l: int, t: float) -> float:
    """The tilt of a lane at a fraction t of its step."""
    return float(s.theta[l] + s.step[l] * integral(rotation_terms(s, l), t))


@compiled
def end_step_at(s: Record, l: int, t: float, level: float) -> None:
    """Make a fraction t of the step of a lane its end, where the tilt is at a level [level rad]."""
    h, terms = s.step[l], rotation_terms(s, l)
    s.next_theta[l], s.next_theta_dot[l] = level, value(terms, t)
    s.next_theta_ddot[l] = slope(terms, t) / h if h > 0.0 else s.theta_ddot[l]
    for r in range(s.n):
        terms = modal_terms(s, r, l)
        s.next_q[r, l] = s.q[r, l] + h * integral(terms, t)
        s.next_dq[r, l] = value(terms, t)
    s.step[l] = t * h
