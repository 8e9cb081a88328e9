"""Figures of results, drawn into axes of your own.

Each function draws one panel into the matplotlib Axes that it gets first, with labels and
units; titles, limits, colours and files are yours. ``legend=False`` leaves out the
legend. `style` gives a figure the look of those that the program writes.

>>> from rpscli import figures, load_case, pushover
>>> from matplotlib.figure import Figure
>>> axes = Figure().subplots()
>>> figures.storey_curve(axes, pushover(load_case("cases/rigid_frame.yaml").structure))
>>> axes.get_xlabel()
'cap beam displacement $u_b$ [m]'

After the axes come

- a `TimeHistoryResult` for `ground_acceleration`, `rotation`, `events`, `displacements`,
  `elastic_displacements`, `energy`, `moment_rotation`, `storey_shears`, `storey_drifts`,
  `floor_accelerations`, `device`, which takes the number of the device too, from 0, and
  `storey_loop`, which takes that of a storey that yields, from 1; under both horizontal
  components also `orbit` and `azimuth`, and displacements take ``"x"`` or ``"y"``;
- a `PushoverResult` for `storey_curve`, `lift` and `capacity`;
- a `ModalResult`, ``"rolling"`` or ``"rocking"``, and the number of the mode, for `mode`;
- a `PodiumStructure` for `structure`, and for `bearing`, which takes a rotation [rad]
  too; a `Bearing` for `bearing_end`;
- a `GroundMotion` for `motion`, and ``"velocity"`` or ``"displacement"``
  in place of acceleration;
- response spectra for `spectrum` and `spectra`; floor spectra and the
  floor for `floor_spectrum`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, signature
from typing import Any, TypeVar, cast

from rpscli.errors import UsageError, hint
from rpscli.report.figures import bearing as _bearing
from rpscli.report.figures import floors, history, motions
from rpscli.report.figures import structure as _structure
from rpscli.report.figures import style as _style
from rpscli.report.figures.look import FIGURES

Panel = TypeVar("Panel", bound=Callable[..., None])


def _examined(draw: Panel, *, shared: bool = False) -> Panel:
    """A panel that refuses other axes and another result than it is annotated with; a
    legend that it shares with others in our figures is its own here.
    """
    axes_name, drawn_name, *_ = (*draw.__annotations__.values(), "")

    @wraps(draw)
    def panel(
        axes: Any, drawn: Any, *arguments: Any, legend: bool = True, **named: Any
    ) -> None:
        for value, name in ((axes, axes_name), (drawn, drawn_name)):
            kind = name.rpartition(".")[2]
            known = {parent.__name__ for parent in type(value).__mro__}
            if kind.isidentifier() and kind not in known:
                home = "matplotlib" if kind == "Axes" else "rpscli"
                raise UsageError(
                    f"{draw.__name__.replace('draw_', 'a panel of ')}: needs {kind} of"
                    f" {home} where a {type(value).__name__} was given; see"
                    " help(rpscli.figures)"
                )
        draw(axes, drawn, *arguments, **named)
        if shared and legend:
            _style.legend_above(axes)
        _style.fit([axes])
        if not legend and (made := axes.get_legend()) is not None:
            made.remove()

    own = signature(draw)
    legend = Parameter("legend", Parameter.KEYWORD_ONLY, default=True, annotation="bool")
    made: Any = panel
    made.__signature__ = own.replace(parameters=[*own.parameters.values(), legend])
    return cast("Panel", panel)


azimuth = _examined(history.draw_azimuth)
bearing = _examined(_bearing.draw_bearing)
bearing_end = _examined(_bearing.draw_end)
capacity = _examined(_structure.draw_capacity)
device = _examined(_bearing.draw_device)
displacements = _examined(history.draw_displacements)
elastic_displacements = _examined(history.draw_drifts)
energy = _examined(history.draw_energy)
events = _examined(history.draw_events)
floor_accelerations = _examined(floors.draw_accelerations, shared=True)
floor_spectrum = _examined(floors.draw_floor_spectrum)
ground_acceleration = _examined(history.draw_ground)
lift = _examined(_structure.draw_lift)
mode = _examined(_structure.draw_mode)
moment_rotation = _examined(history.draw_moment)
motion = _examined(motions.draw_motion)
orbit = _examined(history.draw_orbit)
rotation = _examined(history.draw_rotation)
spectra = _examined(motions.draw_spectra)
spectrum = _examined(motions.draw_spectrum)
storey_curve = _examined(_structure.draw_force)
storey_drifts = _examined(floors.draw_storey_drifts, shared=True)
storey_loop = _examined(floors.draw_loop)
storey_shears = _examined(floors.draw_shears, shared=True)
structure = _examined(_structure.draw_structure)
style = _style.in_style

__all__ = [name for name, value in [*globals().items()] if hasattr(value, "__wrapped__")]


def __getattr__(name: str) -> Any:
    """A panel that another package adds."""
    if name == "moment":  # before
        return moment_rotation
    if not name.startswith("_") and name in FIGURES.names():
        return FIGURES[name]
    meant = hint(
        name, [*__all__, *FIGURES.names()], "help(rpscli.figures) lists all", 0.6
    )
    raise AttributeError(f"rpscli.figures has no panel {name}; {meant}")
