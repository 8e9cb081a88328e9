"""Loops of storeys that yield: shear over drift, storeys side by side."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.floors import shown_floors
from rpscli.report.figures.history import record_name

MOST_STOREYS = 6  # in the picture; columns of timehistory.csv have all


def loops_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Shear over drift of storeys from the first one up, to one scale."""
    storeys = shown_floors(result.structure.storeys, MOST_STOREYS)
    columns = min(len(storeys), 2 if style.narrow() else 3)
    rows = -(-len(storeys) // columns)

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, record_name(result), result.sampling)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes, storey in zip(grid.flat, storeys, strict=False):
            draw_loop(axes, result, storey)
        for axes in grid.flat[len(storeys) :]:
            axes.set_visible(False)
        for place, axes in enumerate(grid.flat):
            if place % columns:
                axes.set_ylabel("")
            if place + columns < len(storeys):
                axes.set_xlabel("")
            else:  # the last one of its column, maybe above a place that stays empty
                axes.xaxis.set_tick_params(labelbottom=True)
        style.legend_below(figure, grid.flat)

    return style.picture(draw, 0.9 + 2.1 * rows)


def draw_loop(axes: style.Axes, result: TimeHistoryResult, storey: int) -> None:
    """Shear of a storey, counted from 1, over its drift, and the lines on which it yields."""
    structure, trace = result.structure, result.trace
    if not structure.yields:
        raise UsageError("a panel of loop: needs storeys that yield, superstructure.yield")
    style.require("storeys", storey, range(1, structure.storeys + 1))
    place, seen = storey - 1, [structure, structure.across][: 1 if trace.y is None else 2]
    strongest = max(float(of.superstructure.strengths.max()) for of in seen)  # type: ignore[union-attr]
    factor, prefix = style.engineering(strongest)
    looks = (style.BLUE, "in x"), (style.RED, "in y")
    for of, way, (colour, name) in zip((trace, trace.y), seen, looks, strict=False):
        building = way.superstructure
        assert of is not None and building is not None and building.strengths is not None  # noqa: PT018
        drifts, shears = 1e3 * of.drifts[:, place], factor * of.storey_shears[:, place]
        k, F = factor * building.stiffnesses[place], factor * building.strengths[place]
        reach = 1e3 * max(float(np.abs(of.drifts[:, place]).max()), 1.2 * F / k)
        for side in (-1.0, 1.0):
            ends = np.array([-reach, reach])
            line = building.hardening * 1e-3 * k * ends + (1.0 - building.hardening) * side * F
            known = "yields" if side > 0.0 and way is structure else None
            axes.plot(ends, line, color=style.GREY, lw=0.8, ls="--", label=known)
        label = name if trace.y is not None else "shear $f$ of springs"
        axes.plot(drifts, shears, color=colour, lw=0.8, label=label)
    ductility = float(result.ductilities[place])
    axes.set_title(f"storey {storey}, ductility {ductility:.3g}")
    axes.set(xlabel="storey drift $d$ [mm]", ylabel=f"storey shear $f$ [{prefix}N]")
