"""One of everything that a package may add to rps."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import click
import numpy as np
from numpy.typing import NDArray

import rpscli
from rpscli.plugins import (
    Column,
    DamperLaw,
    Found,
    GroundMotion,
    IntensityMeasure,
    Quantity,
    RecordError,
    RecordFormat,
    RecordText,
    Report,
    ReportOptions,
    RestitutionLaw,
    StoredPoints,
    TargetSpectrum,
    Whole,
    parse_query,
    point_columns,
    single,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# A record format: a first line `TIDY dt=0.005 unit=cm/s2`, then one value a line.

HEAD = re.compile(r"TIDY dt=(\S+) unit=(\S+)")


def recognises(text: RecordText) -> bool:
    """Files whose first line is a head of TIDY."""
    return bool(text.lines) and HEAD.fullmatch(text.lines[0]) is not None


def read(text: RecordText) -> GroundMotion:
    """The motion; what the user says of step and unit may not contradict the file."""
    head = HEAD.fullmatch(text.lines[0])
    assert head is not None, "it was recognised"
    _, factor = text.agreed_factor(head[2])
    try:
        values = np.array([float(line) for line in text.lines[1:] if line.strip()])
    except ValueError as error:
        raise text.fault(f"{error}; write one number a line") from None
    dt = text.agreed_dt(float(head[1]))
    return GroundMotion(values * factor, dt, text.name, text.source, "TIDY")


TIDY = RecordFormat("TIDY", (".tidy",), recognises, read)

# An intensity measure: the acceleration spectrum intensity of Von Thun and others (1988).


def spectrum_intensity(motion: GroundMotion, period: float, damping: float) -> float:
    """ASI [m/s]: the integral of Sa over periods of 0.1 to 0.5 s."""
    del period  # NaN: it is taken at none
    periods = np.linspace(0.1, 0.5, 41)
    spectrum = rpscli.response_spectrum(motion, periods, damping).pseudo_acceleration
    return float(np.trapezoid(spectrum, periods))


ASI = IntensityMeasure("m/s", spectrum_intensity)

# A target spectrum.


def plateau(rest: str, source: str) -> TargetSpectrum:
    """Constant up to a corner, then falling with the period: `plateau:?a=0.5g&corner=0.6`."""
    query = parse_query(rest.lstrip("?"), source, ("a", "corner"))
    a, corner = query.acceleration("a"), query.quantity("corner", "time")
    if not (a > 0.0 and corner > 0.0):
        raise RecordError(f"{source}: a and corner must be > 0")

    def shape(periods: NDArray[np.float64]) -> NDArray[np.float64]:
        return a * np.minimum(1.0, corner / np.maximum(periods, corner))

    return TargetSpectrum("plateau", source, shape, pgv=None, rules="none")


# A report of studies: the points that came off worst.

RESULT = "rotation_ratio"


class WorstOptions(ReportOptions):
    """The points with the largest rotations."""

    count: Annotated[int, Whole(1)] = 5
    """how many are shown"""


def worst(study: StoredPoints, options: WorstOptions) -> Found:
    """A table and a figure of them, the worst first."""
    columns = point_columns(study.table)
    values = np.nan_to_num(columns[RESULT], nan=-np.inf)  # failed points come last
    first = np.argsort(-values, kind="stable")[: options.count]
    names = [str(name) for name in columns["record"][first]]

    def draw(axes: Axes, heights: list[float]) -> None:
        axes.barh(range(len(names)), heights, tick_label=names)
        axes.set(xlabel="rotation ratio")

    def figure(title: str) -> Callable[..., None]:
        return single(draw, columns[RESULT][first].tolist(), (title,), 3.0)

    table = [Column("record", "-", names), Column(RESULT, "-", columns[RESULT][first])]
    return Found({"": table}, figure, shown={"": {}})


WORST = Report(WorstOptions, worst, results=lambda _: [RESULT])

# A figure: the history of a rotation in its phase plane.


def phase_plane(axes: Axes, result: rpscli.TimeHistoryResult) -> None:
    """The rate of rotation over the rotation."""
    trace = result.trace
    axes.plot(trace.rotation, trace.rotation_rate, linewidth=0.8)
    axes.set(xlabel=r"rotation $\theta$ [rad]", ylabel=r"rate $\dot\theta$ [rad/s]")


# A damper: oil behind a relief valve, which opens at a force and lets the damper resist less.


def force(path: float, speed: float, c: float, relief: float, share: float) -> float:
    """An oil damper with a relief valve: c v up to the relief force, a share of c behind it."""
    opens = relief / c
    return c * speed if speed <= opens else relief + share * c * (speed - opens)


def valve(path: float, speed: float, c: float, relief: float, share: float) -> float:
    """Zero where the valve opens [m/s]."""
    return relief / c - speed


def slope(c: float, relief: float, share: float) -> float:
    """The largest, which is that about rest too [N s/m]."""
    return c


OIL = DamperLaw(
    {
        "closed_coefficient": Quantity("N s/m", symbol="c", above=0),
        "relief_force": Quantity("N", symbol="F_r", above=0),
        "open_share": Quantity(symbol="of c", at_least=0, at_most=1),
    },
    force,
    damping=slope,
    linear=slope,
    watched=valve,
)

# An impact law: what falls faster crushes more of the joint, and gives back less.


def restitution(
    rate: float,
    tan_alpha: float,
    inertia_ratio: float,
    gamma: float,
    eta: float,
    slow: float,
    fast: float,
    usual: float,
) -> float:
    """A restitution that falls with the rate of the tilt: e_f + (e_s - e_f) exp(-rate/rate_0)."""
    return fast + (slow - fast) * math.exp(-rate / usual)


CRUSHING = RestitutionLaw(
    {
        "slow_restitution": Quantity(symbol="e_s", above=0, at_most=1),
        "fast_restitution": Quantity(symbol="e_f", above=0, at_most=1),
        "usual_rate": Quantity(symbol="rate_0 [rad/s]", above=0),
    },
    restitution,
)


# A command of the program: `rps widths CASE`.


@click.command("widths")
@click.argument("case", type=click.Path(exists=True, dir_okay=False))
def widths(case: str) -> None:
    """Print how many widths of its flat part a column of CASE is high."""
    bearing = rpscli.load_case(case).structure.bearing
    click.echo(f"{1.0 / bearing.slenderness:.4g}")
