"""Why a history could not be carried to its end, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.physics.planar import state

if TYPE_CHECKING:
    from rpscli.analyses.kernels.history import History

PHASE_NAMES = {
    state.FULL_CONTACT: "full contact",
    state.ROLLING: "rolling",
    state.ROCKING: "rocking",
}

REASONS = {
    state.FAILED_NOT_FINITE: (
        "the motion is no longer finite; check masses and stiffnesses, or raise analysis.accuracy"
    ),
    state.FAILED_TOO_MANY_EVENTS: (
        "there are more events than analysis.max_events allows; raise it,"
        " or raise analysis.recontact_tolerance"
    ),
    state.FAILED_STEP_TOO_SMALL: (
        "events follow each other without time passing; raise analysis.recontact_tolerance"
    ),
}


def failure_text(history: History) -> str | None:
    """Time, phase, rotation and reason of a failure; None if the history ended well."""
    reason = REASONS.get(history.outcome)
    if reason is None:
        return None
    phase = PHASE_NAMES[history.phase]
    return (
        f"at t = {history.time:.6g} s, {phase}, theta = {history.rotation + 0.0:.6g} rad: {reason}"
    )
