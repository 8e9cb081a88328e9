"""Supports of the columns' ends: rigid, a compliant plane, or two compliant edges."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import is_size, require_fields
from rpscli.physics.laws import geometry, plane_bed

Array: TypeAlias = NDArray[np.float64]
ContactKind = Literal["rigid", "plane", "edges"]
SHAPE = {"plane": 1.0 / 3.0, "edges": 1.0}
"""m(phi_u): the moment at which a kind begins to lift, over that
of a column on its edge."""

USUAL_LOSS = {"rigid": 1.0, "plane": 0.3, "edges": 1.0}
"""kappa where a case gives none: little for plane ends, which
is cautious for rotations."""


@dataclass(frozen=True)
class Contact:
    """Support of the ends in full contact and as they lift, rigid or
    of one size (Theory, 12).
    """

    kind: ContactKind = (
        "rigid"  # plane: an even joint, lifts gradually; edges: lift at once
    )
    period_ratio: float | None = None  # r, in full contact over a fixed base, above 1
    stiffness: float | None = None  # K_s = dF/du_b of the podium at u_b = 0 [N/m]
    settlement: float | None = None  # D_0 of one joint of flat ends under the weight [m]
    damping: float = 0.03  # zeta of the podium in full contact: c = 2 zeta sqrt(k A)

    def __post_init__(self) -> None:
        """Refuse what does not say how soft it is."""
        require_fields(self)
        if self.kind not in USUAL_LOSS:
            raise ValueError(f"contact {self.kind!r} must be rigid, plane or edges")
        given = [
            x
            for x in (self.period_ratio, self.stiffness, self.settlement)
            if x is not None
        ]
        if self.kind == "rigid" and given:
            raise ValueError(
                "rigid contact takes no period_ratio, stiffness or settlement; a"
                " measured period does not tell whether ends are `plane` or `edges`:"
                " name one, and try both"
            )
        if self.kind != "rigid" and len(given) != 1:
            raise ValueError(
                f"contact {self.kind} takes one of period_ratio, stiffness, settlement;"
                f" {len(given)} are given"
            )
        if not all(map(is_size, given)) or not 0.0 <= self.damping < math.inf:
            raise ValueError(
                "sizes of the contact must be > 0, its damping >= 0, none of them huge"
            )
        if self.period_ratio is not None and self.period_ratio <= 1.0:
            raise ValueError(
                f"period_ratio = {self.period_ratio:g} must be above 1: compliant ends"
                " lengthen the period; for 1 use the kind `rigid`"
            )


Standing: TypeAlias = Any
"""A `PodiumStructure`, which imports this module."""


class BedPath(NamedTuple):
    """Arms, height, displacements and potential along |theta|, arrays of its shape."""

    arm: Array  # of the weight, over R: the restoring moment is 2 W R times it
    lift_arm: Array  # B_v: v_b' = 2 R B_v theta'
    lift_bend: Array  # dB_v/dx
    height: Array  # C
    displacement: Array  # u_b/2R
    lift: Array  # v_b/2R
    potential: Array  # of weight and bed, over 2 W R


class Bed(NamedTuple):
    """Compliant full contact, of a structure (Theory (12.5) to (12.9))."""

    structure: Standing
    uplift_rotation: float  # phi_u, at which an edge lifts [rad]
    height: float  # C at phi_u
    lift_arm: float  # B at phi_u
    inertia: float  # A_u, over N m_c R^2 as the next two
    spring: float  # k, the secant of the moment [1/s2]
    damper: float  # c [1/s]
    stiffness: float  # K_s at the cap beam [N/m]
    mass: float  # m_0 at the cap beam [kg]
    sink: float  # what w takes from the arm of the weight; 0 on edges
    root: float  # and from that of the lift
    kept: float  # j, theta' after uplift over that before: below 1 on edges
    # what u_b/2R lacks at phi_u for being continuous, C_u being constant below it
    shift: float
    full_rotation: float  # x_full of curved ends or 0 [rad]
    fade: float  # 1/(x_full - phi_u) or 0

    @property
    def settlement(self) -> float | None:
        """D_0 of one joint under permanent load [m]; None on
        curved ends, which bear wider.
        """
        b = self.structure.bearing
        return float(self.uplift_rotation * b.half_width) if b.is_flat else None

    @property
    def period_ratio(self) -> float | None:
        """r, first period in full contact over that on a fixed base;
        None without a building.
        """
        from scipy.optimize import brentq

        if self.structure.superstructure is None:
            return None
        first = float(self.structure.superstructure.frequencies[0])

        def misses(share: float) -> float:
            return (
                _storey_stiffness(self.structure, self.mass, share * first)
                / self.stiffness
                - 1.0
            )

        return 1.0 / float(brentq(misses, 1e-9, 1.0 - 1e-12, xtol=1e-15, rtol=1e-15))

    @property
    def period(self) -> float | None:
        """First period in full contact [s]."""
        building = self.structure.superstructure
        ratio = self.period_ratio
        return None if ratio is None else ratio * float(building.periods[0])

    @property
    def joint_stiffness(self) -> float | None:
        """W/D_0 of one joint of all columns, pressed evenly by
        the permanent load [N/m].
        """
        return self.settlement and float(self.structure.weight) / self.settlement

    @property
    def ratio(self) -> float:
        """phi_u/alpha."""
        return float(self.uplift_rotation / self.structure.bearing.alpha)

    @property
    def contact_share(self) -> float | None:
        """Contact length at alpha/10 over the flat part's; None
        of edges and curved ends.
        """
        gradual = self.root and self.structure.bearing.is_flat
        return math.sqrt(min(10.0 * self.ratio, 1.0)) if gradual else None

    def refuse_start(self, rotation: float) -> None:
        """Refuse a release from full contact: raises ValueError [rad]."""
        if 0.0 < abs(rotation) <= self.uplift_rotation:
            raise ValueError(
                f"initial_rotation = {rotation:.6g} rad must be 0, or above"
                f" {self.uplift_rotation:.6g} rad, where the ends begin to lift"
            )

    def path(self, x: Array) -> BedPath:
        """Arms, displacements and potential at |theta| [rad]."""
        u = self.uplift_rotation
        fade = self.fade
        b = self.structure.bearing
        below = x < u
        up = np.maximum(x, u)
        B, C, displacement, lift = geometry.path_along(b.rolling, b.rocking, b.beta, up)
        c = np.where(up < b.beta, b.rolling.c, b.rocking.c)
        start = float(geometry.path_along(b.rolling, b.rocking, b.beta, np.array(u))[3])
        end = np.minimum(up, self.full_rotation) if self.full_rotation else up
        w, slope = plane_bed.patch(end, u, fade)
        area = plane_bed.patch_integral(end, u, fade) - plane_bed.patch_integral(
            u, u, fade
        )
        arm = self.lift_arm - self.sink / math.sqrt(u)  # at phi_u
        stored = 0.5 * arm * u + lift - start - self.sink * area
        return BedPath(
            np.where(below, arm * x / u, B - self.sink * w),
            np.where(below, 0.0, B - self.root * w),
            np.where(below, 0.0, c - C - np.where(up > end, 0.0, self.root * slope)),
            np.where(below, self.height, C),
            np.where(below, self.height * x, displacement + self.shift),
            np.where(below, 0.0, lift - start - self.root * area),
            np.where(below, 0.5 * arm * x * x / u, stored),
        )


def _make_bed(structure: Standing, u: float) -> Bed:
    """The bed whose edges lift at phi_u [rad]."""
    b = structure.bearing
    contact = structure.contact
    gamma = structure.gamma
    phase = b.rocking if b.is_flat else b.rolling
    gradual = contact.kind == "plane"
    sine = math.sin(u)
    cosine = math.cos(u)
    columns = structure.columns_mass
    B, C = (
        f(phase, cosine, sine) for f in (geometry.contact_arm, geometry.contact_height)
    )
    masses = (
        b.inertia_ratio - 1.0,
        1.0 + 4.0 * gamma,
        1.0 + 4.0 * gamma * (1.0 + structure.eta_riding),
    )
    inertia = geometry.inertia(*masses, C * C, 0.0)
    lifted = geometry.inertia(*masses, C * C, B * B)
    sink = 2.0 / 3.0 * math.sin(b.alpha) * math.sqrt(u) if gradual else 0.0
    arm = (B - sink / math.sqrt(u)) / u
    spring = 2.0 * structure.weight * arm / (columns * b.semi_diagonal)
    full = 0.0
    if gradual and not b.is_flat:
        sunk = 1.5 * b.half_width**2 * u / math.sqrt(2.0 * b.radius)
        full = math.sqrt(2.0 * sunk ** (2.0 / 3.0) / b.radius)
    return Bed(
        structure,
        uplift_rotation=u,
        height=C,
        lift_arm=B,
        inertia=inertia,
        spring=spring,
        damper=2.0 * contact.damping * math.sqrt(max(spring, 0.0) * inertia),
        stiffness=0.25 * columns * spring / C**2,
        mass=0.25 * columns * inertia / C**2,
        sink=sink,
        root=B * math.sqrt(u) if gradual else 0.0,
        kept=1.0 if gradual else math.sqrt(inertia / lifted),
        shift=C * u - geometry.cap_beam_displacement(phase, u, cosine, sine),
        full_rotation=full,
        fade=1.0 / (full - u) if full > u else 0.0,
    )


def _storey_stiffness(structure: Standing, mass: float, omega: float) -> float:
    """K_s with which the building vibrates freely at omega, beam and
    columns weighing m_0 [N/m].
    """
    building = structure.superstructure
    shaken = building.participation**2 / (1.0 - (omega / building.frequencies) ** 2)
    return float(omega**2 * (mass + shaken.sum()))


def bed_of(structure: Standing) -> Bed | None:
    """Compliance of full contact of a structure; None on rigid ends."""
    contact = structure.contact
    b = structure.bearing
    if contact.kind == "rigid":
        return None
    _refuse_combinations(structure)
    softest = b.slenderness * SHAPE[contact.kind]
    bed = (
        _bed_of_stiffness(structure, softest)
        if contact.settlement is None
        else _make_bed(structure, contact.settlement / b.half_width)
    )
    if bed is None or bed.uplift_rotation >= softest or bed.spring <= 0.0:
        share = "3 phi_u" if contact.kind == "plane" else "phi_u"
        raise ValueError(
            f"the contact is so soft that it does not hold the weight upright: {share}"
            " must stay below tan(alpha); use a smaller period_ratio or settlement, or a"
            " larger stiffness"
        )
    beyond = max(bed.uplift_rotation, bed.full_rotation)
    if not b.is_flat and beyond >= b.beta:
        raise ValueError(
            f"the ends bear outside of their flat part from {beyond:.3g} rad on, beyond"
            f" the end of their arcs at {b.beta:.3g} rad; use a stiffer contact, or flat"
            " ends"
        )
    farthest = 2.0 * b.semi_diagonal * bed.height * bed.uplift_rotation
    if any(getattr(device, "gap", math.inf) <= farthest for device in structure.devices):
        raise ValueError(
            f"with compliant ends a stop must have a gap above {farthest:.3g} m, the"
            " displacement at which they begin to lift"
        )
    return bed


def _bed_of_stiffness(structure: Standing, softest: float) -> Bed | None:
    """The bed with the stiffness or the period of the contact, its edges lifting below
    `softest` [rad]; None if the contact is softer than that.
    """
    from scipy.optimize import brentq

    contact = structure.contact

    def misses(u: float) -> float:
        """Excess of the stiffness over that which is wanted, as a share of it."""
        bed = _make_bed(structure, u)
        wanted = contact.stiffness
        if contact.period_ratio is not None:
            omega = float(structure.superstructure.frequencies[0]) / contact.period_ratio
            wanted = _storey_stiffness(structure, bed.mass, omega)
        return float(bed.stiffness / wanted) - 1.0

    ends = 1e-12 * softest, softest * (1.0 - 1e-9)
    if misses(ends[0]) < 0.0:
        raise ValueError("the contact is so stiff that it is rigid; use the kind `rigid`")
    if misses(ends[1]) < 0.0:
        u = float(brentq(misses, *ends, xtol=1e-18, rtol=1e-15))
        return _make_bed(structure, u)
    return None


def _refuse_combinations(structure: Standing) -> None:
    """Refuse what is not followed with compliant ends: raises ValueError."""
    contact = structure.contact
    b = structure.bearing
    devices = {device.kind for device in structure.devices}
    law = structure.impact_law
    without = structure.superstructure is None
    curved = not b.is_flat
    reasons = {
        "ends without a flat part have nothing to bear on; use `rigid`": b.is_spherical,
        "floors would jump at re-contact, use the impact law `flexible`": law.floors_jump,
        "a period_ratio is that of a building, without one give stiffness or"
        " settlement": (contact.period_ratio is not None and without),
        "curved ends bear on more than a settlement describes; give period_ratio or"
        " stiffness": (contact.settlement is not None and curved),
        "tendons would load the bed, which is not followed; leave them out": "tendon"
        in devices,
        "rolling resistance is given by the contact's damping; leave it out": (
            "rolling_resistance" in devices
        ),
    }
    for reason, refused in reasons.items():
        if refused:
            raise ValueError(f"contact `{contact.kind}`: {reason}")
