"""How a history ended."""

from __future__ import annotations

from typing import Literal

from rpscli.analyses.history import History
from rpscli.physics import layout

Outcome = Literal["at_rest", "survived", "overturned_rolling", "overturned_rocking", "failed"]

OUTCOMES: dict[int, Outcome] = {
    layout.AT_REST: "at_rest",
    layout.SURVIVED: "survived",
    layout.OVERTURNED_ROLLING: "overturned_rolling",
    layout.OVERTURNED_ROCKING: "overturned_rocking",
}


def outcome_of(history: History) -> Outcome:
    """The outcome; every code that is no proper ending is a failure."""
    return OUTCOMES.get(history.outcome, "failed")
