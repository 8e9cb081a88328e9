"""History of a slab that turns about the vertical: beside the one of its centre alone.

>>> from rpscli import Bearing, MotionComponents, PodiumStructure, Twist, load_record
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5,
...     rows=(0.0, 10.0), rows_y=(0.0, 10.0), twist=Twist(scatter=0.02))
>>> pulse = load_record("pulse:sine?amplitude=0.4g&period=0.8")
>>> twisted = twist_history(podium, MotionComponents(pulse, y=pulse.scaled(0.5)))
>>> twisted.outcome, twisted.corner_factor > 1.0
('survived', True)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rpscli.analyses.kernels.twist import SLOW, TwistRun, follow_twist
from rpscli.analyses.outcomes import OUTCOMES, REASONS, Outcome
from rpscli.analyses.settings import TimeHistorySettings, require_inputs
from rpscli.errors import CaseError
from rpscli.model.podium import Array, PodiumStructure
from rpscli.physics import state
from rpscli.physics.state import Record
from rpscli.records.ground_motion import MotionComponents
from rpscli.shown import Shown, frozen

NOT_MOVED = 1e-9
"""Displacement of the centre below which no column is compared with it [m]."""


@dataclass(frozen=True, eq=False, repr=False)
class TwistResult(Shown):
    """A slab on three ways, and each column by itself; SI units.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    motion
        Ground motion.
    run
        What the kernel has left behind.
    """

    structure: PodiumStructure
    motion: MotionComponents
    run: TwistRun

    def facts(self) -> dict[str, Any]:
        """What happened."""
        return {
            "outcome": self.outcome,
            "max_twist": self.max_twist,
            "corner_factor": self.corner_factor,
        }

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        code = int(self.run.slab["outcome"])
        if code == state.AT_REST and not self.run.columns["max_u"].any():
            return "at_rest"
        if code == state.SURVIVED and self._is_held:
            return "stays_tilted"
        if code == state.AT_REST:
            return "survived"
        return OUTCOMES.get(code, "failed")

    @property
    def _is_held(self) -> bool:
        """True if friction dampers hold the slab away from upright at the end."""
        if not any(device.kind == "friction" for device in self.structure.devices):
            return False
        displaced = bool(np.hypot(*self.column_ways[-1].T).max() > NOT_MOVED)
        u_x, u_y = self.run.slab["rate"][:2].tolist()
        return displaced and math.hypot(u_x, u_y) < SLOW

    @property
    def reason(self) -> str | None:
        """Why it failed; None if it did not."""
        return REASONS.get(int(self.run.slab["outcome"]))

    @cached_property
    def time(self) -> Array:
        """(rows,) of the samples [s]."""
        return frozen(np.arange(len(self.run.samples), dtype=np.float64) * self.motion.dt)

    @property
    def ways(self) -> Array:
        """(rows, 3) u_x, u_y [m] and psi [rad] at the samples."""
        return self.run.samples[:, :3]

    @cached_property
    def column_ways(self) -> Array:
        """(rows, N, 2) displacements of the heads over the ground [m] at the samples."""
        x, y = self.run.places.T
        psi = self.ways[:, 2:]
        less = 2.0 * np.sin(0.5 * psi) ** 2
        moved_x = self.ways[:, :1] - less * x - np.sin(psi) * y
        moved_y = self.ways[:, 1:2] + np.sin(psi) * x - less * y
        return frozen(np.stack([moved_x, moved_y], axis=-1))

    @property
    def max_twist(self) -> float:
        """Largest |psi| [rad]."""
        return float(self.run.slab["max_twist"])

    @property
    def residual_twist(self) -> float:
        """|psi| at the end [rad]; 0 in full contact."""
        return float(abs(self.run.slab["way"][2]))

    @property
    def max_centre_displacement(self) -> float:
        """Largest |u| of the slab's centre [m]."""
        return float(self.run.slab["max_u"])

    @property
    def max_corner_displacement(self) -> float:
        """Largest |u| of a column's head [m]: of the one that moves most."""
        return float(self.run.columns["max_u"].max())

    @property
    def corner_factor(self) -> float | None:
        """Largest displacement of a column over that of the centre in the same history;
        None if nothing moved.
        """
        centre = self.max_centre_displacement
        return self.max_corner_displacement / centre if centre > NOT_MOVED else None

    @property
    def max_rotation(self) -> float:
        """Largest tilt of a column [rad]."""
        return float(self.run.columns["max_tilt"].max())

    @property
    def rotation_ratio(self) -> float:
        """Largest tilt of a column over its own critical rotation."""
        return float((self.run.columns["max_tilt"] / self.run.critical).max())

    @property
    def worst_column(self) -> int:
        """Index of the column that moves most, from 0."""
        return int(self.run.columns["max_u"].argmax())

    @property
    def max_base_shear(self) -> float:
        """Largest resultant of the storeys' push on the slab, at ends of steps [N]."""
        return float(self.run.slab["max_shear"])

    @property
    def energies(self) -> dict[str, float]:
        """Input, parts of it, and what the integration has lost [J]."""
        last = self.run.samples[-1]
        supplied, damped, pivots, dampers, lost = last[7:12].tolist()
        stored = float(last[6] - self.run.samples[0, 6])
        return {
            "input": supplied,
            "damped": damped,
            "pivots": pivots,
            "dampers": dampers,
            "passes": float(last[17]),
            "lost_at_rest": lost,
            "stored": stored,
            "residual": supplied - damped - pivots - dampers - lost - last[17] - stored,
        }

    def by_column(self) -> list[tuple[str, str, Array]]:
        """Names, units and values of each column: place, factor, largest demands."""
        columns = self.run.columns
        passes = [("passes", "-", columns["passes"])]
        if self.structure.bearing.is_spherical:
            passes = []  # they roll through upright
        return [
            ("x", "m", columns["x"]),
            ("y", "m", columns["y"]),
            ("slenderness_factor", "-", self.run.factors),
            ("max_displacement", "m", columns["max_u"]),
            ("max_displacement_time", "s", columns["max_time"]),
            ("max_rotation", "rad", columns["max_tilt"]),
            ("rotation_ratio", "-", columns["max_tilt"] / self.run.critical),
            ("least_normal", "N", columns["least_load"]),
            ("largest_normal", "N", columns["most_load"]),
            *passes,
        ]


class OfTurningSlab:
    """Results of a history that are those of a slab that turns, where one does."""

    structure: PodiumStructure
    history: Record
    twist: TwistResult | None
    max_cap_beam_displacement: float

    @property
    def max_rotation(self) -> float:
        """Largest rotation [rad]: of the column that tilts most where the slab turns, or of
        the podium without a turn if that is larger.
        """
        alone = float(self.history["max_theta"])
        return max(alone, self.max_column_rotation or 0.0)

    @property
    def rotation_ratio(self) -> float:
        """That over the critical rotation, of each column its own where the slab turns."""
        alone = float(self.history["max_theta"]) / self.structure.critical_rotation
        return max(alone, self.column_rotation_ratio or 0.0)

    @property
    def max_twist(self) -> float | None:
        """Largest |psi| [rad]; None where the slab does not turn."""
        return None if self.twist is None else self.twist.max_twist

    @property
    def residual_twist(self) -> float | None:
        """|psi| at the end [rad]; likewise."""
        return None if self.twist is None else self.twist.residual_twist

    @property
    def max_corner_displacement(self) -> float | None:
        """Largest displacement of a column's head [m], or of the cap beam where it does not
        turn if that is larger; likewise.
        """
        if self.twist is None:
            return None
        return max(self.max_cap_beam_displacement, self.twist.max_corner_displacement)

    @property
    def corner_factor(self) -> float | None:
        """That over the largest of the slab's centre in the same motion; likewise."""
        return None if self.twist is None else self.twist.corner_factor

    @property
    def max_column_rotation(self) -> float | None:
        """Largest tilt of a column [rad]; likewise."""
        return None if self.twist is None else self.twist.max_rotation

    @property
    def column_rotation_ratio(self) -> float | None:
        """Largest tilt of a column over its own critical rotation; likewise."""
        return None if self.twist is None else self.twist.rotation_ratio


def twist_history(
    structure: PodiumStructure,
    motion: MotionComponents,
    settings: TimeHistorySettings | None = None,
) -> TwistResult:
    """Follow the slab on all three ways under both components.

    Parameters
    ----------
    structure
        Podium, bearings and building, with `twist`.
    motion
        Ground motion with both horizontal components and no vertical one.
    settings
        Accuracy, overturning limit, free vibration.

    Raises
    ------
    CaseError
        If `structure.twist` is None, or where one component acts alone.
    """
    settings, motion = require_inputs(structure, motion, settings, None)
    if structure.twist is None:
        raise CaseError("podium.twist is not given: write podium.twist: {} to compute it")
    if motion.y is None:
        raise CaseError(
            "podium.twist: one component acts alone, and twist leaves its plane: give"
            " both components (?both), the second as zero if it is none"
        )
    if motion.vertical is not None:
        raise CaseError(
            "podium.twist: the vertical component is not followed by slabs that turn;"
            " leave it out"
        )
    if settings.initial_rotation:
        raise CaseError(
            "podium.twist: a release from analysis.initial_rotation is not followed"
        )
    return TwistResult(structure, motion, follow_twist(structure, motion, settings))
