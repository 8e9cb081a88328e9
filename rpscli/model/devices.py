"""Laws of the devices between ground and cap beam, with all that
follows (Theory, section 11).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rpscli.errors import require_fields
from rpscli.model.bearing import Bearing, UpliftedState
from rpscli.model.own import DamperLaw, OwnLaw
from rpscli.model.podium import (
    Array,
    AtRest,
    Consequence,
    Device,
    Linear,
    PodiumStructure,
)
from rpscli.registry import Registry


@dataclass(frozen=True)
class ViscousDamper(Device):
    """P = -c |u_b'|^a sgn(u_b') on the cap beam, c [N (s/m)^a] the
    force at 1 m/s, a 0.2 to 2.
    """

    coefficient: float
    exponent: float = 1.0
    at: tuple[tuple[float, float], ...] = ()

    kind = "viscous"
    results = ("max_damper_force",)

    def __post_init__(self) -> None:
        _require(self, "> 0", "coefficient")
        if not 0.2 <= self.exponent <= 2.0:
            raise ValueError("exponent must be >= 0.2 and <= 2")

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        if self.exponent != 1.0:
            return Linear(left_out="dampers whose exponent is not 1")
        return Linear(damping=self.coefficient * state.height**2)

    def bounds(self, structure: PodiumStructure) -> tuple[float, float]:
        # Powers of the velocity shorten their steps by themselves.
        return 0.0, self.coefficient if self.exponent == 1.0 else 0.0

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        if structure.bearing.is_spherical:
            return
        speed = (structure.uplift_force / self.coefficient) ** (1.0 / self.exponent)
        yield Consequence(
            "velocity_at_uplift_force", "reaches W tan(alpha) at", "m/s", speed
        )


@dataclass(frozen=True)
class FrictionDamper(Device):
    """P = -F_d sgn(u_b'), F_d [N]; at rest any |P| <= F_d."""

    force: float
    at: tuple[tuple[float, float], ...] = ()

    kind = "friction"
    results = ("max_damper_force",)

    def __post_init__(self) -> None:
        _require(self, "> 0", "force")

    def at_rest(
        self, structure: PodiumStructure, rotation: Array, farthest: float
    ) -> AtRest:
        return AtRest(held=self.force)

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        return Linear(left_out="friction")

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        if structure.bearing.is_spherical:
            return
        share = self.force / structure.uplift_force
        yield Consequence("uplift_share", "over W tan(alpha)", "-", share)


@dataclass(frozen=True)
class Stop(Device):
    """s P = -(k_s (|u_b| - d) + c_s |u_b|') beyond the gap d [m] on
    both sides, where it pushes.
    """

    gap: float
    stiffness: float
    damping: float = 0.0

    kind = "stop"
    results = ("max_stop_force",)

    def __post_init__(self) -> None:
        _require(self, ">= 0", "gap", "damping")
        _require(self, "> 0", "stiffness")

    def at_rest(
        self, structure: PodiumStructure, rotation: Array, farthest: float
    ) -> AtRest:
        beyond = np.maximum(self.stroke(structure, rotation) - self.gap, 0.0)
        return AtRest(self.stiffness * beyond)

    def stiffness_after_uplift(self, structure: PodiumStructure) -> float:
        return self.stiffness if self.gap == 0.0 else 0.0

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        return Linear(left_out="stops")

    def bounds(self, structure: PodiumStructure) -> tuple[float, float]:
        return self.stiffness, self.damping

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        x = self.reached_at(structure, self.gap)
        over = None if x is None else x / structure.critical_rotation
        yield Consequence("met_rotation", "met at", "rad", x)
        yield Consequence("met_rotation_ratio", "met at, over theta_cr", "-", over)


@dataclass(frozen=True)
class Tendon(Device):
    """An unbonded tendon in the axis of each column, from the ground to the cap beam.

    Elastic up to its yield force and perfectly plastic beyond; it never pushes. Prestress
    P_0 while the structure stands [N], k_t [N/m] and P_y [N] are those of one.
    """

    prestress: float
    stiffness: float
    yield_force: float = math.inf

    kind = "tendon"
    in_each_column = True

    def __post_init__(self) -> None:
        _require(self, ">= 0", "prestress")
        _require(self, "> 0", "stiffness")
        if not self.yield_force > self.prestress:
            raise ValueError(
                f"yield_force = {self.yield_force:g} N must be > prestress ="
                f" {self.prestress:g} N; use a lower prestress, or leave yield_force out"
                " for a tendon that never yields"
            )

    @property
    def results(self) -> tuple[str, ...]:
        return ("lost_prestress",) if self.prestress > 0.0 else ()

    def at_rest(
        self, structure: PodiumStructure, rotation: Array, farthest: float
    ) -> AtRest:
        stretch = self.stroke(structure, rotation) - self.permanent(structure, farthest)
        tension = np.clip(
            self.prestress + self.stiffness * stretch, 0.0, self.yield_force
        )
        lever = structure.bearing.tendon_lever(rotation)
        arm = structure.lever_arm(rotation)
        return AtRest(structure.columns * tension * lever / arm)

    def permanent(self, structure: PodiumStructure, farthest: float) -> float:
        """Elongation that it keeps after it was drawn to a rotation [m]."""
        elastic = (self.yield_force - self.prestress) / self.stiffness
        drawn = self.stroke(structure, np.array([farthest]))
        return max(0.0, float(drawn[0]) - elastic)

    def stiffness_after_uplift(self, structure: PodiumStructure) -> float:
        bearing = structure.bearing
        N = structure.columns
        B = bearing.half_width
        r = 0.0 if bearing.is_flat else bearing.radius
        growth = N * (self.stiffness * 4.0 * B**2 + self.prestress * 2.0 * r)
        return _force_growth(bearing, N * self.prestress * 2.0 * B, growth)

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        # N T de/dx, over (2 R)^2 x.
        e, slope, bend = state.elongation
        tension = min(self.prestress + self.stiffness * e, self.yield_force)
        growth = structure.columns * (self.stiffness * slope**2 + tension * bend)
        diameter = 2.0 * structure.bearing.semi_diagonal
        return Linear(growth / diameter**2, left_out="yielding of tendons")

    def bounds(self, structure: PodiumStructure) -> tuple[float, float]:
        # N k_t (de/du_b)^2: de/dx is at most 2 (B + r beta), du_b/dx at least 2 R
        # cos(alpha).
        b = structure.bearing
        radius = 2.0 * b.curvature_ratio * b.semi_diagonal * math.cos(b.alpha)
        reach = math.tan(b.alpha) + radius * b.beta / (
            b.semi_diagonal * math.cos(b.alpha)
        )
        return structure.columns * self.stiffness * reach**2, 0.0

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        added = structure.columns * self.prestress * structure.bearing.slenderness
        share = added / structure.uplift_force
        yield Consequence("uplift_share", "prestress over weight", "-", share)
        if not math.isfinite(self.yield_force):
            return
        ratio = self.prestress / self.yield_force
        yield Consequence("prestress_ratio", "prestress over yield force", "-", ratio)
        x = self.reached_at(
            structure, (self.yield_force - self.prestress) / self.stiffness
        )
        yield Consequence("yield_rotation", "yields at", "rad", x)
        left = self.remaining_prestress(
            self.permanent(structure, structure.critical_rotation)
        )
        yield Consequence(
            "prestress_after_critical", "prestress after theta_cr", "N", left
        )

    def stroke(self, structure: PodiumStructure, rotation: Array) -> Array:
        return structure.bearing.tendon_elongation(rotation)

    def remaining_prestress(self, permanent: float) -> float:
        return max(0.0, self.prestress - self.stiffness * permanent)


@dataclass(frozen=True)
class RollingResistance(Device):
    """The moment f (N_top + N_bot) against the tilt's rate, f [m], the
    weight for normal forces.
    """

    lever: float

    kind = "rolling_resistance"
    results = ()

    def __post_init__(self) -> None:
        _require(self, "> 0", "lever")

    def constants(self, structure: PodiumStructure) -> tuple[float, ...]:
        return (2.0 * structure.weight * self.lever,)

    def at_rest(
        self, structure: PodiumStructure, rotation: Array, farthest: float
    ) -> AtRest:
        return AtRest(
            held=2.0 * structure.weight * self.lever / structure.lever_arm(rotation)
        )

    def stiffness_after_uplift(self, structure: PodiumStructure) -> float:
        return _force_growth(structure.bearing, 2.0 * structure.weight * self.lever, 0.0)

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        return Linear(left_out="rolling resistance")

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        if structure.bearing.is_spherical:
            return
        share = self.lever / structure.bearing.half_width
        yield Consequence("uplift_share", "over W tan(alpha)", "-", share)


@dataclass(frozen=True)
class OwnDamper(Device):
    """A damper of the kind `name` whose law another package adds, and
    values of its constants.
    """

    name: str
    law: DamperLaw
    values: tuple[float, ...]

    results = ("max_damper_force",)

    def __post_init__(self) -> None:
        require_fields(self)
        self.law.require_values(self.values, f"damper {self.name}")
        self.law.require_resistance(self.name, self.values)

    @property
    def kind(self) -> str:
        return self.name

    def constants(self, structure: PodiumStructure) -> tuple[float, ...]:
        return self.values

    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        if self.law.linear is None:
            return Linear(
                left_out=f"dampers of kind {self.name}, which have a kink at rest"
            )
        return Linear(damping=self.law.linear(*self.values) * state.height**2)

    def bounds(self, structure: PodiumStructure) -> tuple[float, float]:
        stiffness = (
            0.0 if self.law.stiffness is None else self.law.stiffness(*self.values)
        )
        return stiffness, self.law.damping(*self.values)


def own_laws(structure: PodiumStructure) -> dict[str, OwnLaw]:
    """Laws of other packages that a structure has, by their names."""
    laws: dict[str, OwnLaw] = {
        device.kind: device.law
        for device in structure.devices
        if isinstance(device, OwnDamper)
    }
    own = structure.impact_law.own
    return laws if own is None else {**laws, structure.impact_law.kind: own}


def _require(device: Device, rule: str, *names: str) -> None:
    require_fields(device)
    for name in names:
        value = getattr(device, name)
        if not 0.0 <= value < math.inf or (rule == "> 0" and value == 0.0):
            raise ValueError(f"{name} must be {rule} and finite")


def _force_growth(bearing: Bearing, moment: float, growth: float) -> float:
    """Part of dF/du_b at u_b = 0+ that a moment M + M' x adds [N/m], exact.

    With the arm 2 R C = 2 H + 2 B x it is the force M/2H + (M' - M B/H)
    x/2H, and du_b = 2 H dx.
    """
    return (growth - moment * bearing.half_width / bearing.half_height) / (
        4.0 * bearing.half_height**2
    )


DEVICES: dict[str, type[Device]] = {
    ViscousDamper.kind: ViscousDamper,
    FrictionDamper.kind: FrictionDamper,
    Stop.kind: Stop,
    Tendon.kind: Tendon,
    RollingResistance.kind: RollingResistance,
}
"""Laws by their names in a case, in the order of the kernels' codes."""

DAMPERS: Registry[type[Device] | DamperLaw] = Registry("dampers", {**DEVICES}, DamperLaw)
"""The same, and what other packages add."""
