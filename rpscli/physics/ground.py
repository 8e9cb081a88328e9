"""Ground acceleration of a lane, linear between samples and zero
after the last; and its log.
"""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.lane import azimuth_along, sign_of, tilt_of, ways_of
from rpscli.physics.state import FULL_CONTACT, NO_RECORD, Floats, Record


@compiled
def set_ground(s: Record, l: int, acceleration: Floats) -> None:
    """Set how the ground moves in the interval that begins."""
    i = s.interval[l]
    inside = i + 1 < s.npts[l]
    scale = s.scale[l]
    rate = s.rate[l]
    s.time[l] = 0.0
    for axis in range(ways_of(s)):
        start = 0.0
        end = 0.0
        if inside:
            at = s.record[axis, l] + i
            start = scale * acceleration[at]
            end = scale * acceleration[at + 1]
        s.a_g[axis, l] = start
        s.a_g_slope[axis, l] = (end - start) * rate
    start = 0.0
    end = 0.0
    if inside and s.vertical[l] != NO_RECORD:
        at = s.vertical[l] + i
        start = scale * acceleration[at]
        end = scale * acceleration[at + 1]
    s.g_up[l] = s.gravity[l] + start
    s.g_up_slope[l] = (end - start) * rate


@compiled
def time_of(s: Record, l: int) -> float:
    """Time of a lane since the start of its record [s]."""
    return float(s.interval[l] * s.dt[l] + s.time[l])


@compiled
def azimuth_of(s: Record, l: int) -> float:
    """Of the tilt at the start of the step, from x towards y [rad]."""
    x, y = tilt_of(s, l)
    return azimuth_along(s, x, y)


@compiled
def log_row(s: Record, l: int, log: Record, kind: int) -> int:
    """Count an event; its row in the log, or -1 if there is no room."""
    row = -1
    if log.shape[0] > 0:
        row = 0
        for i in range(s.events.shape[0]):
            row += s.events[i, l]
        if row >= log.shape[0]:
            row = -1
    s.events[kind, l] += 1
    return row


@compiled
def log_event(
    s: Record, l: int, log: Record, kind: int, before: float, after: float, lost: float
) -> int:
    """Count an event at the present state, and log it if there is room; its row, or -1.

    Rates of the tilt before and after are those along its side.
    """
    row = log_row(s, l, log, kind)
    if row >= 0:
        entry = log[row]
        sign = sign_of(s, l)
        theta = 0.0 if s.phase[l] == FULL_CONTACT else sign * s.x[l]
        entry.time = time_of(s, l)
        entry.kind = kind
        entry.theta = theta
        entry.energy_lost = lost
        entry.theta_dot_before = sign * before
        entry.theta_dot_after = sign * after
        entry.azimuth = azimuth_of(s, l)
        entry.least_tilt = 0.0
        entry.nearness = 0.0
        entry.loss_share = 0.0
    return row
