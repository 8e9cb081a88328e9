"""Figures of results, drawn into axes of your own.

Each function draws one panel into the matplotlib Axes that it gets first, with labels and units;
titles, limits, colours and files are yours. `style` gives a figure the look of those that the
program writes.

>>> from rpscli import figures, load_case, pushover
>>> from matplotlib.figure import Figure
>>> axes = Figure().subplots()
>>> figures.storey_curve(axes, pushover(load_case("cases/rigid_frame.yaml").structure))
>>> axes.get_xlabel()
'cap beam displacement $u_b$ [m]'

After the axes come

- a `TimeHistoryResult` for `ground_acceleration`, `rotation`, `events`, `displacements`,
  `elastic_displacements`, `energy`, `moment`, `storey_shears`, `storey_drifts`,
  `floor_accelerations`, and `device`, which takes the number of the device too, from 0; under both
  horizontal components also `orbit` and `azimuth`, and displacements take ``"x"`` or ``"y"``;
- a `PushoverResult` for `storey_curve`, `lift` and `capacity`;
- a `ModalResult`, ``"rolling"`` or ``"rocking"``, and the number of the mode, for `mode`;
- a `PodiumStructure` for `structure`, and for `bearing`, which takes a rotation [rad] too; a
  `Bearing` for `bearing_end`;
- a `GroundMotion` for `motion`, and ``"velocity"`` or ``"displacement"`` in place of acceleration;
- response spectra for `spectrum` and `spectra`; floor spectra and the floor for `floor_spectrum`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from rpscli.errors import UsageError
from rpscli.report.figures.bearing import draw_bearing as bearing
from rpscli.report.figures.bearing import draw_end as bearing_end
from rpscli.report.figures.devices import draw_device as device
from rpscli.report.figures.floors import draw_accelerations as floor_accelerations
from rpscli.report.figures.floors import draw_floor_spectrum as floor_spectrum
from rpscli.report.figures.floors import draw_shears as storey_shears
from rpscli.report.figures.floors import draw_storey_drifts as storey_drifts
from rpscli.report.figures.history import draw_azimuth as azimuth
from rpscli.report.figures.history import draw_displacements as displacements
from rpscli.report.figures.history import draw_drifts as elastic_displacements
from rpscli.report.figures.history import draw_energy as energy
from rpscli.report.figures.history import draw_events as events
from rpscli.report.figures.history import draw_ground as ground_acceleration
from rpscli.report.figures.history import draw_moment as moment
from rpscli.report.figures.history import draw_rotation as rotation
from rpscli.report.figures.look import FIGURES
from rpscli.report.figures.motions import draw_motion as motion
from rpscli.report.figures.motions import draw_spectra as spectra
from rpscli.report.figures.motions import draw_spectrum as spectrum
from rpscli.report.figures.orbit import draw_orbit as orbit
from rpscli.report.figures.pushover import draw_capacity as capacity
from rpscli.report.figures.pushover import draw_force as storey_curve
from rpscli.report.figures.pushover import draw_lift as lift
from rpscli.report.figures.structure import draw_mode as mode
from rpscli.report.figures.structure import draw_structure as structure
from rpscli.report.figures.style import in_style as style

__all__ = [
    "azimuth",
    "bearing",
    "bearing_end",
    "capacity",
    "device",
    "displacements",
    "elastic_displacements",
    "energy",
    "events",
    "floor_accelerations",
    "floor_spectrum",
    "ground_acceleration",
    "lift",
    "mode",
    "moment",
    "motion",
    "orbit",
    "rotation",
    "spectra",
    "spectrum",
    "storey_curve",
    "storey_drifts",
    "storey_shears",
    "structure",
    "style",
]


def _examined(draw: Callable[..., None]) -> Callable[..., None]:
    """A panel that refuses other axes and another result than it is annotated with."""
    axes_name, drawn_name, *_ = (*draw.__annotations__.values(), "")

    @wraps(draw)
    def panel(axes: Any, drawn: Any, *arguments: Any, **named: Any) -> None:
        for value, name in ((axes, axes_name), (drawn, drawn_name)):
            kind = name.rpartition(".")[2]
            known = {parent.__name__ for parent in type(value).__mro__}
            if kind.isidentifier() and kind not in known:
                home = "matplotlib" if kind == "Axes" else "rpscli"
                raise UsageError(
                    f"{draw.__name__.replace('draw_', 'a panel of ')}: needs {kind} of {home}"
                    f" where a {type(value).__name__} was given; see help(rpscli.figures)"
                )
        draw(axes, drawn, *arguments, **named)

    return panel


def __getattr__(name: str) -> Any:
    """A panel that another package adds."""
    if not name.startswith("_") and name in FIGURES.names():
        return FIGURES[name]
    raise AttributeError(f"module 'rpscli.figures' has no attribute {name!r}")


for _name in __all__[: __all__.index("style")]:
    globals()[_name] = _examined(globals()[_name])
