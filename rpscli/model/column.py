"""One column as an engineer designs it: forces along it, and the pressure under its ends.

Ends are elastic where they bear on their arcs, and plastic where they stand on an edge,
under which an elastic pressure has no bound. The plates under and over them are
half-spaces. Theory (16.1) to (16.6).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import require_fields
from rpscli.model.bearing import Bearing

Array: TypeAlias = NDArray[np.float64]

LARGEST_EDGE = 1.0 / 3.0
"""Of the width: an edge that crushes further is no line about which a column turns."""


class ColumnState(NamedTuple):
    """One column at an instant, and its forces."""

    side: float  # 1 where the lower contact lies right of the axis, or -1
    rotation: float  # |theta| [rad]
    rate: float  # theta' [rad/s]
    # of the lower contact from the middle of its end [m]; the upper end is its image
    lever: float
    rise: float  # the same along the axis [m]
    shear_bottom: float  # F to the right on what is above [N]
    normal_bottom: float  # N upwards on what is above [N]
    shear_top: float
    normal_top: float

    def section_forces(
        self, bearing: Bearing, mass: float, along: Array
    ) -> tuple[Array, ...]:
        """P [N], compression positive, Q [N] and M [N m] at places along the column.

        Accelerations are those that the forces at both ends give it: (16.1), (16.2).
        """
        H = bearing.half_height
        xi = np.asarray(along)
        s = self.side
        F = self.shear_bottom
        N = self.normal_bottom
        mu = mass / (2.0 * H)
        cos = math.cos(self.rotation)
        sin = math.sin(self.rotation)
        across = (F - self.shear_top) / mass
        up = (N - self.normal_top) / mass
        a_n = s * across * sin + up * cos
        a_t = s * across * cos - up * sin
        P_b = N * cos + s * F * sin
        Q_b = s * F * cos - N * sin
        # Of the contacts about the centre.
        beside = self.lever * cos - (H - self.rise) * sin
        above = self.lever * sin + (H - self.rise) * cos
        inertia = (bearing.inertia_ratio - 1.0) * mass * bearing.semi_diagonal**2
        moment = beside * (N + self.normal_top) + s * above * (F + self.shear_top)
        turning = -moment / inertia
        j = (inertia - mass * H**2 / 3.0) / (2.0 * H)
        bent = 0.5 * xi**2 - H * xi
        P = P_b - mu * (a_n * xi - self.rate**2 * bent)
        Q = Q_b - mu * (a_t * xi + turning * bent)
        M = self.lever * P_b + (xi - self.rise) * Q_b - 0.5 * mu * a_t * xi**2
        return P, Q, M + turning * (mu * (0.5 * H * xi**2 - xi**3 / 6.0) + j * xi)


@dataclass(frozen=True)
class ArcContact:
    """Where an arc touches a plate: along a line, or in a point."""

    kind: Literal["line", "point"]
    radius: float  # along the tilt [m]
    radius_across: float | None = None  # of a point [m]
    length: float | None = None  # of a line [m]

    def __str__(self) -> str:
        """The kind and its sizes.

        >>> str(ArcContact("line", 1.5, length=0.7)), str(ArcContact("point", 2.0, 2.0))
        ('line of 0.7 m, r = 1.5 m', 'point, r = 2 m')
        """
        if self.length is not None:
            return f"line of {self.length:.4g} m, r = {self.radius:.4g} m"
        if self.radius_across in (None, self.radius):
            return f"{self.kind}, r = {self.radius:.4g} m"
        return f"point, r = {self.radius:.4g} m, across {self.radius_across:.4g} m"


@dataclass(frozen=True)
class ColumnDesign:
    """Cross-section and material of a column, and of the plate it stands on."""

    section: Literal["square", "round"]
    modulus: float  # E of the column [Pa]
    poisson: float  # nu of the column
    contact_strength: float  # f: pressure that column or plate can bear [Pa]
    edge_length: float | None = None  # L of the line on which an end bears [m]
    plate_modulus: float | None = None  # of the plate; None: that of the column
    plate_poisson: float | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be a length or a material."""
        require_fields(self)
        sizes = self.modulus, self.contact_strength, self.edge_length, self.plate_modulus
        if not all(0.0 < size < math.inf for size in sizes if size is not None):
            raise ValueError(
                "moduli, contact_strength and edge_length must be > 0 and finite"
            )
        if not all(0.0 <= nu <= 0.5 for nu in (self.poisson, self.plate_poisson or 0.0)):
            raise ValueError("poisson must be from 0 to 0.5")

    def bears_on_line(self, bearing: Bearing) -> bool:
        """True where its ends touch plates along a line, and not in a point.

        Where nothing is said of the ends, those of round columns are bodies of
        revolution, as are those without a flat part, of which a point is the safe side;
        other square columns are curved, or have an edge, along each of their sides.
        """
        if bearing.ends is not None:
            return bearing.ends == "cylindrical"
        return self.section == "square" and not bearing.is_of_revolution

    def line(self, bearing: Bearing) -> float | None:
        """L of the line on which an end bears [m]; None where it touches in a point."""
        self.refuse_line(bearing)
        return self.edge_length if self.bears_on_line(bearing) else None

    def stands_on_corners(self, bearing: Bearing) -> bool:
        """True of square ends that have a line along each side, and none on a corner."""
        return bearing.ends is None and self.bears_on_line(bearing)

    def refuse_line(self, bearing: Bearing) -> None:
        """Refuse a line without a length, and a length without a line."""
        line = self.bears_on_line(bearing)
        # A square column without a flat part may have one, from before ends had a shape.
        unsaid = self.section == "square" and bearing.ends is None
        if line and self.edge_length is None:
            raise ValueError(
                "edge_length belongs to square columns and cylindrical ends, all of"
                " them, as in 0.45 m: L of the line on which an end bears"
            )
        if self.edge_length is not None and not (line or unsaid):
            ends = "spherical ends" if bearing.ends else "ends of round columns"
            raise ValueError(
                "edge_length belongs to square columns and cylindrical ends (podium."
                f"bearing.ends): {ends} touch in a point; remove it"
            )

    def contact(self, bearing: Bearing, rotation: float) -> ArcContact:
        """Contact of an arc at a tilt [rad], which is above 0 beside a flat part."""
        r = bearing.radius
        if self.bears_on_line(bearing):
            return ArcContact("line", r, length=self.edge_length)
        width = bearing.half_width
        across = r + width / math.sin(rotation) if width else r
        return ArcContact("point", r, radius_across=across)

    @property
    def contact_modulus(self) -> float:
        """E* of column and plate [Pa]."""
        nu = self.poisson if self.plate_poisson is None else self.plate_poisson
        plate = (1.0 - nu**2) / (self.plate_modulus or self.modulus)
        return 1.0 / ((1.0 - self.poisson**2) / self.modulus + plate)

    def pressed(
        self, bearing: Bearing, rotation: Array, force: Array
    ) -> tuple[Array, ...]:
        """Elastic pressure p_0 under an arc [Pa], and half widths of the contact [m].

        The first of these lies in the plane of tilt; that of a line across is infinite.
        """
        r = bearing.radius
        E = self.contact_modulus
        N = np.maximum(force, 0.0)
        if (L := self.line(bearing)) is not None:  # (16.4)
            half = np.sqrt(4.0 * N * r / (math.pi * L * E))
            return np.sqrt(N * E / (math.pi * L * r)), half, np.full_like(half, np.inf)
        from scipy.special import elliprd  # slow

        # (16.5), with Carlson's integrals for K and E: [K - E]/m = R_D(0, k^2, 1)/3 and
        # [E/k^2 - K]/m = R_D(0, 1, k^2)/3, without the differences that vanish with m.
        width = bearing.half_width
        ratio = 1.0 + (
            width / (r * np.sin(rotation)) if width else np.zeros_like(rotation)
        )
        k = ratio ** (-2.0 / 3.0)
        one = np.ones_like(ratio)
        for _ in range(16):  # each leaves a fifth of the error at most
            short = elliprd(0.0, k * k, one)
            k = k * (elliprd(0.0, one, k * k) / short / ratio) ** 0.6
        both = elliprd(0.0, one, k * k) * elliprd(0.0, k * k, one) / 9.0
        F_1 = (4.0 / math.pi) ** (1.0 / 3.0) * np.sqrt(k) * both ** (1.0 / 6.0)
        c = (0.75 * np.maximum(N, 1e-9) * r * np.sqrt(ratio) / E) ** (1.0 / 3.0) * F_1
        return 1.5 * N / (math.pi * c**2), c * np.sqrt(k), c / np.sqrt(k)

    def doubt(self, bearing: Bearing, rotation: float, force: float) -> str:
        """The reason why the pressure is another one; empty where its law is valid."""
        _, along, across = self.pressed(bearing, np.array(rotation), np.array(force))
        r = bearing.radius
        line = self.bears_on_line(bearing)
        if r * math.sin(rotation) <= along and not bearing.is_spherical:
            return "an upper bound, since the flat part still bears"
        if bearing.is_spherical:
            return "" if line or along < r / 5.0 else "the contact is wider than r/5"
        wide = not line and across >= 0.5 * (bearing.half_width + r * math.sin(rotation))
        return "longer than half of the distance to the axis" if wide else ""

    def crushed(self, bearing: Bearing, force: float) -> tuple[float, float]:
        """Depth of a plastic edge, and by how much it shortens the lever
        of the column [m] (16.6).

        Of a round end that crushes whole, the depth goes on with the force.
        """
        area = max(force, 0.0) / self.contact_strength
        radius = bearing.end_half_width
        if (L := self.line(bearing)) is not None:
            return area / L, 0.5 * area / L
        area /= radius**2
        if area >= math.pi:
            return 2.0 * radius * area / math.pi, radius
        from scipy.optimize import brentq  # slow

        p = float(
            brentq(lambda p: p - 0.5 * math.sin(2.0 * p) - area, 0.0, math.pi, xtol=1e-14)
        )
        centroid = 2.0 / 3.0 * math.sin(p) ** 3 / area if area else 1.0
        return radius * (1.0 - math.cos(p)), radius * (1.0 - centroid)
