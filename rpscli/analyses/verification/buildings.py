"""The building: exact in full contact, and its base shear after an impact."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification.comparison import Comparison, compare, within
from rpscli.analyses.verification.structures import motion, paper_podium
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import GroundMotion

CONTACT = "Full contact (exact solution for a load that is linear between samples)"
IMPACT = "One storey after its first well separated impact (closed form)"


def buildings() -> Iterator[Comparison]:
    """Base shear and roof displacement without uplift; base shear after an impact."""
    record = _weak_motion()
    for storeys in (1, 3, 9):
        structure = paper_podium(storeys, 0.15, 0.5)
        result = time_history(structure, record, TimeHistorySettings(free_vibration=0.0))
        assert structure.superstructure is not None, "the paper's structures have buildings"
        exact = exact_displacements(structure.superstructure, record)
        largest = np.max(np.abs(exact), axis=0)
        shear = float(structure.superstructure.stiffnesses[0] * largest[0])
        roof = float(np.max(np.abs(result.trace.floor_displacements[:, -1])))
        # Rounding of a few hundred steps, and of an exponential of a stiff matrix.
        for name, unit, expected, value in (
            ("base shear", "N", shear, result.max_base_shear),
            ("roof displacement", "m", float(largest[-1]), roof),
        ):
            known = within(expected, 1e-9)
            yield compare(CONTACT, f"{name}, n = {storeys}", unit, known, value)
    yield _after_impact()


def exact_displacements(building: Superstructure, record: GroundMotion) -> NDArray[np.float64]:
    """(npts, n) floor displacements on a fixed base [m], by one matrix exponential a sample.

    Parameters
    ----------
    building
        n storeys on the cap beam.
    record
        Horizontal ground acceleration.
    """
    from scipy.linalg import expm

    n, dt = building.storeys, record.dt
    flow = np.zeros((2 * n + 2, 2 * n + 2))
    flow[:n, n : 2 * n] = np.eye(n)
    inverse = np.linalg.inv(building.mass_matrix)
    flow[n : 2 * n, :n] = -inverse @ building.stiffness_matrix
    flow[n : 2 * n, n : 2 * n] = -inverse @ building.damping_matrix
    flow[n : 2 * n, 2 * n] = -1.0
    flow[2 * n, 2 * n + 1] = 1.0
    step = expm(flow * dt)
    state, states = np.zeros(2 * n + 2), [np.zeros(n)]
    for start, end in zip(record.acceleration[:-1], record.acceleration[1:], strict=True):
        state[2 * n :] = start, (end - start) / dt
        state = step @ state
        states.append(state[:n])
    return np.array(states)


def _weak_motion() -> GroundMotion:
    """Three sines under a rounded envelope, too weak for uplift."""
    t = np.arange(401) * 0.02
    waves = np.sin(5.0 * t) + np.sin(11.0 * t + 1.0) + np.sin(23.0 * t + 2.0)
    return motion(0.05 * waves * np.sin(math.pi * t / t[-1]), 0.02)


def _after_impact() -> Comparison:
    """V swings from V_st about -V_st: it reaches 1 + 2 exp(-pi xi_u/sqrt(1 - xi_u^2)).

    xi_u = xi omega_u/omega_0 for stiffness-proportional damping, gravity neglected (Theory,
    section 6).
    """
    structure = paper_podium(1, 0.15, 0.5)
    base = 0.25 * structure.columns_mass * structure.bearing.inertia_ratio
    base += structure.cap_beam_mass + structure.superstructure_mass * structure.bearing.alpha**2
    xi = 0.05 * math.sqrt(1.0 + structure.superstructure_mass / base)
    expected = 1.0 + 2.0 * math.exp(-math.pi * xi / math.sqrt(1.0 - xi**2))
    settings = replace(TimeHistorySettings(free_vibration=3.0), initial_rotation=0.12)
    result = time_history(structure, motion(np.zeros(2), 0.001), settings, with_fixed_base=False)
    first = next(event.time for event in result.events if event.kind == "impact")
    after = (result.trace.time > first) & (result.trace.time < first + 0.1)
    swing = np.max(np.abs(result.trace.storey_shears[after, 0])) / structure.static_base_shear
    # The shear still rings a little before the impact, and C and A vary with the rotation.
    return compare(IMPACT, "V_b/V_st, tan a = 0.15, rho = 0.5", "-", within(expected, 0.03), swing)
