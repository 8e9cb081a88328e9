"""A step of all lanes: taken, looked at, accepted; as `planar.steps`, with a rule of its own.

Near the upright position the series converge over a time theta/v only, so that steps follow one
another in other lengths than even parts of an interval: a step too long for its series is halved,
and behind it steps grow again.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled, fma, specialised, variant
from rpscli.physics.core.quintic import Quintic, lower_hull, quintic, upper_hull
from rpscli.physics.core.records import LANES, ORDER, Record
from rpscli.physics.core.series import integral, sine_cosine, value
from rpscli.physics.planar.events import end_turn_at, take_turn
from rpscli.physics.planar.steps import (
    ONE_BEFORE,
    add_terms,
    chosen,
    path_of,
    plan_steps,
    sums,
)
from rpscli.physics.spatial.devices import begin_devices_3d, extend_devices_3d
from rpscli.physics.spatial.equation_of_motion import (
    begin_terms,
    extend_modes,
    extend_positions,
    extend_tilt,
    momentum_terms,
    turning_terms,
)

ARC = 0.3
"""Longest step over theta/v, v = sqrt(p^2 + (theta w)^2)."""

ROOM = 0.01
"""Azimuth that a step may always turn by as if it were the first terms of its series [rad]."""

LEAST_STEP = 1e-13
"""Of the sampling interval: a step is not halved further."""

SAME = 1e-12
"""Of the sampling interval: nothing is left of it."""

assert ORDER == 7, "orders are written out below"


@compiled
def take_steps(s: Record) -> None:
    """Advance the lanes, each by its own step: writes the Taylor terms and the end."""
    if s.lanes == 1:
        extend_all(s, 1)
    else:
        extend_all(s, LANES)
    add_terms(s)
    add_turns(s)


@specialised
def extend_all(s: Record, lanes: int) -> None:
    """Terms of all orders, in all lanes, see `planar.steps.extend_all`."""
    begin_terms(s, lanes)
    begin_devices_3d(s)
    extend_tilt(s, lanes, 1)
    extend_positions(s, lanes, 2)
    extend_modes(s, lanes, 1)
    extend_devices_3d(s, 1)
    extend_tilt(s, lanes, 2)
    extend_positions(s, lanes, 3)
    extend_modes(s, lanes, 2)
    extend_devices_3d(s, 2)
    extend_tilt(s, lanes, 3)
    extend_positions(s, lanes, 4)
    extend_modes(s, lanes, 3)
    extend_devices_3d(s, 3)
    extend_tilt(s, lanes, 4)
    extend_positions(s, lanes, 5)
    extend_modes(s, lanes, 4)
    extend_devices_3d(s, 4)
    extend_tilt(s, lanes, 5)
    extend_positions(s, lanes, 6)
    extend_modes(s, lanes, 5)
    extend_devices_3d(s, 5)
    extend_tilt(s, lanes, 6)
    extend_positions(s, lanes, 7)
    extend_modes(s, lanes, 6)
    extend_devices_3d(s, 6)
    extend_tilt(s, lanes, 7)
    extend_positions(s, lanes, 8)
    extend_modes(s, lanes, 7)
    extend_devices_3d(s, 7)


@compiled
def add_turns(s: Record) -> None:
    """What else is at the end of the step: L, the turn of the azimuth, x'' and what acts on it."""
    w, d, L = s.turning_terms, s.dtheta_terms, s.momentum_terms
    for l in range(s.lanes):
        per = 1.0 / s.step[l]
        turn, _ = sums(w[0, l], w[1, l], w[2, l], w[3, l], w[4, l], w[5, l], w[6, l], w[7, l])
        s.next_turn[l] = s.step[l] * turn
        faster, momentum = 0.0, 0.0
        for m in range(ORDER, 0, -1):
            faster += m * d[m, l]
            momentum += L[m, l]
        s.next_angular_momentum[l] = momentum + L[0, l]
        s.theta_ddot[l], s.turning_rate[l] = per * d[1, l], per * w[1, l]
        s.next_theta_ddot[l] = per * faster
    for r in range(s.n):
        for l in range(s.lanes):
            damping = s.two_xi_omega[r, l] * s.next_dq[r, l]
            s.modal_force[r, l] = fma(s.omega2[r, l], s.next_q[r, l], damping)


@compiled
def rate_path(s: Record, l: int) -> Quintic:
    """The quintic through p, p' and p'' at both ends of the step."""
    h, d = s.step[l], s.dtheta_terms
    bend = (d[2, l] + d[2, l]) + 6.0 * d[3, l] + 12.0 * d[4, l] + 20.0 * d[5, l]
    bend += 30.0 * d[6, l] + 42.0 * d[7, l]
    return quintic(
        1.0, d[0, l], d[1, l], 2.0 * d[2, l], s.next_theta_dot[l], h * s.next_theta_ddot[l], bend
    )


@compiled
def check_steps(s: Record) -> None:
    """Look at the steps just taken, as `planar.steps.check_steps`.

    A step is accepted that is short enough, stays in the range of its phase, and in which p surely
    does not rise through zero: nothing passes near upright. `step_limit` becomes what the next one
    may be.
    """
    for l in range(s.lanes):
        path, rate, h = path_of(s, l), rate_path(s, l), s.step[l]
        lowest, highest = min(lower_hull(path), path[0]), max(upper_hull(path), path[0])
        inside = (lowest >= s.theta_low[l]) & (highest <= s.theta_high[l])
        falls = (rate[0] < 0.0) & (upper_hull(rate) < 0.0)
        rises = (rate[0] >= 0.0) & (lower_hull(rate) >= 0.0)
        turns = (rate[0] >= 0.0) & (rate[5] < 0.0)
        clear = inside & (falls | rises | turns)
        cleared = (s.no_event[l] > 0.0) & (abs(path[5]) < math.inf)
        ratio = ratio_of(s, l) / s.last_term[l]
        too_long = (ratio > 1.0) & (h > LEAST_STEP * s.dt[l])
        accepted = (cleared | clear) & (not too_long)
        passing = (path[5] > s.theta_cr[l]) & (s.critical_time[l] < 0.0)
        peaks = (turns & (highest > s.max_theta[l])) | passing
        s.too_long[l] = 1.0 if too_long else 0.0
        s.accepted[l] = 1.0 if accepted else 0.0
        s.peak_inside[l] = 1.0 if accepted & peaks else 0.0
        s.series_ratio[l] = ratio


@compiled
def ratio_of(s: Record, l: int) -> float:
    """The last terms of the series of p and w over the first."""
    d, w, h = s.dtheta_terms, s.turning_terms, s.step[l]
    first = abs(d[0, l]) + abs(d[1, l]) + abs(d[2, l])
    last = max(abs(d[ORDER, l]), ONE_BEFORE * abs(d[ORDER - 1, l]))
    # Where the tilt begins with t^3, at uplift, A has its terms 3, 6, ... and the series gaps.
    last = max(last, s.per_A[l] * abs(s.A_terms[ORDER - 1, l] * d[2, l]))
    first_turn = h * (abs(w[0, l]) + abs(w[1, l]) + abs(w[2, l])) + ROOM
    last_turn = h * max(abs(w[ORDER, l]), ONE_BEFORE * abs(w[ORDER - 1, l]))
    tilt = last / max(first, 1e-300)
    return float(max(tilt, last_turn / first_turn))


GROWTH, CAUTION = 2.0, 0.9
"""Of steps behind one that was too long: at most so much longer, and so much of what fits."""


@variant(plan_steps, "cos_phi")
def plan_step(s: Record, l: int) -> None:
    """Length of the next step: an even part of what is left of the interval, or `step_limit`.

    Nothing is left where `steps_left` is 0.
    """
    left = s.dt[l] - s.time[l]
    if left <= SAME * s.dt[l]:
        s.steps_left[l] = 0.0
        return
    steps = max(math.ceil(left / s.uplifted_step[l] - 1e-9), 1)
    s.step[l], s.steps_left[l] = left / steps, steps
    limit = longest_here(s, l)
    if s.step_limit[l] > 0.0:
        limit = min(limit, s.step_limit[l])
    if limit < s.step[l]:
        s.step[l], s.steps_left[l] = limit, 1.0  # what follows is planned anew


@compiled
def longest_here(s: Record, l: int) -> float:
    """Longest step that the distance from upright allows [s]."""
    x, p = s.theta[l], s.theta_dot[l]
    before = s.tilt_terms[0, l]  # J grows as its square
    across = s.angular_momentum[l] * s.per_J[l] * before * before / x
    speed = math.sqrt(p * p + across * across)
    return float(ARC * x / speed) if speed > 0.0 else math.inf


@compiled
def grow(s: Record, l: int) -> None:
    """Let steps grow behind an accepted one that was limited."""
    if s.step_limit[l] > 0.0:
        ratio, fits = s.series_ratio[l], GROWTH
        if ratio > (CAUTION / GROWTH) ** ORDER:
            fits = CAUTION * ratio ** (-1.0 / ORDER)
        s.step_limit[l] = s.step[l] * fits
        if s.step_limit[l] > s.uplifted_step[l]:
            s.step_limit[l] = 0.0


@compiled
def accept_steps(s: Record) -> None:
    """Make the ends of accepted steps the states of their lanes."""
    lanes = s.lanes
    for l in range(lanes):
        accepted = s.accepted[l]
        sine, cosine = sine_cosine(s.next_turn[l])
        cos_phi, sin_phi = s.cos_phi[l], s.sin_phi[l]
        s.theta[l] = chosen(accepted, s.next_theta[l], s.theta[l])
        s.theta_dot[l] = chosen(accepted, s.next_theta_dot[l], s.theta_dot[l])
        s.theta_ddot[l] = chosen(accepted, s.next_theta_ddot[l], s.theta_ddot[l])
        momentum = chosen(accepted, s.next_angular_momentum[l], s.angular_momentum[l])
        s.angular_momentum[l] = momentum
        s.cos_phi[l] = chosen(accepted, cos_phi * cosine - sin_phi * sine, cos_phi)
        s.sin_phi[l] = chosen(accepted, sin_phi * cosine + cos_phi * sine, sin_phi)
        for i in range(4):
            s.before[i, l] = chosen(accepted, s.bound[i, l], s.before[i, l])
    for r in range(s.n):
        for l in range(lanes):
            s.q[r, l] = chosen(s.accepted[l], s.next_q[r, l], s.q[r, l])
            s.dq[0, r, l] = chosen(s.accepted[l], s.next_dq[r, l], s.dq[0, r, l])
    for l in range(lanes):
        accepted = s.accepted[l] > 0.0
        s.time[l] += s.step[l] if accepted else 0.0
        left = s.steps_left[l] - (1.0 if accepted else 0.0)
        s.steps_left[l] = left
        x, p = s.theta[l], s.theta_dot[l]
        across = s.turning[l] * x
        near = s.step[l] * s.step[l] * (p * p + across * across) > ARC * ARC * (x * x)
        goes_on = accepted & (left > 0.0) & (s.step_limit[l] == 0.0) & (not near)
        s.needs_attention[l] = 0.0 if goes_on else 1.0
        s.no_event[l] = 0.0
        s.steps[l] += 1.0


@variant(end_turn_at, "cos_phi")
def end_turn_at_3d(s: Record, l: int, t: float) -> None:
    """Set turn and L at a fraction t of the step of a lane, where it is to end."""
    s.next_turn[l] = s.step[l] * integral(turning_terms(s, l), t)
    s.next_angular_momentum[l] = value(momentum_terms(s, l), t)


@variant(take_turn, "cos_phi")
def take_turn_3d(s: Record, l: int) -> None:
    """Make turn and L at the end of a lane's step its state."""
    turn_by(s, l, s.next_turn[l])
    s.angular_momentum[l] = s.next_angular_momentum[l]


@compiled
def turn_by(s: Record, l: int, angle: float) -> None:
    """Turn the azimuth of a lane's tilt."""
    cosine, sine, cos_phi, sin_phi = math.cos(angle), math.sin(angle), s.cos_phi[l], s.sin_phi[l]
    s.cos_phi[l] = cos_phi * cosine - sin_phi * sine
    s.sin_phi[l] = sin_phi * cosine + cos_phi * sine
