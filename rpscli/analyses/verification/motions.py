"""Histories: full contact, impact, free rocking, devices, earthquakes, compliant ends.

The earthquakes are shipped motions that a second integrator followed. Its unknowns are the tilt and
the storey drifts, its mass matrix is full, its steps are those of DOP853, and full contact is a
matrix exponential; it shares nothing with the kernels. It is too slow to run here: a test of the
program computes these numbers again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.modal import modal
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification.known import (
    FLAT,
    LINEAR,
    SLENDER,
    Comparison,
    Known,
    compare,
    motion,
    paper_podium,
    slender_block,
    within,
)
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.model.superstructure import ModalDamping, Superstructure, profile_stiffnesses
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.shipped import shipped_cases

CONTACT = "Full contact (exact solution for a load that is linear between samples)"
IMPACT = "One storey after its first well separated impact (closed form)"


def shear_at_samples(result: TimeHistoryResult) -> float:
    """Largest base shear at the samples [N], where the reference values know it."""
    return float(np.max(np.abs(result.trace.storey_shears[:, 0])))


def released(
    structure: PodiumStructure, rotation: float, seconds: float, dt: float = 1e-3
) -> TimeHistoryResult:
    """So many seconds after a release from a tilt [rad], on still ground."""
    settings = TimeHistorySettings(free_vibration=seconds, initial_rotation=rotation)
    return time_history(structure, motion(np.zeros(2), dt), settings, with_fixed_base=False)


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
            ("base shear", "N", shear, shear_at_samples(result)),
            ("roof displacement", "m", float(largest[-1]), roof),
        ):
            known = within(expected, 1e-9)
            yield compare(CONTACT, f"{name}, n = {storeys}", unit, known, value)
    yield _after_impact()


def exact_displacements(building: Superstructure, record: GroundMotion) -> NDArray[np.float64]:
    """(npts, n) floor displacements on a fixed base [m], by one matrix exponential a sample."""
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
    """V swings from V_st about -V_st: 1 + 2 exp(-pi xi_u/sqrt(1 - xi_u^2)) (Theory, section 6)."""
    structure = paper_podium(1, 0.15, 0.5)
    base = 0.25 * structure.columns_mass * structure.bearing.inertia_ratio
    base += structure.cap_beam_mass + structure.superstructure_mass * structure.bearing.alpha**2
    xi = 0.05 * math.sqrt(1.0 + structure.superstructure_mass / base)
    expected = 1.0 + 2.0 * math.exp(-math.pi * xi / math.sqrt(1.0 - xi**2))
    result = released(structure, 0.12, 3.0)
    first = next(event.time for event in result.events if event.kind == "impact")
    after = (result.trace.time > first) & (result.trace.time < first + 0.1)
    swing = np.max(np.abs(result.trace.storey_shears[after, 0])) / structure.static_base_shear
    # The shear still rings a little before the impact, and C and A vary with the rotation.
    return compare(IMPACT, "V_b/V_st, tan a = 0.15, rho = 0.5", "-", within(expected, 0.03), swing)


ROCKING = "Free rocking of a slender block, R = 1 m, e = 0.9 (Housner, linear theory)"
RESTITUTION = 0.9
STEP = 0.002
STARTS = (0.2, 0.5, 0.9)
"""theta/alpha at the release."""


def free_rocking() -> Iterator[Comparison]:
    """T = (4/p) acosh(1/(1 - phi)) and phi_n = 1 - sqrt(1 - e^(2n) [1 - (1 - phi_0)^2])."""
    structure = slender_block(1.0, RESTITUTION)
    p, alpha = math.sqrt(0.75 * structure.gravity), math.atan(SLENDER)
    for start in STARTS:
        result = released(structure, start * alpha, 6.0, STEP)
        impacts = [event.time for event in result.events if event.kind == "impact"]
        quarter = within(math.acosh(1.0 / (1.0 - start)) / p, LINEAR)
        where = f"phi_0 = {start:g}"
        yield compare(ROCKING, f"a quarter of the period, {where}", "s", quarter, impacts[0])
        for n in (1, 2, 3):
            phi = 1.0 - math.sqrt(1.0 - RESTITUTION ** (2 * n) * (1.0 - (1.0 - start) ** 2))
            inside = (result.trace.time > impacts[n - 1]) & (result.trace.time < impacts[n])
            peak = float(np.max(np.abs(result.trace.rotation[inside])))
            # The peak lies up to half a sample from the largest sample of its parabola.
            missed = p**2 * (1.0 - phi) * STEP**2 / 8.0
            known = within(phi, LINEAR + missed / phi)
            yield compare(ROCKING, f"phi after {n} impacts, {where}", "-", known, peak / alpha)
            half = within(2.0 * math.acosh(1.0 / (1.0 - phi)) / p, LINEAR)
            time = impacts[n] - impacts[n - 1]
            yield compare(ROCKING, f"half period after {n} impacts, {where}", "s", half, time)


SWING = "One swing of a rigid frame with devices (energy at the impact)"
EXACT = 1e-9
START = 0.7
"""Tilt from which it is let go, over theta_cr."""

COLUMNS = 4


def devices() -> Iterator[Comparison]:
    """Energy at the first impact over that without devices."""
    for rho in (FLAT, 0.5):
        bare = replace(paper_podium(1, 0.15, rho), superstructure=None, columns=COLUMNS)
        x = START * bare.critical_rotation
        F, u, v = (float(value[0]) for value in bare.path(np.array([x])))
        e = float(bare.bearing.tendon_elongation(np.array([x]))[0])
        W, lifted = bare.weight, bare.weight * v
        F_d, k_s, d = 0.3 * F, 5.0 * F / u, 0.4 * u
        f, P, k_t = 0.01 * bare.bearing.half_width, 0.02 * W, 0.1 * W / e
        swings: tuple[tuple[str, Device, float], ...] = (
            ("friction", FrictionDamper(F_d), -F_d * u),
            ("rolling resistance", RollingResistance(f), -2.0 * W * f * x),
            ("stop", Stop(d, k_s), 0.5 * k_s * (u - d) ** 2),
            ("tendons", Tendon(P, k_t), COLUMNS * (P * e + 0.5 * k_t * e**2)),
        )
        for name, device, change in swings:
            known = within(1.0 + change / lifted, EXACT)
            found = energy_of_impact(replace(bare, devices=(device,)), x) / lifted
            ends = f"rho = {rho:g}" if rho else "flat"
            yield compare(SWING, f"E/(W v_b), {name}, {ends}", "-", known, found)


def energy_of_impact(structure: PodiumStructure, rotation: float) -> float:
    """Kinetic energy of the first impact after a release [J]."""
    result = released(structure, rotation, 3.0, 0.01)
    rate = next(event.rotation_rate_before for event in result.events if event.kind == "impact")
    return (
        0.5
        * structure.columns_mass
        * structure.bearing.semi_diagonal**2
        * (
            structure.turning_inertia
            + (1.0 + 4.0 * structure.gamma_total) * math.sin(structure.bearing.alpha) ** 2
        )
        * rate**2
    )


EARTHQUAKES = "Earthquakes against a second integrator (DOP853 in tilt and drifts)"
FREE_VIBRATION = 2.0
ACCURACY = 4.0
"""Steps a quarter as long as usual: both integrators are converged then."""

CONVERGED = 2e-7
"""Impacts multiply what is left of the errors of both."""


class Reference(NamedTuple):
    """A history, and what the second integrator finds: max |theta| [rad], V_b/V_st, impacts."""

    record: str
    storeys: int
    tan_alpha: float
    rho: float
    max_rotation: float
    base_shear_ratio: float
    impacts: int


REFERENCES = (
    Reference("synthetic_far_field", 3, 0.10, 1.5, 0.0702881264, 2.252459866, 52),
    Reference("synthetic_far_field", 3, 0.15, 0.25, 0.0708316409, 1.964707709, 211),
    Reference("synthetic_near_field_pulse", 2, 0.20, 1.5, 0.0438734735, 2.544852830, 147),
    Reference("synthetic_near_field_pulse", 3, 0.20, FLAT, 0.2207060255, 2.437501670, 111),
)


def shipped_record(name: str) -> str:
    """Source of a motion that comes with the program."""
    return str(shipped_cases() / "records" / f"{name}.at2")


def histories() -> Iterator[Comparison]:
    """Largest rotation and base shear, and the number of impacts."""
    settings = TimeHistorySettings(free_vibration=FREE_VIBRATION, accuracy=ACCURACY)
    for row in REFERENCES:
        structure = paper_podium(row.storeys, row.tan_alpha, row.rho)
        record = load_record(shipped_record(row.record))
        result = time_history(structure, record, settings, with_fixed_base=False)
        ends = f"rho = {row.rho:g}" if row.rho else "flat"
        short = row.record.removeprefix("synthetic_").replace("_", " ")
        where = f"{short}, n = {row.storeys}, tan a = {row.tan_alpha:g}, {ends}"
        shear = shear_at_samples(result) / structure.static_base_shear
        for name, unit, known, computed in (
            ("theta", "rad", within(row.max_rotation, CONVERGED), result.max_rotation),
            ("V_b/V_st", "-", within(row.base_shear_ratio, CONVERGED), shear),
            ("impacts", "-", Known(float(row.impacts), 0.0), float(result.impacts)),
        ):
            yield compare(EARTHQUAKES, f"{name}, {where}", unit, known, computed)


PERIODS = "Full contact of compliant ends, r = 1.2 (periods over T1)"
RELEASES = "Release at 0.4 alpha, undamped building on compliant plane ends"
TILTED = 0.4 * math.atan(0.15), 2.4
"""0.4 alpha [rad], and how long it is followed [s]."""
SECOND_PERIOD = 0.4899030
"""Of one storey, over T1; by another program, as are the releases."""

BACK_SWINGS = (
    (1, 2.868200132581778e-05, 1.0, 0.35612, 5.649),
    (3, 2.1e-4, 0.0, 0.38034, 3.4081),
    (3, 2.1e-4, 0.3, 0.36964, 3.922),
)
"""Of plane ends: storeys, phi_u, loss; back swing over alpha and V_b/V_st."""


def of_paper(storeys: int, contact: Contact, loss: float = 1.0) -> PodiumStructure:
    """The paper's podium with flat ends, and stiffnesses that are equal, without damping."""
    masses = np.full(storeys, 2e5)
    stiffnesses = profile_stiffnesses(masses, storeys / 10.0, "uniform")
    return replace(
        paper_podium(storeys, 0.15, FLAT),
        superstructure=Superstructure(masses, stiffnesses, ModalDamping(0.0)),
        impact_law=ImpactLaw(loss=loss),
        contact=contact,
    )


def compliant_ends() -> Iterator[Comparison]:
    """T/T_1 = r, swings and shears of releases, kept energy, and stiff edges."""
    for storeys, kind in ((6, "plane"), (6, "edges"), (1, "plane")):
        ends = Contact(kind, period_ratio=1.2, damping=0.0)  # type: ignore[arg-type]
        structure = of_paper(storeys, ends)
        full, where = modal(structure).full_contact, f"{kind}, n = {storeys}"
        assert full is not None, "its ends are compliant"
        ratios = full.periods / (0.1 * storeys)
        yield compare(PERIODS, f"first, {where}", "-", within(1.2, 1e-9), ratios[0])
    # The reference has the C of rigid columns in the mass at the beam.
    yield compare(PERIODS, f"second, {where}", "-", within(SECOND_PERIOD, 1e-6), ratios[1])
    half_width = structure.bearing.half_width
    for storeys, phi_u, loss, back, shear in BACK_SWINGS:
        ends = Contact("plane", settlement=phi_u * half_width, damping=0.0)
        where = f"n = {storeys}, loss = {loss:g}"
        found = released(of_paper(storeys, ends, loss), *TILTED)
        # Half of the last digit, and what lies between samples of 1 ms.
        known = Known(back, 1e-5), Known(shear, 5e-4)
        yield compare(RELEASES, f"back swing/alpha, {where}", "-", known[0], back_swing(found))
        yield compare(RELEASES, f"V_b/V_st, {where}", "-", known[1], found.base_shear_ratio or 0.0)
        if loss == 0.0:
            kept = found.trace.energy_stored[-1] / found.trace.energy_stored[0]
            yield compare(RELEASES, f"energy kept, {where}", "-", within(1.0, 1e-6), kept)
    stiff = Contact("edges", settlement=1e-5 * structure.bearing.alpha * half_width, damping=0.0)
    edges, rigid = (back_swing(released(of_paper(1, ends), *TILTED)) for ends in (stiff, Contact()))
    name = "back swing/alpha, stiff edges against rigid ends, n = 1"
    yield compare(RELEASES, name, "-", Known(rigid, 1e-4), edges)


def back_swing(result: TimeHistoryResult) -> float:
    """The largest rotation to the other side, over alpha."""
    return -float(result.trace.rotation.min()) / result.structure.bearing.alpha
