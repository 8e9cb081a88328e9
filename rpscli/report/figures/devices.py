"""Devices in figures: how each law is drawn in pictures of the structure, and their loops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.model import devices as laws
from rpscli.model.podium import Device
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.lines import Line2D

Array = NDArray[np.float64]

BRACE, POSTS, CABLES, NOWHERE = range(4)  # signs for devices in pictures of the structure


class Drawn(NamedTuple):
    """The drawing of a law; resistance, the force on the cap beam turned round, has the sign -1."""

    scene: int
    force: str = "resistance"
    stroke: str = "$u_b$ [m]"
    sign: float = -1.0


DRAWN: dict[type[Device], Drawn] = {
    laws.ViscousDamper: Drawn(BRACE),
    laws.FrictionDamper: Drawn(BRACE),
    laws.OwnDamper: Drawn(BRACE),
    laws.Stop: Drawn(POSTS),
    laws.Tendon: Drawn(CABLES, "tension of one", "elongation of one [m]", 1.0),
    laws.RollingResistance: Drawn(NOWHERE),
}
"""All laws; the one place that a new one is drawn from."""


def devices_figure(result: TimeHistoryResult, title: str) -> bytes:
    """The loops of all devices."""
    count = len(result.structure.devices)
    columns = min(count, 2 if style.narrow() else 3)
    rows = -(-count // columns)

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, result.record.name, result.sampling)
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for index, axes in enumerate(panels[:count]):
            draw_device(axes, result, index)
        style.blank(panels[count:])

    return style.picture(draw, 0.5 + 2.7 * rows, max(2.6 * columns, 4.0))


def draw_device(axes: style.Axes, result: TimeHistoryResult, index: int) -> None:
    """Resistance of a device against displacement, of tendons tension against elongation."""
    style.require("devices", index, range(len(result.structure.devices)))
    trace, device = result.trace.devices, result.structure.devices[index]
    drawn = DRAWN[type(device)]
    force = drawn.sign * trace.force[:, index]
    factor, prefix = style.engineering(float(np.nanmax(np.abs(force), initial=0.0)))
    axes.plot(trace.displacement[:, index], factor * force, color=style.BLUE, lw=0.8)
    style.cross(axes)
    axes.set_title(f"device {index}: {device.kind.replace('_', ' ')}", fontsize=style.small())
    stroke = drawn.stroke if result.motion.y is None else drawn.stroke.replace("u_b", "|u_b|")
    axes.set(xlabel=stroke, ylabel=f"{drawn.force} [{prefix}N]")
    axes.locator_params(axis="x", nbins=3 if style.narrow() else 5)


class SceneDevices:
    """Devices in pictures of the structure, moved with the cap beam; a legend has their names."""

    # Posts stand at the gap of each stop, red and pushed aside beyond it; dampers share a brace;
    # cables stand where the feet of the columns do. `half` is half the width of the beam, `base`
    # the height of its underside at rest [m].
    def __init__(
        self, axes: style.Axes, devices: Sequence[Device], feet: Array, half: float, base: float
    ) -> None:
        self.feet, self.half, self.base = feet, half, base
        by_scene: dict[int, list[Any]] = {BRACE: [], POSTS: [], CABLES: [], NOWHERE: []}
        for device in devices:
            by_scene[DRAWN[type(device)].scene].append(device)
        self.stops: list[tuple[float, float, Line2D]] = [
            (side, stop.gap, axes.plot([], [], color=style.BLACK, lw=2.5, label="stop")[0])
            for stop in by_scene[POSTS]
            for side in (-1.0, 1.0)
        ]
        cable: dict[str, Any] = {"color": style.PINK, "lw": 1.5, "label": "tendon"}
        count = len(feet) if by_scene[CABLES] else 0
        self.tendons = [axes.plot([], [], **cable)[0] for _ in range(count)]
        kinds = dict.fromkeys(device.kind.replace("_", " ") for device in by_scene[BRACE])
        look: dict[str, Any] = {"color": style.GREEN, "lw": 1.5, "marker": "s", "markevery": [1]}
        look["label"] = f"{' and '.join(kinds)} damper"
        self.brace = axes.plot([], [], **look, ms=5.0)[0] if kinds else None
        brace = [] if self.brace is None else [self.brace]
        self.moving = [*(post for _, _, post in self.stops), *self.tendons, *brace]

    def show(self, shift: float, lift: float) -> None:
        """Move them with the cap beam, displaced and lifted [m]."""
        for side, gap, post in self.stops:
            at, pushed = side * (self.half + gap), max(side * shift - gap, 0.0)
            post.set_data([at, at + side * pushed], [0.0, 1.06 * self.base])
            post.set_color(style.RED if pushed else style.BLACK)
        for foot, tendon in zip(self.feet, self.tendons, strict=False):
            tendon.set_data([foot, foot + shift], [0.0, self.base + lift])
        if self.brace is not None:
            start, end = -0.75 * self.half, shift - 0.45 * self.half
            top = self.base + lift
            self.brace.set_data([start, 0.5 * (start + end), end], [0.0, 0.5 * top, top])
