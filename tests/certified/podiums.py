"""Structures of the certified problems: numbers, as pages and cases tell them, for both roads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
import yaml
from oracles.crossings import Array
from oracles.devices import Friction, OracleDevice, RollingResistance, Stop, Tendon, Viscous
from oracles.storey_lagrangian import OracleSystem, StoreyLagrangian

KINDS: dict[type, str] = {
    Viscous: "viscous",
    Friction: "friction",
    Stop: "stop",
    Tendon: "tendon",
    RollingResistance: "rolling_resistance",
}
RECTANGLE = 4.0 / 3.0


class Floors(NamedTuple):
    """From the bottom."""

    masses: tuple[float, ...] = ()
    stiffnesses: tuple[float, ...] = ()


NO_FLOORS = Floors()


@dataclass(frozen=True)
class Podium:
    """Four columns under a cap beam, or one column alone; SI units."""

    slenderness: float = 0.15
    wedge: float = 0.0
    rho: float = 0.0
    R: float = 1.5
    columns_mass: float = 2e4
    beam: float = 2e5
    above: Floors = NO_FLOORS
    damping: float = 0.05
    devices: tuple[OracleDevice, ...] = ()
    number: int = 4
    contact: tuple[str, float, float] | None = None
    """Kind, settlement D_0 [m], damping ratio."""
    loss: float = 1.0
    contact_time: float | None = None

    @property
    def masses(self) -> tuple[float, ...]:
        return self.above.masses

    @property
    def stiffnesses(self) -> tuple[float, ...]:
        return self.above.stiffnesses

    @property
    def wedge_or_flat(self) -> float:
        return self.wedge or self.slenderness

    @property
    def rayleigh(self) -> tuple[float, float]:
        """a_0 and a_1 of C = a_0 M + a_1 K."""
        n = len(self.masses)
        if not n or not self.damping:
            return 0.0, 0.0
        root = np.sqrt(np.linalg.eigvals(self.stiffness_matrix / np.array(self.masses)[:, None]))
        first, *others = sorted(float(w) for w in root.real)
        if n == 1:
            return 0.0, 2.0 * self.damping / first
        second = others[0]
        both = 2.0 * self.damping / (first + second)
        return both * first * second, both

    @property
    def stiffness_matrix(self) -> Array:
        n = len(self.masses)
        between = np.eye(n) - np.eye(n, k=-1)
        return np.asarray(between.T @ np.diag(self.stiffnesses) @ between)

    @property
    def damping_matrix(self) -> Array:
        a_0, a_1 = self.rayleigh
        return np.asarray(a_0 * np.diag(self.masses) + a_1 * self.stiffness_matrix)

    def oracle(self) -> OracleSystem:
        return OracleSystem(
            self.R, self.slenderness, self.wedge_or_flat, self.rho, RECTANGLE, self.columns_mass,
            self.beam, np.array(self.masses), np.array(self.stiffnesses), self.damping_matrix,
            law="flexible",
        )  # fmt: skip

    @property
    def restitution(self) -> float:
        """e with the part `loss` of what impulses at the edges take."""
        return 1.0 - self.loss * (1.0 - self.lagrangian.restitution)

    @property
    def axial(self) -> float:
        """I_3/(m R^2) of solid round columns with flat ends."""
        return 0.5 * self.slenderness**2 / (1.0 + self.slenderness**2)

    @property
    def lagrangian(self) -> StoreyLagrangian:
        return StoreyLagrangian(self.oracle())

    def case(
        self, title: str, record: Mapping[str, str | float], analysis: Mapping[str, float]
    ) -> str:
        """The file that `rps` reads."""
        above: dict[str, object] = {"storeys": len(self.masses)}
        if self.masses:
            above |= {"storey_mass": list(self.masses), "stiffness": list(self.stiffnesses)}
            above["damping"] = {"ratio": self.damping, "modes": [1, min(2, len(self.masses))]}
        bearing: dict[str, float] = {"semi_diagonal": self.R, "slenderness": self.slenderness}
        bearing |= {"wedge_slenderness": self.wedge_or_flat, "curvature_ratio": self.rho}
        impact: dict[str, object] = {"law": "flexible", "loss": self.loss}
        if self.contact_time is not None:
            impact["contact_time"] = self.contact_time
        podium: dict[str, object] = {
            "bearing": {**bearing, "inertia_ratio": RECTANGLE},
            "columns": self.number,
            "column_mass": self.columns_mass / self.number,
            "cap_beam_mass": self.beam,
            "impact": impact,
        }
        if self.contact:
            kind, settlement, damping = self.contact
            podium["contact"] = {"kind": kind, "settlement": settlement, "damping": damping}
        if self.devices:
            podium["devices"] = [told(device) for device in self.devices]
        whole: dict[str, object] = {
            "rps": 1,
            "title": title,
            "superstructure": above,
            "podium": podium,
        }
        whole |= {"record": dict(record), "analysis": dict(analysis)}
        return str(yaml.safe_dump(whole, sort_keys=False, width=100, default_flow_style=None))

    def table(self) -> str:
        """Its numbers as a table of Markdown."""
        rows = [
            ("slenderness of the flat part, `tan(alpha) = B/H`", f"{self.slenderness:g}"),
            ("semi-diagonal `R = sqrt(H^2 + B^2)`", f"{self.R:.16g} m"),
            ("radius of the arcs over the height, `rho = r/(2 H)`", f"{self.rho:g}"),
            ("slenderness to the arcs' outer edge, `tan(alpha')`", f"{self.wedge_or_flat:g}"),
            ("mass of all columns", f"{self.columns_mass:g} kg"),
            ("inertia of a column about an edge of its flat part, over its mass and `R^2`", "4/3"),
            ("mass of the cap beam", f"{self.beam:g} kg"),
        ]
        if not self.rho:
            del rows[2:4]
        if not self.beam:
            rows.pop()
        if self.masses:
            rows += [
                ("floors, from the bottom", " / ".join(f"{m:g}" for m in self.masses) + " kg"),
                ("storey stiffness", " / ".join(f"{k:g}" for k in self.stiffnesses) + " N/m"),
            ]
            a_0, a_1 = self.rayleigh
            ratio = f"damping, {100 * self.damping:g} % in modes 1 and 2: `C = a_0 M + a_1 K`"
            if len(self.masses) == 1:
                ratio = f"damping, {100 * self.damping:g} %: `C = a_1 K`"
            if self.damping:
                value = f"a_1 = {a_1:.16g} s"
                rows.append((ratio, f"a_0 = {a_0:.16g} 1/s, {value}" if a_0 else value))
            else:
                rows.append(("damping of the building", "none"))
        if self.slenderness:
            rows.append(
                ("tilt rate after an impact over that before, `e`", f"{self.restitution:.16g}")
            )
        lines = ["| | |", "|---|---|", *(f"| {name} | {value} |" for name, value in rows)]
        return "\n".join(lines)


def told(device: OracleDevice) -> dict[str, object]:
    """A device as a case writes it; a tendon's `columns` are those of the podium."""
    values = {field.name: getattr(device, field.name) for field in fields(device)}
    values.pop("columns", None)
    kept = {name: value for name, value in values.items() if value != math.inf}
    return {"kind": KINDS[type(device)], **kept}
