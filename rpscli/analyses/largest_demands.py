"""What a history asks of its structure at most: the results that need no samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.device_results import DeviceDemand, device_demands
from rpscli.analyses.failure import failure_text
from rpscli.analyses.kernels.history import History
from rpscli.analyses.outcome import Outcome, outcome_of
from rpscli.analyses.result_quantities import HISTORY, IMPACTS, STOREY_SHEARS, values_of
from rpscli.frozen import frozen
from rpscli.model.podium import PodiumStructure
from rpscli.physics.planar import state
from rpscli.shown import Shown, with_unit


@dataclass(frozen=True, eq=False, repr=False)
class Demand(Shown):
    """Largest demands of a history; SI units.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    history
        What its history left behind.
    """

    structure: PodiumStructure
    history: History

    @property
    def outcome(self) -> Outcome:
        """How the history ended."""
        return outcome_of(self.history)

    @property
    def failure(self) -> str | None:
        """Why the history could not be carried to its end; None if it could."""
        return failure_text(self.history)

    @property
    def overturned(self) -> bool:
        """Whether the overturning limit was passed."""
        return self.outcome.startswith("overturned")

    @property
    def stays_tilted(self) -> bool:
        """Whether friction holds the storey tilted at the end."""
        return self.history.phase == state.STUCK

    @property
    def max_rotation(self) -> float:
        """Largest |theta|, turning points between samples included [rad]."""
        return self.history.max_rotation

    @property
    def max_rotation_time(self) -> float | None:
        """When |theta| was largest [s]; None if there was no rotation."""
        return self.history.max_rotation_time if self.max_rotation > 0.0 else None

    @property
    def rotation_ratio(self) -> float:
        """max |theta|/theta_cr."""
        return self.max_rotation / self.critical_rotation

    @property
    def critical_rotation(self) -> float:
        """theta_cr [rad]."""
        return self.structure.critical_rotation

    @property
    def critical_passage_time(self) -> float | None:
        """When |theta| passed theta_cr for the first time [s]; None if never."""
        return self.history.critical_time if self.history.critical_time >= 0.0 else None

    @property
    def max_cap_beam_displacement(self) -> float:
        """Largest |u_b| [m]; u_b grows with |theta|."""
        return self._paths[0][0]

    @property
    def max_lift(self) -> float:
        """Largest v_b, by which the building is lifted [m]; it grows up to theta_cr."""
        return self._paths[1][1]

    @property
    def residual_rotation(self) -> float:
        """|theta| at the end of the history [rad]; 0 in full contact."""
        return abs(self.history.rotation)

    @property
    def residual_displacement(self) -> float:
        """|u_b| at the end of the history [m]; 0 in full contact."""
        return self._paths[0][2]

    @cached_property
    def _paths(self) -> tuple[list[float], list[float]]:
        """u_b and v_b [m] at the largest rotation, at the largest up to theta_cr, at the end."""
        highest = min(self.max_rotation, self.critical_rotation)
        _, u, v = self.structure.path(
            np.array([self.max_rotation, highest, self.residual_rotation])
        )
        return u.tolist(), v.tolist()

    @property
    def devices(self) -> tuple[DeviceDemand, ...]:
        """Demands of each device, in the order of the structure's."""
        return device_demands(self.structure, self.history)

    @property
    def max_damper_force(self) -> float | None:
        """Largest force of a viscous or friction damper [N]; None without one."""
        return self._largest_force("max_damper_force")

    @property
    def max_stop_force(self) -> float | None:
        """Largest force of a stop [N]; None without one."""
        return self._largest_force("max_stop_force")

    def _largest_force(self, result: str) -> float | None:
        """Largest force of the devices whose laws name a result [N]; None without any."""
        devices = enumerate(self.structure.devices)
        numbers = [number for number, device in devices if result in device.results]
        return max((float(self.history.device_force[i]) for i in numbers), default=None)

    @property
    def lost_prestress(self) -> float | None:
        """Largest part of its prestress that a tendon has lost; None without prestress."""
        lost = [
            1.0 - demand.remaining_prestress / prestress
            for device, demand in zip(self.structure.devices, self.devices, strict=True)
            if (prestress := device.remaining_prestress(0.0))
            and demand.remaining_prestress is not None
        ]
        return max(lost, default=None)

    @property
    def energy_devices(self) -> float:
        """Energy dissipated in all devices [J]."""
        return float(self.history.device_energy.sum())

    @property
    def storey_shears(self) -> NDArray[np.float64]:
        """(n,) largest elastic shears k_i d_i at the samples [N], from the bottom."""
        return self.history.storey_shears

    @property
    def floor_accelerations(self) -> NDArray[np.float64]:
        """(n,) largest absolute accelerations at the samples [m/s2], from the bottom."""
        return self.history.floor_accelerations

    @property
    def max_floor_acceleration(self) -> float | None:
        """Largest of `floor_accelerations` [m/s2]; None without a superstructure."""
        return _largest(self.floor_accelerations)

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
        return frozen(self.storey_shears / building.stiffnesses) if building else self.storey_shears

    @property
    def drift_ratio(self) -> float | None:
        """Largest drift over storey height; None where no heights are given."""
        building = self.structure.superstructure
        ratios = None if building is None else building.drift_ratios(self.max_drifts)
        return None if ratios is None else float(np.max(ratios))

    @property
    def friction_demand(self) -> float:
        """Largest |F|/N at either end of the columns: the friction that no sliding needs."""
        return float(max(self.history.friction))

    @property
    def friction_ratio(self) -> float | None:
        """friction_demand over the coefficient of friction; None where that is not given."""
        coefficient = self.structure.friction
        return None if coefficient is None else self.friction_demand / coefficient

    @property
    def uplifts(self) -> int:
        """Number of uplifts from full contact."""
        return int(self.history.counts[state.UPLIFT])

    @property
    def impacts(self) -> int:
        """Number of impacts, those that end in re-contact included."""
        return int(self.history.counts[state.IMPACT])

    @property
    def duration(self) -> float:
        """Length of the history with its free vibration [s]."""
        return self.history.time

    @property
    def energy_impact(self) -> float:
        """Net energy lost at impacts and re-contacts [J]."""
        return self.history.energy_lost

    @property
    def energy_created(self) -> float:
        """Energy gained where the impact law sets floors in motion [J] (Theory, section 4)."""
        return self.history.energy_created

    @property
    def creating_impacts(self) -> int:
        """Number of impacts that gained energy."""
        return self.history.creating_impacts

    def facts(self) -> dict[str, Any]:
        """Outcome and scalar results with their units, the main demands first."""
        ordered = sorted(HISTORY, key=lambda quantity: not quantity.demand)
        return {
            "outcome": self.outcome,
            **{q.name: with_unit(getattr(self, q.name), q.unit) for q in ordered},
        }

    def scalars(self) -> dict[str, Any]:
        """Outcome and scalar results, under their names in JSON and CSV.

        A value that does not exist, or is infinite, is None.
        """
        return {"outcome": self.outcome, **values_of(self, HISTORY)}

    def results(self) -> dict[str, Any]:
        """What a study keeps of a history besides its outcome."""
        return values_of(self, (*HISTORY, *IMPACTS, STOREY_SHEARS))


def _largest(values: NDArray[np.float64]) -> float | None:
    """The largest of some values; None if there are none."""
    return float(np.max(values)) if len(values) else None
