"""Worst instants of the most loaded column of a history: moment,
pressure, crushed edge, force.

Theory, section 16. Maxima are those of a dense trace. At impacts they leave out the
impulse of beam and columns, which has no bound between rigid ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.trace import Trace
from rpscli.model.column import ArcContact, ColumnDesign, ColumnState
from rpscli.model.podium import PodiumStructure
from rpscli.physics import state
from rpscli.physics.laws.geometry import path_along

Array = NDArray[np.float64]

ENDS = ("bottom", "top")
WITHOUT_IMPULSE = (
    "the impulse of beam and columns at impacts, infinite between rigid ends"
)


@dataclass(frozen=True)
class ColumnInstant:
    """One end of the most loaded column when something is
    largest; in the plane of tilt.
    """

    largest: str  # name of the result that is
    end: str
    time: float  # [s]
    rotation: float  # [rad]
    axial_force: float  # N [N]
    shear: float  # F to the right on what is above [N]
    eccentricity: float  # M/N [m]
    moment: float  # M [N m]
    contact_pressure: float | None  # p_0 on an arc [Pa]; None elsewhere
    crushed_depth: float | None  # b_c at an edge [m]; None elsewhere
    doubt: str  # why the pressure is another one; empty where its law is valid
    contact: ArcContact | None  # on an arc; None elsewhere


@dataclass(frozen=True)
class ColumnDemand:
    """Demands on the most loaded column."""

    instants: tuple[ColumnInstant, ...]  # At which each result is largest
    at_largest_moment: ColumnState
    pressure_ratio: float | None  # Largest p_0/f on arcs; None where it is not known
    crushed_ratio: float | None
    """Largest b_c over the width of an end; 0 where no column came onto an edge."""
    corner: float  # of that moment over that of the inscribed circle; 1 but for squares
    mean_force: float  # N of all columns over their number, at the largest moment [N]
    moments: tuple[tuple[float, float], ...]
    """Then, in x and in y: that of the podium [N m], and the lever of the rows [m], which
    give the column more than the mean; empty without rows."""


def corner_of(structure: PodiumStructure, *, both: bool) -> float:
    """Ratio by which a column bears farther from its axis on a corner than on its
    inscribed circle: sqrt(2) of square ends that tilt to any side.
    """
    return math.sqrt(2.0) if both and _corners(structure) else 1.0


def _corners(structure: PodiumStructure) -> bool:
    design = structure.column
    return design is not None and design.stands_on_corners(structure.bearing)


def no_line(structure: PodiumStructure, *, both: bool) -> str:
    """The reason why neither pressure nor edge is known; empty if they are."""
    if both and _corners(structure):
        return (
            "a square column that tilts to any side stands on a corner, not along a line"
        )
    return ""


class _Loads(NamedTuple):
    """Arrays (samples,), of forces and moments (2, samples) at
    the bottom and at the top.
    """

    down: NDArray[np.bool_]
    side: Array
    lever: Array
    rise: Array
    F: Array
    N: Array
    M: Array
    corner: Array  # (samples,)


def _loads(
    structure: PodiumStructure, trace: Trace, heaviest: dict[str, Array]
) -> _Loads:
    b = structure.bearing
    x = np.abs(trace.rotation)
    B = b.half_width
    r = 0.0 if b.is_flat else b.radius
    y = np.minimum(x, b.beta)
    down = (trace.phase == state.FULL_CONTACT) | (trace.phase == state.BEDDED)
    F = _along_tilt(trace, down) / structure.columns
    N = np.array([heaviest[end] for end in ENDS])
    tilted = np.where(trace.rotation < 0.0, -1.0, 1.0)
    side = np.where(down, -np.sign(F[0] + F[1]), tilted)
    arm = structure.weight_arm(x)
    height = structure.lever_arm(x) / (2.0 * b.semi_diagonal)
    added = N[0] - trace.normal_bottom / structure.columns
    # In full contact, where only the sum of both moments is known: one eccentricity, as
    # at uplift.
    corner = corner_of(structure, both=trace.y is not None)
    upright = np.minimum(
        b.half_height * np.abs(F[0] + F[1]) / np.maximum(N[0] + N[1], 1e-9), corner * B
    )
    F = F - np.where(down, 0.0, side * added * arm / height)  # (16.3)
    rigid = (
        arm if structure.bed is None else path_along(b.rolling, b.rocking, b.beta, x)[0]
    )
    lever = np.where(down, upright, B + r * np.sin(y) - b.semi_diagonal * (rigid - arm))
    rise = np.where(down, 0.0, r * (1.0 - np.cos(y)))
    P = N * np.cos(x) + side * F * np.sin(x)
    Q = side * F * np.cos(x) - N * np.sin(x)
    of_corner = np.where(down, 1.0, corner)
    M = of_corner * (lever * P - rise * Q)
    return _Loads(down, side, lever, rise, F, N, M, of_corner)


@dataclass(frozen=True, eq=False)
class _Ends:
    """Both ends of the most loaded column at the times of a trace: loads and bearing."""

    structure: PodiumStructure
    design: ColumnDesign
    trace: Trace
    loads: _Loads
    rotation: Array  # |theta| [rad]
    rolls: NDArray[np.bool_]  # (samples,) on arcs; nowhere if no line of contact is known
    edges: NDArray[np.bool_]  # (samples,) on edges; the same

    def instant(self, largest: str, values: Array) -> ColumnInstant:
        """End and time of the largest of values (2, samples)."""
        design = self.design
        b = self.structure.bearing
        end, i = np.unravel_index(int(np.argmax(values)), values.shape)
        x = self.rotation[i]
        N = self.loads.N[end, i]
        force = float(N)
        moment = float(self.loads.M[end, i])
        return ColumnInstant(
            largest,
            ENDS[end],
            float(self.trace.time[i]),
            float(self.trace.rotation[i]),
            force,
            float(self.loads.F[end, i]),
            moment / force if force else 0.0,
            moment,
            float(design.pressed(b, x, N)[0]) if self.rolls[i] else None,
            design.crushed(b, force)[0] if self.edges[i] else None,
            design.doubt(b, float(x), force) if self.rolls[i] else "",
            design.contact(b, float(x)) if self.rolls[i] else None,
        )

    def pressures(self) -> Array:
        """Pressures on arcs (2, samples) [Pa] that may be the largest; 0 elsewhere."""
        # It grows with N and with the tilt: the others lie below one that has more of
        # both.
        x = self.rotation
        N = self.loads.N
        order = np.argsort(-x)
        most = np.where(self.rolls, N.max(axis=0), 0.0)[order]
        rows = order[(most >= np.maximum.accumulate(most)) & self.rolls[order]]
        values = np.zeros_like(N)
        values[:, rows] = self.design.pressed(
            self.structure.bearing, np.broadcast_to(x[rows], (2, len(rows))), N[:, rows]
        )[0]
        return values

    def column_state(self, i: int) -> ColumnState:
        """Tilt, levers and forces of the column at a sample."""
        of = self.loads
        forces = of.F[0, i], of.N[0, i], of.F[1, i], of.N[1, i]
        tilt = of.side[i], self.rotation[i], self.trace.rotation_rate[i]
        return ColumnState(*map(float, (*tilt, of.lever[i], of.rise[i], *forces)))


def column_demand(
    structure: PodiumStructure,
    design: ColumnDesign,
    trace: Trace,
    heaviest: dict[str, Array],
    moments: list[tuple[Array, Array]],
) -> ColumnDemand:
    """Worst instants, from axial forces of the most loaded column
    at the times of a trace.
    """
    b = structure.bearing
    x = np.abs(trace.rotation)
    of = _loads(structure, trace, heaviest)
    known = not no_line(structure, both=trace.y is not None)
    up = ~of.down & known
    rolls = up & (x > 0.0) & (x < b.beta)
    ends = _Ends(structure, design, trace, of, x, rolls, edges=up & (x >= b.beta))

    size = np.abs(of.M)
    found = [ends.instant("column_moment", size), ends.instant("max_column_force", of.N)]
    ratio = 0.0 if known and not b.is_flat else None
    crushed = 0.0 if known else None
    if ends.rolls.any():
        found.append(ends.instant("contact_pressure_ratio", ends.pressures()))
        ratio = (found[-1].contact_pressure or 0.0) / design.contact_strength
    if ends.edges.any():
        on_edges = np.where(ends.edges, of.N, -np.inf)
        found.append(ends.instant("crushed_width_ratio", on_edges))
        crushed = (found[-1].crushed_depth or 0.0) / (2.0 * b.end_half_width)

    i = int(np.argmax(size.max(axis=0)))
    corner = float(of.corner[i])
    shares = tuple((float(moment[i]), float(lever[i])) for moment, lever in moments)
    mean = float(getattr(trace, f"normal_{found[0].end}")[i]) / structure.columns
    return ColumnDemand(
        tuple(found), ends.column_state(i), ratio, crushed, corner, mean, shares
    )


def _along_tilt(trace: Trace, down: NDArray[np.bool_]) -> Array:
    """Shears at both ends in the plane of tilt (2, samples) [N]; of
    upright columns, the sum's.
    """
    x = np.array([trace.shear_bottom, trace.shear_top])
    if trace.y is None or trace.azimuth is None:
        return x
    y = np.array([trace.y.shear_bottom, trace.y.shear_top])
    azimuth = np.where(down, np.arctan2(y.sum(axis=0), x.sum(axis=0)), trace.azimuth)
    return np.asarray(x * np.cos(azimuth) + y * np.sin(azimuth))
