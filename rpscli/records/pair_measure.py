"""What a pair of horizontal components measures: one number for all directions between them.

A measure of one component depends on how the sensors stood. Of a pair it is taken over the 180
directions 0, 1, ... 179 deg from the first component towards the second: `over_directions` has a
measure, `spectra_over_directions` spectra, and `of_directions` makes one number of them:

* ``rotd50``: the median over the directions, ``rotd100``: the largest (D. M. Boore, Bull. Seism.
  Soc. Am. 100, 2010; directions count by themselves at each period);
* ``geomean``: the geometric mean of both components as they were recorded, ``larger``: the larger
  of both, ``x``: the first one.

``component`` is no measure of a pair: each component by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import AVERAGED, Measure, averaged, displacement, measured, velocity
from rpscli.records.pair import rotated
from rpscli.records.spectrum import pseudo_acceleration_history

Array = NDArray[np.float64]

Of = Literal["rotd50", "geomean", "rotd100", "larger", "x", "component"]
"""What a measure may be of."""

OF: tuple[Of, ...] = get_args(Of)

USUAL: Of = "rotd50"
"""Of pairs, where nothing else is asked for."""

SHOWN: dict[Of, str] = {"rotd50": "RotD50", "rotd100": "RotD100"}
"""As outputs name those that have another spelling."""

DIRECTIONS = np.arange(180.0)
"""From the first component towards the second [deg]."""


def measure_label(measure: str, of: Of | None, at: str = "") -> str:
    """A measure, at a period perhaps, as columns and axes name it."""
    pair = "" if of in (None, "component") else SHOWN.get(of, of)
    inside = ", ".join(filter(None, (at, pair)))
    return f"{measure}({inside})" if inside else measure


def of_directions(values: Array, of: Of = USUAL) -> Array:
    """Of values (180, ...) over the directions, (...)."""
    first, second = values[0], values[90]
    if of == "rotd50":
        return np.asarray(np.median(values, axis=0))
    if of == "rotd100":
        return np.asarray(values.max(axis=0))
    if of == "geomean":
        return np.asarray(np.sqrt(first * second))
    return np.asarray(np.maximum(first, second) if of == "larger" else first)


def over_directions(
    first: GroundMotion,
    second: GroundMotion,
    measure: Measure,
    period: float | None = None,
    damping: float = 0.05,
) -> Array:
    """(180,) a measure of the pair turned to each direction, SI units."""
    x, y = (rotated(first, second, angle) for angle in (0.0, 90.0))  # of one length
    if measure in _LINEAR:
        return _peaks(*(_linear(each, measure, period, damping) for each in (x, y)))
    if measure in AVERAGED:
        periods = AVERAGED[measure] * (period or 1.0 if measure == "AvgSa" else 1.0)
        spectra = spectra_over_directions(first, second, periods, damping)
        return averaged(spectra, measure, periods)
    turned = (rotated(first, second, angle) for angle in DIRECTIONS.tolist())
    return np.array([measured(each, measure, period, damping) for each in turned])


def spectra_over_directions(
    first: GroundMotion, second: GroundMotion, periods: Sequence[float] | Array, damping: float
) -> Array:
    """(180, periods) pseudo-acceleration of the pair turned to each direction [m/s2]."""
    spectra = (over_directions(first, second, "Sa", float(t), damping) for t in periods)
    return np.column_stack([*spectra])


def pair_measure(
    first: GroundMotion,
    second: GroundMotion,
    measure: Measure,
    of: Of = USUAL,
    period: float | None = None,
    damping: float = 0.05,
) -> float:
    """A measure of a pair, SI units."""
    return float(of_directions(over_directions(first, second, measure, period, damping), of))


_LINEAR: tuple[Measure, ...] = ("PGA", "PGV", "PGD", "Sa")


def _linear(motion: GroundMotion, measure: Measure, period: float | None, damping: float) -> Array:
    """What is linear in a motion and has the measure as its largest magnitude."""
    if measure == "Sa":
        assert period is not None, "Sa is asked for at a period"
        return pseudo_acceleration_history(motion, period, damping)
    integral = {"PGV": velocity, "PGD": displacement}.get(measure)
    return integral(motion.acceleration, motion.dt) if integral else motion.acceleration


def _peaks(x: Array, y: Array) -> Array:
    """(180,) largest magnitudes of what is linear in the motion, in each direction."""
    turn = np.radians(DIRECTIONS)
    # 90 deg is the second component to the last bit, as it is of a motion that is turned.
    cosines = np.where(DIRECTIONS == 90.0, 0.0, np.cos(turn))
    turns = np.column_stack([cosines, np.sin(turn)])
    # What is nearer than the least reach of some points is the farthest in no direction.
    corners = [int(np.argmax(np.abs(c * x + s * y))) for c, s in turns[::15].tolist()]
    reach = float(_reach(turns, x[corners], y[corners]).min())
    far = x**2 + y**2 >= (reach * (1.0 - 1e-9)) ** 2
    x, y = x[far], y[far]
    parts = np.array_split(turns, 1 + min(x.size // 1000, 179))
    return np.concatenate([_reach(part, x, y) for part in parts])


def _reach(turns: Array, x: Array, y: Array) -> Array:
    """Largest magnitude of points in each direction, given by cosine and sine."""
    return np.asarray(np.abs(turns[:, :1] * x + turns[:, 1:] * y).max(axis=1))
