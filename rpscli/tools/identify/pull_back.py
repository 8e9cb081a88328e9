"""Slenderness of columns from a pull-back test of which two numbers are known.

A building was pushed sideways, let go, and came to rest. Displacement and time to rest
are known within ranges, and so is what else such a test does not show: size and curvature
of the columns, loss at impacts, period. Slendernesses are kept that some combination of
all these brings to rest in the time that was seen; the same building on ends without a
flat part, which only rolling resistance stops, stands beside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import AnalysisError, UsageError
from rpscli.machine import available_cores
from rpscli.model.devices import RollingResistance
from rpscli.model.podium import Array, PodiumStructure
from rpscli.records.ground_motion import GroundMotion
from rpscli.tools.identify.estimates import Estimate

Range = tuple[float, float]

COMBINATIONS = 32
"""Of what is not known, evenly spread (a Halton sequence) over the ranges."""
SLENDERNESSES = np.geomspace(0.01, 0.3, 18)
"""That are looked at; between two of them times to rest are interpolated."""
LEVERS = np.geomspace(2e-4, 0.03, 12)
"""Of rolling resistance on ends without a flat part, likewise [m]."""
LONGER = 1.3
"""Histories over the longest time to rest: what still moves then is later."""
STEP = 0.01
"""Between samples of the displacement [s]."""


class Unknown(NamedTuple):
    """A quantity that the test does not show: its unit, and its range unless one is
    given, over the value of the case where that is so.
    """

    unit: str
    usual: Range
    is_factor: bool
    of: Callable[[PodiumStructure], float | None]


def _period(structure: PodiumStructure) -> float | None:
    above = structure.superstructure
    return None if above is None else float(above.periods[0])


def _loss(structure: PodiumStructure) -> float | None:
    law = structure.impact_law
    return None if law.kind == "value" else law.loss


def _curvature(structure: PodiumStructure) -> float | None:
    return None if structure.bearing.is_flat else structure.bearing.curvature_ratio


def _wedge_ratio(structure: PodiumStructure) -> float | None:
    bearing = structure.bearing
    if bearing.is_flat or bearing.is_spherical:
        return None
    return bearing.wedge_slenderness / bearing.slenderness


UNKNOWN = {
    "semi_diagonal": Unknown(
        "m", (0.8, 1.25), is_factor=True, of=lambda s: s.bearing.semi_diagonal
    ),
    "curvature_ratio": Unknown("-", (0.25, 1.5), is_factor=False, of=_curvature),
    "round_curvature_ratio": Unknown("-", (0.55, 1.5), is_factor=False, of=lambda _: 1.0),
    "wedge_ratio": Unknown("-", (1.0, 1.0), is_factor=True, of=_wedge_ratio),
    "loss": Unknown("-", (0.3, 1.2), is_factor=False, of=_loss),
    "period": Unknown("s", (0.8, 1.25), is_factor=True, of=_period),
}
"""round_curvature_ratio is that of ends without a flat part, which stand from 1/2 on;
wedge_ratio is tan(alpha') over tan(alpha), so that arcs grow with the flat part."""


class Pull(NamedTuple):
    """What was seen: how far the cap beam was pushed [m], and after how long it stayed
    within a distance of where it ended [s, m].
    """

    displacement: Range
    rest: Range
    within: float


class Times(NamedTuple):
    """Times to rest of one value over all combinations; infinite where the building
    overturns, or moves on longer than histories last [s].
    """

    value: float
    least: float
    median: float
    largest: float
    overturned: int


class PullBack(NamedTuple):
    """What a test says of the slenderness, and of the lever on ends without flat part."""

    slenderness: Estimate | None
    lever: Estimate | None
    by_slenderness: list[Times]
    by_lever: list[Times]
    ranges: dict[str, Range]
    histories: int


def pull_back(
    structure: PodiumStructure,
    pull: Pull,
    given: Mapping[str, Range],
    combinations: int,
) -> PullBack:
    """What fits a test of a building like `structure`, over ranges of what is not known.

    An interval has every value that fits with some combination: it is no probability, and
    as wide as the ranges make it. The value is the median of all that fits.
    """
    _refuse(structure, pull, given)
    ranges = ranges_of(structure, given)
    draws = _spread(combinations, [pull.displacement, *ranges.values()])
    unknown = [dict(zip(("u", *ranges), row, strict=True)) for row in draws.tolist()]
    of_slenderness = _times(structure, unknown, SLENDERNESSES, _on_flat_parts, pull)
    of_lever = _times(structure, unknown, LEVERS, _on_round_ends, pull)
    return PullBack(
        _fitting(SLENDERNESSES, of_slenderness, pull.rest),
        _fitting(LEVERS, of_lever, pull.rest),
        _rows(SLENDERNESSES, of_slenderness),
        _rows(LEVERS, of_lever),
        ranges,
        of_slenderness.size + of_lever.size,
    )


Combination = Mapping[str, float]
"""A value of each unknown, and of the displacement u [m]."""
Made = Callable[[PodiumStructure, Combination, float], PodiumStructure | None]


def _times(
    structure: PodiumStructure,
    unknown: Sequence[Combination],
    values: Array,
    made: Made,
    pull: Pull,
) -> Array:
    """Times to rest (combinations, values) [s]."""
    tried = [(each, value) for each in unknown for value in values.tolist()]

    def timed(of: tuple[Combination, float]) -> float:
        return time_to_rest(made(structure, *of), of[0]["u"], pull)

    with ThreadPoolExecutor(available_cores()) as pool:
        found = np.array([*pool.map(timed, tried)])
    return found.reshape(len(unknown), len(values))


def ranges_of(structure: PodiumStructure, given: Mapping[str, Range]) -> dict[str, Range]:
    """Ranges of what the structure has and the test does not show."""
    found = {}
    for name, each in UNKNOWN.items():
        if (of_case := each.of(structure)) is None:
            if name in given:
                raise UsageError(f"--range {name}: this case has none; leave it out")
            continue
        low, high = each.usual
        factor = of_case if each.is_factor else 1.0
        found[name] = given.get(name, (factor * low, factor * high))
    return found


def _refuse(structure: PodiumStructure, pull: Pull, given: Mapping[str, Range]) -> None:
    """Refuse numbers that no test has."""
    for name, (low, high) in {
        "displacement": pull.displacement, "rest": pull.rest, **given
    }.items():  # fmt: skip
        if not 0.0 < low <= high < math.inf:
            raise UsageError(f"{name}: from {low:g} to {high:g} must be > 0 and finite")
    if not 0.0 < pull.within < pull.displacement[0]:
        raise UsageError(
            f"--within: {pull.within:g} m must be > 0 and below the displacement of"
            f" {pull.displacement[0]:g} m, or it is at rest from the beginning"
        )
    if structure.bed is not None:
        raise UsageError(
            "pull-back is for rigid ends; put --set podium.contact.kind=rigid over the"
            " case, without a ratio, stiffness or settlement"
        )
    if structure.bearing.is_spherical:
        raise UsageError(
            "the columns of this case have no flat part; give them a slenderness, of any"
            " size: ends without one are computed beside it"
        )


def _spread(count: int, ranges: Sequence[Range]) -> Array:
    """Points (count, n) evenly spread over ranges, the same ones each time."""
    from scipy.stats import qmc

    low, high = np.array(ranges).T
    places = qmc.Halton(len(ranges), scramble=False).random(count + 1)[1:]
    return np.asarray(low + (high - low) * places)


def _above(structure: PodiumStructure, unknown: Combination) -> PodiumStructure:
    """The structure with the period and the loss of a combination."""
    law = structure.impact_law
    if "loss" in unknown:
        law = replace(law, loss=unknown["loss"])
    building = structure.superstructure
    if building is not None and "period" in unknown:
        softer = (float(building.periods[0]) / unknown["period"]) ** 2
        building = replace(building, stiffnesses=softer * building.stiffnesses)
    return replace(structure, impact_law=law, superstructure=building)


def _on_flat_parts(
    structure: PodiumStructure, unknown: Combination, slenderness: float
) -> PodiumStructure | None:
    """The structure with a slenderness; None if there is none with all of this."""
    bearing = structure.bearing
    try:
        changed = replace(
            bearing,
            semi_diagonal=unknown["semi_diagonal"],
            slenderness=slenderness,
            wedge_slenderness=slenderness * unknown.get("wedge_ratio", 1.0),
            curvature_ratio=unknown.get("curvature_ratio", bearing.curvature_ratio),
        )
        return replace(_above(structure, unknown), bearing=changed)
    except ValueError:  # an arc that does not reach, an impact that nothing survives
        return None


def _on_round_ends(
    structure: PodiumStructure, unknown: Combination, lever: float
) -> PodiumStructure | None:
    """The structure on ends without a flat part that resist rolling with a lever [m]."""
    bearing = structure.bearing
    try:
        changed = replace(
            bearing,
            semi_diagonal=unknown["semi_diagonal"],
            slenderness=0.0,
            curvature_ratio=unknown["round_curvature_ratio"],
            ends="spherical",
        )
        law = replace(structure.impact_law, kind="flexible", restitution=None, factor=1.0)
        made = replace(_above(structure, unknown), impact_law=law, bearing=changed)
        others = [each for each in structure.devices if each.kind != "rolling_resistance"]
        return replace(made, devices=(*others, RollingResistance(lever)))
    except ValueError:
        return None


def time_to_rest(
    structure: PodiumStructure | None, displacement: float, pull: Pull
) -> float:
    """Time from which the cap beam stays within a distance of where it ends [s].

    NaN where the building overturns, or cannot be built or pushed so far; infinite where
    it moves on for longer than anybody saw.
    """
    if structure is None:
        return math.nan
    start = structure.bearing.rotation_at(displacement)
    if not start < structure.critical_rotation:
        return math.nan
    span = LONGER * pull.rest[1] + 2.0
    settings = TimeHistorySettings(free_vibration=span, initial_rotation=start)
    still = GroundMotion(np.zeros(2), STEP, "still", "still", "")
    try:
        result = time_history(structure, still, settings, with_fixed_base=False)
    except AnalysisError:
        return math.nan
    if result.outcome.startswith("overturned") or result.outcome == "failed":
        return math.nan
    theta = result.trace.rotation
    moved = np.sign(theta) * structure.path(np.abs(theta))[1]
    end = float(moved[-1]) if result.outcome == "stays_tilted" else 0.0
    return _settled(moved - end, result.trace.time, pull)


def _settled(moved: Array, time: Array, pull: Pull) -> float:
    """Time after which it stays as near as is asked; infinite if that is too late."""
    beyond = np.flatnonzero(np.abs(moved) > pull.within)
    if not len(beyond):
        return 0.0
    last = float(time[beyond[-1]])
    return last if last < LONGER * pull.rest[1] else math.inf


def _fitting(values: Array, times: Array, rest: Range) -> Estimate | None:
    """Median and ends of all values whose time to rest lies within a range.

    Between two values the logarithm of the time is linear in that of the value.
    """
    fine = np.linspace(0.0, 1.0, 41)[:-1]
    fits: list[float] = []
    for row in times:
        for x, t in zip(_pairs(np.log(values)), _pairs(row), strict=True):
            if not np.all(np.isfinite(t)) or min(t) <= 0.0:
                continue
            between = np.exp(np.log(t[0]) + fine * np.log(t[1] / t[0]))
            inside = (between >= rest[0]) & (between <= rest[1])
            fits += np.exp(x[0] + fine[inside] * (x[1] - x[0])).tolist()
    if not fits:
        return None
    return Estimate(float(np.median(fits)), min(fits), max(fits))


def _pairs(values: Array) -> list[tuple[float, float]]:
    """Neighbours of each other."""
    return [*zip(values[:-1].tolist(), values[1:].tolist(), strict=True)]


def _rows(values: Iterable[float], times: Array) -> list[Times]:
    """Least, median and largest time of each value over the combinations that stand."""
    rows = []
    for value, column in zip(values, times.T, strict=True):
        stood = np.sort(column[~np.isnan(column)])
        ends = (
            (float(stood[0]), float(stood[(len(stood) - 1) // 2]), float(stood[-1]))
            if len(stood)
            else (math.nan,) * 3
        )
        rows.append(Times(float(value), *ends, int(np.isnan(column).sum())))
    return rows
