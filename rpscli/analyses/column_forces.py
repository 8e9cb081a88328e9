"""Forces of one column: weight and overturning moment (Theory (8.7), (8.8))."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_design import no_line
from rpscli.analyses.trace import DirectionTrace, Trace
from rpscli.errors import listed
from rpscli.model.podium import PodiumStructure
from rpscli.physics import state

Array = NDArray[np.float64]


OF_COLUMNS = (
    "max_column_shear", "max_column_force", "min_column_force",
    "column_moment", "contact_pressure_ratio", "crushed_width_ratio",
)  # fmt: skip
"""Results that come from the forces of single columns."""


AMPLE = 1.3
"""Of tan(alpha): a friction with which rigid floors on the beam
would not let columns slide."""


class PlanForces(NamedTuple):
    """Axial forces of all columns at the instant at which one has the largest."""

    time: float  # [s]
    end: str  # top or bottom
    forces: Array
    """(rows, rows in y) of each column, compression positive [N]; one row in y where
    only one component acts, for columns beside each other carry alike then."""


@dataclass(frozen=True)
class AxialForces:
    """Axial forces of single columns, of all rows and times, and what the rows share.

    Under both components the outer column is that of the corner (Theory (8.7)).
    """

    largest: dict[str, float]
    least: dict[str, float]
    """At the `top` and at the `bottom` of a column, compression positive [N]."""
    overturning_ratio: float | None
    """Largest r: what the moment of the floors' inertia about the cap beam adds to an
    outer column, over the mean force; None without rows."""
    lift_off: float | None  # Time at which one would first lift off [s]; None if never
    sliding_time: float
    """Time during which columns would slide with a friction of `AMPLE` tan(alpha) [s]."""
    heaviest: dict[str, Array]
    """Of the most loaded column at each time of the trace, at both ends [N]."""
    moments: list[tuple[Array, Array]]
    """In x and in y at each time: that of the podium [N m], and mean(x^2)/abs(x) of the
    outer row on the side to which it acts [m]."""
    plan: PlanForces | None
    """None without rows."""
    shear: float | None
    """Largest of a column at either end, also of those that carry more or less than the
    mean (16.3) [N]; None without rows, where only the mean of all columns is known."""


def no_bound(name: str, structure: PodiumStructure) -> str:
    """The reason why a result of both components bounds no force of a
    column; empty if it does.
    """
    if name not in OF_COLUMNS:
        return ""
    on_end = name in ("contact_pressure_ratio", "crushed_width_ratio")
    if on_end and (corner := no_line(structure, both=True)):
        remedy = f"make it round, or remove the limit (--set limits.{name}=null)"
        return f"{name} cannot be a limit under both components: {corner}; {remedy}"
    axial = name != "max_column_shear"
    left_out = structure.left_out_of_columns(both=True, axial=axial)
    if not left_out:
        return ""
    return (
        f"{name} cannot be a limit under both components: it lacks"
        f" {listed(left_out, 'and')}, which may multiply it; remove it (--set"
        f" limits.{name}=null) and judge columns under single components"
    )


def axial_forces(structure: PodiumStructure, trace: Trace) -> AxialForces:
    """Axial forces of single columns from a trace that is dense
    beside the vertical period.
    """
    normal = {"top": trace.normal_top, "bottom": trace.normal_bottom}
    more = np.zeros_like(trace.time)
    less = more.copy()
    ratio = None
    lift_off = None
    inertia = more.copy()
    moments = []
    directions = _directions(trace)
    if all((rows := (structure.rows, structure.rows_y))[: len(directions)]):
        for places, (of, towards) in zip(rows, directions, strict=False):
            inertial = overturning_moment(structure, of)
            moment = inertial + thrust_moment(structure, trace, of, towards)
            left, right = _levers(places)
            inertia += np.abs(inertial) / min(left, right)
            moments.append((moment, np.where(moment < 0.0, left, right)))
            more += np.maximum(moment / right, -moment / left)
            less += np.minimum(moment / right, -moment / left)
        stands = trace.normal_top > 0.0
        least = np.maximum(trace.normal_top, 1.0)
        ratio = float(np.max(np.where(stands, inertia / least, np.inf)))
        lifts = np.flatnonzero(-less > trace.normal_top)
        lift_off = float(trace.time[lifts[0]]) if len(lifts) else None
    N = structure.columns
    heaviest = {end: (force + more) / N for end, force in normal.items()}
    return AxialForces(
        {end: float(np.max(force)) for end, force in heaviest.items()},
        {end: float(np.min(force + less)) / N for end, force in normal.items()},
        ratio,
        lift_off,
        sliding_time(structure, trace),
        heaviest,
        moments,
        _plan(structure, trace, heaviest, moments) if moments else None,
        _largest_shear(structure, trace, (more, less)) if moments else None,
    )


def _levers(places: Sequence[float]) -> tuple[float, float]:
    """mean(x^2)/abs(x) of the outer rows to the left and to the right of the middle [m].

    >>> [round(lever, 3) for lever in _levers((0.0, 2.0, 9.0))]  # at -3.667 and 5.333 m
    [4.061, 2.792]
    """
    x = np.array(places) - np.mean(places)
    return tuple((np.mean(x**2) / np.abs((np.min(x), np.max(x)))).tolist())


def _plan(
    structure: PodiumStructure,
    trace: Trace,
    heaviest: dict[str, Array],
    moments: list[tuple[Array, Array]],
) -> PlanForces:
    """Axial forces of all columns when the most loaded one has its largest (8.7)."""
    end = max(heaviest, key=lambda name: float(np.max(heaviest[name])))
    at = int(np.argmax(heaviest[end]))
    mean = float(heaviest[end][at])
    parts = [np.zeros(1), np.zeros(1)]
    rows = (structure.rows, structure.rows_y)
    for way, ((moment, lever), places) in enumerate(zip(moments, rows, strict=False)):
        x = np.array(places) - np.mean(places)
        parts[way] = moment[at] * x / np.mean(x**2) / structure.columns
        mean -= abs(float(moment[at])) / float(lever[at]) / structure.columns
    return PlanForces(float(trace.time[at]), end, mean + np.add.outer(*parts))


def _largest_shear(
    structure: PodiumStructure, trace: Trace, uneven: tuple[Array, Array]
) -> float:
    """Largest shear of columns that carry so much more, or less, than the mean times
    their number, passes that floors cannot follow left out (16.3) [N].
    """
    x = np.abs(trace.rotation)
    tilted = (trace.phase != state.FULL_CONTACT) & (trace.phase != state.BEDDED)
    slope = 2.0 * structure.bearing.semi_diagonal * structure.weight_arm(x)
    slope = np.where(tilted, slope / structure.lever_arm(x), 0.0)
    counted = ~in_shocks(structure, trace)
    largest = 0.0
    for end in ("top", "bottom"):
        for more in uneven:
            parts = [
                getattr(of, f"shear_{end}") - more * slope * towards
                for of, towards in _directions(trace)
            ]
            sizes = np.sqrt(sum(part**2 for part in parts))
            largest = max(largest, float(np.max(sizes[counted], initial=0.0)))
    return largest / structure.columns


def sliding_time(structure: PodiumStructure, trace: Trace) -> float:
    """Time during which the friction demand is above `AMPLE`
    tan(alpha), shocks left out [s].
    """
    limit = AMPLE * structure.bearing.slenderness
    slides = np.zeros(len(trace.time), dtype=bool)
    for end, normal in (("top", trace.normal_top), ("bottom", trace.normal_bottom)):
        slides |= trace.size(f"shear_{end}") > limit * np.maximum(normal, 0.0)
    share = np.count_nonzero(slides & ~in_shocks(structure, trace)) / max(
        len(slides) - 1, 1
    )
    return float(share * trace.time[-1])


def _directions(trace: Trace) -> list[tuple[DirectionTrace, Array]]:
    """Histories in x and, of both components, in y, each with the part of the tilt to
    there.
    """
    if trace.y is None or trace.azimuth is None:
        return [(trace, np.sign(trace.rotation))]
    return [(trace, np.cos(trace.azimuth)), (trace.y, np.sin(trace.azimuth))]


def overturning_moment(structure: PodiumStructure, of: DirectionTrace) -> Array:
    """Moment of the floors' inertia about the cap beam (samples,) [N
    m], positive to the right.
    """
    building = structure.superstructure
    if building is None or building.storey_heights is None:
        return np.zeros(len(of.shear_top))
    return -(
        of.floor_accelerations @ (building.masses * np.cumsum(building.storey_heights))
    )


def thrust_moment(
    structure: PodiumStructure, t: Trace, of: DirectionTrace, towards: Array
) -> Array:
    """Moment of leaning thrust lines and drifts, beside that of
    inertia (samples,) [N m].
    """
    # Columns bear on the beam at the edge they turn about, or where one at rest is in
    # equilibrium.
    b = structure.bearing
    B = structure.weight_arm(np.abs(t.rotation))
    edge = towards * b.semi_diagonal * B + 0.5 * of.cap_beam_displacement
    height = b.semi_diagonal * math.cos(b.alpha)
    rest = -height * (of.shear_top + of.shear_bottom)
    rest = rest / np.maximum(t.normal_top + t.normal_bottom, 1.0)
    beside = np.where(t.phase == state.FULL_CONTACT, rest, edge)
    carried = structure.cap_beam_mass + structure.superstructure_mass
    weighs = np.zeros_like(t.time)
    if (building := structure.superstructure) is not None:
        drifted = of.floor_displacements - of.cap_beam_displacement[:, None]
        weighs = t.normal_top / carried * (drifted @ building.masses)
        if t.vertical_accelerations is not None:
            pressing = building.masses * (structure.gravity + t.vertical_accelerations)
            weighs = np.sum(drifted * pressing, axis=1)
    return t.normal_top * beside + weighs


def in_shocks(structure: PodiumStructure, trace: Trace) -> NDArray[np.bool_]:
    """Samples of passes that floors cannot follow (13.19), none of
    one component (samples,).
    """
    if trace.azimuth_rate is None or structure.passes_smoothly:
        return np.zeros(len(trace.time), dtype=bool)
    rate = np.hypot(trace.rotation_rate, trace.rotation * trace.azimuth_rate)
    return np.asarray(structure.shock_time * rate > trace.rotation)
