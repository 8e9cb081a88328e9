"""How a history ended."""

from __future__ import annotations

from typing import Literal

from rpscli.analyses.kernels.history import History
from rpscli.physics.planar import state

Outcome = Literal["at_rest", "survived", "overturned_rolling", "overturned_rocking", "failed"]

OUTCOMES: dict[int, Outcome] = {
    state.AT_REST: "at_rest",
    state.SURVIVED: "survived",
    state.OVERTURNED_ROLLING: "overturned_rolling",
    state.OVERTURNED_ROCKING: "overturned_rocking",
}


def outcome_of(history: History) -> Outcome:
    """The outcome; every code that is no proper ending is a failure."""
    return OUTCOMES.get(history.outcome, "failed")
