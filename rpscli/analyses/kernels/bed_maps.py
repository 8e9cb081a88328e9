"""What full contact on a bed makes of a state in a step, as matrices (Theory, section 12)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.core.records import INSTANTS, Record
from rpscli.physics.planar.state import MOST_ON_BED

NO_MAP = -1


def steps_of(system: Record, dt: float) -> int:
    """Exact steps in a sampling interval, as the kernel counts them."""
    return max(math.ceil(dt * float(system["contact_rate"])), 1)


def has_map(system: Record, dt: float) -> bool:
    """Whether exact steps follow its full contact: without devices, and a block holds a sample."""
    few = system["n"] <= MOST_ON_BED and steps_of(system, dt) < INSTANTS
    return bool(system["compliant"] and not system["devices"] and few)


def bed_maps(system: Record, dt: float, *, audited: bool) -> NDArray[np.float64]:
    """Rows of theta, theta', q_1, q_1', ..., the ground's acceleration and slope, flat.

    Each holds what it adds to the state a step later; zeros fill up to fours of rows and eights of
    numbers. If audited, the same to the nodes of Gauss's rule within follow.
    """
    from scipy.linalg import expm

    from rpscli.physics.core.series import NODES  # brings numba, which is slow

    n, h = int(system["n"]), dt / steps_of(system, dt)
    size, C, gamma = 2 * n + 2, float(system["bed_height"]), float(system["gamma"])
    inertia = float(system["Io"]) - 1.0 + (1.0 + 4.0 * gamma) * C * C
    # Rates of [theta, theta', q_1, q_1', ...], a_g and its slope, over time.
    rates: Any = np.zeros((size + 2, size + 2))
    rates[range(0, size, 2), range(1, size, 2)] = 1.0
    springs, dampers = np.diag(system["omega2"][:n]), np.diag(system["two_xi_omega"][:n])
    force = np.zeros((n, size + 2))
    force[:, 2:size:2], force[:, 3:size:2] = springs, dampers
    Gamma = system["Gamma"][:n]
    push = (2.0 / (system["columns_mass"] * system["R"])) * (Gamma @ force)
    push[size] -= (1.0 + 2.0 * gamma) / system["R"]
    rates[1] = C * push / inertia
    rates[1, 0] -= system["bed_k"] / inertia
    rates[1, 1] -= system["bed_c"] / inertia
    rates[3:size:2] = -force - np.outer(Gamma, 2.0 * system["R"] * C * rates[1])
    rates[3:size:2, size] -= Gamma
    rates[size, size + 1] = 1.0
    # Rates times h beside displacements: the matrix is then of the order of one.
    unit = np.ones(size + 2)
    unit[1::2] = h
    scaled = rates * h * unit[:, None] / unit
    fours, eights = 4 * math.ceil((size + 2) / 4), 8 * math.ceil(size / 8)
    found = np.zeros((1 + len(NODES) * audited, fours, eights))
    for part, into in zip((1.0, *NODES), found, strict=False):
        step = expm(part * scaled) * unit / unit[:, None]
        into[: size + 2, :size] = step[:size].T
    return found.ravel()
