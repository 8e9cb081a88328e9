"""Files that each analysis leaves behind: columns of the CSV files, and figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rpscli.analyses.floor_spectra import (
    FloorSpectra,
    fixed_base_floor_spectra,
    isolated_floor_spectra,
)
from rpscli.analyses.modal import ModalResult
from rpscli.analyses.pushover import CapacityCurve, PushoverResult, pushover
from rpscli.analyses.result_quantities import STOREY_CURVE, STOREYS, STOREYS_YIELDING
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Event, sampled
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import ResponseSpectrum
from rpscli.records.selection import Selection
from rpscli.report.figures import (
    bearing,
    devices,
    floors,
    history,
    motions,
    orbit,
    structure,
    style,
)
from rpscli.report.figures import pushover as static
from rpscli.report.figures.look import FIGURES, USUAL, Draw, Look, figure_files
from rpscli.report.files import Content
from rpscli.report.table import Column, columns_of, csv_lines, csv_text
from rpscli.report.tables import motions as tables
from rpscli.report.tables.timehistory import fixed_base_demands, isolated_demands

Files = Iterator[tuple[str, str | Content]]  # names and contents


def _with_added(
    figures: Mapping[str, Draw], result: object, title: str, look: Look
) -> dict[str, Draw]:
    """Our figures, and those of other packages that are asked for."""

    def drawn(name: str) -> bytes:
        draw = FIGURES[name]
        with FIGURES.blaming(name):  # errors in its labels surface when it is saved
            return style.single(draw, result, (title, name), 3.4)

    return {**{name: partial(drawn, name) for name in look.added}, **figures}


def bearing_files(of: PodiumStructure, title: str, look: Look = USUAL) -> Files:
    """The drawing of the bearing."""
    draw = partial(bearing.bearing_figure, pushover(of, patterns=()), title)
    yield from figure_files({"bearing": draw}, look).items()


def modal_files(result: ModalResult, title: str, look: Look = USUAL) -> Files:
    """Files of a modal analysis."""
    yield "modes.csv", csv_text(mode_columns(result))
    yield "shapes.csv", csv_text(shape_columns(result))
    heads = {"state": "-", "mode": "-", "real": "1/s", "imaginary": "rad/s"}
    rows = [
        (name, index // 2, value.real, value.imag)  # two a mode, mode 0 is the storey's own
        for name, modes in result.uplifted.items()
        for index, value in enumerate(modes.eigenvalues.tolist())
    ]
    yield "eigenvalues.csv", csv_text(columns_of(heads, rows))
    figures: dict[str, Draw] = {"modes": partial(structure.modes_figure, result, title)}
    yield from figure_files(_with_added(figures, result, title, look), look).items()


def pushover_files(result: PushoverResult, title: str, look: Look = USUAL) -> Files:
    """Files of the static characteristics; without a building there are no capacity curves."""
    curve = [Column(q.name, q.unit, getattr(result.curve, q.name)) for q in STOREY_CURVE]
    yield "storey_curve.csv", csv_text(curve)  # one row a point, from the uplift on
    figures: dict[str, Draw] = {
        "bearing": partial(bearing.bearing_figure, result, title),
        "storey_curve": partial(static.storey_curve_figure, result, title),
    }
    if result.capacity:
        yield "capacity.csv", csv_text(capacity_columns(result.capacity))
        figures["capacity"] = partial(static.capacity_figure, result, title)
    yield from figure_files(_with_added(figures, result, title, look), look).items()


def timehistory_files(result: TimeHistoryResult, title: str, look: Look = USUAL) -> Files:
    """Files of a time history."""
    yield "timehistory.csv", csv_lines(history_columns(result))
    yield "events.csv", csv_text(event_columns(result.events))
    yield "storeys.csv", csv_text(storey_columns(result))
    figures: dict[str, Callable[..., bytes]] = {
        **({"storey_shears": floors.profile_figure} if result.structure.storeys else {}),
        **({"storey_loops": floors.loops_figure} if result.structure.yields else {}),
        **({"devices": devices.devices_figure} if result.structure.devices else {}),
        **({"column": bearing.column_figure} if result.column_demand is not None else {}),
        **({"orbit": orbit.orbit_figure} if result.trace.y is not None else {}),
        "rotation": history.rotation_figure,
        "displacements": history.displacement_figure,
        "moment_rotation": history.moment_figure,
        "energy": history.energy_figure,
    }
    few = history.thinned(result)
    draws = {
        # Maxima over the height are those of all samples.
        stem: partial(draw, result if stem == "storey_shears" else few, title)
        for stem, draw in figures.items()
    }
    yield from figure_files(_with_added(draws, result, title, look), look).items()


def floor_spectra_files(result: TimeHistoryResult, title: str, look: Look = USUAL) -> Files:
    """Spectra of the floors; none without a building."""
    if not result.structure.storeys:
        return
    isolated, fixed = isolated_floor_spectra(result), fixed_base_floor_spectra(result)
    yield "floor_spectra.csv", csv_text(floor_spectra_columns(isolated, fixed))
    record = f"{result.record.name}{', fixed base elastic' * result.structure.yields}"
    draw = partial(floors.floor_spectra_figure, isolated, fixed, title, record)
    yield from figure_files({"floor_spectra": draw}, look).items()


def record_files(motion: GroundMotion, spectrum: ResponseSpectrum, look: Look = USUAL) -> Files:
    """Files of a ground motion."""
    yield "record.csv", csv_lines(tables.motion_columns(motion))
    yield "spectrum.csv", csv_text(tables.spectrum_columns(spectrum))
    draw = partial(motions.record_figure, motion, spectrum)
    yield from figure_files({"record": draw}, look).items()


def selection_files(selection: Selection, folder: Path, look: Look = USUAL) -> Files:
    """Files of a choice of motions; the list names them as seen from the folder."""
    yield "selection.txt", tables.selection_list(selection, folder)
    yield "selection.csv", csv_text(tables.selection_columns(selection))
    yield "spectra.csv", csv_text(tables.mean_columns(selection))
    draw = partial(motions.selection_figure, selection, selection.target.name)
    yield from figure_files({"selection": draw}, look).items()


def mode_columns(result: ModalResult) -> list[Column]:
    """`modes.csv`: one row a vibration mode of each state; those uplifted in both orders."""
    heads = {"state": "-", "mode": "-", "frequency": "rad/s", "period": "s", "damping": "-"}
    heads |= {"frequency_ratio": "-", "damping_ratio": "-"}
    heads |= {"first_order_frequency": "rad/s", "first_order_damping": "-"}
    rows: list[tuple[Any, ...]] = []
    for state, modes, of_itself in (
        ("full_contact", result.full_contact, None),
        (result.fixed_base_state, result.fixed_base, 1.0),
        ("vertical", result.vertical, 1.0),
    ):
        pairs = np.transpose([modes.frequencies, modes.damping]).tolist() if modes else ()
        for i, (w, xi) in enumerate(pairs, 1):
            rows.append((state, i, w, 2.0 * math.pi / w, xi, of_itself, of_itself, None, None))
    for name, modes_of_state in result.vibrations():
        for i, (w, *others) in enumerate(modes_of_state.tolist(), 1):
            rows.append((name, i, w, 2.0 * math.pi / w, *others))
    return columns_of(heads, rows)


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


def capacity_columns(curves: tuple[CapacityCurve, ...]) -> list[Column]:
    """`capacity.csv`: the points of one load pattern after those of the other."""
    patterns = [curve.pattern for curve in curves for _ in curve.sum_of_floor_forces]
    heads = {"roof_displacement": "m", "cap_beam_displacement": "m", "sum_of_floor_forces": "N"}
    values = {name: np.concatenate([getattr(each, name) for each in curves]) for name in heads}
    return [
        Column("pattern", "-", patterns),
        *(Column(name, unit, values[name]) for name, unit in heads.items()),
    ]


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
    yielding = STOREYS_YIELDING if result.structure.yields else ()
    return columns + [Column(q.column, q.unit, getattr(result, q.name)) for q in yielding]


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
