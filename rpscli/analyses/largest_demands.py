"""Largest demands of histories: the results that need no samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Generic, TypeVar, cast, overload

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.outcomes import Outcome, failure_text, outcomes_of
from rpscli.analyses.result_quantities import (
    EVERY,
    HISTORY,
    KERNEL_FIELDS,
    PAIR,
    YIELDING,
    ResultQuantity,
    values_of,
)
from rpscli.analyses.trace import DeviceDemand
from rpscli.model.podium import Array, Device, PodiumStructure
from rpscli.model.statics import uplift_acceleration
from rpscli.model.superstructure import Superstructure
from rpscli.physics import interface, state
from rpscli.physics.laws import geometry
from rpscli.physics.records import record_type
from rpscli.physics.state import Record
from rpscli.shown import Shown, frozen, with_unit

T = TypeVar("T")


_PLAIN = record_type(interface.RESULT)


class Demands:
    """Results of histories as columns (histories, ...), NaN where a history has none.

    The structures have one number of storeys; `number` says which of
    them a history belongs to.
    """

    def __init__(
        self, structures: Sequence[PodiumStructure], number: Sequence[int], left: Record
    ) -> None:
        # Fields by attribute, which records of the kernels have, take numpy ten times as
        # long.
        self.left = left.view(_PLAIN, np.ndarray)
        self.structures = structures
        self.number = np.array(number)
        self.storeys = structures[0].storeys

    @classmethod
    def of_one(cls, structure: PodiumStructure, history: Record) -> Demands:
        """A batch of one history."""
        return cls([structure], [0], np.array([history], dtype=_PLAIN))

    def column(self, name: str) -> Array:
        """The values of the attribute of `Demand` with this name."""
        result = vars(Demand)[name]
        return np.asarray(
            result.made(self) if result.made else self.left[KERNEL_FIELDS[name]]
        )

    def columns(self, quantities: Iterable[ResultQuantity]) -> dict[str, Array]:
        """Finite values by name; NaN where there is none."""
        with np.errstate(all="ignore"):
            values = {q.name: self.column(q.name) + 0.0 for q in quantities}  # no -0.0
        for column in values.values():
            column[~np.isfinite(column)] = np.nan
        return values

    def each(self, constant: Callable[[PodiumStructure], Any]) -> Array:
        """Of the structure of each history; NaN for None."""
        values = np.array(
            [constant(structure) for structure in self.structures], np.float64
        )
        return np.asarray(values[self.number])

    def of_building(
        self, constant: Callable[[Superstructure], Any], *, y: bool = False
    ) -> Array:
        """Of each storey of the building of each history (histories, n); NaN for None."""
        unknown = np.full(self.storeys, np.nan)

        def known(structure: PodiumStructure) -> Array:
            building = (structure.across if y else structure).superstructure
            values = None if building is None else constant(building)
            return unknown if values is None else values

        return self.each(known)

    @cached_property
    def critical_rotation(self) -> Array:
        """theta_cr."""
        return self.each(lambda structure: structure.critical_rotation)

    @cached_property
    def path(self) -> tuple[Array, Array]:
        """u_b, v_b (3, histories) at the largest rotation, the largest
        up to theta_cr, the end.
        """
        largest = self.left["max_theta"]
        highest = np.minimum(largest, self.critical_rotation)
        bearings = [structure.bearing for structure in self.structures]
        rolling, rocking = (
            geometry.Phase(*np.array(phases).T[:, self.number])
            for phases in ([b.rolling for b in bearings], [b.rocking for b in bearings])
        )
        beta = np.array([b.beta for b in bearings])[self.number]
        rotations = np.array([largest, highest, self.column("residual_rotation")])
        _, _, u, v = geometry.path_along(rolling, rocking, beta, rotations)
        diameter = 2.0 * np.array([b.semi_diagonal for b in bearings])[self.number]
        u = diameter * u
        v = diameter * v
        for number, structure in enumerate(self.structures):
            if structure.bed is not None:
                rows = self.number == number
                _, u[:, rows], v[:, rows] = structure.path(rotations[:, rows])
        return u, v

    def on_bed(self, values: Array) -> Array:
        """The values on compliant ends; NaN on rigid ones."""
        return np.asarray(
            np.where(self.each(lambda st: st.bed is not None) > 0.0, values, np.nan)
        )

    def of_passes(self, field: str) -> Array:
        """A field of histories with passes near upright; NaN of
        others, which have none.
        """
        smooth = self.each(lambda structure: structure.passes_smoothly) > 0.0
        values = self.known(field)
        return np.asarray(
            np.where(smooth.reshape(-1, *(1,) * (values.ndim - 1)), np.nan, values)
        )

    def of_storeys(self, field: str) -> Array:
        """(histories, n)."""
        values: Array = self.left[field][:, : self.storeys]
        return values

    @property
    def yields(self) -> bool:
        """True if storeys of some of them yield."""
        return any(structure.yields for structure in self.structures)

    def yielding(self, field: str) -> Array:
        """A field by direction and storey (histories, ways, n); NaN
        where storeys stay elastic.
        """
        values = np.asarray(self.left[field], np.float64)[:, : self.ways, : self.storeys]
        return np.where(np.isfinite(self.of_ways(lambda b: b.strengths)), values, np.nan)

    @property
    def ways(self) -> int:
        """Horizontal components that act in all of them."""
        return int(self.left["ways"][0])

    def of_ways(self, constant: Callable[[Superstructure], Any]) -> Array:
        """Of each storey in each direction (histories, ways, n); NaN for None."""
        ways = (self.of_building(constant, y=bool(way)) for way in range(self.ways))
        return np.stack([*ways], axis=1)

    def of_devices(
        self, value: Callable[[Device, dict[str, Array]], Array | None]
    ) -> Array:
        """Largest value of the devices of each history, of
        what it left in their slots.
        """
        largest = np.full((len(self.left), state.SLOTS), np.nan)
        for number, structure in enumerate(self.structures):
            rows = np.flatnonzero(self.number == number)
            for i, device in enumerate(structure.devices):
                left = {
                    name: self.left[name][rows, i]
                    for name in ("device_force", "permanent")
                }
                if (values := value(device, left)) is not None:
                    largest[rows, i] = values
        return np.asarray(np.fmax.reduce(largest, axis=1))

    def known(self, field: str) -> Array:
        """A field that histories under both components have; NaN of the others."""
        values = np.asarray(self.left[field], np.float64)
        pairs = (self.left["ways"] == 2).reshape(-1, *(1,) * (values.ndim - 1))
        return np.where(pairs, values, np.nan)

    def of_storeys_in(self, way: str, field: str) -> Array:
        """A field in one direction (histories, n); NaN under one component."""
        return self.known(f"{field}_{way}")[:, : self.storeys]

    def largest_force(self, result: str) -> Array:
        """Of the devices whose laws name a result."""
        return self.of_devices(
            lambda device, left: (
                left["device_force"] if result in device.results else None
            )
        )


class _Result(Generic[T]):
    """An attribute of `Demand`, and a column of `Demands`: a field
    of the kernel's, or made.

    The table of results has its meaning and its unit. Numbers that
    are not `kept` are None.
    """

    def __init__(
        self,
        made: Callable[[Demands], Array] | None = None,
        doc: str = "",
        kept: Callable[[Any], Any] = lambda _: True,
    ) -> None:
        self.__doc__ = doc
        self.made = made
        self._kept = kept

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        self.__doc__ = EVERY[name].described if name in EVERY else self.__doc__

    @overload
    def __get__(self, demand: None, owner: type) -> _Result[T]: ...
    @overload
    def __get__(self, demand: Demand, owner: type) -> T: ...
    def __get__(self, demand: Demand | None, owner: type) -> _Result[T] | T:
        if demand is None:
            return self
        value: Any = demand._alone.column(self._name)[0]  # noqa: SLF001 -- of the class below
        if value.ndim:
            return cast("T", frozen(value))
        return cast("T", value.item() if self._kept(value) else None)


_Optional = partial(_Result[float | None], kept=np.isfinite)
"""One that not every history has."""


def _largest(values: Array) -> Array:
    """The largest of each row; NaN of empty ones."""
    return (
        np.asarray(values.max(axis=1))
        if values.shape[1]
        else np.full(len(values), np.nan)
    )


def _drifts(h: Demands) -> Array:
    """Of elastic storeys from their shears, of those that yield from their ductility."""
    if not h.yields:
        return _elastic_drifts(h)
    # Both directions of a yielding storey as if they were largest together, an upper
    # bound.
    yields_at = h.of_ways(lambda b: b.strengths) / h.of_ways(lambda b: b.stiffnesses)
    drifts = np.linalg.norm(h.yielding("ductility") * yields_at, axis=1)
    return np.where(np.isfinite(drifts), drifts, _elastic_drifts(h))


def _elastic_drifts(h: Demands) -> Array:
    """Resultants over the stiffness; where that differs in y, the
    lesser of two upper bounds.
    """
    shears = h.column("storey_shears")
    k = h.of_building(lambda b: b.stiffnesses)
    in_y = [structure.superstructure_y for structure in h.structures]
    if h.ways == 1 or not any(in_y):
        return shears / k
    k_y = h.of_building(lambda b: b.stiffnesses, y=True)
    parts = h.of_storeys("storey_shear_x") / k, h.of_storeys("storey_shear_y") / k_y
    return np.minimum(shears / np.minimum(k, k_y), np.hypot(*parts))


def _uplift_shear(structure: PodiumStructure) -> float | None:
    """M_tot times the ground acceleration that uplifts; None without devices."""
    mass = structure.superstructure_mass if structure.devices else 0.0
    return mass * uplift_acceleration(structure) or None


def _edge_pressure(histories: Demands) -> Array:
    """Of plane flat ends: it grows with the root of the rotation
    once an edge has lifted.
    """
    plane = [
        st.bed.uplift_rotation
        if st.bed and st.bed.root and st.bearing.is_flat
        else np.nan
        for st in histories.structures
    ]
    ratio = histories.left["max_theta"] / np.array(plane)[histories.number]
    return np.asarray(np.where(ratio > 1.0, 2.0 * np.sqrt(ratio), 1.0 + ratio))


def _lost(device: Device, left: dict[str, Array]) -> Array | None:
    """The share of its prestress that a device has lost."""
    if not (prestress := device.remaining_prestress(0.0)):
        return None
    remaining = [
        device.remaining_prestress(length) for length in left["permanent"].tolist()
    ]
    return 1.0 - np.array(remaining, np.float64) / prestress


@dataclass(frozen=True, eq=False, repr=False)
class Demand(Shown):
    """Largest demands of a history; SI units.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    history
        What its history left behind: a `physics.interface.RESULT`.
    """

    structure: PodiumStructure
    history: Record

    @cached_property
    def _alone(self) -> Demands:
        return Demands.of_one(self.structure, self.history)

    @property
    def outcome(self) -> Outcome:
        """Ending of the history."""
        return cast("Outcome", str(outcomes_of(self.history)))

    @property
    def failure(self) -> str | None:
        """The reason why the history could not be carried to
        its end; None if it could.
        """
        return failure_text(self.history, self.structure)

    @property
    def overturned(self) -> bool:
        """True if the overturning limit was passed."""
        return self.outcome.startswith("overturned")

    @property
    def stays_tilted(self) -> bool:
        """True if friction holds the podium tilted at the end."""
        return self.outcome == "stays_tilted"

    max_rotation = _Result[float]()
    max_rotation_time = _Optional(
        lambda h: np.where(h.left["max_theta"] > 0.0, h.left["max_theta_time"], np.nan)
    )
    rotation_ratio = _Result[float](lambda h: h.left["max_theta"] / h.critical_rotation)
    critical_rotation = _Result[float](lambda h: h.critical_rotation)
    critical_passage_time = _Optional(
        lambda h: np.where(
            h.left["critical_time"] >= 0.0, h.left["critical_time"], np.nan
        )
    )
    max_cap_beam_displacement = _Result[float](lambda h: h.path[0][0])
    max_lift = _Result[float](lambda h: h.path[1][1])
    residual_rotation = _Result[float](lambda h: np.abs(h.left["rotation"]))
    residual_displacement = _Result[float](lambda h: h.path[0][2])
    max_damper_force = _Optional(lambda h: h.largest_force("max_damper_force"))
    max_stop_force = _Optional(lambda h: h.largest_force("max_stop_force"))
    lost_prestress = _Optional(lambda h: h.of_devices(_lost))
    energy_devices = _Result[float](lambda h: h.left["device_energy"].sum(axis=1))
    storey_shears = _Result[Array](lambda h: h.of_storeys("storey_shear"))
    floor_accelerations = _Result[Array](lambda h: h.of_storeys("floor_acceleration"))
    max_floor_acceleration = _Optional(
        lambda h: _largest(h.column("floor_accelerations"))
    )
    max_base_shear = _Result[float](
        lambda h: h.column("storey_shears")[:, 0] if h.storeys else np.zeros(len(h.left))
    )
    base_shear_ratio = _Optional(
        lambda h: (
            h.column("max_base_shear") / h.each(lambda s: s.static_base_shear or None)
        )
    )
    uplift_shear_ratio = _Optional(
        lambda h: h.column("max_base_shear") / h.each(_uplift_shear)
    )
    max_drifts = _Result[Array](
        _drifts,
        "largest storey drifts [m]; of both directions resultants, of the largest of"
        " each where the directions differ or storeys yield: a bound",
    )
    drift_ratio = _Optional(
        lambda h: _largest(
            h.column("max_drifts") / h.of_building(lambda b: b.storey_heights)
        )
    )
    ductilities = _Result[Array](lambda h: h.yielding("ductility").max(axis=1))
    plastic_drifts = _Result[Array](
        lambda h: (h.yielding("slip_most") - h.yielding("slip_least")).max(axis=1)
    )
    residual_drifts = _Result[Array](lambda h: np.linalg.norm(h.yielding("slip"), axis=1))
    energies_yielded = _Result[Array](lambda h: h.yielding("yielded").sum(axis=1))
    first_yields = _Result[Array](
        lambda h: np.where((t := h.yielding("first_yield")) >= 0.0, t, np.inf).min(axis=1)
    )
    ductility = _Optional(lambda h: _largest(h.column("ductilities")))
    plastic_drift = _Optional(lambda h: _largest(h.column("plastic_drifts")))
    residual_drift = _Optional(lambda h: _largest(h.column("residual_drifts")))
    residual_drift_ratio = _Optional(
        lambda h: _largest(
            h.column("residual_drifts") / h.of_building(lambda b: b.storey_heights)
        )
    )
    energy_yielded = _Optional(lambda h: h.column("energies_yielded").sum(axis=1))
    friction_demand = _Result[float](
        lambda h: np.maximum(h.left["friction_top"], h.left["friction_bottom"])
    )
    friction_ratio = _Optional(  # which may be infinite
        lambda h: (
            h.column("friction_demand") / h.each(lambda structure: structure.friction)
        ),
        kept=lambda value: not np.isnan(value),
    )
    uplifts = _Result[int](lambda h: h.left["events"][:, state.UPLIFT])
    impacts = _Result[int](lambda h: h.left["events"][:, state.IMPACT])
    reentries = _Optional(lambda h: h.on_bed(h.left["events"][:, state.IMPACT]))
    full_contact_share = _Optional(
        lambda h: h.on_bed(h.left["bedded_time"] / h.left["time"])
    )
    max_impact_number = _Optional(lambda h: h.on_bed(h.left["impact_number"]))
    edge_pressure_ratio = _Optional(_edge_pressure)
    duration = _Result[float]()
    energy_impact = _Result[float]()
    energy_created = _Result[float]()
    creating_impacts = _Result[int]()

    max_rotation_azimuth = _Optional(
        lambda h: np.where(h.left["max_theta"] > 0.0, h.known("max_azimuth"), np.nan)
    )
    critical_azimuth = _Optional(
        lambda h: np.where(
            h.left["critical_time"] >= 0.0, h.known("critical_azimuth"), np.nan
        )
    )
    residual_azimuth = _Optional(
        lambda h: np.where(h.left["rotation"] != 0.0, h.known("azimuth"), np.nan)
    )
    max_cap_beam_displacement_x = _Optional(lambda h: h.known("max_x"))
    max_cap_beam_displacement_y = _Optional(lambda h: h.known("max_y"))
    max_base_shear_x = _Optional(
        lambda h: _largest(h.of_storeys_in("x", "storey_shear")[:, :1])
    )
    max_base_shear_y = _Optional(
        lambda h: _largest(h.of_storeys_in("y", "storey_shear")[:, :1])
    )
    max_floor_acceleration_x = _Optional(
        lambda h: _largest(h.of_storeys_in("x", "floor_acceleration"))
    )
    max_floor_acceleration_y = _Optional(
        lambda h: _largest(h.of_storeys_in("y", "floor_acceleration"))
    )
    passes = _Optional(lambda h: h.of_passes("events")[:, state.PASS])
    passes_as_impacts = _Optional(lambda h: h.of_passes("passes_as_impacts"))
    accumulations = _Optional(lambda h: h.of_passes("accumulations"))
    closest_pass = _Optional(lambda h: h.known("closest_pass"))
    shortest_pass = _Optional(lambda h: h.known("shortest_pass"))
    energy_passes = _Optional(lambda h: h.known("energy_passes"))
    torsion_lever = _Optional(lambda h: h.known("torsion_lever"))

    @property
    def both_components(self) -> bool:
        """True if both horizontal components acted."""
        return bool(self.history["ways"] == 2)

    @property
    def devices(self) -> tuple[DeviceDemand, ...]:
        """Demands of each device, in the order of the structure's."""
        structure = self.structure
        history = self.history
        rotation = np.array([history["max_theta"]])
        return tuple(
            DeviceDemand(
                device.kind,
                float(history["device_force"][i]),
                float(device.stroke(structure, rotation)[0]),
                float(history["device_velocity"][i]),
                float(history["device_energy"][i]),
                device.remaining_prestress(float(history["permanent"][i])),
            )
            for i, device in enumerate(structure.devices)
        )

    @property
    def quantities(self) -> tuple[ResultQuantity, ...]:
        """Scalar results that such a history has, or could have."""
        yielding = YIELDING if self.structure.yields else ()
        return (*HISTORY, *yielding, *(PAIR if self.both_components else ()))

    @property
    def driven_back(self) -> NDArray[np.bool_]:
        """(n,) storeys that less than the residual drift remains
        of at rest, by hardening.
        """
        h = self._alone
        back = np.abs(h.yielding("slip")) * h.of_ways(lambda b: b.back_stiffness)
        return frozen(
            np.asarray((back > h.of_ways(lambda b: b.strengths)).any(axis=(0, 1)))
        )

    def facts(self) -> dict[str, Any]:
        """Outcome and scalar results with their units, the main demands first."""
        known = (q for q in self.quantities if q not in PAIR)
        ordered = sorted(known, key=lambda quantity: not quantity.demand)
        return {
            "outcome": self.outcome,
            **{q.name: with_unit(getattr(self, q.name), q.unit) for q in ordered},
        }

    def scalars(self) -> dict[str, Any]:
        """Outcome and scalar results, under their names in JSON and CSV.

        A value that does not exist, or is infinite, is None.
        """
        return {"outcome": self.outcome, **values_of(self, self.quantities)}
