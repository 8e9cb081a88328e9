"""What a time history gives besides its largest demands: samples, events, energies, warnings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.fixed_base import FixedBaseResponse
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.trace import Event, Trace
from rpscli.physics import state
from rpscli.physics.formulae import geometry
from rpscli.records.ground_motion import GroundMotion


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
class TimeHistoryResult(Demand):
    """Response of a structure to a record: its largest demands, samples and events; SI units."""

    record: GroundMotion
    settings: TimeHistorySettings
    trace: Trace
    events: tuple[Event, ...]
    fixed_base: FixedBaseResponse | None

    @property
    def energy(self) -> Energy:
        """The energy audit."""
        given, damped, lost, stored = (float(e) for e in self.history.energies)
        started = float(self.trace.energy_stored[0])
        residual = given + started - damped - lost - stored
        return Energy(given, damped, lost, stored, residual, self.energy_created)

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
        if self.outcome == "survived" and self.history.motion != state.FULL_CONTACT:
            if self.settings.free_vibration is not None:
                notes.append(
                    "the storey still moves at the end; a longer `analysis.free_vibration`"
                    " may bring larger maxima"
                )
            elif self.duration >= self.record.duration + LONGEST_FREE_VIBRATION:
                notes.append(f"not at rest {LONGEST_FREE_VIBRATION:g} s after the record's end")
        return tuple(notes)
