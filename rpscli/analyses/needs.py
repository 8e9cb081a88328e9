"""Needs of results: words for what a structure must have, and whether it has it.

The one list of them: for limits in files, for `--fail-on`, for studies and their reports.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


class Need(NamedTuple):
    """A part of a structure in words, and whether one has it."""

    words: str
    met_by: Callable[[PodiumStructure], bool]


def _has_heights(structure: PodiumStructure) -> bool:
    building = structure.superstructure
    return building is not None and building.storey_heights is not None


def _has_column_forces(structure: PodiumStructure) -> bool:
    known = not structure.left_out_of_columns(both=False)
    return structure.counts_columns and known


def _has_rows(structure: PodiumStructure) -> bool:
    known = not structure.left_out_of_columns(both=False, axial=False)
    return structure.counts_columns and known


def _has_columns(structure: PodiumStructure) -> bool:
    return structure.column is not None and _has_column_forces(structure)


def _device_with(result: str) -> Callable[[PodiumStructure], bool]:
    return lambda structure: any(result in device.results for device in structure.devices)


_DESIGNED = "podium.column, podium.plan and superstructure.vertical_period in the case"

NEEDS = {
    "superstructure": Need(
        "a superstructure", lambda structure: structure.superstructure is not None
    ),
    "superstructure, flat part": Need(
        "a superstructure on columns with a flat part, so that V_st > 0",
        lambda structure: structure.static_base_shear > 0.0,
    ),
    "superstructure.storey_height": Need(
        "superstructure.storey_height in the case", _has_heights
    ),
    "superstructure, devices": Need(
        "a superstructure and podium.devices",
        lambda structure: bool(structure.storeys and structure.devices),
    ),
    "superstructure.yield": Need(
        "superstructure.yield, strengths of storeys, in the case",
        lambda structure: structure.yields,
    ),
    "superstructure.yield, storey_height": Need(
        "superstructure.yield and superstructure.storey_height in the case",
        lambda structure: structure.yields and _has_heights(structure),
    ),
    "podium.friction": Need(
        "podium.friction in the case", lambda structure: structure.friction is not None
    ),
    "contact": Need(
        "a compliant podium.contact: kind plane or edges",
        lambda structure: structure.bed is not None,
    ),
    "plane contact": Need(
        "podium.contact of the kind plane under flat ends",
        lambda structure: structure.contact.kind == "plane" and structure.bearing.is_flat,
    ),
    "columns": Need(
        "podium.columns, podium.plan and superstructure.vertical_period in the case,"
        " without which it is of all columns, and leaves out the overturning moment and"
        " the shock of impacts",
        _has_column_forces,
    ),
    "rows of columns": Need(
        "podium.columns and podium.plan in the case, without which it is the mean of the"
        " columns or their sum, and not that of the most loaded one",
        _has_rows,
    ),
    "designed columns": Need(_DESIGNED, _has_columns),
    "columns on arcs": Need(
        f"curved ends, {_DESIGNED}",
        lambda structure: _has_columns(structure) and not structure.bearing.is_flat,
    ),
    "twist": Need(
        "podium.twist, by which the slab turns about the vertical, in the case",
        lambda structure: structure.twist is not None,
    ),
    "damper": Need("a damper in podium.devices", _device_with("max_damper_force")),
    "stop": Need("a stop in podium.devices", _device_with("max_stop_force")),
    "tendon": Need(
        "a prestressed tendon in podium.devices", _device_with("lost_prestress")
    ),
}
"""Parts of a structure that results need, by their names in the list of results."""
