"""CSV tables of a time history."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.events import Event
from rpscli.analyses.results import TimeHistoryResult
from rpscli.report.table import Column, columns_of


def history_columns(result: TimeHistoryResult) -> list[Column]:
    """`timehistory.csv`: one row a sample; floors and storeys are counted from the bottom.

    `phase` is 0 in full contact, 1 rolling, 2 rocking, 3 held by friction. Displacements are
    relative to the ground, floor accelerations absolute. Forces are those of one column, F to the
    right and N upwards on what is above; of all columns together where the case does not give
    their number. Devices are counted from 0, as in `podium.devices`.
    """
    t, columns = result.trace, result.structure.columns
    return [
        Column("time", "s", t.time),
        Column("ground_acceleration", "m/s2", t.ground_acceleration),
        Column("rotation", "rad", t.rotation),
        Column("rotation_rate", "rad/s", t.rotation_rate),
        Column("cap_beam_displacement", "m", t.cap_beam_displacement),
        Column("lift", "m", t.lift),
        *_each("floor_{}_displacement", "m", t.floor_displacements),
        *_each("storey_{}_drift", "m", t.drifts),
        *_each("storey_{}_shear", "N", t.storey_shears),
        *_each("floor_{}_acceleration", "m/s2", t.floor_accelerations),
        Column("driving_moment", "N m", t.driving_moment),
        Column("column_shear_top", "N", t.shear_top / columns),
        Column("column_shear_bottom", "N", t.shear_bottom / columns),
        Column("column_force_top", "N", t.normal_top / columns),
        Column("column_force_bottom", "N", t.normal_bottom / columns),
        Column("energy_input", "J", t.energy_input),
        Column("energy_damped", "J", t.energy_damped),
        Column("energy_impact", "J", t.energy_impact),
        Column("energy_stored", "J", t.energy_stored),
        *_devices(result),
        Column("phase", "-", t.phase),
    ]


def _devices(result: TimeHistoryResult) -> Iterator[Column]:
    """Force, displacement and energy of each device, named by its kind."""
    trace = result.trace.devices
    for index, device in enumerate(result.structure.devices):
        name = f"device_{index}_{device.kind}"
        yield Column(f"{name}_force", "N", trace.force[:, index])
        yield Column(f"{name}_displacement", "m", trace.displacement[:, index])
        yield Column(f"{name}_energy", "J", trace.energy[:, index])


def event_columns(events: tuple[Event, ...]) -> list[Column]:
    """`events.csv`: one row an event, in the order of time."""
    heads = {"time": "s", "kind": "-", "rotation": "rad"}
    heads |= {"rotation_rate_before": "rad/s", "rotation_rate_after": "rad/s", "energy_lost": "J"}
    return columns_of(heads, [[getattr(event, name) for name in heads] for event in events])


def _each(name: str, unit: str, values: NDArray[np.float64]) -> Iterator[Column]:
    for index, column in enumerate(values.T, start=1):
        yield Column(name.format(index), unit, column)
