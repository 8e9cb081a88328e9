"""Time history of a rocking podium structure under a ground motion.

>>> from rpscli import Bearing, PodiumStructure, load_record
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
>>> pulse = load_record("pulse:sine?amplitude=0.4g&period=0.8")
>>> time_history(podium, pulse, with_fixed_base=False).uplifts
1
"""

from __future__ import annotations

import math
from dataclasses import replace

from rpscli.analyses.column_design import column_demand
from rpscli.analyses.column_forces import axial_forces
from rpscli.analyses.fixed_base import FixedBaseResponse, fixed_base_response
from rpscli.analyses.kernels.history import SampledHistory, sampled_history
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings, require_inputs
from rpscli.analyses.trace import Trace, event_list, trace_of
from rpscli.analyses.twist import TwistResult, twist_history
from rpscli.model.podium import PodiumStructure
from rpscli.physics import state
from rpscli.physics.state import Record
from rpscli.records.ground_motion import GroundMotion, MotionComponents


def time_history(
    structure: PodiumStructure,
    record: GroundMotion | MotionComponents,
    settings: TimeHistorySettings | None = None,
    *,
    vertical: GroundMotion | None = None,
    with_fixed_base: bool = True,
) -> TimeHistoryResult:
    """Response of the structure to a record, with free vibration after its end.

    Overturning is an outcome, as is a step that fails (``failed``, with a reason).

    Parameters
    ----------
    structure
        Podium, bearings and building.
    record
        Horizontal ground acceleration, or all components; zero after its last sample.
    settings
        Accuracy, tolerance, limits; the defaults keep maxima within 1e-4 of the converged
        values where the motion is not near overturning.
    vertical
        Vertical ground acceleration with the same time step, positive upwards.
    with_fixed_base
        Also run the same building on a fixed base.

    Raises
    ------
    RecordError
        If the two components have different time steps.
    """
    settings, motion = require_inputs(structure, record, settings, vertical)
    twist = twist_history(structure, motion, settings) if structure.twist else None
    run = sampled_history(structure, motion, settings)
    fixed = _on_fixed_base(structure, run, motion) if with_fixed_base else None
    return _with_columns(TimeHistoryResult(
        structure=structure,
        history=_worse(run.history, twist),
        record=motion.horizontal,
        settings=settings,
        trace=trace_of(structure, run),
        events=event_list(run.log, both=motion.y is not None),
        fixed_base=fixed,
        motion=motion, twist=twist,
    ))  # fmt: skip


def _worse(history: Record, twist: TwistResult | None) -> Record:
    """What a history left behind, with the outcome of a slab that ended worse turning."""
    if twist is None:
        return history
    code = int(twist.run.slab["outcome"])
    if code <= max(int(history["outcome"]), state.SURVIVED):
        return history
    changed = history.copy()
    changed["outcome"] = code
    return changed


def _on_fixed_base(
    structure: PodiumStructure, run: SampledHistory, motion: MotionComponents
) -> FixedBaseResponse | None:
    """The building on a fixed base, as long as its history and the record; if any."""
    if structure.superstructure is None:
        return None
    horizontal = [each.npts for name, each in motion.named.items() if name != "vertical"]
    intervals = max(int(run.history.intervals), max(horizontal) - 1)
    return fixed_base_response(structure, motion, intervals)


def _with_columns(result: TimeHistoryResult) -> TimeHistoryResult:
    """The result with forces of single columns, and the demand on a designed one."""
    structure = result.structure
    design = structure.column
    both = result.both_components
    rows = structure.rows and (structure.rows_y or not both)
    shaken = structure.superstructure is not None and len(result.left_out_of_columns) < 2
    even = not (rows or shaken)
    if even and design is None:
        return result
    dense = denser_trace(result, AXIAL_STEP)
    axial = axial_forces(structure, dense)
    designed = None
    if design is not None:
        designed = column_demand(structure, design, dense, axial.heaviest, axial.moments)
    return replace(result, axial=None if even else axial, column_demand=designed)


AXIAL_STEP = 5e-4
"""Between instants at which the forces of single columns are looked at [s], or less.

Of nine storeys with 0.05 s vertically the largest is then 0.3 % low, and the
least 1 % of the weight high."""


def denser_trace(result: TimeHistoryResult, step: float, beyond: float = 0.0) -> Trace:
    """Trace of a result at even parts of the sampling interval, up
    to `step`, so long on [s].
    """
    parts = max(math.ceil(result.record.dt / step - 1e-9), 1)
    settings = result.settings
    if beyond > 0.0:
        free = max(result.duration - result.record.duration, 0.0) + beyond
        settings = replace(settings, free_vibration=free)
    elif parts == 1:
        return result.trace
    return trace_of(
        result.structure,
        sampled_history(result.structure, result.motion, settings, parts),
    )
