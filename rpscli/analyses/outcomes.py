"""Outcomes of histories: how they end, and why some of them fail."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rpscli.model.devices import own_laws
from rpscli.model.own import OwnLaw
from rpscli.model.podium import PodiumStructure
from rpscli.physics import state
from rpscli.physics.state import Record

Outcome = Literal[
    "at_rest",
    "survived",
    "stays_tilted",
    "overturned_rolling",
    "overturned_rocking",
    "failed",
]

OUTCOMES: dict[int, Outcome] = {
    state.AT_REST: "at_rest",
    state.SURVIVED: "survived",
    state.OVERTURNED_ROLLING: "overturned_rolling",
    state.OVERTURNED_ROCKING: "overturned_rocking",
}
"""Proper endings; every other code is a failure."""

OUTCOME_WORDS = np.array(
    [OUTCOMES.get(code, "failed") for code in range(state.FAILED_RESTITUTION + 1)]
)
"""By the codes of `physics.state`, of which RUNNING counts from the end."""

STOOD: tuple[Outcome, ...] = ("survived", "stays_tilted")
"""After uplift: back in full contact or on the way, or held by friction at the end."""

PHASE_NAMES = {
    state.FULL_CONTACT: "full contact",
    state.ROLLING: "rolling",
    state.ROCKING: "rocking",
    state.STUCK: "held by friction",
    state.BEDDED: "full contact",
}

REASONS = {
    state.FAILED_NOT_FINITE: (
        "the motion is no longer finite; check masses and stiffnesses, or raise"
        " analysis.accuracy"
    ),
    state.FAILED_TOO_MANY_EVENTS: (
        "there are more events than analysis.max_events allows; raise it,"
        " or raise analysis.recontact_tolerance"
    ),
    state.FAILED_STEP_TOO_SMALL: (
        "events follow each other without time passing; raise"
        " analysis.recontact_tolerance"
    ),
    state.FAILED_TOO_MANY_STEPS: (
        "a viscous damper whose exponent is below 1 holds the cap beam so firmly that"
        " steps become too many; use a friction damper, a larger exponent or a smaller"
        " coefficient"
    ),
    state.FAILED_RESTITUTION: "a restitution is not above 0 and at most 1",
}


def outcomes_of(left: Record) -> NDArray[np.str_]:
    """Outcomes of `state.RESULT`s, of any shape."""
    words = OUTCOME_WORDS[left["outcome"]]
    held = (left["phase"] == state.STUCK) & (words == "survived")
    return np.asarray(np.where(held, "stays_tilted", words))


def refusals(law: OwnLaw) -> Iterator[str]:
    """Refusals of the functions of a law that gave no finite number, in their words."""
    from rpscli.physics.own_laws import said_of

    for function, taken in law.taken().items():
        if said := said_of(function, taken):
            yield said


def failure_text(history: Record, structure: PodiumStructure) -> str | None:
    """Time, phase, rotation and reason of a failure; None if the history ended well."""
    reason = REASONS.get(int(history["outcome"]))
    if reason is None:
        return None
    if own := own_laws(structure):
        refused = [text for law in own.values() for text in refusals(law)]
        told = f"{reason}; with laws of other packages: {', '.join(own)}"
        reason = "; ".join(refused) or told
    phase = PHASE_NAMES[int(history["phase"])]
    theta = history["rotation"] + 0.0
    return f"at t = {history['time']:.6g} s, {phase}, theta = {theta:.6g} rad: {reason}"
