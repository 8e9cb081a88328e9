"""Which files each analysis leaves behind."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path

from rpscli.analyses.floor_spectra import fixed_base_floor_spectra, isolated_floor_spectra
from rpscli.analyses.modal import ModalResult
from rpscli.analyses.pushover import PushoverResult, pushover
from rpscli.analyses.results import TimeHistoryResult
from rpscli.model.podium import PodiumStructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.selection import Selection
from rpscli.records.spectrum import ResponseSpectrum
from rpscli.report.figures import style
from rpscli.report.figures.bearing import bearing_figure
from rpscli.report.figures.devices import devices_figure
from rpscli.report.figures.floors import floor_spectra_figure, profile_figure
from rpscli.report.figures.history import (
    displacement_figure,
    energy_figure,
    moment_figure,
    rotation_figure,
    thinned,
)
from rpscli.report.figures.look import FIGURES, USUAL, Draw, Look, figure_files
from rpscli.report.figures.motions import record_figure, selection_figure
from rpscli.report.figures.orbit import orbit_figure
from rpscli.report.figures.pushover import capacity_figure, storey_curve_figure
from rpscli.report.figures.structure import modes_figure
from rpscli.report.files import Content
from rpscli.report.table import csv_lines, csv_text
from rpscli.report.tables.analyses import (
    capacity_columns,
    eigenvalue_columns,
    event_columns,
    floor_spectra_columns,
    history_columns,
    mode_columns,
    shape_columns,
    storey_columns,
    storey_curve_columns,
)
from rpscli.report.tables.motions import (
    mean_columns,
    motion_columns,
    selection_columns,
    selection_list,
    spectrum_columns,
)

Files = Iterator[tuple[str, str | Content]]
"""Names and contents."""


def _with_added(
    figures: Mapping[str, Draw], result: object, title: str, look: Look
) -> dict[str, Draw]:
    """Our figures, and those of other packages that are asked for."""
    added = {
        name: partial(style.single, FIGURES[name], result, (title, name), 3.4)
        for name in look.added
    }
    return {**added, **figures}


def bearing_files(structure: PodiumStructure, title: str, look: Look = USUAL) -> Files:
    """The drawing of the bearing."""
    draw = partial(bearing_figure, pushover(structure, patterns=()), title)
    yield from figure_files({"bearing": draw}, look).items()


def modal_files(result: ModalResult, title: str, look: Look = USUAL) -> Files:
    """Files of a modal analysis."""
    yield "modes.csv", csv_text(mode_columns(result))
    yield "shapes.csv", csv_text(shape_columns(result))
    yield "eigenvalues.csv", csv_text(eigenvalue_columns(result))
    figures = _with_added({"modes": partial(modes_figure, result, title)}, result, title, look)
    yield from figure_files(figures, look).items()


def pushover_files(result: PushoverResult, title: str, look: Look = USUAL) -> Files:
    """Files of the static characteristics; without a building there are no capacity curves."""
    yield "storey_curve.csv", csv_text(storey_curve_columns(result.curve))
    figures: dict[str, Draw] = {
        "bearing": partial(bearing_figure, result, title),
        "storey_curve": partial(storey_curve_figure, result, title),
    }
    if result.capacity:
        yield "capacity.csv", csv_text(capacity_columns(result.capacity))
        figures["capacity"] = partial(capacity_figure, result, title)
    yield from figure_files(_with_added(figures, result, title, look), look).items()


def timehistory_files(result: TimeHistoryResult, title: str, look: Look = USUAL) -> Files:
    """Files of a time history."""
    yield "timehistory.csv", csv_lines(history_columns(result))
    yield "events.csv", csv_text(event_columns(result.events))
    yield "storeys.csv", csv_text(storey_columns(result))
    figures: dict[str, Callable[..., bytes]] = {
        **({"storey_shears": profile_figure} if result.structure.storeys else {}),
        **({"devices": devices_figure} if result.structure.devices else {}),
        **({"orbit": orbit_figure} if result.trace.y is not None else {}),
        "rotation": rotation_figure,
        "displacements": displacement_figure,
        "moment_rotation": moment_figure,
        "energy": energy_figure,
    }
    few = thinned(result)
    draws = {stem: partial(draw, few, title) for stem, draw in figures.items()}
    yield from figure_files(_with_added(draws, result, title, look), look).items()


def floor_spectra_files(result: TimeHistoryResult, title: str, look: Look = USUAL) -> Files:
    """Spectra of the floors; none without a building."""
    if not result.structure.storeys:
        return
    isolated, fixed = isolated_floor_spectra(result), fixed_base_floor_spectra(result)
    yield "floor_spectra.csv", csv_text(floor_spectra_columns(isolated, fixed))
    draw = partial(floor_spectra_figure, isolated, fixed, title, result.record.name)
    yield from figure_files({"floor_spectra": draw}, look).items()


def record_files(motion: GroundMotion, spectrum: ResponseSpectrum, look: Look = USUAL) -> Files:
    """Files of a ground motion."""
    yield "record.csv", csv_lines(motion_columns(motion))
    yield "spectrum.csv", csv_text(spectrum_columns(spectrum))
    yield from figure_files({"record": partial(record_figure, motion, spectrum)}, look).items()


def selection_files(selection: Selection, folder: Path, look: Look = USUAL) -> Files:
    """Files of a choice of motions; the list names them as seen from the folder."""
    yield "selection.txt", selection_list(selection, folder)
    yield "selection.csv", csv_text(selection_columns(selection))
    yield "spectra.csv", csv_text(mean_columns(selection))
    draw = partial(selection_figure, selection, selection.target.name)
    yield from figure_files({"selection": draw}, look).items()
