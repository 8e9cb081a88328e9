"""Columns of the CSV files of modes, static characteristics, time histories, storeys and floors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.floor_spectra import FloorSpectra
from rpscli.analyses.modal import ModalResult
from rpscli.analyses.pushover import CapacityCurve, StoreyCurve
from rpscli.analyses.result_quantities import STOREY_CURVE, STOREYS
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Event, sampled
from rpscli.report.table import Column, columns_of


def mode_columns(result: ModalResult) -> list[Column]:
    """`modes.csv`: one row a vibration mode of each state; those uplifted in both orders."""
    heads = {"state": "-", "mode": "-", "frequency": "rad/s", "period": "s", "damping": "-"}
    ratios = {"frequency_ratio": "-", "damping_ratio": "-"}
    paper = {"first_order_frequency": "rad/s", "first_order_damping": "-"}
    return columns_of(heads | ratios | paper, _mode_rows(result))


def _mode_rows(result: ModalResult) -> Iterator[tuple[str | int | float | None, ...]]:
    for state, alone, of_itself in (
        ("full_contact", result.full_contact, None),
        (result.fixed_base_state, result.fixed_base, 1.0),
    ):
        pairs = zip(alone.frequencies, alone.damping, strict=True) if alone else ()
        for i, (w, xi) in enumerate(pairs):
            numbers = float(w), 2.0 * math.pi / w, float(xi), of_itself, of_itself
            yield state, i + 1, *numbers, None, None
    for name, (modes, first) in result.both_orders.items():
        for i, (w, xi) in enumerate(zip(modes.frequencies, modes.damping, strict=True)):
            ratios = float(modes.frequency_ratio[i]), float(modes.damping_ratio[i])
            paper = float(first.frequencies[i]), float(first.damping[i])
            yield name, i + 1, float(w), 2.0 * math.pi / w, float(xi), *ratios, *paper


def shape_columns(result: ModalResult) -> list[Column]:
    """`shapes.csv`: one row a level of each mode; mode 0 is the storey's own, level 0 the beam."""
    profiles = {(name, 0): [*modes.profiles().values()] for name, modes in result.uplifted.items()}
    full = result.full_contact
    if result.fixed_base is not None:
        fixed = result.fixed_base.profiles()["shapes"]
        profiles = {(result.fixed_base_state, 1): [fixed, fixed], **profiles}
    if full is not None:
        elastic = full.shapes.T - full.shapes[0][:, None]
        profiles = {("full_contact", 1): [full.shapes.T, elastic], **profiles}
    rows = [
        (state, first + mode, level, float(shapes[mode, level]), float(elastic[mode, level]))
        for (state, first), (shapes, elastic) in profiles.items()
        for mode, level in np.ndindex(*shapes.shape)
    ]
    return columns_of(dict.fromkeys(("state", "mode", "level", "horizontal", "elastic"), "-"), rows)


def eigenvalue_columns(result: ModalResult) -> list[Column]:
    """`eigenvalues.csv`: two rows a mode of each uplifted state, mode 0 the storey's own."""
    heads = {"state": "-", "mode": "-", "real": "1/s", "imaginary": "rad/s"}
    rows = [
        (name, index // 2, value.real, value.imag)
        for name, modes in result.uplifted.items()
        for index, value in enumerate(modes.eigenvalues.tolist())
    ]
    return columns_of(heads, rows)


def storey_curve_columns(curve: StoreyCurve) -> list[Column]:
    """`storey_curve.csv`: one row a point, from the uplift on."""
    return [Column(q.name, q.unit, getattr(curve, q.name)) for q in STOREY_CURVE]


def capacity_columns(curves: tuple[CapacityCurve, ...]) -> list[Column]:
    """`capacity.csv`: the points of one load pattern after those of the other."""
    patterns = [curve.pattern for curve in curves for _ in curve.sum_of_floor_forces]
    heads = {"roof_displacement": "m", "cap_beam_displacement": "m", "sum_of_floor_forces": "N"}
    values = {name: np.concatenate([getattr(each, name) for each in curves]) for name in heads}
    return [
        Column("pattern", "-", patterns),
        *(Column(name, unit, values[name]) for name, unit in heads.items()),
    ]


Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoreyDemands:
    """Largest absolute values in each storey from the bottom, arrays (n,): `STOREYS` of results.

    Drift ratios are None where the case gives no storey heights.
    """

    storey_drifts: Array
    storey_drift_ratios: Array | None
    storey_shears: Array
    floor_accelerations: Array
    floor_velocities: Array


def isolated_demands(result: TimeHistoryResult) -> StoreyDemands:
    """Demands of the building on its bearings."""
    return _demands(result, result.max_drifts, result)


def fixed_base_demands(result: TimeHistoryResult) -> StoreyDemands | None:
    """Demands of the same building on a fixed base; None without a building."""
    fixed = result.fixed_base
    return None if fixed is None else _demands(result, fixed.drifts, fixed)


def storey_columns(result: TimeHistoryResult) -> list[Column]:
    """`storeys.csv`: one row a storey, from the bottom."""
    count = result.structure.storeys
    both = {"": isolated_demands(result), "fixed_base_": fixed_base_demands(result)}
    columns = [Column("storey", "-", range(1, count + 1))]
    for prefix, demands in both.items():
        for quantity in STOREYS if demands else ():
            values = getattr(demands, quantity.name)
            known = [None] * count if values is None else values
            columns.append(Column(f"{prefix}{quantity.column}", quantity.unit, known))
    return columns


def _demands(result: TimeHistoryResult, drifts: Array, of: Any) -> StoreyDemands:
    building = result.structure.superstructure
    ratios = None if building is None else building.drift_ratios(drifts)
    floors = of.floor_accelerations, of.floor_velocities
    return StoreyDemands(drifts, ratios, of.storey_shears, *floors)


def history_columns(result: TimeHistoryResult) -> list[Column]:
    """`timehistory.csv`: one row a sample of the record, on through the free vibration."""
    return [Column(*each) for each in sampled(result.structure, result.trace)]


def event_columns(events: tuple[Event, ...]) -> list[Column]:
    """`events.csv`: one row an event, in the order of time."""
    heads = {"time": "s", "kind": "-", "rotation": "rad"}
    heads |= {"rotation_rate_before": "rad/s", "rotation_rate_after": "rad/s", "energy_lost": "J"}
    if any(event.azimuth is not None for event in events):
        heads |= {"azimuth": "rad", "least_tilt": "rad", "nearness": "-", "loss_share": "-"}
    return columns_of(heads, [[getattr(event, name) for name in heads] for event in events])


def floor_spectra_columns(isolated: FloorSpectra, fixed: FloorSpectra | None) -> list[Column]:
    """`floor_spectra.csv`: one row a floor, from the bottom, and period."""
    floors, periods = isolated.displacement.shape
    columns = [
        Column("floor", "-", np.repeat(np.arange(1, floors + 1), periods)),
        Column("period", "s", np.tile(isolated.periods, floors)),
    ]
    for prefix, spectra in (("", isolated), ("fixed_base_", fixed)):
        if spectra is not None:
            columns += [
                Column(f"{prefix}pseudo_acceleration", "m/s2", spectra.pseudo_acceleration.ravel()),
                Column(f"{prefix}displacement", "m", spectra.displacement.ravel()),
            ]
    return columns
