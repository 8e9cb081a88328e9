"""Devices in the picture of the structure: stops beside the beam, tendons, braces with dampers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rpscli.model.devices import FrictionDamper, Stop, Tendon, ViscousDamper
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rpscli.analyses.results import TimeHistoryResult

Array = NDArray[np.float64]


class SceneDevices:
    """Posts stand at the gap of each stop, red while it pushes; all dampers share one brace.

    Parameters
    ----------
    axes
        Of the scene.
    result
        History with the forces of its devices.
    feet
        Where the columns stand [m].
    half, base
        Half the width of the beam and the height of its underside at rest [m].
    """

    def __init__(
        self, axes: Axes, result: TimeHistoryResult, feet: Array, half: float, base: float
    ) -> None:
        self.trace, devices = result.trace, result.structure.devices
        self.feet, self.half, self.base = feet, half, base
        self.stops = [
            (index, [self._post(axes, side * (half + device.gap), base) for side in (-1.0, 1.0)])
            for index, device in enumerate(devices)
            if isinstance(device, Stop)
        ]
        count = len(feet) if any(isinstance(device, Tendon) for device in devices) else 0
        self.tendons = [axes.plot([], [], color=style.RED, lw=1.0)[0] for _ in range(count)]
        braced = any(isinstance(device, ViscousDamper | FrictionDamper) for device in devices)
        look = {"color": style.RED, "lw": 1.5, "marker": "s", "markevery": [1], "ms": 5.0}
        self.brace = axes.plot([], [], **look)[0] if braced else None  # type: ignore[arg-type]

    @staticmethod
    def _post(axes: Axes, at: float, base: float) -> object:
        return axes.plot([at, at], [0.0, 1.25 * base], color=style.BLACK, lw=2.5)[0]

    def show(self, sample: int, shift: float, lift: float) -> None:
        """Move them to where they are at a sample."""
        for index, posts in self.stops:
            force = float(self.trace.devices.force[sample, index])
            for side, post in zip((-1.0, 1.0), posts, strict=True):
                pushes = force * side < 0.0
                post.set_color(style.RED if pushes else style.BLACK)  # type: ignore[attr-defined]
        for foot, tendon in zip(self.feet, self.tendons, strict=False):
            tendon.set_data([foot, foot + shift], [0.0, self.base + lift])
        if self.brace is not None:
            start, end = -0.75 * self.half, shift - 0.45 * self.half
            top = self.base + lift
            self.brace.set_data([start, 0.5 * (start + end), end], [0.0, 0.5 * top, top])
