"""Files that each analysis leaves behind: columns of the CSV files, and figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from rpscli.analyses.floor_spectra import fixed_base_floor_spectra, isolated_floor_spectra
from rpscli.analyses.modal import ModalResult
from rpscli.analyses.pushover import PushoverResult, pushover
from rpscli.analyses.result_quantities import STOREY_CURVE, STOREYS, STOREYS_YIELDING
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.trace import Event, sampled
from rpscli.model.podium import PodiumStructure
from rpscli.registry import apart
from rpscli.report.figures import (
    bearing,
    floors,
    history,
    structure,
    style,
)
from rpscli.report.figures.look import FIGURES, USUAL, Look
from rpscli.report.figures.style import Draw, figure_files
from rpscli.report.figures.twist import twist_figure
from rpscli.report.files import Files
from rpscli.report.storey_demands import fixed_base_demands, isolated_demands
from rpscli.report.table import Column, columns_of, csv_lines, csv_text
from rpscli.report.twist import twist_columns, way_columns


def _figures(figures: Mapping[str, Draw], result: Any, title: str, look: Look) -> Files:
    """Our figures of a result, and those of other packages that are asked for."""

    def drawn(name: str, figure: style.Figure) -> None:
        with FIGURES.blaming(name):
            style.single(FIGURES[name], apart(result), (title, name), 3.4)(figure)
            figure.draw_without_rendering()  # errors in its labels surface here

    added = {name: partial(drawn, name) for name in look.added}
    yield from figure_files({**added, **figures}, look).items()


def bearing_files(of: PodiumStructure, title: str, look: Look = USUAL) -> Files:
    """The drawing of the bearing."""
    draw = partial(structure.bearing_figure, pushover(of, patterns=()), title)
    yield from figure_files({"bearing": draw}, look).items()


def modal_files(result: ModalResult, title: str, look: Look = USUAL) -> Files:
    """Files of a modal analysis."""
    yield "modes.csv", csv_text(mode_columns(result))
    yield "shapes.csv", csv_text(shape_columns(result))
    rows = [
        (
            name,
            index // 2,
            value.real,
            value.imag,
        )  # two a mode, mode 0 is the podium's own
        for name, modes in result.uplifted.items()
        for index, value in enumerate(modes.eigenvalues.tolist())
    ]
    heads = "state, mode, real [1/s], imaginary [rad/s]"
    yield "eigenvalues.csv", csv_text(columns_of(heads, rows))
    figures: dict[str, Draw] = {"modes": partial(structure.modes_figure, result, title)}
    yield from _figures(figures, result, title, look)


def pushover_files(result: PushoverResult, title: str, look: Look = USUAL) -> Files:
    """Files of the static characteristics; without a building
    there are no capacity curves.
    """
    curve = [Column(q.name, q.unit, getattr(result.curve, q.name)) for q in STOREY_CURVE]
    yield "storey_curve.csv", csv_text(curve)  # one row a point, from the uplift on
    figures: dict[str, Draw] = {
        "bearing": partial(structure.bearing_figure, result, title),
        "storey_curve": partial(structure.storey_curve_figure, result, title),
    }
    if result.capacity:
        heads = (
            "pattern, roof_displacement [m], cap_beam_displacement [m],"
            " sum_of_floor_forces [N]"
        )
        rows = [
            (each.pattern, *point)
            for each in result.capacity
            for point in zip(
                each.roof_displacement, each.cap_beam_displacement, each.sum_of_floor_forces,
                strict=True,
            )
        ]  # fmt: skip
        yield "capacity.csv", csv_text(columns_of(heads, rows))
        figures["capacity"] = partial(structure.capacity_figure, result, title)
    yield from _figures(figures, result, title, look)


def timehistory_files(result: TimeHistoryResult, title: str, look: Look = USUAL) -> Files:
    """Files of a time history."""
    yield "timehistory.csv", csv_lines(history_columns(result))
    yield "events.csv", csv_text(event_columns(result.events))
    yield "storeys.csv", csv_text(storey_columns(result))
    if result.twist is not None:
        yield "columns.csv", csv_text(twist_columns(result.twist))
        yield "twist.csv", csv_lines(way_columns(result.twist))
    of = result.structure
    of_pair = result.trace.y is not None
    words = title, history.record_name(result)
    along = ("along the tilt, where going round drives too",) * of_pair
    known = (
        ("storey_shears", floors.profile_figure, of.storeys),
        ("storey_loops", floors.loops_figure, of.yields),
        ("devices", bearing.devices_figure, of.devices),
        ("column", bearing.column_figure, result.column_demand),
        ("orbit", history.orbit_figure, of_pair),
        ("twist", twist_figure, result.twist),
        ("rotation", history.rotation_figure, True),
        ("displacements", history.displacement_figure, True),
    )
    figures: dict[str, Draw] = {
        **{stem: partial(draw, result, title) for stem, draw, there in known if there},
        "moment_rotation": style.single(
            history.draw_moment, result, (*words, *along), 4.2, 6.0
        ),
        "energy": style.single(history.draw_energy, result, words, 3.4),
    }
    yield from _figures(figures, result, title, look)


def floor_spectra_files(
    result: TimeHistoryResult, title: str, look: Look = USUAL
) -> Files:
    """Spectra of the floors, a row each and period from the bottom;
    none without a building.
    """
    if not result.structure.storeys:
        return
    isolated = isolated_floor_spectra(result)
    fixed = fixed_base_floor_spectra(result)
    count, periods = isolated.displacement.shape
    columns = [
        Column("floor", "-", np.repeat(np.arange(1, count + 1), periods)),
        Column("period", "s", np.tile(isolated.periods, count)),
    ]
    for prefix, of in {"": isolated, "fixed_base_": fixed}.items():
        if of is not None:
            acceleration = of.pseudo_acceleration.ravel()
            columns.append(Column(f"{prefix}pseudo_acceleration", "m/s2", acceleration))
            columns.append(Column(f"{prefix}displacement", "m", of.displacement.ravel()))
    yield "floor_spectra.csv", csv_text(columns)
    record = (
        f"{history.record_name(result)}{', fixed base elastic' * result.structure.yields}"
    )
    draw = partial(floors.floor_spectra_figure, isolated, fixed, title, record)
    yield from figure_files({"floor_spectra": draw}, look).items()


def mode_columns(result: ModalResult) -> list[Column]:
    """`modes.csv`: one row a vibration mode of each state; those
    uplifted in both orders.
    """
    heads = (
        "state, mode, frequency [rad/s], period [s], damping, frequency_ratio,"
        " damping_ratio"
    )
    heads += ", first_order_frequency [rad/s], first_order_damping"
    rows: list[tuple[Any, ...]] = []
    for state, modes, of_itself in (
        ("full_contact", result.full_contact, None),
        (result.fixed_base_state, result.fixed_base, 1.0),
        ("vertical", result.vertical, 1.0),
    ):
        pairs = np.transpose([modes.frequencies, modes.damping]).tolist() if modes else ()
        for i, (w, xi) in enumerate(pairs, 1):
            rows.append(
                (state, i, w, 2.0 * math.pi / w, xi, of_itself, of_itself, None, None)
            )
    for name, modes_of_state in result.vibrations():
        for i, (w, *others) in enumerate(modes_of_state.tolist(), 1):
            rows.append((name, i, w, 2.0 * math.pi / w, *others))
    return columns_of(heads, rows)


def shape_columns(result: ModalResult) -> list[Column]:
    """`shapes.csv`: one row a level of each mode; mode 0 is the
    podium's own, level 0 the beam.
    """
    profiles = {
        (name, 0): [*modes.profiles().values()] for name, modes in result.uplifted.items()
    }
    full = result.full_contact
    if result.fixed_base is not None:
        fixed = result.fixed_base.profiles()["shapes"]
        profiles = {(result.fixed_base_state, 1): [fixed, fixed], **profiles}
    if full is not None:
        elastic = full.shapes.T - full.shapes[0][:, None]
        profiles = {("full_contact", 1): [full.shapes.T, elastic], **profiles}
    rows = [
        (
            state,
            first + mode,
            level,
            float(shapes[mode, level]),
            float(elastic[mode, level]),
        )
        for (state, first), (shapes, elastic) in profiles.items()
        for mode, level in np.ndindex(*shapes.shape)
    ]
    return columns_of("state, mode, level, horizontal, elastic", rows)


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
    """`timehistory.csv`: one row a sample of the record, on
    through the free vibration.
    """
    return [Column(*each) for each in sampled(result.structure, result.trace)]


def event_columns(events: tuple[Event, ...]) -> list[Column]:
    """`events.csv`: one row an event, in the order of time."""
    units = {"time": "s", "kind": "-", "rotation": "rad"}
    units |= {
        "rotation_rate_before": "rad/s",
        "rotation_rate_after": "rad/s",
        "energy_lost": "J",
    }
    if any(event.azimuth is not None for event in events):
        units |= {
            "azimuth": "rad",
            "least_tilt": "rad",
            "nearness": "-",
            "loss_share": "-",
        }
    return [
        Column(name, of, [getattr(e, name) for e in events]) for name, of in units.items()
    ]
