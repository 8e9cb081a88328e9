"""Static behaviour: the podium alone, and the whole structure
under lateral floor forces.

>>> from rpscli import Bearing, PodiumStructure
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
>>> round(pushover(podium).critical_displacement, 3)
0.892
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from rpscli.analyses.result_quantities import PUSHOVER, STOREY_CURVE, values_of
from rpscli.analyses.settings import require_structure
from rpscli.errors import listed
from rpscli.model.podium import Array, PodiumStructure
from rpscli.model.statics import NEARLY, friction_force, restoring_force, storey_strengths
from rpscli.model.superstructure import Superstructure
from rpscli.shown import Shown, with_unit

PatternName = Literal["uniform", "triangular", "first_mode"]

PATTERNS: tuple[PatternName, ...] = ("uniform", "triangular", "first_mode")


@dataclass(frozen=True, eq=False, repr=False)
class StoreyCurve(Shown):
    """Restoring force of the podium against its motion, from 0+
    to the end of the curve.
    """

    rotation: Array  # (points,) |theta| [rad]
    displacement: Array  # (points,) u_b [m]
    force: Array
    """(points,) that holds it on the way out: F = W B/C, stops,
    tendons and friction [N]."""
    lift: Array  # (points,) v_b [m]
    unloading_force: Array
    """(points,) on the way back from the end, negative where it must be drawn back;
    without friction and yielding tendons the same as `force` [N]."""


@dataclass(frozen=True, eq=False, repr=False)
class CapacityCurve(Shown):
    """Whole structure under floor forces lambda p: elastic to the
    uplift, rigid storey above.

    After uplift lambda sum(p) = F(theta), and the floors stand at 1 u_b + lambda K^-1 p
    (Theory (5.5); paper, Figure 1c); storeys that yield add their plastic drifts (Theory,
    section 15). Where they yield without hardening it ends with the first of them, a
    mechanism.
    """

    pattern: str  # Name of the pattern, or ``given``
    forces: Array  # (n,) p, scaled to sum 1
    roof_displacement: Array  # (points,) [m]
    cap_beam_displacement: Array  # (points,) [m]
    sum_of_floor_forces: Array  # (points,) lambda [N]
    roof_displacement_at_uplift: float  # [m]; not a number where a mechanism comes first
    yield_forces: Array | None = None
    """(n,) lambda at which each storey yields [N], infinite if never;
    None of elastic buildings."""

    @property
    def yielding(self) -> dict[int, float]:
        """Storeys that yield on the way, counted from 1, and
        lambda where each begins [N].
        """
        if self.yield_forces is None:
            return {}
        reached = NEARLY * self.sum_of_floor_forces.max()
        return {i: F for i, F in enumerate(self.yield_forces.tolist(), 1) if reached >= F}


@dataclass(frozen=True, eq=False, repr=False)
class PushoverResult(Shown):
    """Static characteristics of the podium and capacity curves of the structure.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    uplift_force
        F at 0+ [N]; of compliant ends where they begin to lift.
    critical_rotation, critical_displacement
        theta_cr [rad], and u_b there [m].
    initial_stiffness
        dF/du_b at 0+ [N/m]; of compliant ends K_s.
    curve
        Restoring force of the podium.
    capacity
        One for each load pattern; none without a building.
    """

    structure: PodiumStructure
    uplift_force: float
    critical_rotation: float
    critical_displacement: float
    initial_stiffness: float
    curve: StoreyCurve
    capacity: tuple[CapacityCurve, ...]

    def facts(self) -> dict[str, Any]:
        """Scalars with their units."""
        return {q.name: with_unit(getattr(self, q.name), q.unit) for q in PUSHOVER}

    def results(self) -> dict[str, Any]:
        """Scalars, the podium's curve and one entry a load pattern;
        forces in N, lengths in m.
        """
        curves = [asdict(curve) for curve in self.capacity]
        for curve in curves:
            if curve["yield_forces"] is None:  # elastic buildings have none
                del curve["yield_forces"]
        scalars = {
            **values_of(self, PUSHOVER),
            "curve": values_of(self.curve, STOREY_CURVE),
        }
        return {**scalars, "capacity": curves}

    @property
    def warnings(self) -> tuple[str, ...]:
        """Storeys that yield before columns lift, by the patterns that do it."""
        strengths = storey_strengths(self.structure)
        weak: dict[int, list[str]] = {}
        for curve in self.capacity:
            for storey, force in curve.yielding.items():
                if NEARLY * force < self.uplift_force:
                    weak.setdefault(storey, []).append(curve.pattern)
        if not weak:
            return ()
        told = listed(
            (f"storey {i} ({', '.join(of)})" for i, of in sorted(weak.items())), "and"
        )
        late = [
            str(storey) for storey in sorted(weak) if strengths[storey - 1].uplift_first
        ]
        slowly = (
            f"; under slow ground motion they lift before storey {', '.join(late)} yields"
        )
        text = "under these floor forces yielding comes before the columns lift"
        return (f"the podium does not protect {told}: {text}{slowly * bool(late)}",)

    def curve_ratios(self) -> dict[str, Array]:
        """The podium's curve without units."""
        return {
            "rotation_ratio": self.curve.rotation / self.critical_rotation,
            "force_over_weight": self.curve.force / self.structure.weight,
        }


def pushover(
    structure: PodiumStructure,
    *,
    patterns: Sequence[PatternName | Sequence[float]] = PATTERNS,
    points: int = 201,
) -> PushoverResult:
    """Storey curve to theta_cr, and capacity curves for the given load patterns.

    Parameters
    ----------
    structure
        Podium, bearings and building; without a building there are no capacity curves.
    patterns
        ``uniform`` (forces as the masses), ``triangular`` (mass times
        height), ``first_mode`` (mass times fixed-base first mode), or
        floor forces from the bottom.
    points
        Points of each curve, beta being one of them where the podium rolls.

    Raises
    ------
    ValueError
        If a given pattern has the wrong length or does not push.
    """
    require_structure(structure)
    bed = structure.bed
    uplift = 0.0 if bed is None else bed.uplift_rotation
    stiffness = structure.initial_stiffness if bed is None else bed.stiffness
    added = sum(device.stiffness_after_uplift(structure) for device in structure.devices)

    curve = _storey_curve(structure, _rotations(structure, points))
    building = structure.superstructure
    return PushoverResult(
        structure=structure,
        uplift_force=float(np.interp(uplift, curve.rotation, curve.force)),
        critical_rotation=structure.critical_rotation,
        critical_displacement=float(curve.displacement[-1]),
        initial_stiffness=stiffness + added,
        curve=curve,
        capacity=tuple(_capacity(building, curve, p, uplift) for p in patterns)
        if building
        else (),
    )


def _rotations(structure: PodiumStructure, points: int) -> Array:
    """Rotations from 0 to theta_cr [rad], with beta, and dense where
    compliant ends begin to lift.
    """
    end = structure.critical_rotation
    beta = structure.bearing.beta
    rotation = np.linspace(0.0, end, points)
    if 0.0 < beta < end:
        rotation = np.sort(np.append(rotation, beta))
    if (bed := structure.bed) is not None:
        uplift = bed.uplift_rotation
        gradual = np.geomspace(uplift, min(100.0 * uplift, end), 40)
        rotation = np.unique(np.concatenate([rotation, gradual]))
    return rotation


def _storey_curve(structure: PodiumStructure, rotation: Array) -> StoreyCurve:
    """Restoring force of the podium at these rotations, out to theta_cr and back."""
    _, displacement, lift = structure.path(rotation)
    held = friction_force(structure, rotation)
    end = structure.critical_rotation
    return StoreyCurve(
        rotation=rotation,
        displacement=displacement,
        force=restoring_force(structure, rotation) + held,
        lift=lift,
        unloading_force=restoring_force(structure, rotation, farthest=end) - held,
    )


def _capacity(
    building: Superstructure,
    curve: StoreyCurve,
    pattern: PatternName | Sequence[float],
    uplift: float,
) -> CapacityCurve:
    forces = load_pattern(building, pattern)
    sway = np.linalg.solve(building.stiffness_matrix, forces)
    path = np.stack((curve.rotation, curve.displacement, curve.force))
    path = np.concatenate((np.zeros((3, 1)), path), axis=1)
    yield_forces = None
    shears = np.cumsum(forces[::-1])[::-1]
    if building.strengths is not None:
        with np.errstate(divide="ignore"):  # storeys without a shear never yield
            yield_forces = building.strengths / np.abs(shears)
        path = _with_kinks(path, yield_forces, hardens=building.hardening > 0.0)
    rotation, base, pushed = path
    roof = base + pushed * sway[-1]
    if yield_forces is not None and building.hardening > 0.0:
        roof += _plastic_drifts(building, np.outer(pushed, shears)).sum(1)
    lifts = np.interp(uplift, rotation, roof)
    if NEARLY * pushed.max() < np.interp(uplift, curve.rotation, curve.force):
        lifts = np.nan
    return CapacityCurve(
        pattern=pattern if isinstance(pattern, str) else "given",
        forces=forces,
        roof_displacement=roof,
        cap_beam_displacement=base,
        sum_of_floor_forces=pushed,
        roof_displacement_at_uplift=float(lifts),
        yield_forces=yield_forces,
    )


def _with_kinks(path: Array, yield_forces: Array, *, hardens: bool) -> Array:
    """Rotation, u_b and lambda (3, points) with a point where
    each storey begins to yield.

    Without hardening the first of them ends the path.
    """
    for force in np.unique(yield_forces):
        below = path[2] < force
        for i in np.flatnonzero(below[:-1] & ~below[1:])[:1]:
            before = path[:, i]
            after = path[:, i + 1]
            point = before + (force - before[2]) / (after[2] - before[2]) * (
                after - before
            )
            point[2] = force
            path = np.insert(path, i + 1, point, axis=1)
            if not hardens:
                return path[:, : i + 2]
    return path


def _plastic_drifts(building: Superstructure, shears: Array) -> Array:
    """Of storeys under shears one after the other (points, n), from
    rest [m] (Theory (15.1)).
    """
    back = np.zeros_like(shears)
    F = building.strengths
    for point, shear in enumerate(shears[1:], 1):
        back[point] = np.clip(back[point - 1], shear - F, shear + F)
    return np.asarray(back / building.back_stiffness)


def load_pattern(
    building: Superstructure, pattern: PatternName | Sequence[float]
) -> Array:
    """Floor forces (n,) of sum 1, from the bottom; a given pattern has any unit."""
    if isinstance(pattern, str):
        n = building.storeys
        heights = building.storey_heights
        height = np.arange(1.0, n + 1.0) if heights is None else np.cumsum(heights)
        shape = {
            "uniform": np.ones(n),
            "triangular": height,
            "first_mode": building.shapes[:, 0],
        }[pattern]
        forces = building.masses * shape
    else:
        forces = np.asarray(pattern, dtype=float)
    if (
        forces.shape != (building.storeys,)
        or not np.isfinite(forces).all()
        or forces.sum() <= 0.0
    ):
        raise ValueError(
            f"the load pattern must be {building.storeys} floor forces from the bottom"
            f" with a sum > 0, not {forces.tolist()}"
        )
    return np.asarray(forces / forces.sum())
