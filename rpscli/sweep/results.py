"""Results of one point under their published names."""

from __future__ import annotations

from typing import Any

import numpy as np

from rpscli.analyses.demand import Demand
from rpscli.analyses.modal import ModalResult, UpliftedModes, modal
from rpscli.analyses.pushover import PushoverResult, pushover
from rpscli.case.study_schema import Analysis
from rpscli.model.podium import PodiumStructure

Results = dict[str, Any]
"""Numbers, None, lists of numbers, and mappings of these; JSON-able."""

DONE = "done"
"""Outcome of an analysis that has no others."""

FAILED = "failed"

SCALARS: dict[Analysis, tuple[str, ...]] = {
    "timehistory": (
        "max_rotation",
        "rotation_ratio",
        "critical_rotation",
        "critical_passage_time",
        "max_cap_beam_displacement",
        "max_base_shear",
        "base_shear_ratio",
        "drift_ratio",
        "friction_demand",
        "uplifts",
        "impacts",
        "duration",
        "energy_impact",
        "energy_created",
        "creating_impacts",
        "pga",
        "pgv",
    ),
    "modal": (
        "fixed_base.frequencies.0",
        "fixed_base.periods.0",
        "fixed_base.damping.0",
        "rolling.frequency_ratio.0",
        "rolling.damping_ratio.0",
        "rolling.frequency_parameter",
        "rolling.frequency_parameter_rigid",
        "rocking.frequency_ratio.0",
        "rocking.damping_ratio.0",
        "rocking.frequency_parameter",
        "rocking.frequency_parameter_rigid",
    ),
    "pushover": (
        "uplift_force",
        "critical_rotation",
        "critical_displacement",
        "initial_stiffness",
    ),
}
"""Scalar results of each analysis, in the order of `points.csv`; modes count from 0."""


_UPLIFTED = (
    "frequencies",
    "damping",
    "frequency_ratio",
    "damping_ratio",
    "frequency_parameter",
    "frequency_parameter_rigid",
    "shapes",
    "elastic_shapes",
)
_CURVE = ("rotation", "displacement", "force", "lift", "rotation_ratio", "force_over_weight")

KNOWN: dict[Analysis, tuple[str, ...]] = {
    "timehistory": (*SCALARS["timehistory"], "storey_shears"),
    "modal": (
        *(f"fixed_base.{name}" for name in ("frequencies", "periods", "damping", "shapes")),
        *(f"{state}.{name}" for state in ("rolling", "rocking") for name in _UPLIFTED),
        "floor",
    ),
    "pushover": (*SCALARS["pushover"], *(f"curve.{name}" for name in _CURVE)),
}
"""Results that a report may name; elements of lists by their index, counted from 0."""


def is_result(analysis: Analysis, path: str) -> bool:
    """Whether an analysis has a result of this name.

    >>> is_result("modal", "rolling.frequency_ratio.0"), is_result("modal", "rolling.period")
    (True, False)
    """
    parts = path.split(".")
    while parts and parts[-1].isdecimal():
        parts.pop()
    return ".".join(parts) in KNOWN[analysis]


def history_results(structure: PodiumStructure, demand: Demand) -> Results:
    """Largest demands of a history, as `rps timehistory` names them."""
    building, static = structure.superstructure, structure.static_base_shear
    shears = demand.storey_shears
    base_shear = float(shears[0]) if len(shears) else 0.0
    drift_ratio = None
    if building is not None and building.storey_heights is not None:
        drift_ratio = float(np.max(shears / building.stiffnesses / building.storey_heights))
    _, displacement, _ = structure.path(np.array([demand.max_rotation]))
    friction = demand.friction_demand
    return {
        "max_rotation": demand.max_rotation,
        "rotation_ratio": demand.max_rotation / structure.critical_rotation,
        "critical_rotation": structure.critical_rotation,
        "critical_passage_time": demand.critical_passage_time,
        "max_cap_beam_displacement": float(displacement[0]),
        "max_base_shear": base_shear,
        "base_shear_ratio": base_shear / static if static > 0.0 else None,
        "drift_ratio": drift_ratio,
        "friction_demand": friction if np.isfinite(friction) else None,
        "uplifts": demand.uplifts,
        "impacts": demand.impacts,
        "duration": demand.duration,
        "energy_impact": demand.energy_impact,
        "energy_created": demand.energy_created,
        "creating_impacts": demand.creating_impacts,
        "storey_shears": shears.tolist(),
    }


def parametric_results(analysis: Analysis, structure: PodiumStructure) -> Results:
    """Results of a modal or pushover analysis."""
    if analysis == "modal":
        return _modal(modal(structure))
    return _pushover(pushover(structure))


def _modal(result: ModalResult) -> Results:
    fixed = result.fixed_base
    base = None
    if fixed is not None:
        base = {
            "frequencies": fixed.frequencies.tolist(),
            "periods": fixed.periods.tolist(),
            "damping": fixed.damping.tolist(),
            "shapes": [[0.0, *shape] for shape in fixed.shapes.T.tolist()],
        }
    return {
        "fixed_base": base,
        "rolling": None if result.rolling is None else _uplifted(result.rolling),
        "rocking": _uplifted(result.rocking),
        "floor": list(range(result.structure.storeys + 1)),
    }


def _uplifted(modes: UpliftedModes) -> Results:
    elastic = modes.elastic_shapes.T.tolist()
    return {
        "frequencies": modes.frequencies.tolist(),
        "damping": modes.damping.tolist(),
        "frequency_ratio": modes.frequency_ratio.tolist(),
        "damping_ratio": modes.damping_ratio.tolist(),
        "frequency_parameter": modes.frequency_parameter,
        "frequency_parameter_rigid": modes.frequency_parameter_rigid,
        "shapes": modes.shapes.T.tolist(),
        "elastic_shapes": [[0.0, *shape] for shape in elastic],
    }


def _pushover(result: PushoverResult) -> Results:
    weight, curve = result.structure.weight, result.curve
    return {
        "uplift_force": result.uplift_force,
        "critical_rotation": result.critical_rotation,
        "critical_displacement": result.critical_displacement,
        "initial_stiffness": result.initial_stiffness,
        "curve": {
            "rotation": curve.rotation.tolist(),
            "displacement": curve.displacement.tolist(),
            "force": curve.force.tolist(),
            "lift": curve.lift.tolist(),
            "rotation_ratio": (curve.rotation / result.critical_rotation).tolist(),
            "force_over_weight": (curve.force / weight).tolist(),
        },
    }


def value_at(results: Results, path: str) -> Any:
    """The value at a dotted path; None where there is none (a mode that does not exist).

    >>> value_at({"rolling": {"frequency_ratio": [1.7, 1.2]}}, "rolling.frequency_ratio.0")
    1.7
    """
    value: Any = results
    for part in path.split("."):
        if isinstance(value, list):
            index = int(part) if part.isdecimal() else len(value)
            value = value[index] if index < len(value) else None
        else:
            value = value.get(part) if isinstance(value, dict) else None
    return value
