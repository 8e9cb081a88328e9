"""The numbers and formulae of one podium, written once for the peers (Theory, sections 1 to 4).

Nothing of the program's kernels is used. Motion is followed mirrored: `x = |theta|`, and floors and
ground are multiplied by the side of the tilt, so that one right-hand side serves both sides.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping

Floats = NDArray[np.float64]

NEGLIGIBLE = 1e-6
"""An excursion below this times alpha is not followed: the storey locks."""


class PeerHistory(NamedTuple):
    """What a peer's history says."""

    max_rotation: float
    impacts: int


class Phase(NamedTuple):
    """Constants of rolling or of rocking (Theory, section 1)."""

    p: float
    q: float
    c: float
    u0: float


class Rocking(NamedTuple):
    """A building on kinematic bearings; `level` is beta, where rolling and rocking meet."""

    R: float
    alpha: float
    level: float
    rolling: Phase
    rocking: Phase
    Io: float
    gamma: float
    eta: float
    columns_mass: float
    masses: Floats
    stiffnesses: Floats
    a0: float
    a1: float
    restitution: float
    gravity: float
    limit: float


def rocking_of(structure: PodiumStructure) -> Rocking:
    """The numbers of a structure with curved ends, Rayleigh damping and the rigid impact law."""
    b, building = structure.bearing, structure.superstructure
    assert building is not None
    assert isinstance(building.damping, RayleighDamping)
    alpha = math.atan(b.slenderness)
    k = 2.0 * b.curvature_ratio * math.cos(alpha)
    beta = math.asin((b.wedge_slenderness - b.slenderness) / (2.0 * b.curvature_ratio))
    sine, cosine = math.sin(alpha), math.cos(alpha)
    a0, a1 = building.damping.coefficients(building.frequencies)
    gamma = structure.cap_beam_mass / structure.columns_mass
    eta = float(building.masses.sum()) / structure.cap_beam_mass
    carried = 4.0 * gamma * (1.0 + eta)
    return Rocking(
        R=b.semi_diagonal,
        alpha=alpha,
        level=beta,
        rolling=Phase(sine, k - cosine, k, sine),
        rocking=Phase(
            sine + k * math.sin(beta), k * (1.0 - math.cos(beta)) - cosine, 0.0, sine + k * beta
        ),
        Io=b.inertia_ratio,
        gamma=gamma,
        eta=eta,
        columns_mass=structure.columns_mass,
        masses=np.array(building.masses),
        stiffnesses=np.array(building.stiffnesses),
        a0=a0,
        a1=a1,
        restitution=1.0 - 2.0 * sine**2 * (1.0 + carried) / (b.inertia_ratio + carried),
        gravity=structure.gravity,
        limit=2.0 * b.critical_rotation,
    )


def rates(y: Floats, across: float, phase: Phase, podium: Rocking) -> Floats:
    """y' of y = [x, floors, x', floors'], uplifted, under the mirrored ground `across`.

    Plain numpy, which numba compiles as it stands.
    """
    n = len(podium.masses)
    R, gamma, eta = podium.R, podium.gamma, podium.eta
    p, q, c, u0 = phase
    x, w = y[0], y[n + 1]
    cosine, sine = math.cos(x), math.sin(x)
    B = p * cosine + q * sine
    C = c + p * sine - q * cosine
    S = p * p + q * q - c * c + 2.0 * c * C
    beam = 2.0 * R * (u0 + c * x - q * sine - p * cosine)
    beam_rate = 2.0 * R * C * w
    floors, floor_rates = y[1 : n + 1], y[n + 2 :]
    drifts, drift_rates = floors.copy(), floor_rates.copy()
    drifts[1:] -= floors[:-1]
    drift_rates[1:] -= floor_rates[:-1]
    drifts[0] -= beam
    drift_rates[0] -= beam_rate
    shears = podium.stiffnesses * (drifts + podium.a1 * drift_rates)
    drag = podium.a0 * (floor_rates - beam_rate)
    V = shears[0] + np.sum(podium.masses * drag)
    pulls = shears.copy()
    pulls[:-1] -= shears[1:]
    A = podium.Io - 1.0 + (1.0 + 4.0 * gamma) * S + 4.0 * gamma * eta * B * B
    D = B * ((1.0 + 4.0 * gamma) * c + 4.0 * gamma * eta * (c - C))
    weight = B * podium.gravity / R * (1.0 + 2.0 * gamma + 2.0 * gamma * eta)
    push = across / R * (1.0 + 2.0 * gamma) - 2.0 * V / (podium.columns_mass * R)
    out = np.empty_like(y)
    out[: n + 1] = y[n + 1 :]
    out[n + 1] = -(weight + C * push + D * w * w) / A
    out[n + 2 :] = -pulls / podium.masses - drag - across
    return out
