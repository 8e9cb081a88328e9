"""What a time history gives: arrays, events, and the scalars of the report."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.fixed_base import FixedBaseResponse
from rpscli.analyses.outcome import Outcome
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.trace import Event, Trace
from rpscli.model.podium import PodiumStructure
from rpscli.physics import geometry, layout
from rpscli.records.ground_motion import GroundMotion

if TYPE_CHECKING:
    from rpscli.analyses.history import History


@dataclass(frozen=True)
class Energy:
    """Where the energy went [J]: input = damped + impact + stored + residual.

    `impact` is the net loss at impacts and re-contacts; `created` the part of it that was gained
    where the rigid impact law sets floors in motion (Theory, section 4). `residual` is the error
    of the integration.
    """

    input: float
    damped: float
    impact: float
    stored: float
    residual: float
    created: float


@dataclass(frozen=True, eq=False)
class TimeHistoryResult:
    """Response of a structure to a record; SI units."""

    structure: PodiumStructure
    record: GroundMotion
    settings: TimeHistorySettings
    outcome: Outcome
    failure: str | None
    history: History
    trace: Trace
    events: tuple[Event, ...]
    fixed_base: FixedBaseResponse | None

    @property
    def overturned(self) -> bool:
        """Whether the overturning limit was passed."""
        return self.outcome.startswith("overturned")

    @property
    def max_rotation(self) -> float:
        """Largest |theta|, turning points between samples included [rad]."""
        return float(self.history.max_rotation)

    @property
    def rotation_ratio(self) -> float:
        """max |theta|/theta_cr."""
        return self.max_rotation / self.structure.critical_rotation

    @property
    def max_cap_beam_displacement(self) -> float:
        """Largest |u_b| [m]; u_b grows with |theta|."""
        _, u, _ = self.structure.path(np.array([self.max_rotation]))
        return float(u[0])

    @property
    def storey_shears(self) -> NDArray[np.float64]:
        """(n,) largest elastic shears k_i d_i at the samples [N], from the bottom."""
        return self.history.storey_shears

    @property
    def floor_accelerations(self) -> NDArray[np.float64]:
        """(n,) largest absolute accelerations at the samples [m/s2], from the bottom."""
        return self.history.floor_accelerations

    @property
    def max_base_shear(self) -> float:
        """Largest elastic shear of the first storey [N]; 0 without a superstructure."""
        return float(self.storey_shears[0]) if len(self.storey_shears) else 0.0

    @property
    def base_shear_ratio(self) -> float | None:
        """max_base_shear over V_st = M_tot g tan(alpha); None without a superstructure."""
        static = self.structure.static_base_shear
        return self.max_base_shear / static if static > 0.0 else None

    @property
    def max_drifts(self) -> NDArray[np.float64]:
        """(n,) largest storey drifts [m]."""
        building = self.structure.superstructure
        return self.storey_shears / building.stiffnesses if building else self.storey_shears

    @property
    def drift_ratio(self) -> float | None:
        """Largest drift over storey height; None where no heights are given."""
        building = self.structure.superstructure
        if building is None or building.storey_heights is None:
            return None
        return float(np.max(self.max_drifts / building.storey_heights))

    @property
    def friction_demand(self) -> float:
        """Largest |F|/N at either end of the columns: the friction that no sliding needs."""
        return float(max(self.history.friction))

    @property
    def uplifts(self) -> int:
        """Number of uplifts from full contact."""
        return int(self.history.counts[layout.UPLIFT])

    @property
    def impacts(self) -> int:
        """Number of impacts, those that end in re-contact included."""
        return int(self.history.counts[layout.IMPACT])

    @property
    def duration(self) -> float:
        """Length of the history with its free vibration [s]."""
        return float(self.history.time)

    @property
    def critical_passage_time(self) -> float | None:
        """When |theta| passed theta_cr for the first time [s]; None if never."""
        return float(self.history.critical_time) if self.history.critical_time >= 0.0 else None

    @property
    def energy(self) -> Energy:
        """The energy audit."""
        given, damped, lost, stored = (float(e) for e in self.history.energies)
        created = float(self.history.energy_created)
        started = float(self.trace.energy_stored[0])
        residual = given + started - damped - lost - stored
        return Energy(given, damped, lost, stored, residual, created)

    def restoring_moment(self, rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        """Static moment 2 R W s B(x) at rotations theta [N m], of the shape of `rotation`.

        What `Trace.driving_moment` equals in slow motion; positive where the weight restores a
        positive rotation.
        """
        b, theta = self.structure.bearing, np.asarray(rotation)
        arm, *_ = geometry.path_along(b.rolling, b.rocking, b.beta, np.abs(theta))
        return 2.0 * b.semi_diagonal * self.structure.weight * np.sign(theta) * arm

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user must know before trusting the numbers."""
        notes = list(self.record.warnings)
        least = min(self.history.least_normal)
        if least <= 0.0:
            notes.append(
                "contact is lost: the normal force between columns and beam or ground falls to"
                f" {least:.3g} of the weight; the model assumes contact throughout"
            )
        supplied = abs(self.energy.input) + float(self.trace.energy_stored[0])
        if self.energy.created > 0.02 * supplied:
            share = self.energy.created / supplied
            notes.append(
                f"the rigid impact law created {share:.1%} of the energy supplied at impacts;"
                " compare with `impact: {law: flexible}`"
            )
        if self.outcome == "survived" and self.history.motion != layout.FULL_CONTACT:
            if self.settings.free_vibration is not None:
                notes.append(
                    "the storey still moves at the end; a longer `analysis.free_vibration`"
                    " may bring larger maxima"
                )
            elif self.duration >= self.record.duration + LONGEST_FREE_VIBRATION:
                notes.append(f"not at rest {LONGEST_FREE_VIBRATION:g} s after the record's end")
        return tuple(notes)

    def scalars(self) -> dict[str, float | int | str | None]:
        """The scalar results under their names in JSON and CSV."""
        friction = self.friction_demand
        return {
            "outcome": self.outcome,
            "max_rotation": self.max_rotation,
            "rotation_ratio": self.rotation_ratio,
            "critical_rotation": self.structure.critical_rotation,
            "critical_passage_time": self.critical_passage_time,
            "max_cap_beam_displacement": self.max_cap_beam_displacement,
            "max_base_shear": self.max_base_shear,
            "base_shear_ratio": self.base_shear_ratio,
            "drift_ratio": self.drift_ratio,
            "uplifts": self.uplifts,
            "impacts": self.impacts,
            "duration": self.duration,
            "friction_demand": friction if math.isfinite(friction) else None,
        }
