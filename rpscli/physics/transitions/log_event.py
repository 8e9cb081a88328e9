"""Counting and logging events."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.state import EVENT_KINDS, Record


@compiled
def time_of(s: Record, l: int) -> float:
    """Time of a lane since the start of its record [s]."""
    return float(s.interval_start[l] + s.time[l])


@compiled
def log_event(
    s: Record,
    l: int,
    log: Record,
    time: float,
    kind: int,
    theta: float,
    before: float,
    after: float,
    lost: float,
) -> None:
    """Count an event, and log it if there is room (the caller sees from the counts if not).

    Parameters
    ----------
    time
        Since the start of the record [s].
    kind
        `state.UPLIFT` to `state.OVERTURNING`.
    theta, before, after
        Rotation [rad], and its rate before and after the event [rad/s].
    lost
        Energy that the event took [J].
    """
    if log.shape[0] > 0:
        row = 0
        for i in range(EVENT_KINDS):
            row += s.events[l, i]
        if row < log.shape[0]:
            entry = log[row]
            entry.time, entry.kind, entry.theta = time, kind, theta
            entry.theta_dot_before, entry.theta_dot_after = before, after
            entry.energy_lost = lost
    s.events[l, kind] += 1
