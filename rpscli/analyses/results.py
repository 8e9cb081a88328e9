"""Result of a time history: beside its largest demands samples,
events, energies, warnings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.column_design import ColumnDemand
from rpscli.analyses.column_forces import AxialForces, in_shocks
from rpscli.analyses.fixed_base import (
    FixedBaseResponse,
    floor_speeds,
    largest_of_cubics,
    largest_resultants,
    largest_velocities,
)
from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.outcomes import STOOD
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.trace import Event, Trace, sampled
from rpscli.analyses.twist import OfTurningSlab, TwistResult
from rpscli.errors import listed
from rpscli.model.column import LARGEST_EDGE
from rpscli.model.devices import ViscousDamper
from rpscli.physics import state
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.shown import data_frame, frozen
from rpscli.units import digits_beside

SMALL_SHARE = 1e-6
"""Of the energy supplied: what its residual may have."""

SLOW = 1e-4
"""Of the critical rotation: below it velocities come near those at which a power of them
is taken as linear (`kernels.systems.LINEAR_SPEEDS`)."""

NEAR_CRITICAL = 0.8
"""Rotations above this part of the critical one are near it: a
little more may overturn."""

LARGEST_TRIED = 8.0
"""chi of impacts, up to which records were followed on a
resolved bed (VERIFICATION.md)."""

CRUSHING = 10.0
"""Edge pressure over the mean: 30 MPa where the permanent load presses with 3 MPa."""

STEEL = 100e9
"""Columns of a larger modulus have ends of steel [Pa]."""

STEEL_ROTATION = 0.05
"""Of rollers of EN 1337-4 and of rockers of EN 1337-6 [rad]."""

STEEL_CODE = {True: "EN 1337-4", False: "EN 1337-6"}
"""That gives the strength of steel on steel, on lines and in points."""

RESTING = (state.FULL_CONTACT, state.STUCK, state.BEDDED)
"""Phases in which the podium is down, or held."""


def _beside(value: float, limit: float | None) -> str:
    """A value beside what it is beyond, to be told from it."""
    return f"{value:.{digits_beside(value, limit or 0.0, 3)}g}"


@dataclass(frozen=True)
class Energy:
    """Balance of the energy [J]: the input is damped, dissipated, lost,
    stored, or the residual.
    """

    input: float  # by the ground
    damped: float  # in the building
    impact: float  # net loss at impacts and re-contacts
    stored: float  # at the end
    residual: float  # error of the integration
    created: float  # of impact, gained where floors are set in motion (Theory (4.11))
    devices: float
    bed: float  # in what the ends bear on in full contact
    damped_vertical: float  # in vertical dampers of the building
    yielded: float  # in storeys that yield


@dataclass(frozen=True)
class ColumnForces:
    """Envelope of the forces at one end of a column [N]; compression is positive."""

    shear: float  # largest |F|
    largest_normal: float
    least_normal: float  # negative where the contact would pull


@dataclass(frozen=True, eq=False, repr=False)
class TimeHistoryResult(OfTurningSlab, Demand):  # type: ignore[override]
    """Response of a structure to a record: its largest demands,
    samples and events; SI units.

    Parameters
    ----------
    record
        Horizontal ground acceleration.
    settings
        Accuracy, tolerance, limits.
    trace
        Histories at the record's samples, see `sampling`.
    events
        In the order of time.
    fixed_base
        The same building on a fixed base; None where that was not asked for.
    motion
        All components of the ground's motion.
    axial
        Axial forces of single columns; None where neither rows of columns nor the
        vertical period of the building are given.
    column_demand
        What the most loaded column has to carry; None where `podium.column` is not given.
    twist
        The slab that turns about the vertical, beside all that is of its centre alone;
        None where `podium.twist` is not given.
    """

    record: GroundMotion
    settings: TimeHistorySettings
    trace: Trace
    events: tuple[Event, ...]
    fixed_base: FixedBaseResponse | None
    motion: MotionComponents
    axial: AxialForces | None = None
    column_demand: ColumnDemand | None = None
    twist: TwistResult | None = None

    def to_dataframe(self) -> Any:
        """The samples as a table of pandas, which must be installed:
        columns of `timehistory.csv`.

        SI units, which are its `attrs["units"]` by column.
        """
        columns = [*sampled(self.structure, self.trace)]
        table = data_frame({name: values for name, _, values in columns})
        table.attrs["units"] = {name: unit for name, unit, _ in columns}
        return table

    def facts(self) -> dict[str, Any]:
        """The record, and what it asked for."""
        return {"record": self.record.name, **super().facts()}

    @property
    def sampling(self) -> str:
        """Of the trace, its CSV file and figures; other results hold
        what lies between as well.
        """
        return f"samples every {self.record.dt:g} s, between which maxima may lie"

    @property
    def energy(self) -> Energy:
        """The energy audit."""
        history = self.history
        devices = self.energy_devices
        supplied, damped, lost, stored = (
            float(history[f"energy_{name}"])
            for name in ("input", "damped", "lost", "stored")
        )
        stored = stored + float(history["device_stored"].sum())
        bed = float(history["bed_energy"])
        yielded = float(history["energy_yielded"])
        available = supplied + float(self.trace.energy_stored[0])
        vertical = float(history["energy_upwards"])
        return Energy(
            input=supplied,
            damped=damped,
            impact=lost,
            stored=stored,
            residual=available
            - damped
            - vertical
            - devices
            - bed
            - lost
            - stored
            - yielded,
            created=self.energy_created,
            devices=devices,
            bed=bed,
            damped_vertical=vertical,
            yielded=yielded,
        )

    def restoring_moment(self, rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        """Static moment 2 R W s B(x) at rotations theta [N m], on a bed
        with its arm in place of B.

        What `Trace.driving_moment` equals in slow motion; positive where the weight
        restores a positive rotation.
        """
        st = self.structure
        theta = np.asarray(rotation)
        arm = st.weight_arm(np.abs(theta))
        return 2.0 * st.bearing.semi_diagonal * st.weight * np.sign(theta) * arm

    @cached_property
    def floor_velocities(self) -> NDArray[np.float64]:
        """(n,) largest absolute velocities [m/s], from the bottom.

        Of cubics through the samples and the accelerations there: 0.3 % low at most, 2 %
        where floors jump with the cap beam, dt up to 0.02 s and periods from 0.1 s.
        """
        t = self.trace
        x = self.motion.horizontal
        ground = self.motion.y
        if t.y is None or ground is None:
            return frozen(
                largest_velocities(t.floor_velocities, t.floor_accelerations, x)
            )
        both = (t, x), (t.y, ground)
        moving = [
            (floor_speeds(of.floor_velocities, g), of.floor_accelerations)
            for of, g in both
        ]
        return frozen(largest_resultants(moving, self.record.dt))

    @property
    def max_floor_velocity(self) -> float | None:
        """Largest of `floor_velocities` [m/s]; None without a superstructure."""
        return float(np.max(self.floor_velocities)) if self.structure.storeys else None

    @property
    def max_roof_displacement(self) -> float | None:
        """Largest displacement of the roof to the ground [m], of
        cubics through the samples.

        If the structure overturns, up to the last sample before that.
        """
        if self.structure.superstructure is None:
            return None
        t = self.trace
        dt = self.record.dt
        roofs = [
            (of.floor_displacements[:, -1:], of.floor_velocities[:, -1:])
            for of in (t, t.y)
            if of is not None
        ]
        if len(roofs) == 2:
            return float(largest_resultants(roofs, dt)[0])
        return largest_of_cubics(
            t.floor_displacements[:, -1], t.floor_velocities[:, -1], dt
        )

    @cached_property
    def base_shear_with_dashpots(self) -> float | None:
        """Largest force of the floors' inertia on the cap beam, |sum m_i a_i| at the
        samples: what springs and dashpots of storeys carry [N]; None without storeys.
        """
        building = self.structure.superstructure
        if building is None:
            return None
        forces = [
            of.floor_accelerations @ building.masses
            for of in (self.trace, self.trace.y)
            if of is not None
        ]
        return float(np.max(np.hypot.reduce(forces), initial=0.0))

    @property
    def fixed_base_ratio(self) -> float | None:
        """Base shear over that of the fixed base; None without it, or if that is 0."""
        fixed = 0.0 if self.fixed_base is None else self.fixed_base.base_shear
        return self.max_base_shear / fixed if fixed > 0.0 else None

    @property
    def floor_acceleration_over_fixed(self) -> float | None:
        """Largest floor acceleration over the largest on the fixed
        base, maybe of another floor.

        None where `fixed_base_ratio` is.
        """
        if self.fixed_base is None or self.max_floor_acceleration is None:
            return None
        fixed = float(np.max(self.fixed_base.floor_accelerations))
        return self.max_floor_acceleration / fixed if fixed > 0.0 else None

    @property
    def column_forces(self) -> dict[str, ColumnForces]:
        """Envelopes at the `top` and at the `bottom` of a column.

        All columns carry alike, but for the overturning moment where their rows are
        given; where the case does not give their number, these are the forces of all
        columns together. What axial forces do not hold: `left_out_of_columns`.
        """
        st = self.structure
        history = self.history
        axial = self.axial
        upper = st.cap_beam_mass + st.superstructure_mass
        envelopes = {}
        for end, mass in (("top", upper), ("bottom", upper + st.columns_mass)):
            weight = st.gravity * mass
            forces = (
                float(history[f"{of}_{end}"]) * weight for of in ("heavy", "normal")
            )
            largest, least = (force / st.columns for force in forces)
            if axial is not None:
                largest = axial.largest[end]
                least = axial.least[end]
            shear = float(history[f"shear_{end}"]) / st.columns
            envelopes[end] = ColumnForces(shear, largest, least)
        return (
            envelopes if upper > 0.0 else envelopes | {"top": ColumnForces(0.0, 0.0, 0.0)}
        )

    @property
    def left_out_of_columns(self) -> tuple[str, ...]:
        """Parts that forces of columns do not hold, and the key that would give each."""
        return self.structure.left_out_of_columns(both=self.both_components)

    @property
    def overturning_ratio(self) -> float | None:
        """Force of the floors' inertia in an outer column over the
        mean; None without rows.
        """
        return self.axial.overturning_ratio if self.axial else None

    @property
    def max_column_shear(self) -> float:
        """Largest horizontal force of a column [N]: of the one with
        the most where rows are known, else the mean of all columns (`shear_is_of`).
        """
        shears = [forces.shear for forces in self.column_forces.values()]
        single = None if self.axial is None else self.axial.shear
        return max(*shears, single or 0.0)

    @property
    def shear_is_of(self) -> str:
        """Which column has `max_column_shear`, in words."""
        st = self.structure
        if self.axial is not None and self.axial.shear is not None:
            times = ", times their number" if st.columns == 1 else ""
            return f"most loaded column{times}"
        return "all columns together" if st.columns == 1 else "mean of the columns"

    @property
    def max_column_force(self) -> float:
        """Largest normal force of a column at either end [N]."""
        return max(forces.largest_normal for forces in self.column_forces.values())

    @property
    def min_column_force(self) -> float:
        """Least normal force of a column, where it carries the cap beam [N]."""
        return self.column_forces["top"].least_normal

    @property
    def column_moment(self) -> float | None:
        """Largest moment at an end of a column [N m]; None without
        `podium.column`, as below.
        """
        return (
            None
            if self.column_demand is None
            else abs(self.column_demand.instants[0].moment)
        )

    @property
    def contact_pressure_ratio(self) -> float | None:
        """Largest elastic pressure on arcs over the strength; None of flat ends too."""
        return None if self.column_demand is None else self.column_demand.pressure_ratio

    @property
    def crushed_width_ratio(self) -> float | None:
        """Largest depth of a plastic edge over the width of the end."""
        return None if self.column_demand is None else self.column_demand.crushed_ratio

    @property
    def is_near_critical(self) -> bool:
        """True if it survived after rotations near the critical one, or beyond."""
        return self.outcome in STOOD and self.rotation_ratio > NEAR_CRITICAL

    @property
    def slides(self) -> bool | None:
        """True if the friction demand exceeds the coefficient; None
        where that is not given.
        """
        return None if self.friction_ratio is None else self.friction_ratio > 1.0

    @property
    def sliding_time(self) -> float | None:
        """Time of the first sample at which |F|/N exceeds the
        coefficient [s]; None if at none.

        `slides` tells what lies between samples too.
        """
        coefficient = self.structure.friction
        trace = self.trace
        if coefficient is None:
            return None
        bottom = trace.size("shear_bottom") > coefficient * trace.normal_bottom
        top = trace.size("shear_top") > coefficient * trace.normal_top
        slides = np.flatnonzero((top | bottom) & ~in_shocks(self.structure, trace))
        return float(trace.time[slides[0]]) if len(slides) else None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Notes that the user must know before trusting the numbers."""
        return (
            *self.record.warnings,
            *self._near_the_limit(),
            *self._lost_contact(),
            *self._beyond(),
            *self._of_column(),
            *self._created_energy(),
            *self._energy_of_devices(),
            *self._slow_dampers(),
            *self._still_moving(),
        )

    def _lost_contact(self) -> Iterator[str]:
        """Ends, or single columns, that nothing presses on ground and beam."""
        least = min(self.history["normal_top"], self.history["normal_bottom"])
        if least <= 0.0:
            yield (
                "contact is lost: the normal force between columns and beam or ground"
                f" falls to {least:.3g} of the weight; the model assumes contact"
                " throughout"
            )
        if self.axial and self.axial.lift_off is not None:
            yield (
                f"an outer column would lift off at t = {self.axial.lift_off:.4g} s: the"
                " overturning moment takes more than its share of the weight; the model"
                " assumes that all columns stand"
            )
        elif self.axial and self.min_column_force < 0.0:
            yield (
                "the shock of impacts or passes (and the overturning moment) exceeds the"
                " weight on a column, whose axial force would be negative; the model"
                " assumes that all columns stand"
            )

    def _created_energy(self) -> Iterator[str]:
        """Energy of impacts that nothing supplied."""
        supplied = abs(self.energy.input) + float(self.trace.energy_stored[0])
        if self.energy.created > 0.02 * supplied:
            share = self.energy.created / supplied
            yield (
                f"the rigid impact law created {share:.1%} of the energy supplied at"
                " impacts; compare with `impact: {law: flexible}`"
            )

    def _energy_of_devices(self) -> Iterator[str]:
        """Devices that give more energy to the motion than they take."""
        supplied = abs(self.energy.input) + float(self.trace.energy_stored[0])
        for index, device in enumerate(self.devices):
            least = min(device.energy, float(np.min(self.trace.devices.energy[:, index])))
            if least < -SMALL_SHARE * supplied:
                yield (
                    f"podium.devices.{index} ({device.kind}) gives energy to the motion:"
                    f" what it has dissipated falls to {least:.3g} J, of {supplied:.3g} J"
                    " that are supplied; its law pushes where it must resist"
                )

    def _slow_dampers(self) -> Iterator[str]:
        """Powers of a velocity that was hardly above what is taken as linear."""
        structure = self.structure
        small = 0.0 < self.rotation_ratio < SLOW and structure.passes_smoothly
        powers = [
            str(index)
            for index, device in enumerate(structure.devices)
            if isinstance(device, ViscousDamper) and device.exponent < 1.0
        ]
        if small and powers:
            yield (
                f"the largest rotation is {self.rotation_ratio:.2g} of the critical one:"
                f" podium.devices.{listed(powers, 'and')}, with an exponent below 1, is"
                " linear at the smallest velocities, which moves maxima by 0.1 to 0.2 %"
                " near 1e-5 of the critical rotation, and by far more below 1e-7;"
                " a larger analysis.accuracy divides that velocity"
            )

    def _still_moving(self) -> Iterator[str]:
        """Motion at the end of the history, of a structure that survived."""
        if self.outcome != "survived" or self.history["phase"] in RESTING:
            return
        if self.both_components and self.settings.free_vibration is None:
            brake = "but its joints" if self.structure.bed is not None else "at its ends"
            yield (
                f"at the end the podium still swings or circles, and nothing {brake}"
                " dissipates: the residual rotation is that of this instant; no larger"
                " rotation can occur, but forces and plastic drifts may still grow"
                " (friction dampers or rolling resistance would bring it to rest)"
            )
        elif self.structure.bearing.is_spherical:
            yield (
                "columns without a flat part still roll at the end, as nothing but"
                " dampers and friction stops them: the residual rotation is that of"
                " this instant"
            )
        elif self.settings.free_vibration is not None:
            yield (
                "the podium still moves at the end; a longer"
                " `analysis.free_vibration` may bring larger maxima"
            )
        elif self.duration >= self.record.duration + LONGEST_FREE_VIBRATION:
            yield f"not at rest {LONGEST_FREE_VIBRATION:g} s after the record's end"

    def _beyond(self) -> Iterator[str]:
        """Demands for which compliant ends were not tried, and
        storeys that still yield back.
        """
        if self.driven_back.any():
            storeys = listed(map(str, np.flatnonzero(self.driven_back) + 1), "and")
            yield (
                f"hardening drives storey {storeys} back as it comes to rest,"
                " so that less than the residual drift remains; a longer"
                " `analysis.free_vibration` shows how much"
            )
        chi = self.max_impact_number
        pressure = self.edge_pressure_ratio
        if (
            chi is not None
            and chi > LARGEST_TRIED
            and self.structure.contact.kind == "plane"
        ):
            yield (
                f"the strongest re-contact has chi = {_beside(chi, LARGEST_TRIED)},"
                f" records with more than {LARGEST_TRIED:g} were not tested; vary"
                " `podium.impact.loss`"
            )
        if pressure is not None and pressure > CRUSHING:
            yield (
                f"the pressure at an edge reaches {pressure:.3g} times the mean under"
                " permanent load, at which concrete crushes under usual loads: it loses"
                " more at impacts and restores less than an elastic bed"
            )

    def _of_column(self) -> Iterator[str]:
        """Ends of columns for which the model, or a code, does not hold."""
        design = self.structure.column
        crushed = self.crushed_width_ratio or 0.0
        if crushed > LARGEST_EDGE:
            yield (
                f"an edge crushes over {crushed:.3g} of the width of a column, above a"
                " third: it is no longer a line about which the column turns, and the"
                " weight restores less"
            )
        if design and design.modulus > STEEL and self.max_rotation > STEEL_ROTATION:
            yield (
                f"the largest rotation of {_beside(self.max_rotation, STEEL_ROTATION)}"
                " rad is beyond"
                f" {STEEL_ROTATION:g} rad, up to which"
                f" {STEEL_CODE[design.bears_on_line(self.structure.bearing)]} gives the"
                " strength of steel on steel"
            )

    def _near_the_limit(self) -> Iterator[str]:
        """Nearness to overturning of a structure that
        survived, and sliding of columns.
        """
        ratio = self.rotation_ratio
        passed = self.critical_passage_time
        if self.is_near_critical and passed is not None:
            yield (
                f"the critical rotation was passed at t = {passed:.4g} s (largest"
                f" {ratio:.3g} theta_cr): the weight no longer restored, only the ground"
                " motion reversed it; judge by many records"
            )
        elif self.is_near_critical:
            yield (
                f"the largest rotation is {_beside(ratio, NEAR_CRITICAL)} of the"
                f" critical one, above {NEAR_CRITICAL:g}: a little more may overturn"
                " the structure; judge by many records"
            )
        if self.slides:
            when = (
                ""
                if self.sliding_time is None
                else f" from t = {self.sliding_time:.4g} s"
            )
            yield (
                f"the columns slide{when}: the friction demand"
                f" {_beside(self.friction_demand, self.structure.friction)} exceeds"
                f" podium.friction = {self.structure.friction:g}; the model"
                " assumes that they do not, so the motion is unreliable from then on"
            )
