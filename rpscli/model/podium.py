"""The rocking podium structure, and what each device on it must answer."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from numbers import Integral
from typing import Any, ClassVar, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import is_size, require_fields, told
from rpscli.model.bearing import Bearing, UpliftedState
from rpscli.model.column import ColumnDesign
from rpscli.model.contact import Bed, Contact, bed_of
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import Superstructure
from rpscli.model.twist import Twist
from rpscli.physics.laws import geometry
from rpscli.shown import Shown, with_unit

Array: TypeAlias = NDArray[np.float64]

MOST_COLUMNS = 10**9
USUAL_SHOCK = 0.025
"""`PodiumStructure.shock_time` where no vertical period is known [s]: of one of .1 s."""

MOST_DEVICES = 8
"""A structure has no more; equal devices are one with the sum of
their forces and stiffnesses."""


@dataclass(frozen=True, eq=False, repr=False)
class PodiumStructure(Shown):
    """N kinematic bearings under a cap beam that carries a shear building.

    Parameters
    ----------
    bearing
        Shape of every column.
    columns_mass
        N m_c, all columns together [kg].
    cap_beam_mass
        m_b [kg]; 0 only without a superstructure (N independent free-standing columns).
    superstructure
        The building, or None for a rigid rolling and rocking frame.
    impact_law
        Restitution at theta = 0.
    gravity
        g [m/s2].
    devices
        Dampers, stops and tendons between ground and cap beam.
    columns
        N; only tendons, one in each column, and forces of one column ask for it.
    friction
        Coefficient of friction at both ends of the columns; None where it is not known.
    rows
        Where rows of columns, with equally many each, stand along the motion [m]; none
        where that is not known.
    rows_y
        Where they stand in y, with a column wherever two rows cross [m]; axial forces
        under both components ask for it.
    superstructure_y
        The same floors on the stiffnesses across the first direction, y, where they
        differ from those along it, x; None if they do not.
    contact
        What the ends bear on; rigid or compliant in full contact.
    column
        Section and material of a column; None where it is not designed.
    twist
        How the slab turns about the vertical; None where that is not computed.
    wind
        Base shear of the building under the wind [N], which statics alone ask for; None
        where it is not known.

    Raises
    ------
    ValueError
        For masses, floors in y, devices, or a contact that are not followed, and a
        restitution that is not in (0, 1], of spherical ends not 1 (Theory, section 4).

    Notes
    -----
    Theory (2.3), (5.1).

    Examples
    --------
    >>> from rpscli import Bearing
    >>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
    >>> round(podium.critical_rotation, 4)
    0.2946
    """

    bearing: Bearing
    columns_mass: float
    cap_beam_mass: float
    superstructure: Superstructure | None = None
    impact_law: ImpactLaw = field(default_factory=ImpactLaw)
    gravity: float = STANDARD_GRAVITY
    devices: tuple[Device, ...] = ()
    columns: int = 1
    friction: float | None = None
    rows: tuple[float, ...] = ()
    rows_y: tuple[float, ...] = ()
    superstructure_y: Superstructure | None = None
    contact: Contact = field(default_factory=Contact)
    column: ColumnDesign | None = None
    twist: Twist | None = None
    wind: float | None = None
    bed: Bed | None = field(init=False)
    """Compliant full contact; None on rigid ends."""

    def __post_init__(self) -> None:
        """Refuse masses and restitutions outside the model."""
        require_fields(self)
        sizes = self.columns_mass, self.gravity, self.cap_beam_mass or 1.0
        if not all(map(is_size, sizes)):
            raise ValueError(
                "columns_mass and gravity must be > 0, cap_beam_mass >= 0, all finite"
            )
        if self.friction is not None and self.friction < 0.0:
            raise ValueError(f"friction = {told(self.friction)} must be >= 0, or None")
        if self.wind is not None and not is_size(self.wind):
            raise ValueError(f"wind = {told(self.wind)} must be > 0 and finite, or None")
        self._refuse_buildings()
        for name, rows in (("rows", self.rows), ("rows_y", self.rows_y)):
            if rows and (len(rows) < 2 or not is_size(max(rows) - min(rows))):
                raise ValueError(
                    f"{name} must be at least two positions that differ, as in [0, 4]"
                )
        if not (isinstance(self.columns, Integral) and 1 <= self.columns <= MOST_COLUMNS):
            raise ValueError(
                f"columns = {told(self.columns)} must be a whole number from 1 on"
            )
        if len(self.devices) > MOST_DEVICES:
            raise ValueError(
                f"devices: {len(self.devices)} must be at most {MOST_DEVICES}; write"
                " equal ones as one, with the sum of their forces and stiffnesses"
            )
        self._refuse_impacts()
        if self.column is not None:
            self.column.refuse_line(self.bearing)
        if self.twist is not None:
            self.twist.refuse(self)
        object.__setattr__(self, "bed", bed_of(self))  # raises what it does not have

    def _refuse_impacts(self) -> None:
        """Refuse restitutions outside the model, and tendons without impacts."""
        if self.bearing.is_spherical and self.restitution != 1.0:
            raise ValueError(
                f"restitution e = {self.restitution:.4g} must be 1: columns without a"
                " flat part roll through upright without an impact; remove restitution"
                " and factor"
            )
        if self.bearing.is_spherical and any(
            device.kind == "tendon" for device in self.devices
        ):
            raise ValueError(
                "devices: tendons are not followed in columns without a flat part"
            )
        if not 0.0 < self.restitution <= 1.0:
            raise ValueError(
                f"restitution e = {self.restitution:.4g} (law {self.impact_law.kind})"
                " must be in (0, 1]: with e <= 0 the columns would not pass to their"
                " other edge; use more slender columns (a smaller tan alpha), with the"
                " law `flexible` a lighter building over the cap beam, a smaller loss"
                " (0.5) or factor, or give a measured value"
            )

    def _refuse_buildings(self) -> None:
        x = self.superstructure
        y = self.superstructure_y
        if x is not None and self.cap_beam_mass == 0.0:
            raise ValueError("cap_beam_mass must be > 0: the superstructure stands on it")
        if (
            x is not None
            and x.vertical_period is not None
            and self.impact_law.floors_jump
        ):
            raise ValueError(
                f"the impact law {self.impact_law.kind} lets floors jump with the cap"
                " beam, which vertical springs (vertical_period) do not; use the law"
                " flexible, with loss or factor"
            )
        if y is not None and (x is None or not np.array_equal(x.masses, y.masses)):
            raise ValueError("superstructure_y must have the floors of superstructure")

    def facts(self) -> dict[str, Any]:
        """Sizes, masses and what stands on the bearings."""
        return {
            "storeys": self.storeys,
            "critical_rotation": with_unit(self.critical_rotation, "rad"),
            "columns_mass": with_unit(self.columns_mass, "kg"),
            "cap_beam_mass": with_unit(self.cap_beam_mass, "kg"),
            "superstructure_mass": with_unit(self.superstructure_mass, "kg"),
            "devices": [device.kind for device in self.devices],
            "bearing": self.bearing,
        }

    @property
    def planar_only(self) -> str:
        """The reason why both horizontal components cannot act at
        once; empty if they can.
        """
        if self.bearing.ends == "cylindrical":
            return (
                "podium.bearing.ends: cylindrical ends roll along one direction and"
                " cannot roll across it; give one component, or make the ends spherical"
            )
        jumps = self.impact_law.floors_jump and self.superstructure is not None
        if jumps and not self.passes_smoothly:
            return (
                f"the impact law {self.impact_law.kind} lets floors jump, which has no"
                " form for a pass that loses a part of an impact; use the law flexible,"
                " with loss or factor"
            )
        return ""

    @property
    def passes_smoothly(self) -> bool:
        """True if nothing happens at upright: on compliant ends, and on
        those without flat part.

        Others have impacts there, or passes where both components
        act (Theory, section 13).
        """
        return self.bed is not None or self.bearing.is_spherical

    @cached_property
    def across(self) -> PodiumStructure:
        """The podium under what vibrates in y."""
        return (
            self if self.superstructure_y is None else self._under(self.superstructure_y)
        )

    def in_y(self) -> PodiumStructure:
        """The structure as a motion along y meets it: the building and the rows of that
        direction.
        """
        return replace(self.across, rows=self.rows_y, rows_y=self.rows)

    @cached_property
    def upwards(self) -> PodiumStructure | None:
        """The podium under what vibrates upwards; None where floors ride on the cap
        beam.
        """
        above = None if self.superstructure is None else self.superstructure.upwards
        return None if above is None else self._under(above)

    def _under(self, above: Superstructure) -> PodiumStructure:
        """The podium under another building; joints keep their stiffness."""
        joint = None if self.bed is None else self.bed.stiffness
        contact = replace(
            self.contact, period_ratio=None, settlement=None, stiffness=joint
        )
        return replace(self, superstructure=above, superstructure_y=None, contact=contact)

    @property
    def ways(self) -> dict[str, PodiumStructure]:
        """Structures that vibrate in x and, where that differs, in y, by an empty name
        and ``_y``.
        """
        return (
            {"": self, "_y": self.across}
            if self.superstructure_y is not None
            else {"": self}
        )

    @property
    def counts_columns(self) -> bool:
        """False where rows of several are known, and not how many columns they have."""
        return not self.rows or self.columns > 1

    def left_out_of_columns(self, *, both: bool, axial: bool = True) -> tuple[str, ...]:
        """Parts that forces of single columns leave out, and the
        keys that would give them.

        Parameters
        ----------
        both
            Whether both horizontal components act.
        axial
            Of axial forces; else of shears.
        """
        building = self.superstructure
        parts = []
        passes = both and not self.passes_smoothly
        several = building is not None or self.columns > 1
        if several and not (self.rows and (self.rows_y or not both)):
            key = "podium.plan, with y" if both else "podium.plan"
            what = "leaning columns" if building is None else "the building"
            parts.append(f"the overturning moment of {what} ({key})")
        if not (axial or passes):
            return tuple(parts)
        shocks = (
            f"passes shorter than {1e3 * self.shock_time:g} ms" if passes else "impacts"
        )
        if building is None:
            parts += [f"the shock of {shocks}"] * passes
        elif building.vertical_period is None and not self.bearing.is_spherical:
            parts.append(f"the shock of {shocks} (superstructure.vertical_period)")
        return tuple(parts)

    @property
    def shock_time(self) -> float:
        """Passes near upright that take less are shocks to what
        stands above [s] (13.19).
        """
        above = self.superstructure
        period = None if above is None else above.vertical_period
        return USUAL_SHOCK if period is None else period / 4.0

    @property
    def storeys(self) -> int:
        """n; 0 for a rigid frame."""
        return 0 if self.superstructure is None else self.superstructure.storeys

    @property
    def yields(self) -> bool:
        """True if storeys have strengths."""
        return self.superstructure is not None and self.superstructure.yields

    @property
    def superstructure_mass(self) -> float:
        """M_tot [kg]."""
        return 0.0 if self.superstructure is None else self.superstructure.mass

    @property
    def gamma(self) -> float:
        """m_b/(N m_c)."""
        return self.cap_beam_mass / self.columns_mass

    @property
    def eta(self) -> float:
        """M_tot/m_b; 0 without a superstructure."""
        return (
            self.superstructure_mass / self.cap_beam_mass if self.superstructure else 0.0
        )

    @property
    def eta_riding(self) -> float:
        """eta of floors that rise with the cap beam: of all, or of
        none on vertical springs.
        """
        above = self.superstructure
        return 0.0 if above is None or above.vertical_period is not None else self.eta

    @property
    def gamma_total(self) -> float:
        """gamma (1 + eta): the mass ratio if the superstructure were rigid."""
        return self.gamma * (1.0 + self.eta)

    @property
    def rest_force(self) -> float:
        """Weight on the lower end of a column [N]."""
        mass = self.columns_mass + self.cap_beam_mass + self.superstructure_mass
        return self.gravity * mass / self.columns

    @property
    def restoring_mass(self) -> float:
        """N m_c/2 + m_b + M_tot: what the bearings lift, reduced to the cap beam [kg]."""
        return 0.5 * self.columns_mass + self.cap_beam_mass + self.superstructure_mass

    @property
    def weight(self) -> float:
        """W = restoring mass times g [N]; v_b lifts it."""
        return self.restoring_mass * self.gravity

    @property
    def critical_rotation(self) -> float:
        """theta_cr [rad]."""
        return self.bearing.critical_rotation

    @property
    def restitution(self) -> float:
        """e of the impact law."""
        return self.impact_law.ratio(self.bearing, self.gamma, self.eta_riding)

    @property
    def uplift_acceleration(self) -> float:
        """Ground acceleration that uplifts quasi-statically: g tan(alpha) [m/s2]."""
        return self.gravity * self.bearing.slenderness

    @property
    def uplift_force(self) -> float:
        """F(0) = W tan(alpha): horizontal force at the cap beam that uplifts it [N]."""
        return self.weight * self.bearing.slenderness

    @property
    def static_base_shear(self) -> float:
        """V_st = M_tot g tan(alpha), the base shear at quasi-static
        uplift [N] (Theory (5.4)).
        """
        return self.superstructure_mass * self.uplift_acceleration

    @property
    def initial_stiffness(self) -> float:
        """dF/du_b at u_b = 0+ [N/m], exact.

        F = W B/C and du_b = 2 R C dx, so it is W (B'C - B^2)/(2 R C^3) at x = 0; to first
        order in alpha W (2 rho - 1)/(2 R) (Theory (5.2)).
        """
        phase = self.bearing.rocking if self.bearing.is_flat else self.bearing.rolling
        B = geometry.contact_arm(phase, 1.0, 0.0)
        C = geometry.contact_height(phase, 1.0, 0.0)
        slope = (phase.c - C) * C - B**2
        return self.weight * slope / (2.0 * self.bearing.semi_diagonal * C**3)

    @property
    def turning_inertia(self) -> float:
        """K(0), limit of J/theta^2 over N m_c R^2: inertia
        against turns (Theory (13.12)).
        """
        cosine = math.cos(self.bearing.alpha)
        return self.bearing.inertia_ratio - 1.0 + (1.0 + 4.0 * self.gamma) * cosine**2

    @property
    def pass_turn(self) -> float:
        """Delta phi = pi sqrt(A(0)/K(0)): turn in a pass near
        upright [rad] (Theory (13.13)).

        A(0) - K(0) = (1 + 4 gamma (1 + eta)) sin^2(alpha): falling moves masses up and
        down, going round does not, so the turn exceeds pi however near the pass is.
        Floors on vertical springs have no part in it.
        """
        sine = math.sin(self.bearing.alpha)
        K = self.turning_inertia
        lifted = 1.0 + 4.0 * self.gamma * (1.0 + self.eta_riding)
        return math.pi * math.sqrt(1.0 + lifted * sine**2 / K)

    @property
    def rolling_period(self) -> float | None:
        """T of small rolling under a rigid building [s]; None where a
        flat part makes it jump.

        2 pi sqrt(M/K) with M = N m_c Io/4 + m_b + M_tot and K = W (2 rho - 1)/(2 H),
        exact as the swing vanishes (Theory (6.4)).
        """
        if not self.bearing.is_spherical:
            return None
        columns = 0.25 * self.columns_mass * self.bearing.inertia_ratio
        mass = columns + self.cap_beam_mass + self.superstructure_mass
        return 2.0 * math.pi * math.sqrt(mass / self.initial_stiffness)

    @cached_property
    def rigid_frequency_parameter(self) -> float:
        """p_hat of the rigid flat-ended frame with gamma_total [rad/s] (Theory (6.8))."""
        carried = self.gamma_total
        ratio = (1.0 + 2.0 * carried) / (self.bearing.inertia_ratio + 4.0 * carried)
        return math.sqrt(self.gravity / self.bearing.semi_diagonal * ratio)

    def path(self, rotation: Array) -> tuple[Array, ...]:
        """F = W B/C [N] (on a bed the weight's arm for B), u_b and
        v_b [m] at |theta| [rad].
        """
        (arm, C, u, v) = self._along(rotation)
        diameter = 2.0 * self.bearing.semi_diagonal
        return self.weight * arm / C, diameter * u, diameter * v

    def _along(self, rotation: Array) -> tuple[Array, ...]:
        """Arm of the weight and C over R, u_b and v_b over 2 R at |theta| [rad]."""
        b = self.bearing
        x = np.asarray(rotation)
        if self.bed is None:
            return geometry.path_along(b.rolling, b.rocking, b.beta, x)
        on_bed = self.bed.path(x)
        return on_bed.arm, on_bed.height, on_bed.displacement, on_bed.lift

    def weight_arm(self, rotation: Array) -> Array:
        """Arm of the weight over R at |theta| [rad]: the restoring
        moment is 2 R W times it.
        """
        return self._along(rotation)[0]

    def lever_arm(self, rotation: Array) -> Array:
        """2 R C = |du_b/dtheta| at |theta| [rad]: the arm of a
        force at the cap beam [m].
        """
        return 2.0 * self.bearing.semi_diagonal * self._along(rotation)[1]


class AtRest(NamedTuple):
    """Horizontal forces of a device on the cap beam at rest, at the
    rotations asked for [N].
    """

    restoring: Array | float = 0.0  # Needed in addition to hold a rotation > 0
    held: Array | float = 0.0  # Friction, which holds as much either way


class Linear(NamedTuple):
    """Terms that a device adds to small motions 2 R theta on one side
    (Theory, sections 6, 11).
    """

    stiffness: float = 0.0  # [N/m]
    damping: float = 0.0  # [N s/m]
    left_out: str = ""  # In words, what of it is not linear; empty if nothing


class Consequence(NamedTuple):
    """A number that follows from one device: its name in JSON,
    and the words of a table.
    """

    name: str  # In JSON
    label: str  # In tables
    unit: str  # SI; ``-`` for plain numbers
    value: float | None  # None if it is never reached


@dataclass(frozen=True)
class Device(ABC):
    """The law of a device between ground and cap beam, which it pushes
    unless a law says otherwise.

    All that follows from a law is asked here; what resists motion alone need not answer
    most of it. How it is drawn is told in `report.figures.bearing`.
    """

    in_each_column: ClassVar[bool] = False
    """True if each column has one; its force and stroke are those of one then."""

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """On the plan, each with an equal part of it [m]; none: in the middle."""
        return getattr(self, "at", ())

    @property
    @abstractmethod
    def kind(self) -> str:
        """Its name in a case."""

    @property
    @abstractmethod
    def results(self) -> tuple[str, ...]:
        """Results of a history that exist with it: its largest force by
        a name, or a share lost.
        """

    @abstractmethod
    def linear(self, structure: PodiumStructure, state: UpliftedState) -> Linear:
        """Its linear part, which modes hold."""

    def constants(self, structure: PodiumStructure) -> tuple[float, ...]:
        """Numbers of its law, as the kernels read them."""
        names = (each.name for each in fields(self) if each.name != "at")
        return tuple(getattr(self, name) for name in names)

    def at_rest(
        self, structure: PodiumStructure, rotation: Array, farthest: float
    ) -> AtRest:
        """Forces at rest at |theta|, after it was drawn to the
        farthest rotation [rad].
        """
        return AtRest()

    def stiffness_after_uplift(self, structure: PodiumStructure) -> float:
        """Its part of dF/du_b at u_b = 0+, on the way out [N/m], exact."""
        return 0.0

    def bounds(self, structure: PodiumStructure) -> tuple[float, float]:
        """Stiffness [N/m] and damping [N s/m] that it adds at most
        against u_b, for time steps.
        """
        return 0.0, 0.0

    def consequences(self, structure: PodiumStructure) -> Iterator[Consequence]:
        """Numbers that follow from it before any analysis."""
        return iter(())

    def stroke(self, structure: PodiumStructure, rotation: Array) -> Array:
        """Its displacement or elongation [m]."""
        return structure.path(rotation)[1]

    def remaining_prestress(self, permanent: float) -> float | None:
        """Prestress of one, upright, after a permanent
        elongation [m]; None without [N].
        """
        return None

    def reached_at(self, structure: PodiumStructure, length: float) -> float | None:
        """The |theta| at which its stroke reaches a length; None
        beyond 2 theta_cr [rad].
        """
        from scipy.optimize import brentq

        def excess(x: float) -> float:
            return float(self.stroke(structure, np.array([x]))[0]) - length

        end = 2.0 * structure.critical_rotation
        return None if excess(end) < 0.0 else float(brentq(excess, 0.0, end))
