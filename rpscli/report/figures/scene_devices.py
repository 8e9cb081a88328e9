"""Devices in pictures of the structure: stops beside the beam, tendons, braces with dampers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rpscli.model.devices import Device, FrictionDamper, Stop, Tendon, ViscousDamper
from rpscli.report.figures import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

Array = NDArray[np.float64]


class SceneDevices:
    """Posts stand at the gap of each stop, red and pushed aside beyond it; dampers share a brace.

    Parameters
    ----------
    axes
        Of the picture.
    devices
        Of the structure.
    feet
        Where the columns stand [m].
    half, base
        Half the width of the beam and the height of its underside at rest [m].
    """

    def __init__(
        self, axes: Axes, devices: Sequence[Device], feet: Array, half: float, base: float
    ) -> None:
        self.feet, self.half, self.base = feet, half, base
        self.stops: list[tuple[float, float, Line2D]] = [
            (side, device.gap, axes.plot([], [], lw=2.5)[0])
            for device in devices
            if isinstance(device, Stop)
            for side in (-1.0, 1.0)
        ]
        count = len(feet) if any(isinstance(device, Tendon) for device in devices) else 0
        self.tendons = [axes.plot([], [], color=style.RED, lw=1.0)[0] for _ in range(count)]
        braced = any(isinstance(device, ViscousDamper | FrictionDamper) for device in devices)
        look: dict[str, Any] = {"color": style.RED, "lw": 1.5, "marker": "s", "markevery": [1]}
        self.brace = axes.plot([], [], **look, ms=5.0)[0] if braced else None

    @property
    def moving(self) -> list[Line2D]:
        """All of them."""
        brace = [] if self.brace is None else [self.brace]
        return [*(post for _, _, post in self.stops), *self.tendons, *brace]

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
