"""The events, each with what is watched for it, how far off it is, and what it does.

A kind of event is a row here. What it does logs what happened (`state`: kinds of the
log), since one event may be an impact or a pass, an uplift or a slide.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from rpscli.physics import events, switches
from rpscli.physics.state import CHANGE, HIGH, LET_GO, LOW, NEAREST, YIELD


class EventKind(NamedTuple):
    """A kind of event on which steps end."""

    kind: int
    first: Callable[
        ..., Any
    ]  # fraction of a step at which it first happens, and which of it
    missing: Callable[..., Any]  # what the end of a step is still above it, and the rate
    happens: Callable[..., Any]


EVENTS = (
    EventKind(LOW, events.falls_low, events.missing_low, switches.leave_low),
    EventKind(HIGH, events.rises_high, events.missing_high, switches.leave_high),
    EventKind(NEAREST, events.is_nearest, events.missing_nearest, switches.pass_nearest),
    EventKind(LET_GO, events.let_go, events.missing_let_go, switches.lose_hold),
    EventKind(CHANGE, events.changes, events.missing_change, switches.change),
    EventKind(YIELD, events.yields_first, events.missing_yield, switches.yield_or_end),
)
"""In the order in which the first of several at one instant is chosen."""
