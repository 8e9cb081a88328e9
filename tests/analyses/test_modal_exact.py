"""Exact modes against a numerical Jacobian of other equations of motion; the paper's as a limit."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from oracles.devices import Equipment
from oracles.devices import Tendon as OracleTendon
from oracles.storey_lagrangian import Contact, StoreyLagrangian
from paper_structures import (
    FLAT,
    building,
    known,
    oracle_devices,
    oracle_system,
    podium,
)

from rpscli.analyses.modal import modal
from rpscli.model.bearing import Bearing
from rpscli.model.devices import FrictionDamper, Tendon, ViscousDamper
from rpscli.model.impact import ImpactLaw

pytestmark = pytest.mark.evidence("modes", "program")

# tan alpha, tan alpha', rho; in the last the arc's end lies far beyond the column
SHAPES = [(0.02, 0.04, 0.5), (0.15, 0.3, FLAT), (0.15, 0.3, 0.25), (0.6, 1.2, 0.7)]
SHAPES += [(1.0, 1.5, 1.5), (0.5, 2.0, 0.75)]

DEVICES = {
    "none": (),
    "viscous": (ViscousDamper(4e5),),
    "prestress": (Tendon(3e5, 5e5),),
    "yielding": (Tendon(3e4, 5e7, 4e5), ViscousDamper(4e5)),
}


def jacobian(structure, *, rolling):
    """Of [theta, drifts] and their rates where the state begins, by differences (2 n + 2, ...).

    A constant moment holds the weight and the tendons there, so that it is an equilibrium.
    """
    motion, n = StoreyLagrangian(oracle_system(structure)), structure.storeys
    gear = Equipment(motion, oracle_devices(structure))
    contact, start = Contact(1, rolling=rolling), 0.0 if rolling else motion.beta
    y = np.zeros(2 * n + 2)
    y[0] = start
    gear.unload(start, rolling=rolling)
    endless = {
        "yield_force": math.inf
    }  # as long as it is unloaded: drawn further it would yield
    gear.devices = tuple(
        replace(each, **endless) if isinstance(each, OracleTendon) else each
        for each in gear.devices
    )

    def devices(y):
        return sum(active for active, _ in gear.moments(contact, y[0], y[n + 1], 1))

    weight = motion.lifted_mass * structure.gravity
    held = weight * motion.cap_beam(start, rolling=rolling)[1].imag - devices(y)

    def rates(y):
        moved = motion.acceleration(contact, y, 0.0, structure.gravity, held + devices(y))
        return np.concatenate([y[n + 1 :], moved])

    assert np.abs(rates(y)).max() < 1e-9
    found, steps = np.empty((2 * n + 2, 2 * n + 2)), np.eye(2 * n + 2) * 1e-4
    for j, step in enumerate(steps):
        if j == 0:  # the tilt only grows: elongations have a kink at 0
            slopes = (-25.0, 48.0, -36.0, 16.0, -3.0)
            found[:, j] = (
                sum(c * rates(y + k * step) for k, c in enumerate(slopes)) / 12e-4
            )
        else:
            found[:, j] = (rates(y + step) - rates(y - step)) / 2e-4
    return found


@pytest.mark.parametrize("devices", DEVICES)
@pytest.mark.parametrize("storeys", [0, 1, 3])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_eigenvalues_are_those_of_the_jacobian(shape, storeys, devices):
    bare = replace(podium(storeys), bearing=Bearing(1.5, *shape), columns=6)
    structure = replace(bare, devices=DEVICES[devices])
    beside = replace(structure, devices=(*structure.devices, FrictionDamper(1e5)))
    for name, modes in modal(beside).uplifted.items():
        expected = np.linalg.eigvals(jacobian(structure, rolling=name == "rolling"))
        # differences round; a double zero is found to the root of that only
        zero = 1e-5 if modes.frequency_parameter == 0.0 else 0.0
        near = [expected[np.argmin(np.abs(expected - v))] for v in modes.eigenvalues]
        within = 1e-6 * np.max(np.abs(expected)) + zero
        for part, wanted, found in (
            ("real", np.real(near), modes.eigenvalues.real),
            ("imaginary", np.imag(near), modes.eigenvalues.imag),
        ):
            conforms(
                "modes", f"{part} parts of the eigenvalues [1/s], {name}", wanted, found,
                within, "independent program", "Jacobian of Lagrange's equations",
            )  # fmt: skip


@pytest.mark.evidence("floors on vertical springs", "exact")
@pytest.mark.parametrize("shape", [*SHAPES, (0.0, 0.3, 0.8)], ids=str)
@pytest.mark.parametrize("storeys", [1, 3])
def test_springs_in_tilt_drifts_and_lifts(storeys, shape):
    """Second derivatives of the energies in [theta, drifts, lifts over the beam].

    Weight and springs cancel where floors have sagged, so lifts add nothing but their springs.
    """
    above = replace(building(storeys), vertical_period=0.12, vertical_damping=0.07)
    usual = podium(storeys, law=ImpactLaw(), superstructure=above)
    structure = replace(usual, bearing=Bearing(1.5, *shape))
    n, motion = storeys, StoreyLagrangian(oracle_system(structure))
    chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    chain[-1, -1] = 1.0  # the roof
    root = 1.0 / np.sqrt(above.masses)
    squares, vectors = np.linalg.eigh(root[:, None] * chain * root)
    squares *= (2.0 * math.pi / 0.12) ** 2 / squares[0]
    weighted = vectors / root[:, None]
    for name, modes in modal(structure).uplifted.items():
        rolling = name == "rolling"
        _, slope, bend = motion.cap_beam(0.0 if rolling else motion.beta, rolling=rolling)
        M, C, K = (np.zeros((2 * n + 1, 2 * n + 1)) for _ in range(3))
        M[: n + 1, : n + 1] = motion.mass_matrix(slope)
        M[0, n + 1 :] = M[n + 1 :, 0] = slope.imag * above.masses
        M[n + 1 :, n + 1 :] = np.diag(above.masses)
        K[0, 0] = motion.lifted_mass * structure.gravity * bend.imag
        K[1 : n + 1, 1 : n + 1] = np.diag(above.stiffnesses)
        K[n + 1 :, n + 1 :] = (weighted * squares) @ weighted.T
        C[1 : n + 1, 1 : n + 1] = motion.drift_damping
        C[n + 1 :, n + 1 :] = 2.0 * 0.07 * (weighted * np.sqrt(squares)) @ weighted.T
        turned = np.linalg.solve(M, np.hstack([-K, -C]))
        unmoved = np.hstack([np.zeros_like(M), np.eye(2 * n + 1)])
        expected = np.linalg.eigvals(np.vstack([unmoved, turned]))
        assert len(modes.eigenvalues) == len(expected) == 4 * n + 2
        zero = 1e-5 if modes.frequency_parameter == 0.0 else 0.0
        near = [expected[np.argmin(np.abs(expected - v))] for v in modes.eigenvalues]
        conforms(
            "floors on vertical springs", f"distance of eigenvalues [1/s], {name}",
            np.zeros(len(near)), np.abs(modes.eigenvalues - near),
            1e-9 * np.max(np.abs(expected)) + zero,
            "closed form", "second derivatives of the energies",
        )  # fmt: skip
        assert len(modes.frequencies) == len(modes.vertical_frequencies) == n
        # a beam that is lifted with the floors is stiffer than one that stands
        assert np.all(modes.vertical_frequencies > 0.99 * np.sqrt(squares))


def off_to_first_order(modes):
    """Relative errors of the first frequency, its damping and the own mode."""
    paper = known(modes.first_order)
    assert paper.first_order is None
    printed, exact = (
        np.array([each.frequencies[0], each.damping[0], each.frequency_parameter])
        for each in (paper, modes)
    )
    return printed / exact - 1.0


@pytest.mark.parametrize("devices", ["none", "prestress"])
@pytest.mark.parametrize("rho", [FLAT, 0.3, 1.5])
def test_first_order_is_the_limit_for_small_alpha(rho, devices):
    """What it leaves out falls with the square of alpha, in vibrations and in the own mode."""
    off = []
    for tan_alpha in (0.1, 0.05, 0.025):
        structure = replace(podium(3, tan_alpha, rho), devices=DEVICES[devices])
        off += [off_to_first_order(modes) for modes in modal(structure).uplifted.values()]
    states = 1 if rho == FLAT else 2
    first, second, third = np.array(off).reshape(3, states, 3)
    assert np.abs(first).max() < 0.03  # tan alpha = .1, rocking at beta
    # a quarter at half the angle; below 1e-5 other terms show
    for whole, half in ((first, second), (second, third)):
        assert np.all(np.abs(half) < 0.35 * np.abs(whole) + 1e-5)


@pytest.mark.parametrize(
    ("tan_alpha", "per_cent"),
    [(0.15, (0.54, 0.37, -0.26)), (0.3, (2.04, 1.57, -0.90)), (0.6, (6.37, 5.74, -2.11))],
)
def test_what_first_order_leaves_out(tan_alpha, per_cent):
    """Three storeys, flat ends, in per cent as THEORY has them."""
    found = off_to_first_order(modal(podium(3, tan_alpha, FLAT)).rocking)
    assert 100.0 * found == pytest.approx(per_cent, abs=0.006)


def test_a_rigid_block_falls_as_its_pendulum_does():
    """theta'' = p^2 sin(theta - alpha): its slope at theta = 0 is p^2 cos(alpha)."""
    for tan_alpha in (0.1, 0.5, 1.0):
        structure = podium(0, tan_alpha, FLAT)
        p = structure.rigid_frequency_parameter
        modes = modal(structure).rocking
        expected = p * math.sqrt(math.cos(math.atan(tan_alpha)))
        for name, found in (
            ("p_ext", modes.frequency_parameter),
            ("rigid estimate", modes.frequency_parameter_rigid),
        ):
            conforms(
                "modes", f"{name} [rad/s], block, tan(alpha) {tan_alpha:g}", expected, found,
                1e-12 * expected, "closed form", "p sqrt(cos(alpha)) of a pendulum",
            )  # fmt: skip
