"""Demands and floor spectra over the height of the building;
loops of storeys that yield.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.floor_spectra import FloorSpectra
from rpscli.analyses.result_quantities import (
    FLOOR_ACCELERATIONS,
    STOREY_DRIFT_RATIOS,
    STOREY_DRIFTS,
    STOREY_SHEARS,
)
from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.history import record_name
from rpscli.report.storey_demands import (
    StoreyDemands,
    fixed_base_demands,
    isolated_demands,
)

Array = NDArray[np.float64]


# The shear is the same all the way up a storey: storey i reaches from level i - 1 to i.
STAIRS: dict[str, Any] = {"orientation": "horizontal", "lw": 1.3}
ISOLATED: dict[str, Any] = {"color": style.BLUE, "label": "on bearings"}
FIXED: dict[str, Any] = {"color": style.BLACK, "ls": "--", "label": "fixed base"}


def profile_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """Largest storey shears beside V_st, drifts and floor accelerations."""
    resultants = "largest resultants" if result.trace.y is not None else ""
    style.begin(figure, (title, record_name(result), resultants), 4.2)
    draws = draw_shears, draw_storey_drifts, draw_accelerations
    panels = style.grid(
        figure, [partial(each, result=result) for each in draws], 3, sharey=True
    )
    style.legend_below(figure, (panels[-1], panels[0]))


def draw_shears(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Largest storey shears, and V_st."""
    series = [*_series(result)]
    factor, prefix = style.engineering(
        max(float(of.storey_shears.max()) for of, _ in series)
    )
    for demands, look in series:
        axes.stairs(demands.storey_shears * factor, **STAIRS, **look)
    axes.set_xlabel(STOREY_SHEARS.in_unit(f"{prefix}N"))
    static = result.structure.static_base_shear * factor
    if static > 0.0:
        label = f"$V_{{st}}$ = {static:.4g} {prefix}N"
        axes.axvline(static, color=style.GREEN, lw=0.9, ls="-.", label=label)
    _levels(axes, result.structure.storeys)


def draw_storey_drifts(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Largest storey drifts, as a part of the storey heights where these are known."""
    for demands, look in _series(result):
        values = demands.storey_drifts * 1e3
        label = STOREY_DRIFTS.in_unit("mm")
        if demands.storey_drift_ratios is not None:
            values = demands.storey_drift_ratios * 100.0
            label = STOREY_DRIFT_RATIOS.in_unit("%")
        axes.stairs(values, **STAIRS, **look)
        axes.set_xlabel(label)
    _levels(axes, result.structure.storeys)


def draw_accelerations(axes: style.Axes, result: TimeHistoryResult) -> None:
    """Largest absolute floor accelerations, and the ground's."""
    floors = np.arange(1, result.structure.storeys + 1)
    for demands, look in _series(result):
        axes.plot(demands.floor_accelerations, floors, marker="o", ms=3.5, **look)
    # The samples of a vertical component would stand behind those of both.
    both = result.motion.samples[: 1 if result.motion.y is None else 2]
    pga = float(np.linalg.norm(both, axis=0).max())
    of = "PGA" if len(both) == 1 else "PGA, resultant"
    axes.axvline(pga, color=style.GREY, lw=0.9, ls=":", label=f"{of} = {pga:.3g} m/s²")
    axes.set_xlabel(FLOOR_ACCELERATIONS.axis_label)
    _levels(axes, result.structure.storeys)


def _series(result: TimeHistoryResult) -> Iterator[tuple[StoreyDemands, dict[str, Any]]]:
    yield isolated_demands(result), ISOLATED
    if (fixed := fixed_base_demands(result)) is not None:
        yields = (
            {"label": f"{FIXED['label']}, elastic"} if result.structure.yields else {}
        )
        yield fixed, FIXED | yields


def _levels(axes: style.Axes, storeys: int) -> None:
    axes.set(xlim=(0.0, None), ylim=(0.0, storeys + 0.15), ylabel="level (0 = cap beam)")
    axes.set_yticks(range(0, storeys + 1, max(1, storeys // 10)))


SPECTRA = {
    "pseudo_acceleration": "pseudo-acceleration [m/s²]",
    "displacement": "spectral displacement [m]",
}
MOST_FLOORS = 3  # in the picture; the table has all


def shown_floors(count: int, most: int = MOST_FLOORS) -> list[int]:
    """Numbers of the floors that are drawn, from 1: the lowest,
    some between and the roof.
    """
    floors = np.linspace(1.0, count, min(count, most))
    return [int(floor + 0.5) for floor in floors]


def floor_spectra_figure(
    isolated: FloorSpectra,
    fixed: FloorSpectra | None,
    title: str,
    record: str,
    figure: style.Figure,
) -> None:
    """Pseudo-acceleration above, displacement below; one column a floor."""
    floors = shown_floors(len(isolated.displacement))
    damping = f"{style.percent(isolated.damping)} damping"
    style.begin(figure, (title, record, damping, "steps of 1 ms or less"), 4.8)
    draws = [
        partial(
            draw_floor_spectrum, isolated=isolated, fixed=fixed, floor=floor, name=name
        )
        for name in SPECTRA
        for floor in floors
    ]
    panels = style.grid(figure, draws, len(floors), sharex=True, sharey="row")
    for axes, floor in zip(panels, floors, strict=False):
        axes.set_title(f"floor {floor}")
    for axes in panels[
        :: len(floors)
    ]:  # once all are drawn, since a row shares its limits
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel(axes.get_ylabel().partition(", ")[2])
    style.legend_below(figure, panels)


def draw_floor_spectrum(
    axes: style.Axes,
    isolated: FloorSpectra,
    fixed: FloorSpectra | None,
    floor: int,
    name: str = "pseudo_acceleration",
) -> None:
    """The spectrum of a floor, counted from 1, or its
    `displacement`; beside the fixed base.
    """
    place = floor - 1
    style.require("floors", floor, range(1, len(isolated.displacement) + 1))
    axes.plot(isolated.periods, getattr(isolated, name)[place], **ISOLATED)
    if fixed is not None:
        axes.plot(fixed.periods, getattr(fixed, name)[place], **FIXED)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set(xlim=(isolated.periods[0], isolated.periods[-1]), xlabel="period [s]")
    axes.set_ylabel(f"floor {floor}, {SPECTRA[name]}")


MOST_STOREYS = {True: 8, False: 9}
"""In the picture, in a narrow one and a wide one: as many as a page has room for. Columns
of timehistory.csv have all."""


def loops_figure(result: TimeHistoryResult, title: str, figure: style.Figure) -> None:
    """Shear over drift of storeys from the first one up, to one scale."""
    narrow = style.narrow(figure)
    storeys = shown_floors(result.structure.storeys, MOST_STOREYS[narrow])
    columns = min(len(storeys), 2 if narrow else 3)
    rows = -(-len(storeys) // columns)
    words = [title, record_name(result), result.sampling]
    if len(storeys) < result.structure.storeys:
        words.append(f"{len(storeys)} of {result.structure.storeys} storeys")
    style.begin(figure, words, 0.9 + 2.1 * rows)
    draws = [partial(draw_loop, result=result, storey=storey) for storey in storeys]
    style.legend_below(
        figure, style.grid(figure, draws, columns, sharex=True, sharey=True)
    )


def draw_loop(axes: style.Axes, result: TimeHistoryResult, storey: int) -> None:
    """Shear of a storey, counted from 1, over its drift, and the
    lines on which it yields.
    """
    structure = result.structure
    trace = result.trace
    if not structure.yields:
        raise UsageError(
            "a panel of loop: needs storeys that yield, superstructure.yield"
        )
    style.require("storeys", storey, range(1, structure.storeys + 1))
    place = storey - 1
    seen = [structure, structure.across][: 1 if trace.y is None else 2]
    strongest = max(float(of.superstructure.strengths.max()) for of in seen)  # type: ignore[union-attr]
    factor, prefix = style.engineering(strongest)
    looks = (style.BLUE, "in x"), (style.RED, "in y")
    for of, way, (colour, name) in zip((trace, trace.y), seen, looks, strict=False):
        building = way.superstructure
        assert of is not None and building is not None and building.strengths is not None  # noqa: PT018
        drifts = 1e3 * of.drifts[:, place]
        shears = factor * of.storey_shears[:, place]
        k = factor * building.stiffnesses[place]
        F = factor * building.strengths[place]
        reach = 1e3 * max(float(np.abs(of.drifts[:, place]).max()), 1.2 * F / k)
        for side in (-1.0, 1.0):
            ends = np.array([-reach, reach])
            line = (
                building.hardening * 1e-3 * k * ends
                + (1.0 - building.hardening) * side * F
            )
            known = "yields" if side > 0.0 and way is structure else None
            axes.plot(ends, line, color=style.GREY, lw=0.8, ls="--", label=known)
        label = name if trace.y is not None else "shear $f$ of springs"
        axes.plot(drifts, shears, color=colour, lw=0.8, label=label)
    ductility = float(result.ductilities[place])
    axes.set_title(f"storey {storey}, ductility {ductility:.3g}")
    axes.set(xlabel="storey drift $d$ [mm]", ylabel=f"storey shear $f$ [{prefix}N]")
