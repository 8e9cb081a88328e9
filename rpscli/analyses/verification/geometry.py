"""Geometry of the paper's bearings, worked out by hand from the contact geometry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from rpscli.analyses.verification.comparison import Comparison, compare, printed
from rpscli.analyses.verification.structures import FLAT, paper_podium

GROUP = "Geometry, R = 1.5 m, tan a' = 2 tan a (contact geometry, Theory, section 1)"


class Geometry(NamedTuple):
    """Printed digits of beta, theta_cr [rad], and of u_b and the lift v_b at theta_cr [m].

    Parameters
    ----------
    tan_alpha, rho
        Slenderness, and radius of the arcs.
    beta, critical_rotation
        Printed digits [rad].
    displacement, lift
        Printed digits of u_b and v_b at theta_cr [m].
    """

    tan_alpha: float
    rho: float
    beta: str
    critical_rotation: str
    displacement: str
    lift: str


EXPECTED = (
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
    for row in EXPECTED:
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
            yield compare(GROUP, f"{name}, {where}", unit, known, computed)
