"""What happened in a history, and when: the kernel's log in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rpscli.physics.core.records import Record
from rpscli.physics.planar import state

EventKind = Literal[
    "uplift",
    "impact",
    "recontact",
    "rolling_to_rocking",
    "rocking_to_rolling",
    "critical_rotation_passed",
    "overturning",
    "sticking",
    "sliding",
    "stop_met",
    "stop_left",
    "tendon_yielding",
    "tendon_slack",
    "tendon_taut",
]

EVENT_NAMES: dict[int, EventKind] = {
    state.UPLIFT: "uplift",
    state.IMPACT: "impact",
    state.RECONTACT: "recontact",
    state.ROLLING_TO_ROCKING: "rolling_to_rocking",
    state.ROCKING_TO_ROLLING: "rocking_to_rolling",
    state.CRITICAL_PASSAGE: "critical_rotation_passed",
    state.OVERTURNING: "overturning",
    state.STICKING: "sticking",
    state.SLIDING: "sliding",
    state.STOP_MET: "stop_met",
    state.STOP_LEFT: "stop_left",
    state.TENDON_YIELDING: "tendon_yielding",
    state.TENDON_SLACK: "tendon_slack",
    state.TENDON_TAUT: "tendon_taut",
}


@dataclass(frozen=True)
class Event:
    """One event of a history.

    Parameters
    ----------
    time
        Since the start of the record [s].
    kind
        What happened.
    rotation
        theta [rad].
    rotation_rate_before, rotation_rate_after
        theta' [rad/s].
    energy_lost
        [J], negative where an impact created energy.
    """

    time: float
    kind: EventKind
    rotation: float
    rotation_rate_before: float
    rotation_rate_after: float
    energy_lost: float


def event_list(log: Record) -> tuple[Event, ...]:
    """Events from the rows of the kernel's log."""
    return tuple(
        Event(time, EVENT_NAMES[kind], theta, before, after, lost)
        for time, kind, theta, before, after, lost in log.tolist()
    )
