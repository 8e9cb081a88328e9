"""Geometry of the paper's bearings, worked out by hand, and modes as in its Figures 3 to 5."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from rpscli.analyses.modal import UpliftedModes, modal
from rpscli.analyses.verification.known import (
    FLAT,
    Comparison,
    Known,
    compare,
    paper_podium,
    printed,
)

GEOMETRY = "Geometry, R = 1.5 m, tan a' = 2 tan a (contact geometry, Theory, section 1)"


class Geometry(NamedTuple):
    """Printed digits of beta, theta_cr [rad], and of u_b and the lift v_b at theta_cr [m]."""

    tan_alpha: float
    rho: float
    beta: str
    critical_rotation: str
    displacement: str
    lift: str


GEOMETRIES = (
    Geometry(0.10, 0.25, "0.2014", "0.1974", "0.593", "0.030"),
    Geometry(0.10, 0.5, "0.1002", "0.1984", "0.5975", "0.044"),
    Geometry(0.10, 1.5, "0.0333", "0.1977", "0.5971", "0.054"),
    Geometry(0.15, 0.25, "0.3047", "0.2915", "0.877", "0.065"),
    Geometry(0.15, 0.5, "0.1506", "0.2946", "0.8917", "0.099"),
    Geometry(0.15, 1.5, "0.0500", "0.2925", "0.8902", "0.120"),
    Geometry(0.20, 0.25, "0.4115", "0.3805", "1.148", "0.113"),
    Geometry(0.20, 0.5, "0.2014", "0.3876", "1.1807", "0.172"),
    Geometry(0.20, 1.5, "0.0667", "0.3828", "1.1771", "0.208"),
    Geometry(0.10, FLAT, "0.0000", "0.0997", "0.2985", "0.015"),
    Geometry(0.15, FLAT, "0.0000", "0.1489", "0.4450", "0.033"),
    Geometry(0.20, FLAT, "0.0000", "0.1974", "0.5883", "0.058"),
)


def geometry() -> Iterator[Comparison]:
    """Where rolling ends, the critical rotation, and how far the cap beam is then."""
    for row in GEOMETRIES:
        structure = paper_podium(1, row.tan_alpha, row.rho)
        critical = structure.critical_rotation
        _, displacement, lift = structure.path(np.array([critical]))
        where = f"tan a = {row.tan_alpha:g}, " + (f"rho = {row.rho:g}" if row.rho else "flat")
        # The lifts were rounded twice: 0.0985 became 0.099.
        for name, unit, known, computed in (
            ("beta", "rad", printed(row.beta), structure.bearing.beta),
            ("theta_cr", "rad", printed(row.critical_rotation), critical),
            ("u_b at theta_cr", "m", printed(row.displacement), displacement[0]),
            ("v_b at theta_cr", "m", printed(row.lift, 0.6), lift[0]),
        ):
            yield compare(GEOMETRY, f"{name}, {where}", unit, known, computed)


AMPLIFIED = "First mode after uplift over fixed base, tan a = 0.15 (as in Figure 3)"
PARAMETER = "Frequency parameter of six storeys, tan a = 0.15 (as in Figure 4)"

ROCKING = 0.0
"""Stands for the rocking phase, in which the radius plays no part."""

AMPLIFICATION = {
    (1, 0.25): (1.395, 1.396),
    (1, 0.5): (1.395, 1.395),
    (1, 1.5): (1.396, 1.395),
    (1, ROCKING): (1.376, 1.377),
    (2, 0.25): (1.634, 1.613),
    (2, 0.5): (1.635, 1.612),
    (2, 1.5): (1.638, 1.608),
    (2, ROCKING): (1.583, 1.569),
    (3, 0.25): (1.732, 1.663),
    (3, 0.5): (1.734, 1.660),
    (3, 1.5): (1.742, 1.650),
    (3, ROCKING): (1.664, 1.618),
    (6, 0.25): (1.836, 1.688),
    (6, 0.5): (1.844, 1.676),
    (6, 1.5): (1.875, 1.627),
    (6, ROCKING): (1.741, 1.661),
    (10, 0.25): (1.869, 1.703),
    (10, 0.5): (1.890, 1.668),
    (10, 1.5): (1.974, 1.528),
    (10, ROCKING): (1.753, 1.703),
}
"""By storeys and rho: frequency factor, damping factor."""

FREQUENCY_PARAMETER = {
    (0.25, 1.5): (1.275, 1.280),
    (1.5, 0.5): (4.122, 4.435),
    (1.5, 1.0): (3.008, 3.136),
    (1.5, 1.5): (2.482, 2.560),
    (1.5, 3.0): (1.774, 1.810),
    (ROCKING, 1.5): (1.765, 1.810),
}
"""By rho and R [m]: p_ext of the model and of the rigid estimate [rad/s]."""


def rounded(value: float) -> Known:
    """Half of the third decimal; and some were computed with g = 9.81 m/s2.

    That is 3.4e-4 more than the standard value, and frequencies go with its root.
    """
    return Known(value, 0.5e-3 + 1.8e-4 * value)


def modes() -> Iterator[Comparison]:
    """Amplification of frequency and damping, and the storey's own mode."""
    for (storeys, rho), known in AMPLIFICATION.items():
        found = _uplifted(storeys, rho, 1.5)
        where = f"n = {storeys}, {_phase(rho)}"
        values = (found.frequency_ratio[0], found.damping_ratio[0])
        for name, expected, value in zip(("frequency", "damping"), known, values, strict=True):
            yield compare(AMPLIFIED, f"{name} factor, {where}", "-", rounded(expected), value)
    for (rho, size), known in FREQUENCY_PARAMETER.items():
        found = _uplifted(6, rho, size)
        where = f"R = {size:g} m, {_phase(rho)}"
        values = (found.frequency_parameter, found.frequency_parameter_rigid)
        for name, expected, value in zip(("p_ext", "rigid estimate"), known, values, strict=True):
            yield compare(PARAMETER, f"{name}, {where}", "rad/s", rounded(expected), value)


def _uplifted(storeys: int, rho: float, size: float) -> UpliftedModes:
    states = modal(paper_podium(storeys, 0.15, rho or 0.5, size)).both_orders
    return states["rolling" if rho else "rocking"][1]


def _phase(rho: float) -> str:
    return f"rolling, rho = {rho:g}" if rho else "rocking"
