"""What happened in a history, and when: the kernel's log in words.

>>> from rpscli.physics.planar import state
>>> EVENT_NAMES[state.UPLIFT], EVENT_NAMES[state.OVERTURNING], EVENT_NAMES[state.TENDON_TAUT]
('uplift', 'overturning', 'tendon_taut')
>>> len(EVENT_NAMES) == state.EVENT_KINDS
True
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from rpscli.physics.core.records import Record

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

EVENT_NAMES: tuple[EventKind, ...] = get_args(EventKind)
"""By the codes of the kernels."""


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
