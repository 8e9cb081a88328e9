"""The numbers and formulae of one podium, written once for the peers (Theory, sections 1 to 4).

Nothing of the program's kernels is used. Motion is followed mirrored: `x = |theta|`, and floors and
ground are multiplied by the side of the tilt, so that one right-hand side serves both sides. Full
contact is solved exactly by `stand`, compiled: what remains of a peer's time is its uplifted
motion, and the comparison favours the peers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar, cast

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping

Floats = NDArray[np.float64]

NEGLIGIBLE = 1e-6
"""An excursion below this times alpha is not followed: the storey locks."""

ORDER = 12  # of the Taylor series of full contact within a sampling interval
PARTS = 16  # of an interval in which the first uplift is looked for

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile as peers use numba: contraction and reassociation allowed, nothing kept on disk."""
    result: Any = numba.njit(function, fastmath={"contract", "reassoc"})
    return cast("Function", result)


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


class Landing:
    """Impacts of one podium, with the right-hand side at x = 0 prepared: it is linear there."""

    def __init__(self, podium: Rocking) -> None:
        n, gamma, eta = len(podium.masses), podium.gamma, podium.eta
        sine, cosine = math.sin(podium.alpha), math.cos(podium.alpha)
        self.storeys, self.restitution = n, podium.restitution
        self.beam = 2.0 * podium.R * cosine
        self.jump = self.beam * (1.0 - podium.restitution)
        self.left_out = 2.0 / (1.0 + podium.restitution) * self.beam  # (3.5)
        self.negligible = 2.0 * NEGLIGIBLE * podium.alpha
        curve = podium.rolling.c
        A = podium.Io - 1.0 + 1.0 + 4.0 * gamma + 4.0 * gamma * eta * sine**2
        D = sine * ((1.0 + 4.0 * gamma) * curve + 4.0 * gamma * eta * (curve - cosine))
        restoring = sine * podium.gravity / podium.R * (1.0 + 2.0 * gamma + 2.0 * gamma * eta)
        self.restoring, self.turning = restoring / A, D / A
        self.ground = cosine * (1.0 + 2.0 * gamma) / podium.R / A
        shear = np.zeros(2 * n + 2)  # V = shear . y, beam at 2 R cos(alpha) x'
        shear[1], shear[n + 2 :] = podium.stiffnesses[0], podium.a0 * podium.masses
        shear[n + 2] += podium.a1 * podium.stiffnesses[0]
        shear[n + 1] = -2.0 * podium.R * cosine * shear[n + 2 :].sum()
        self.back = 0.0
        """What decelerates the tilt behind the last impact [rad/s2]."""
        self.building = 2.0 * cosine / (podium.columns_mass * podium.R) / A * shear

    def land(self, y: Floats, across: float) -> bool:
        """Impact: change the mirrored state to that of the other side; whether the storey locks.

        `across` is the ground acceleration as mirrored on the side that is left.
        """
        n = self.storeys
        rate = -self.restitution * y[n + 1]
        y[n + 2 :] -= self.jump * y[n + 1]
        np.negative(y, y)
        y[0], y[n + 1] = 0.0, rate
        back = self.restoring + self.turning * rate * rate - self.ground * across
        back -= self.building @ y
        self.back = float(back)
        stays = back > 0.0 and rate * rate < self.negligible * back
        if stays:
            y[n + 2 :] += self.left_out * rate
        return bool(stays)


class FixedBase(NamedTuple):
    """z' = flow z + ground a_g for z = [v, v'], and the push q = push . z - own a_g.

    `swing` and `kick` are push . flow and push . ground, for the rate of the push.
    `over`, `level` and `ramp` are the exact map over one sampling interval of `dt`.
    """

    flow: Floats
    ground: Floats
    push: Floats
    swing: Floats
    kick: float
    own: float
    lift: float
    dt: float
    over: Floats
    level: Floats
    ramp: Floats


def fixed_base_of(podium: Rocking, dt: float) -> FixedBase:
    """Matrices of the building on a fixed base."""
    n = len(podium.masses)
    between = np.eye(n) - np.eye(n, k=-1)
    stiffness = between.T @ np.diag(podium.stiffnesses) @ between
    damping = podium.a0 * np.diag(podium.masses) + podium.a1 * stiffness
    flow = np.zeros((2 * n, 2 * n))
    flow[:n, n:] = np.eye(n)
    flow[n:, :n] = -stiffness / podium.masses[:, None]
    flow[n:, n:] = -damping / podium.masses[:, None]
    ground = np.r_[np.zeros(n), -np.ones(n)]
    whole = np.zeros((2 * n + 2, 2 * n + 2))
    whole[: 2 * n, : 2 * n] = flow
    whole[: 2 * n, 2 * n] = ground
    whole[2 * n, 2 * n + 1] = 1.0
    exact = expm(whole * dt)[: 2 * n]
    gamma, eta = podium.gamma, podium.eta
    share = 2.0 * gamma * eta / podium.masses.sum()
    push = share * np.r_[stiffness.sum(axis=0), damping.sum(axis=0)]
    return FixedBase(
        flow=flow,
        ground=ground,
        push=push,
        swing=push @ flow,
        kick=float(push @ ground),
        own=1.0 + 2.0 * gamma,
        lift=podium.gravity * np.tan(podium.alpha) * (1.0 + 2.0 * gamma * (1.0 + eta)),
        dt=dt,
        over=np.ascontiguousarray(exact[:, : 2 * n]),
        level=exact[:, 2 * n].copy(),
        ramp=exact[:, 2 * n + 1].copy(),
    )


@compiled
def _series(z: Floats, across: float, slope: float, base: FixedBase) -> Floats:
    """Taylor coefficients of z(t), one row a power."""
    terms = np.empty((ORDER + 1, len(z)))
    terms[0] = z
    for k in range(ORDER):
        terms[k + 1] = base.flow @ terms[k]
        if k == 0:
            terms[k + 1] += base.ground * across
        elif k == 1:
            terms[k + 1] += base.ground * slope
        terms[k + 1] /= k + 1.0
    return terms


@compiled
def _dot(a: Floats, b: Floats) -> float:
    total = 0.0
    for k in range(len(a)):
        total += a[k] * b[k]
    return total


@compiled
def _value(coefficients: Floats, t: float) -> float:
    total = 0.0
    for k in range(len(coefficients) - 1, -1, -1):
        total = total * t + coefficients[k]
    return total


@compiled
def _first_uplift(q: Floats, lift: float, h: float) -> tuple[float, float]:
    """The first time in [0, h] at which |q| passes `lift`, and the side; side 0 if none."""
    for part in range(PARTS):
        low, high = h * part / PARTS, h * (part + 1) / PARTS
        end = _value(q, high)
        if abs(end) < lift:
            continue
        side = 1.0 if end > 0.0 else -1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            if side * _value(q, middle) > lift:
                high = middle
            else:
                low = middle
        return high, side
    return h, 0.0


@compiled
def stand(
    z: Floats, record: Floats, interval: int, after: float, base: FixedBase
) -> tuple[int, float, float]:
    """Advance z from `after` seconds into an interval to the next uplift, or to the record's end.

    Returns the interval, the time into it and the side of uplift (0: the end of the record).
    """
    following = np.empty_like(z)
    q = _dot(base.push, z) - base.own * (
        record[interval] + after * (record[interval + 1] - record[interval]) / base.dt
    )
    for i in range(interval, len(record) - 1):
        slope = (record[i + 1] - record[i]) / base.dt
        start = after if i == interval else 0.0
        across = record[i] + slope * start
        swing = _dot(base.swing, z) + base.kick * across - base.own * slope
        for k in range(len(z)):
            following[k] = _dot(base.over[k], z) + base.level[k] * across + base.ramp[k] * slope
        later = _dot(base.push, following) - base.own * record[i + 1]
        room = base.lift - max(abs(q), abs(later))
        if start > 0.0 or room < 0.5 * base.dt * abs(swing):
            terms = _series(z, across, slope, base)
            powers = terms @ base.push
            powers[0] -= base.own * across
            powers[1] -= base.own * slope
            h, side = _first_uplift(powers, base.lift, base.dt - start)
            for k in range(len(z)):
                z[k] = _value(terms[:, k], h)
            if side != 0.0:
                return i, start + h, side
            q = _dot(base.push, z) - base.own * record[i + 1]
        else:
            z[:] = following
            q = later
    return len(record) - 1, 0.0, 0.0
