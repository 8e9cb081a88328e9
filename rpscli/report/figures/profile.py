"""Demands over the height of the building, isolated and on a fixed base."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures import style
from rpscli.report.tables.storeys import StoreyDemands, fixed_base_demands, isolated_demands

Array = NDArray[np.float64]

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rpscli.analyses.results import TimeHistoryResult

ISOLATED: dict[str, Any] = {"color": style.BLUE, "label": "on bearings"}
FIXED: dict[str, Any] = {"color": style.BLACK, "ls": "--", "label": "fixed base"}


def profile_figure(result: TimeHistoryResult, title: str) -> bytes:
    """Largest storey shears (kN, and over V_st), drifts and floor accelerations."""
    series = [(isolated_demands(result), ISOLATED)]
    if (fixed := fixed_base_demands(result)) is not None:
        series.append((fixed, FIXED))

    def draw(figure: Figure) -> None:
        style.heading(figure, title, result.record.name)
        shear, drift, acceleration = figure.subplots(1, 3, sharey=True)
        for demands, look in series:
            _stairs(shear, demands.shear * 1e-3, look)
            _stairs(drift, _drift(demands)[0], look)
            floors = np.arange(1, result.structure.storeys + 1)
            acceleration.plot(demands.floor_acceleration, floors, marker="o", ms=3.5, **look)
        shear.set_xlabel(style.folded(figure, "storey shear [kN]"))
        static = result.structure.static_base_shear * 1e-3
        ratio = shear.secondary_xaxis("top", functions=style.over(static))
        ratio.set_xlabel("$V_i/V_{st}$ [-]")
        drift.set_xlabel(style.folded(figure, _drift(series[0][0])[1]))
        acceleration.set_xlabel(style.folded(figure, "floor acceleration [m/s²]"))
        acceleration.axvline(result.record.pga, color=style.GREY, lw=0.9, ls=":", label="PGA")
        _levels(shear, result.structure.storeys)
        for axes in (shear, drift, acceleration):
            axes.set_xlim(left=0.0)
        handles, names = acceleration.get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=3)

    return style.picture(draw, 4.2)


def _stairs(axes: Axes, values: Array, look: dict[str, Any]) -> None:
    # The shear is the same all the way up a storey: storey i reaches from level i - 1 to i.
    axes.stairs(values, np.arange(len(values) + 1), orientation="horizontal", **look, lw=1.3)


def _drift(demands: StoreyDemands) -> tuple[Array, str]:
    if demands.drift_ratio is None:
        return demands.drift * 1e3, "storey drift [mm]"
    return demands.drift_ratio * 100.0, "storey drift ratio [%]"


def _levels(axes: Axes, storeys: int) -> None:
    step = max(1, storeys // 10)
    axes.set_ylim(0.0, storeys + 0.15)
    axes.set_yticks(range(0, storeys + 1, step))
    axes.set_ylabel("level (0 = cap beam)")
