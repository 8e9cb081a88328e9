"""What histories ask of their structures at most: the results that need no samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar, cast, overload

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.outcome import Outcome, failure_text, outcomes_of
from rpscli.analyses.result_quantities import HISTORY, KERNEL_FIELDS, ResultQuantity, values_of
from rpscli.analyses.trace import DeviceDemand, device_demands
from rpscli.frozen import frozen
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.statics import uplift_acceleration
from rpscli.physics.core.records import Record, record_type
from rpscli.physics.planar import geometry, state
from rpscli.shown import Shown, with_unit

Array = NDArray[np.float64]
T = TypeVar("T")


class Histories:
    """Results of histories as columns (histories, ...), NaN where a history has none.

    The structures have one number of storeys; `number` says which of them a history belongs to.
    """

    def __init__(
        self, structures: Sequence[PodiumStructure], number: Sequence[int], left: Record
    ) -> None:
        # Fields by attribute, which records of the kernels have, take numpy ten times as long.
        self.left = left.view(record_type(state.RESULT), np.ndarray)
        self.structures, self.number = structures, np.array(number)
        self.storeys = structures[0].storeys

    @classmethod
    def of_one(cls, structure: PodiumStructure, history: Record) -> Histories:
        """A batch of one history."""
        return cls([structure], [0], np.array([history], dtype=record_type(state.RESULT)))

    @property
    def outcomes(self) -> NDArray[np.str_]:
        """How each ended, in words."""
        return outcomes_of(self.left)

    def column(self, name: str) -> Array:
        """The values of a result of the table of results: a field of the kernel's, or made here."""
        field = KERNEL_FIELDS.get(name)
        values: Array = self.left[field] if field else getattr(self, name)
        return values

    def columns(self, quantities: Iterable[ResultQuantity]) -> dict[str, Array]:
        """Finite values by name; NaN where there is none."""
        with np.errstate(all="ignore"):
            values = {q.name: self.column(q.name) + 0.0 for q in quantities}  # no -0.0
        for column in values.values():
            column[~np.isfinite(column)] = np.nan
        return values

    def _kept(self, field: str) -> Array:
        values: Array = self.left[field]
        return values

    def _each(self, constant: Callable[[PodiumStructure], Any]) -> Array:
        """Of the structure of each history; NaN for None."""
        found = np.array([constant(structure) for structure in self.structures], np.float64)
        return np.asarray(found[self.number])

    @property
    def max_rotation_time(self) -> Array:
        """Of those that rotated."""
        return np.where(self._kept("max_theta") > 0.0, self._kept("max_theta_time"), np.nan)

    @cached_property
    def critical_rotation(self) -> Array:
        """theta_cr."""
        return self._each(lambda structure: structure.critical_rotation)

    @property
    def rotation_ratio(self) -> Array:
        """max |theta|/theta_cr."""
        return self._kept("max_theta") / self.critical_rotation

    @property
    def critical_passage_time(self) -> Array:
        """Of those that passed theta_cr."""
        time = self._kept("critical_time")
        return np.where(time >= 0.0, time, np.nan)

    @property
    def residual_rotation(self) -> Array:
        """|theta| at the end."""
        return np.abs(self._kept("rotation"))

    @cached_property
    def _path(self) -> tuple[Array, Array]:
        """u_b and v_b (3, histories) at the largest rotation, the largest up to theta_cr, the end.

        u_b grows with |theta|, v_b up to theta_cr.
        """
        largest = self._kept("max_theta")
        highest = np.minimum(largest, self.critical_rotation)
        bearings = [structure.bearing for structure in self.structures]
        rolling, rocking = (
            geometry.Phase(*np.array(phases).T[:, self.number])
            for phases in ([b.rolling for b in bearings], [b.rocking for b in bearings])
        )
        beta = np.array([b.beta for b in bearings])[self.number]
        rotations = np.array([largest, highest, self.residual_rotation])
        _, _, u, v = geometry.path_along(rolling, rocking, beta, rotations)
        diameter = 2.0 * np.array([b.semi_diagonal for b in bearings])[self.number]
        return diameter * u, diameter * v

    @property
    def max_cap_beam_displacement(self) -> Array:
        """u_b at the largest rotation."""
        return np.asarray(self._path[0][0])

    @property
    def max_lift(self) -> Array:
        """v_b at the largest rotation up to theta_cr."""
        return np.asarray(self._path[1][1])

    @property
    def residual_displacement(self) -> Array:
        """u_b at the end."""
        return np.asarray(self._path[0][2])

    @property
    def storey_shears(self) -> Array:
        """(histories, n)."""
        return self._kept("storey_shear")[:, : self.storeys]

    @property
    def floor_accelerations(self) -> Array:
        """(histories, n)."""
        return self._kept("floor_acceleration")[:, : self.storeys]

    @property
    def max_base_shear(self) -> Array:
        """Of the first storey; 0 without one."""
        return self.storey_shears[:, 0] if self.storeys else np.zeros(len(self.left))

    @property
    def base_shear_ratio(self) -> Array:
        """max_base_shear over V_st."""
        static = self._each(lambda structure: structure.static_base_shear or None)
        return self.max_base_shear / static

    @property
    def uplift_shear_ratio(self) -> Array:
        """max_base_shear over M_tot times the ground acceleration that uplifts with devices."""
        shear = self._each(
            lambda s: s.superstructure_mass * uplift_acceleration(s) or None if s.devices else None
        )
        return self.max_base_shear / shear

    @property
    def max_floor_acceleration(self) -> Array:
        """Largest of all floors."""
        return _largest(self.floor_accelerations)

    @property
    def max_drifts(self) -> Array:
        """(histories, n)."""
        if not self.storeys:
            return self.storey_shears
        return self.storey_shears / self._each(
            lambda s: s.superstructure and s.superstructure.stiffnesses
        )

    @property
    def drift_ratio(self) -> Array:
        """Largest of all storeys."""
        unknown = np.full(self.storeys, np.nan)

        def heights(structure: PodiumStructure) -> Array:
            building = structure.superstructure
            known = None if building is None else building.storey_heights
            return unknown if known is None else known

        return _largest(self.max_drifts / self._each(heights))

    @property
    def friction_demand(self) -> Array:
        """Largest |F|/N of both ends."""
        return np.maximum(self._kept("friction_top"), self._kept("friction_bottom"))

    @property
    def friction_ratio(self) -> Array:
        """friction_demand over the coefficient."""
        return self.friction_demand / self._each(lambda structure: structure.friction)

    @property
    def uplifts(self) -> Array:
        """Events."""
        return self._kept("events")[:, state.UPLIFT]

    @property
    def impacts(self) -> Array:
        """Events."""
        return self._kept("events")[:, state.IMPACT]

    @property
    def max_damper_force(self) -> Array:
        """Of viscous and friction dampers."""
        return self._largest_force("max_damper_force")

    @property
    def max_stop_force(self) -> Array:
        """Of stops."""
        return self._largest_force("max_stop_force")

    def _largest_force(self, result: str) -> Array:
        """Of the devices whose laws name a result."""
        found = np.full((len(self.left), state.SLOTS), np.nan)
        for rows, i, device in self._devices():
            if result in device.results:
                found[rows, i] = self._kept("device_force")[rows, i]
        return np.asarray(np.fmax.reduce(found, axis=1))

    @property
    def lost_prestress(self) -> Array:
        """Largest part that a tendon has lost of its prestress."""
        found = np.full((len(self.left), state.SLOTS), np.nan)
        for rows, i, device in self._devices():
            if prestress := device.remaining_prestress(0.0):
                permanent = self._kept("permanent")[rows, i].tolist()
                remaining = [device.remaining_prestress(length) for length in permanent]
                found[rows, i] = 1.0 - np.array(remaining, np.float64) / prestress
        return np.asarray(np.fmax.reduce(found, axis=1))

    def _devices(self) -> Iterator[tuple[NDArray[np.int64], int, Device]]:
        """Numbers of the histories of each structure, and the slots and laws of its devices."""
        for number, structure in enumerate(self.structures):
            for i, device in enumerate(structure.devices):
                yield np.flatnonzero(self.number == number), i, device

    @property
    def energy_devices(self) -> Array:
        """Of all devices."""
        return np.asarray(self._kept("device_energy").sum(axis=1))


def _largest(values: Array) -> Array:
    """Of each row; NaN of empty ones."""
    return np.asarray(values.max(axis=1)) if values.shape[1] else np.full(len(values), np.nan)


class _Result(Generic[T]):
    """An attribute of `Demand`: the result of its name, of a batch of one history."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, demand: None, owner: type) -> _Result[T]: ...
    @overload
    def __get__(self, demand: Demand, owner: type) -> T: ...
    def __get__(self, demand: Demand | None, owner: type) -> _Result[T] | T:
        if demand is None:
            return self
        found: T = self._told(demand._alone.column(self._name)[0])  # noqa: SLF001
        return found

    def _told(self, value: Any) -> Any:
        return value.item() if value.ndim == 0 else frozen(value)


class _Optional(_Result[float | None]):
    """One that not every history has: None in place of NaN."""

    def _told(self, value: Any) -> Any:
        return None if np.isnan(value) else float(value)


@dataclass(frozen=True, eq=False, repr=False)
class Demand(Shown):
    """Largest demands of a history; SI units.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    history
        What its history left behind: a `physics.planar.state.RESULT`.
    """

    structure: PodiumStructure
    history: Record

    @cached_property
    def _alone(self) -> Histories:
        return Histories.of_one(self.structure, self.history)

    @property
    def outcome(self) -> Outcome:
        """How the history ended."""
        return cast("Outcome", str(outcomes_of(self.history)))

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
        return self.outcome == "stays_tilted"

    max_rotation = _Result[float]("Largest |theta|, turning points between samples included [rad].")
    max_rotation_time = _Optional("When |theta| was largest [s]; None if there was no rotation.")
    rotation_ratio = _Result[float]("max |theta|/theta_cr.")
    critical_rotation = _Result[float]("theta_cr [rad].")
    critical_passage_time = _Optional(
        "When |theta| passed theta_cr for the first time [s]; None if never."
    )
    max_cap_beam_displacement = _Result[float]("Largest |u_b| [m]; u_b grows with |theta|.")
    max_lift = _Result[float](
        "Largest v_b, by which the building is lifted [m]; it grows up to theta_cr."
    )
    residual_rotation = _Result[float]("|theta| at the end of the history [rad].")
    residual_displacement = _Result[float]("|u_b| at the end [m]; 0 in full contact.")
    max_damper_force = _Optional(
        "Largest force of a viscous or friction damper [N]; None without one."
    )
    max_stop_force = _Optional("Largest force of a stop [N]; None without one.")
    lost_prestress = _Optional(
        "Largest part of its prestress that a tendon has lost; None without prestress."
    )
    energy_devices = _Result[float]("Energy dissipated in all devices [J].")
    storey_shears = _Result[Array](
        "(n,) largest elastic shears k_i d_i [N], from the bottom, within steps too."
    )
    floor_accelerations = _Result[Array](
        "(n,) largest absolute accelerations [m/s2], from the bottom, on both sides of impacts."
    )
    max_floor_acceleration = _Optional(
        "Largest of `floor_accelerations` [m/s2]; None without a superstructure."
    )
    max_base_shear = _Result[float](
        "Largest elastic shear of the first storey [N]; 0 without a superstructure."
    )
    base_shear_ratio = _Optional(
        "max_base_shear over V_st = M_tot g tan(alpha); None without a superstructure."
    )
    uplift_shear_ratio = _Optional(
        "max_base_shear over the base shear at quasi-static uplift against weight and devices; None"
        " without either a superstructure or devices."
    )
    max_drifts = _Result[Array]("(n,) largest storey drifts [m].")
    drift_ratio = _Optional("Largest drift over storey height; None where no heights are given.")
    friction_demand = _Result[float](
        "Largest |F|/N at either end of the columns: the friction that no sliding needs."
    )
    friction_ratio = _Optional(
        "friction_demand over the coefficient of friction; None where that is not given."
    )
    uplifts = _Result[int]("Number of uplifts from full contact.")
    impacts = _Result[int]("Number of impacts, those that end in re-contact included.")
    duration = _Result[float]("Length of the history with its free vibration [s].")
    energy_impact = _Result[float]("Net energy lost at impacts and re-contacts [J].")
    energy_created = _Result[float](
        "Energy gained where the impact law sets floors in motion [J] (Theory, section 4)."
    )
    creating_impacts = _Result[int]("Number of impacts that gained energy.")

    @property
    def devices(self) -> tuple[DeviceDemand, ...]:
        """Demands of each device, in the order of the structure's."""
        return device_demands(self.structure, self.history)

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
