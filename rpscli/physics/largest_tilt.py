"""The largest tilt, turning points between samples included, and
the passage of theta_cr.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled, inlined
from rpscli.physics.energy import path_at
from rpscli.physics.events import path_of
from rpscli.physics.ground import log_row
from rpscli.physics.lane import azimuth_along, lanes_of, new_tilt_of, sign_of, ways_of
from rpscli.physics.quintic import (
    first_descent,
    lower_hull,
    offset,
    peak_in_step,
    slope,
    upper_hull,
)
from rpscli.physics.state import CRITICAL_PASSAGE, Record
from rpscli.physics.within import tilt_within


@inlined
def is_signed(s: Record, l: int) -> bool:
    """True if the tilt goes to either side: in one plane, in full contact on a bed."""
    return False if ways_of(s) == 2 else s.bed_k[l] > 0.0


@compiled
def observe_tilt(s: Record, log: Record) -> None:
    """Raise the largest tilt and way of the beam by those of accepted steps."""
    for l in range(lanes_of(s)):
        x = s.new_x[l]
        end = s.interval[l] * s.dt[l] + (s.time[l] + s.h[l])
        higher = (s.accepted[l] > 0.0) & (x > s.max_theta[l])
        s.tilt_rises[l] = 1.0 if higher & (ways_of(s) == 2) else 0.0
        passing = (x > s.theta_cr[l]) & (s.critical_time[l] < 0.0)
        turning = (s.v[l] > 0.0) & (s.new_v[l] < 0.0)
        path = path_of(s, l)
        inside = turning & (max(upper_hull(path), path[0]) > s.max_theta[l])
        below = is_signed(s, l) & (-min(lower_hull(path), path[0]) > s.max_theta[l])
        closer = (s.accepted[l] > 0.0) & (passing | inside | below)
        s.tilt_rises[l] = 2.0 if closer else s.tilt_rises[l]
        s.max_theta_time[l] = (
            end if higher & (not closer) else s.max_theta_time[l]
        ) + 0.0
        s.max_theta[l] = (x if higher & (not closer) else s.max_theta[l]) + 0.0
    for l in range(lanes_of(s)):
        if s.tilt_rises[l] > 1.0:
            raise_tilt(s, l, log)
        elif ways_of(s) == 2 and s.tilt_rises[l] > 0.0:
            x, y = new_tilt_of(s, l)
            s.max_azimuth[l] = azimuth_along(s, x, y)


@compiled
def raise_tilt(s: Record, l: int, log: Record) -> None:
    """Raise the largest tilt by that of the step just taken, to either side."""
    path = path_of(s, l)
    height = s.new_x[l]
    fraction = 1.0
    if s.v[l] > 0.0 and s.new_v[l] < 0.0 and upper_hull(path) > s.max_theta[l]:
        fraction, height = peak_in_step(path)
    if is_signed(s, l) and -min(lower_hull(path), path[0]) > s.max_theta[l]:
        over = (-path[0], -path[1], -path[2], -path[3], -path[4], -path[5])
        t = 1.0
        most = -s.new_x[l]
        if s.v[l] < 0.0 < s.new_v[l]:
            t, most = peak_in_step(over)
        if most > height:
            fraction = t
            height = most
    if height > s.max_theta[l]:
        s.max_theta[l] = height
        s.max_theta_time[l] = s.interval[l] * s.dt[l] + (s.time[l] + fraction * s.h[l])
        s.max_azimuth[l] = azimuth_within(s, l, fraction)
        if height > s.theta_cr[l] and s.critical_time[l] < 0.0:
            log_critical_passage(s, l, log, path)


@compiled
def azimuth_within(s: Record, l: int, t: float) -> float:
    """Azimuth of the tilt a fraction t into the step [rad]."""
    tilt, _ = tilt_within(s, l, t)
    return azimuth_along(s, tilt[0], tilt[1])


@compiled
def log_critical_passage(
    s: Record, l: int, log: Record, path: tuple[float, float, float, float, float, float]
) -> None:
    """Note when theta_cr was passed for the first time, within the step just taken."""
    level = s.theta_cr[l]
    h = s.h[l]
    t = min(first_descent(offset(path, -1.0, level), s.piece), 1.0)
    sign = sign_of(s, l)
    rate = sign * slope(path, t) / h if h > 0.0 else 0.0
    s.critical_time[l] = s.interval[l] * s.dt[l] + s.time[l] + t * h
    s.critical_azimuth[l] = azimuth_within(s, l, t)
    row = log_row(s, l, log, CRITICAL_PASSAGE)
    if row >= 0:
        entry = log[row]
        entry.time = s.critical_time[l]
        entry.kind = CRITICAL_PASSAGE
        entry.theta = sign * level
        entry.theta_dot_before = rate
        entry.theta_dot_after = rate
        entry.energy_lost = 0.0
        entry.azimuth = s.critical_azimuth[l]
        entry.least_tilt = 0.0
        entry.nearness = 0.0
        entry.loss_share = 0.0


@compiled
def observe_ways(s: Record) -> None:
    """Raise the beam's way in x and in y by those at the ends of
    accepted steps, and between.
    """
    for axis in range(ways_of(s)):
        for l in range(lanes_of(s)):
            u = path_at(s, l, s.new_x[l]) * s.diameter[l]
            way = abs(u * s.new_tilt[axis, l] / (s.new_x[l] if s.new_x[l] > 0.0 else 1.0))
            counts = (s.accepted[l] > 0.0) & (s.moves[l] > 0.0)
            s.max_beam[axis, l] = max(s.max_beam[axis, l], way if counts else 0.0)
