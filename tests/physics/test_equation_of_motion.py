"""The right-hand side at random states: identities, and Lagrange's equations in other unknowns."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.storey_lagrangian import Contact, StoreyLagrangian
from paper_structures import Array, oracle_system

from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, RayleighDamping, Superstructure
from rpscli.physics.state import ROCKING, ROLLING

from .one_lane import OneLane

pytestmark = [
    pytest.mark.evidence("equation of motion", "exact"),
    pytest.mark.evidence("equation of motion", "program"),
]

SIXTH_ORDER = {1: 45.0, 2: -9.0, 3: 1.0}
"""Weights of central differences over 60 h."""


class State(NamedTuple):
    """A structure somewhere in its motion: [x, u_1 ... u_n] and rates."""

    structure: PodiumStructure
    motion: int
    side: float
    position: Array
    velocity: Array
    horizontal: float
    vertical: float

    def in_a_lane(self) -> OneLane:
        lane = OneLane(self.structure, self.motion, self.side)
        lane.place(self.position, self.velocity)
        return lane

    def accelerations(self) -> Array:
        return self.in_a_lane().accelerations(self.horizontal, self.vertical)

    @property
    def arms(self) -> tuple[float, float]:
        """B and C."""
        bearing, x = self.structure.bearing, float(self.position[0])
        phase = bearing.rolling if self.motion == ROLLING else bearing.rocking
        return (
            phase.p * math.cos(x) + phase.q * math.sin(x),
            phase.c + phase.p * math.sin(x) - phase.q * math.cos(x),
        )


@st.composite
def states(draw: st.DrawFn) -> State:
    n = draw(st.integers(0, 4))
    positive = st.floats(0.2, 5.0)
    above = None
    if n:
        dampings: list[RayleighDamping | ModalDamping] = [RayleighDamping(0.05), ModalDamping(0.03)]
        damping = draw(st.sampled_from(dampings))
        masses, stiffnesses = (
            np.array(draw(st.lists(positive, min_size=n, max_size=n))) for _ in range(2)
        )
        above = Superstructure(1e5 * masses, 1e8 * stiffnesses, damping)
    tan_alpha = draw(st.floats(0.05, 0.3))
    rho = draw(st.sampled_from([0.0, 0.3, 0.5, 1.5]))
    bearing = Bearing(draw(positive), tan_alpha, 2.0 * tan_alpha, rho)
    rigid = ImpactLaw("rigid")  # of which any of these shapes goes over
    structure = PodiumStructure(bearing, 1e4 * draw(positive), 1e5 * draw(positive), above, rigid)
    motion = draw(st.sampled_from([ROLLING, ROCKING])) if rho else ROCKING
    x = draw(st.floats(0.0, bearing.beta) if motion == ROLLING else st.floats(bearing.beta, 0.6))
    floors = st.lists(st.floats(-0.5, 0.5), min_size=n, max_size=n)
    rate, acceleration = st.floats(-1.0, 1.0), st.floats(-5.0, 5.0)
    return State(
        structure,
        motion,
        draw(st.sampled_from([1.0, -1.0])),
        np.array([x, *draw(floors)]),
        np.array([draw(rate), *draw(floors)]),
        draw(acceleration),
        draw(acceleration),
    )


def drift_state(state: State, lane: OneLane) -> Array:
    """The same state as [theta, drifts, theta', drift rates], on the lane's own u_b and u_b'."""
    base, base_velocity = lane.base, lane.base_velocity
    return np.concatenate(
        (
            [state.side * state.position[0]],
            np.diff(state.position[1:], prepend=base),
            [state.side * state.velocity[0]],
            np.diff(state.velocity[1:], prepend=base_velocity),
        )
    )


@given(states())
def test_lagranges_equations_in_tilt_and_drifts_say_the_same(state: State) -> None:
    lane = state.in_a_lane()
    found = lane.accelerations(state.horizontal, state.vertical)
    lagrangian = StoreyLagrangian(oracle_system(state.structure))
    contact = Contact(int(state.side), rolling=state.motion == ROLLING)
    gravity = state.structure.gravity + state.vertical
    q2 = lagrangian.acceleration(contact, drift_state(state, lane), state.horizontal, gravity)
    (B, C), diameter = state.arms, 2.0 * state.structure.bearing.semi_diagonal
    base = state.side * diameter * (C * found[0] + B * state.velocity[0] ** 2)
    # the oracle solves with a full matrix, whose condition of up to 1e4 multiplies rounding
    size = 1e-11 * (1.0 + float(np.max(np.abs(q2))))
    assert state.side * found[0] == pytest.approx(q2[0], abs=size)
    # du_b/dtheta = 2 R C, C < 5
    assert found[1:] == pytest.approx(base + np.cumsum(q2[1:]), abs=size * (1.0 + 5.0 * diameter))


@given(states())
def test_energies_are_those_of_the_lagrangian(state: State) -> None:
    lane = state.in_a_lane()
    lane.accelerations()
    lagrangian = StoreyLagrangian(oracle_system(state.structure))
    contact = Contact(int(state.side), rolling=state.motion == ROLLING)
    expected = sum(lagrangian.energies(contact, drift_state(state, lane)))
    assert lane.energy() == pytest.approx(expected, rel=1e-11, abs=1e-6)


@given(states())
def test_energy_changes_by_what_the_ground_gives_and_the_dampers_take(state: State) -> None:
    """dE/dt = -a_g [...] - a_v [...] - v'^T C v' (Theory, section 8): the flows that are noted."""
    lane, h = state.in_a_lane(), 1e-3
    moving = lane.accelerations(state.horizontal, state.vertical)
    given_power, taken = lane.powers()
    flow = given_power - taken
    energies = {}
    for i in range(-3, 4):
        lane.place(state.position + i * h * state.velocity, state.velocity + i * h * moving)
        energies[i] = lane.energy()
    slope = sum(w * (energies[i] - energies[-i]) for i, w in SIXTH_ORDER.items()) / (60.0 * h)
    # What is left of the differences is rounding, eps/h of the largest term: the lift is a small
    # difference of numbers of order one, times the weight.
    lifted = 2.0 * state.structure.bearing.semi_diagonal * state.structure.weight
    size = max(lifted, *(abs(energy) for energy in energies.values()))
    assert flow == pytest.approx(slope, abs=1e-14 / h * size)
