"""Time history of a rocking podium structure under a ground motion."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.failure import failure_text
from rpscli.analyses.fixed_base import fixed_base_response
from rpscli.analyses.kernel_input import (
    floor_parameters,
    ground_parameters,
    numerics,
    podium_parameters,
)
from rpscli.analyses.results import Outcome, TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.trace import event_list, trace_of
from rpscli.model.podium import PodiumStructure
from rpscli.physics import layout
from rpscli.records.ground_motion import GroundMotion

OUTCOMES: dict[int, Outcome] = {
    layout.AT_REST: "at_rest",
    layout.SURVIVED: "survived",
    layout.OVERTURNED_ROLLING: "overturned_rolling",
    layout.OVERTURNED_ROCKING: "overturned_rocking",
}
"""Every other code of the kernel is a failure."""

FIRST_LOG = 4096
"""Rows of the event log at the first attempt; a longer history is run once more."""


def time_history(
    structure: PodiumStructure,
    record: GroundMotion,
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
    with_fixed_base: bool = True,
) -> TimeHistoryResult:
    """Response of the structure to a record, with free vibration after its end.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    record
        Horizontal ground acceleration; zero after its last sample.
    settings
        Accuracy, tolerance, limits; the defaults keep maxima within 1e-4 of the converged values
        where the motion is not near overturning.
    vertical
        Vertical ground acceleration with the same time step, positive upwards.
    with_fixed_base
        Also run the same building on a fixed base.

    Returns
    -------
    TimeHistoryResult. A step that could not be taken gives the outcome ``failed`` with a reason,
    not an exception; overturning is a result like any other.

    Raises
    ------
    ValueError
        If the two components have different time steps.
    """
    settings = settings or TimeHistorySettings()
    if vertical is not None and vertical.dt != record.dt:
        raise ValueError(
            f"the vertical record has dt = {vertical.dt} s, the horizontal one {record.dt} s:"
            " they must agree"
        )
    # Imported here: compiling or loading kernels costs time that other commands need not pay.
    from rpscli.physics.driver import integrate  # noqa: PLC0415

    podium = podium_parameters(structure, settings)
    floors = floor_parameters(structure.superstructure)
    ground = ground_parameters(record, vertical)
    steps = numerics(structure, record.dt, settings)
    rows = len(ground.horizontal) + steps.free_samples
    samples = np.empty((rows, layout.ROW_FLOORS + 2 * structure.storeys))
    log = np.empty((FIRST_LOG, layout.LOG_COLUMNS))
    history = integrate(podium, floors, ground, steps, samples, log)
    if (events := int(history.counts.sum())) > FIRST_LOG:
        log = np.empty((events, layout.LOG_COLUMNS))
        history = integrate(podium, floors, ground, steps, samples, log)
    trace = trace_of(structure, ground, samples[: history.intervals + 1].copy())
    fixed = None
    if with_fixed_base and structure.superstructure is not None:
        fixed = fixed_base_response(structure.superstructure, floors, ground, history.intervals)
    return TimeHistoryResult(
        structure=structure,
        record=record,
        settings=settings,
        outcome=OUTCOMES.get(int(history.outcome), "failed"),
        failure=failure_text(history),
        history=history,
        trace=trace,
        events=event_list(log[:events]),
        fixed_base=fixed,
    )
