"""The structure at one instant of a time history, true to scale but for the storey drifts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.report.figures import style
from rpscli.report.figures.column_outline import leaning_outline
from rpscli.report.figures.devices import SceneDevices
from rpscli.report.figures.levels import level_heights

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from rpscli.analyses.results import TimeHistoryResult

Array = NDArray[np.float64]

BOX_ASPECT = 0.8
"""Height of the picture over its width."""

COLUMNS = 3
"""Columns that are drawn where there is a cap beam; the model does not know their number."""


class Scene:
    """The structure at one instant; `show` moves it to another."""

    def __init__(self, axes: Axes, result: TimeHistoryResult, title: str, speed: float) -> None:
        self.result = result
        self.levels = level_heights(result.structure)
        self.magnification = _magnification(result, self.levels)
        structure = result.structure
        height = 2.0 * structure.bearing.half_height
        self.width = 1.6 * max(height, 0.35 * float(self.levels[-1]))
        count = COLUMNS if structure.cap_beam_mass > 0.0 else 1
        self.feet = np.linspace(-0.4, 0.4, count) * self.width if count > 1 else np.zeros(1)
        self.thickness = 0.12 * height
        self.columns = [
            axes.fill([], [], fc="#C9C9C9", ec=style.BLACK, lw=0.8)[0] for _ in self.feet
        ]
        look: dict[str, Any] = {"color": style.BLACK, "lw": 1.0}
        self.beam = axes.fill([], [], fc=style.BLUE, ec=style.BLACK, lw=0.8)[0]
        self.floors = [axes.plot([], [], color=style.BLUE, lw=3.0)[0] for _ in self.levels[1:]]
        self.sides = [axes.plot([], [], **look)[0] for _ in (-1, 1)] if self.floors else []
        base = float(self.levels[0])
        self.devices = SceneDevices(axes, structure.devices, self.feet, 0.5 * self.width, base)
        self.clock = axes.set_title("", loc="right", fontsize=style.small())
        axes.figure.suptitle(title, fontsize=style.small(), parse_math=False)
        axes.axhline(0.0, color=style.BLACK, lw=1.0)
        axes.set_xlabel(self._legend(speed), fontsize=style.small())
        self._frame(axes)

    @property
    def moving(self) -> list[Artist]:
        """What `show` moves."""
        parts = [*self.columns, self.beam, *self.sides, *self.floors, *self.devices.moving]
        return [*parts, self.clock]

    def _legend(self, speed: float) -> str:
        drifts = f"; storey drifts x {self.magnification:g}" if self.floors else ""
        return f"bearings to scale{drifts}; {_pace(speed)}"

    def _frame(self, axes: Axes) -> None:
        trace = self.result.trace
        shift = float(np.nanmax(np.abs(trace.cap_beam_displacement)))
        reach = 0.5 * self.width + shift + 0.12 * float(self.levels[-1])
        top = float(self.levels[-1] + np.nanmax(trace.lift)) + 2.0 * self.thickness
        height = max(1.1 * top, 2.0 * reach * BOX_ASPECT)
        axes.set_xlim(-0.5 * height / BOX_ASPECT, 0.5 * height / BOX_ASPECT)
        axes.set_ylim(-0.06 * top, height - 0.06 * top)
        axes.set_box_aspect(BOX_ASPECT)  # with these limits, a metre is as high as it is wide
        axes.set_yticks([])
        axes.set_xticks([])
        axes.grid(visible=False)

    def show(self, sample: int) -> None:
        """Move everything to where it is at a sample."""
        trace, bearing = self.result.trace, self.result.structure.bearing
        shift, lift = float(trace.cap_beam_displacement[sample]), float(trace.lift[sample])
        outline = leaning_outline(bearing, float(trace.rotation[sample]), shift, lift)
        for foot, column in zip(self.feet, self.columns, strict=True):
            column.set_xy(outline + np.array([foot, 0.0]))
        base = float(self.levels[0]) + lift
        half = 0.5 * self.width
        if len(self.feet) > 1:
            top = base + self.thickness
            corners = [(-half, base), (half, base), (half, top), (-half, top)]
            self.beam.set_xy(np.array(corners) + np.array([shift, 0.0]))
        if self.floors:
            drift = trace.floor_displacements[sample] - shift
            x = np.concatenate([[shift], shift + self.magnification * drift])
            y = self.levels + lift + self.thickness
            for floor, (at, height) in zip(
                self.floors, zip(x[1:], y[1:], strict=True), strict=True
            ):
                floor.set_data([at - half, at + half], [height, height])
            for side, line in zip((-half, half), self.sides, strict=True):
                line.set_data(x + side, y)
        self.devices.show(shift, lift)
        self.clock.set_text(f"t = {trace.time[sample]:.2f} s")


def _pace(speed: float) -> str:
    """How fast a film runs, in words.

    >>> _pace(2.13), _pace(1.0), _pace(0.5)
    ('2.1 times faster than real', 'in real time', '2 times slower than real')
    """
    if f"{speed:.2g}" == "1":
        return "in real time"
    return f"{max(speed, 1.0 / speed):.2g} times {'faster' if speed > 1.0 else 'slower'} than real"


def _magnification(result: TimeHistoryResult, levels: Array) -> float:
    """A round number that lets the largest drift of the roof be seen."""
    trace = result.trace
    if not result.structure.storeys:
        return 1.0
    drift = trace.floor_displacements[:, -1] - trace.cap_beam_displacement
    wanted = 0.1 * (levels[-1] - levels[0]) / max(float(np.nanmax(np.abs(drift))), 1e-12)
    return float(next((m for m in (100, 50, 20, 10, 5, 2) if m <= wanted), 1))
