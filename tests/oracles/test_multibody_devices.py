"""Devices of the second integrator against bodies in contact, with what the engine has for them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import oracle_system

from .crossings import Array
from .devices import Friction, OracleDevice, RollingResistance, Stop, Tendon, Viscous
from .multibody import simulate
from .reference_systems import pulse
from .resolved_contact import structure_of
from .second_integrator import simulate as integrated
from .storey_lagrangian import OracleSystem

pytest.importorskip(
    "mujoco", reason="the physics engine is not installed: pip install rpscli[contact]"
)
pytestmark = [pytest.mark.long, pytest.mark.evidence("devices", "program")]

RELEASED = 0.4 * math.atan(0.15)
W = structure_of("3", 0.5).weight
F_0 = structure_of("3", 0.5).uplift_force

KINDS: dict[str, tuple[OracleDevice, ...]] = {
    "none": (),
    "damper": (Viscous(0.3 * F_0),),
    "friction": (Friction(0.3 * F_0),),
    "friction that holds": (Friction(1.2 * F_0),),
    "stop": (Stop(0.1, 15.0 * F_0),),
    "prestressed tendon": (Tendon(2.0, 0.2 * W, 5.0 * F_0),),
    "tendon without prestress": (Tendon(2.0, 0.0, 5.0 * F_0),),
    "all": (
        Viscous(0.1 * F_0),
        Friction(0.1 * F_0),
        Stop(0.1, 9.0 * F_0),
        Tendon(2.0, 0.1 * W, F_0),
    ),
}


def gap(
    system: OracleSystem,
    ag: Array,
    dt: float,
    duration: float,
    devices: tuple[OracleDevice, ...],
    released: float = 0.0,
) -> float:
    """Largest difference of the rotations over the largest rotation."""
    found = simulate(system, ag, dt, duration, initial_rotation=released, devices=devices)
    ours = integrated(
        system,
        ag,
        dt,
        free_vibration=duration - dt * (len(ag) - 1),
        initial_rotation=released,
        devices=devices,
        rtol=1e-8,
    )
    assert ours.max_rotation > 0.1 * RELEASED
    between = np.interp(found.time, ours.time, ours.theta)
    return float(np.max(np.abs(between - found.rotation))) / ours.max_rotation


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("building", "rho"), [("3", 0.5), ("3", 1.5), ("frame", 0.0)])
def test_devices_after_a_release(building: str, rho: float, kind: str) -> None:
    system = replace(oracle_system(structure_of(building, rho)), law="flexible")
    # contacts that close within 0.1 ms, as without devices
    assert gap(system, np.zeros(2), 2e-3, 1.6, KINDS[kind], RELEASED) < 1e-3


@pytest.mark.parametrize("rho", [0.5, 1.5])
def test_rolling_resistance_with_the_normal_forces_of_each_instant(rho: float) -> None:
    system = replace(oracle_system(structure_of("3", rho)), law="flexible")
    # the program takes them static: some per cent of the resistance, itself a tenth of F_0; until
    # the impact, after which columns in the engine do not come down together
    resisting = (RollingResistance(0.03),)
    assert gap(system, np.zeros(2), 2e-3, 0.35, resisting, RELEASED) < 0.01
    free = integrated(
        system, np.zeros(2), 2e-3, free_vibration=0.35, initial_rotation=RELEASED, rtol=1e-8
    )
    held = simulate(system, np.zeros(2), 2e-3, 0.35, initial_rotation=RELEASED, devices=resisting)
    assert free.impacts == 0
    assert held.rotation[-1] - free.theta[-1] > 0.05 * RELEASED


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "friction that holds"])
def test_devices_under_a_pulse(kind: str) -> None:
    system = replace(oracle_system(structure_of("3", 0.5)), law="flexible")
    record = pulse(3.5, 0.8, 0.004)
    assert gap(system, record, 0.004, 1.6, KINDS[kind]) < 0.01
