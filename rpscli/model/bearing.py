"""One kinematic bearing: its shape, and what follows from shape
alone, at rest and uplifted.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import is_size, require_fields
from rpscli.physics.laws import geometry
from rpscli.units import computed_remedy

Ends: TypeAlias = Literal["spherical", "cylindrical"]


def first_order_critical_curvature_ratio(
    slenderness: float, wedge_slenderness: float
) -> float:
    """rho_cr = (1 - tan(alpha)/tan(alpha'))/2 (paper, Eq. 1):
    sin(beta) taken as tan(beta).

    Examples
    --------
    >>> first_order_critical_curvature_ratio(0.15, 0.30)
    0.25
    """
    return 0.5 * (1.0 - slenderness / wedge_slenderness)


STEEP = 2.0
"""Slenderness above which no column stands: perhaps an angle in degrees."""


@dataclass(frozen=True)
class Bearing:
    """A free-standing column whose ends are flat in the middle and curved outside.

    Parameters
    ----------
    semi_diagonal
        R = sqrt(H^2 + B^2) of the half-height H and the
        half-width B of the flat part [m].
    slenderness
        tan(alpha) = B/H; 0 for spherical ends, whose arc leaves no flat part.
    wedge_slenderness
        tan(alpha') = B'/H, B' the half-width up to which the ends are
        curved. Flat ends ignore it.
    curvature_ratio
        rho = r/(2H), r the radius of the arcs; 0 for flat ends (Housner's block).
    inertia_ratio
        I_o/(m_c R^2), I_o about an edge of the flat part; 4/3 for a rectangular block.
    inertia_ratio_axial
        I_3/(m_c R^2), I_3 about the axis of the column, which takes part where
        both horizontal components act; left out: (B'/R)^2/2, a solid round
        column of half-width B'.
    ends
        `spherical` ends are bodies of revolution about the axis of the column, which
        touch in a point; `cylindrical` ones are curved along the motion only, touch
        along a line and cannot roll across it. None: as the width of the flat part and
        the section of the column say. Flat ends have none.

    Raises
    ------
    ValueError
        If a size is not positive, if the arc cannot span from B to B' (0 <=
        sin(beta) <= 1 fails), or if spherical ends would not stand: their radius
        must exceed H, rho > 1/2.

    Notes
    -----
    Theory, section 1; paper, Figure 1b.

    Examples
    --------
    >>> bearing = Bearing(1.5, 0.15, 0.30, 0.5)
    >>> round(bearing.beta, 4), round(bearing.critical_rotation, 4)
    (0.1506, 0.2946)
    """

    semi_diagonal: float
    slenderness: float
    wedge_slenderness: float
    curvature_ratio: float
    inertia_ratio: float = 4.0 / 3.0
    inertia_ratio_axial: float = None  # type: ignore[assignment]  # completed below
    ends: str | None = None  # one of `Ends`

    def __post_init__(self) -> None:
        """Refuse a shape that cannot be built."""
        require_fields(self)
        for name in ("semi_diagonal", "inertia_ratio"):
            if not is_size(value := getattr(self, name)):
                raise ValueError(f"{name} = {value} must be > 0")
        if self.slenderness < 0.0:
            raise ValueError(f"slenderness = {self.slenderness} must be >= 0")
        if self.curvature_ratio < 0.0:
            raise ValueError(
                f"curvature_ratio = {self.curvature_ratio} must be >= 0; 0 = flat ends"
            )
        if self.is_spherical and not (
            self.curvature_ratio > 0.5 and self.wedge_slenderness > 0.0
        ):
            raise ValueError(
                f"curvature_ratio = {self.curvature_ratio:g} must be > 0.5 with"
                f" slenderness: 0, and wedge_slenderness = {self.wedge_slenderness:g} >"
                " 0: without a flat part an arc whose radius is not above half the"
                " height does not hold the column upright"
            )
        self._refuse_ends()
        if not self.is_flat and self.slenderness > self.wedge_slenderness:
            raise ValueError(
                f"wedge_slenderness = {self.wedge_slenderness:g} must be >= slenderness ="
                f" {self.slenderness:g}: the arcs lie outside the flat part; both are"
                f" tangents{self._angles()}"
            )
        if not self.is_flat and self._sin_beta > 1.0:
            raise ValueError(
                f"curvature_ratio = {self.curvature_ratio:.6g} must be >="
                f" {0.5 * (self.wedge_slenderness - self.slenderness):.6g} = (tan alpha'"
                " - tan alpha)/2: a smaller arc does not reach the wedge's edge; use a"
                f" larger one, or a smaller wedge_slenderness{self._angles()}"
            )
        axial: float | None = vars(self)["inertia_ratio_axial"]
        if axial is None:
            solid = 0.5 * (math.cos(self.alpha) * self._wedge) ** 2
            object.__setattr__(self, "inertia_ratio_axial", solid)
        elif axial <= 0.0:
            raise ValueError(f"inertia_ratio_axial = {axial} must be > 0")

    def _refuse_ends(self) -> None:
        """Refuse shapes that are unknown, and those of ends that are not curved."""
        if self.ends not in (None, *get_args(Ends)):
            raise ValueError(f"ends = {self.ends} must be spherical, cylindrical or None")
        if self.ends is not None and self.is_flat:
            raise ValueError(
                f"ends = {self.ends} has no meaning for flat ends, which are not curved:"
                " give them arcs, or remove ends"
            )

    def _angles(self) -> str:
        """A hint at degrees where a slenderness is no tangent of any column."""
        steep = [
            each for each in (self.slenderness, self.wedge_slenderness) if each > STEEP
        ]
        return "".join(computed_remedy(f"{each:g} deg", "1") for each in steep)

    @property
    def is_flat(self) -> bool:
        """True of flat ends: the column rocks from the start and never rolls."""
        return self.curvature_ratio == 0.0 or self.wedge_slenderness == self.slenderness

    @property
    def is_spherical(self) -> bool:
        """True if an arc takes all of the ends: the column rolls
        from rest, without impacts.
        """
        return self.slenderness == 0.0

    @property
    def is_of_revolution(self) -> bool:
        """True of ends that touch in a point whatever the section of the column: those
        said to be spherical, and those without a flat part of which nothing is said.
        """
        return self.ends == "spherical" or (self.ends is None and self.is_spherical)

    @property
    def alpha(self) -> float:
        """Slenderness angle of the flat part [rad]."""
        return math.atan(self.slenderness)

    @property
    def _wedge(self) -> float:
        """tan(alpha'); tan(alpha) for flat ends."""
        return self.slenderness if self.is_flat else self.wedge_slenderness

    @property
    def alpha_wedge(self) -> float:
        """alpha': slenderness angle of the curved part's edge
        [rad]; alpha for flat ends.
        """
        return math.atan(self._wedge)

    @property
    def _sin_beta(self) -> float:
        return (self.wedge_slenderness - self.slenderness) / (2.0 * self.curvature_ratio)

    @property
    def beta(self) -> float:
        """Rotation at which rolling ends and rocking begins [rad]; 0 for flat ends."""
        return 0.0 if self.is_flat else math.asin(self._sin_beta)

    @property
    def half_height(self) -> float:
        """H [m]."""
        return self.semi_diagonal * math.cos(self.alpha)

    @property
    def half_width(self) -> float:
        """B, half the flat part [m]."""
        return self.semi_diagonal * math.sin(self.alpha)

    @property
    def end_half_width(self) -> float:
        """B', or B where the ends are flat [m]."""
        return self.half_width + self.radius * math.sin(self.beta)

    @property
    def radius(self) -> float:
        """r, the radius of the arcs [m]."""
        return 2.0 * self.half_height * self.curvature_ratio

    @cached_property
    def rolling(self) -> geometry.Phase:
        """Constants of the rolling phase."""
        return geometry.rolling_phase(self.alpha, self.curvature_ratio)

    @cached_property
    def rocking(self) -> geometry.Phase:
        """Constants of the rocking phase."""
        return geometry.rocking_phase(self.alpha, self.curvature_ratio, self.beta)

    @cached_property
    def critical_rotation(self) -> float:
        """theta_cr: where the weight stops restoring; the smallest
        positive root of B [rad].

        The paper's Eq. 1 has the same branches, but changes over at its first-order
        rho_cr: see `critical_rotation_of_paper`.
        """
        return geometry.critical_rotation(self.rolling, self.rocking, self.beta)

    def rotation_at(self, displacement: float) -> float:
        """Rotation at which the cap beam has moved so far [m]; infinite if it never has.

        >>> bearing = Bearing(1.5, 0.15, 0.30, 0.5)
        >>> round(bearing.rotation_at(0.5), 6), bearing.rotation_at(5.0)
        (0.166459, inf)
        """
        from scipy.optimize import brentq  # slow

        def beyond(rotation: float) -> float:
            path = geometry.path_along(
                self.rolling, self.rocking, self.beta, np.array([rotation])
            )
            return float(2.0 * self.semi_diagonal * path[2][0] - displacement)

        end = self.largest_rotation  # up to which it grows
        return (
            math.inf if beyond(end) < 0.0 else float(brentq(beyond, 0.0, end, xtol=1e-15))
        )

    @cached_property
    def largest_rotation(self) -> float:
        """Rotation where the model ends [rad]: the cap beam is
        farthest from its place, C = 0.

        pi/2 + alpha for flat ends; at most pi, up to where `formulae.trigonometry` holds.

        >>> round(Bearing(1.5, 0.15, 0.15, 0.0).largest_rotation - math.atan(0.15), 12) == round(
        ...     math.pi / 2, 12
        ... )
        True
        """
        return min(geometry.arm_root(self.rocking) + 0.5 * math.pi, math.pi)

    @property
    def overturns_rolling(self) -> bool:
        """True if theta_cr is reached before the contact arrives at the arc's end."""
        return self.critical_rotation < self.beta

    @property
    def critical_rotation_of_paper(self) -> float:
        """theta_cr by Eq. 1 of the paper [rad]; its branches jump by
        about 2 % at its rho_cr.
        """
        if self.curvature_ratio <= self.critical_curvature_ratio_of_paper:
            return math.atan2(self.slenderness, 1.0 - 2.0 * self.curvature_ratio)
        lowered = 1.0 - 2.0 * self.curvature_ratio * (1.0 - math.cos(self.beta))
        return math.atan2(self._wedge, lowered)

    @property
    def critical_curvature_ratio_of_paper(self) -> float:
        """rho_cr to first order, as the paper has it (Theory (1.15))."""
        return first_order_critical_curvature_ratio(self.slenderness, self._wedge)

    @cached_property
    def critical_curvature_ratio(self) -> float:
        """The rho at which theta_cr = beta exactly; above it the
        column overturns rocking.

        Solves tan alpha/(1 - 2 rho) = tan beta(rho), Theory (1.14). 0 for flat ends.
        """
        rise = self._wedge - self.slenderness
        if rise <= 0.0 or self.is_spherical:
            return 0.5 if self.is_spherical else 0.0
        # With t = 2 rho the condition squares to t^2 - rise^2 = (rise (1 -
        # t)/tan(alpha))^2, a quadratic whose root between rise and 1 is wanted (beta from
        # 90 degrees down).
        ratio = (rise / self.slenderness) ** 2
        roots = np.roots([1.0 - ratio, 2.0 * ratio, -(rise**2) - ratio]).real
        admissible = [t for t in roots if rise <= t <= 1.0]
        return 0.5 * float(min(admissible)) if admissible else math.nan

    def tendon_elongation(self, rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        """Elongation of a tendon in the axis at |theta| [m] (Theory (11.9))."""
        across, upwards, _ = self._end_displacement(rotation)
        return 2.0 * np.hypot(across, upwards)

    def tendon_lever(self, rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        """de/dx, the arm of a tendon about the contacts at
        |theta| [m] (Theory (11.10)).
        """
        across, upwards, reach = self._end_displacement(rotation)
        distance = np.hypot(across, upwards)
        some = np.where(distance > 0.0, distance, 1.0)
        return 2.0 * reach * np.where(distance > 0.0, upwards / some, 1.0)  # its cosine

    def _end_displacement(
        self, rotation: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], ...]:
        """Ways of the middle of an end across and upwards, and
        the contact from there [m].
        """
        x = np.abs(np.asarray(rotation, dtype=float))
        y = np.minimum(x, self.beta)
        return geometry.end_displacement(
            self.half_width,
            0.0 if self.is_flat else self.radius,
            (y, np.sin(y), 1.0 - np.cos(y)),
            (np.sin(x), 1.0 - np.cos(x)),
        )


class UpliftedState(NamedTuple):
    """Contact geometry at one tilt x, of which linear equations have
    constants (Theory (6.1)).

    Lengths of the columns are over R, derivatives by the tilt.
    """

    rotation: float  # x [rad]
    arm: float  # B
    height: float  # C, so that u_b' = 2 R C x'
    kappa: float  # B', the podium's dimensionless stiffness
    squared_distance: float  # S = B^2 + C^2; 1 to first order
    elongation: tuple[float, float, float]  # e, e' and e'' of a tendon in the axis [m]


def uplifted_state(
    bearing: Bearing, *, rolling: bool, exact: bool = True
) -> UpliftedState:
    """The state where it begins; else the paper's, to first order
    and rocking continued to 0.
    """
    if not exact:
        diameter = 2.0 * bearing.semi_diagonal
        a = bearing.alpha if rolling else bearing.alpha_wedge
        kappa = 2.0 * bearing.curvature_ratio - 1.0 if rolling else -1.0
        # e = 2 R (a x + (kappa + 1) x^2/2)
        return UpliftedState(
            0.0, a, 1.0, kappa, 1.0, (0.0, diameter * a, diameter * (kappa + 1.0))
        )
    phase, x = (bearing.rolling, 0.0) if rolling else (bearing.rocking, bearing.beta)
    cosine = math.cos(x)
    sine = math.sin(x)
    B = geometry.contact_arm(phase, cosine, sine)
    C = geometry.contact_height(phase, cosine, sine)
    kappa = phase.q * cosine - phase.p * sine
    return UpliftedState(x, B, C, kappa, B * B + C * C, _elongation(bearing, x))


def _elongation(bearing: Bearing, x: float) -> tuple[float, float, float]:
    """At theta = 0, or where the contact has arrived at the arc's end and stays there."""
    B = bearing.half_width
    r = 0.0 if bearing.is_flat else bearing.radius
    if x == 0.0:
        return 0.0, 2.0 * B, 2.0 * r
    # The middle of an end moves by z = reach - edge exp(-i x); e = 2 |z|.
    edge = complex(B + r * math.sin(x), r * (1.0 - math.cos(x)))
    turned = edge * cmath.exp(-1j * x)
    z = B + r * x - turned
    away = (z.conjugate() * 1j * turned).real
    bend = abs(turned) ** 2 + (z.conjugate() * turned).real
    distance = abs(z)
    return (
        2.0 * distance,
        2.0 * away / distance,
        2.0 * (bend - (away / distance) ** 2) / distance,
    )
