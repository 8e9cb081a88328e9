"""Small results of every kind, pairs made of them, and what matplotlib has drawn of them."""

from dataclasses import fields, replace
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.trace import DirectionTrace
from rpscli.model.bearing import Bearing
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, Superstructure, profile_stiffnesses
from rpscli.records.loading import load_record
from rpscli.report.figures import style
from rpscli.report.figures.look import USUAL

CURVED = Bearing(1.5, 0.15, 0.30, 0.5)
ROLLER = Bearing(1.5, 0.15, 0.30, 0.25)  # overturns rolling
FLAT = Bearing(1.5, 0.15, 0.15, 0.0)

PREFIXES = {"": 1.0, "k": 1e-3, "M": 1e-6}


def building(storeys, *, heights=True):
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, 0.1 * storeys)
    known = np.full(storeys, 3.0) if heights else None
    return Superstructure(masses, stiffnesses, ModalDamping(0.05), known)


def yielding(storeys=2, hardening=0.05):
    """Storeys that yield below the shear at uplift."""
    above = replace(
        building(storeys), strengths=np.full(storeys, 2e5), hardening=hardening
    )
    return replace(structure(storeys=storeys), superstructure=above)


def structure(bearing=CURVED, storeys=2, *, heights=True):
    above = building(storeys, heights=heights) if storeys else None
    return PodiumStructure(bearing, 2e4, 2e5, above)


def history(made, pulse, free=0.5):
    return time_history(
        made, load_record(pulse), TimeHistorySettings(free_vibration=free)
    )


KINDS = {
    "rolls": lambda: history(structure(), "pulse:half_sine?amplitude=0.3g&period=0.6"),
    "at rest": lambda: history(structure(), "pulse:half_sine?amplitude=0.01g&period=0.6"),
    "overturns": lambda: history(
        structure(), "pulse:half_sine?amplitude=1.5g&period=1.5", None
    ),
    "flat, one storey, no heights": lambda: history(
        structure(FLAT, 1, heights=False), "pulse:half_sine?amplitude=0.4g&period=0.6"
    ),
    "yields": lambda: history(yielding(), "pulse:half_sine?amplitude=0.3g&period=0.6"),
    "frame": lambda: history(
        structure(FLAT, 0), "pulse:half_sine?amplitude=0.4g&period=0.6"
    ),
}


def drawn(function, *arguments, look=USUAL):
    """The figure that a function draws, with a look."""
    return style.drawn(partial(function, *arguments), look)


def curve(axes, label):
    """Abscissae and ordinates of the line with a label."""
    (line,) = [line for line in axes.lines if line.get_label() == label]
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def is_drawn(found, x, y):
    """Require that a line goes through points."""
    for drawn, wanted in zip(found, (x, y), strict=True):
        # but for the order of a product
        np.testing.assert_allclose(drawn, np.asarray(wanted, float), rtol=1e-13)


def legend(of):
    """Entries of the legend of axes or of a figure."""
    found = of.legends[0] if isinstance(of, Figure) else of.get_legend()
    assert found is not None
    return [text.get_text() for text in found.get_texts()]


def prefix(label, unit):
    """Factor of a prefixed unit in the brackets of an axis label."""
    name = label[label.rindex("[") + 1 : label.rindex("]")]
    assert name.endswith(unit)
    return PREFIXES[name.removesuffix(unit)]


def second_axis(axes):
    """The axis on the other side, with the limits that it is drawn with."""
    axes.get_figure().draw_without_rendering()
    (second,) = axes.child_axes
    return second


ANGLE = np.radians(140.0)
"""Of the plane of motion, from x towards y."""


def turned(kind="rolls", angle=ANGLE):
    """A history in a vertical plane at an azimuth (samples,) [rad], told in x and y."""
    plane = KINDS[kind]()
    trace = plane.trace
    names = [each.name for each in fields(DirectionTrace)]
    cosine, sine = np.broadcast_arrays(np.cos(angle), np.sin(angle), trace.time)[:2]

    def along(part):
        found = {name: getattr(trace, name) for name in names}
        shapes = {n: (-1, *[1] * (v.ndim - 1)) for n, v in found.items() if v is not None}
        return found | {n: part.reshape(shape) * found[n] for n, shape in shapes.items()}

    azimuth = np.arctan2(np.sign(trace.rotation) * sine, np.sign(trace.rotation) * cosine)
    pair = along(cosine) | {
        "rotation": np.abs(trace.rotation),
        "rotation_rate": np.sign(trace.rotation) * trace.rotation_rate,
        "azimuth": np.where(trace.rotation == 0.0, 0.0, azimuth),
        "y": DirectionTrace(**along(sine)),
    }
    x, y = (
        replace(plane.record, acceleration=plane.record.acceleration * part, name=name)
        for name, part in (("x", np.cos(ANGLE)), ("y", np.sin(ANGLE)))
    )
    events = tuple(
        replace(
            each,
            kind="pass",
            azimuth=ANGLE,
            least_tilt=3e-5,
            nearness=0.25,
            loss_share=0.5,
        )
        if each.kind == "impact"
        else each
        for each in plane.events
    )
    return replace(
        plane, record=x, motion=replace(plane.motion, horizontal=x, y=y), events=events,
        trace=replace(trace, **pair),
    )  # fmt: skip
