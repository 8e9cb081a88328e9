"""Impacts and re-contacts: what they do to the floors and to energy, and what is left out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from paper_structures import FLAT, Array, needs_compiled_kernels, podium, stillness

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactKind, ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.physics.state import ROCKING, ROLLING

from .one_lane import OneLane

pytestmark = pytest.mark.evidence("impact laws", "exact")

velocities = st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3)
rates = st.floats(-1.0, -0.01)


def arriving(structure: PodiumStructure, rate: float, floors: list[float]) -> OneLane:
    """At theta = 0, coming from the right with theta' = rate < 0."""
    motion = ROCKING if structure.bearing.is_flat else ROLLING
    lane = OneLane(structure, motion)
    lane.place(np.zeros(structure.storeys + 1), np.array([rate, *floors]))
    return lane


def after_impact(
    structure: PodiumStructure, rate: float, floors: list[float]
) -> tuple[Array, float]:
    """Rates after an impact from the right; energy lost over energy."""
    lane = arriving(structure, rate, floors)
    before = lane.energy()
    gone = lane.change_edge()
    # both are differences of parts of the energy before
    assert gone == pytest.approx(before - lane.energy(), abs=1e-13 * before)
    assert lane.side == -1.0
    assert lane.velocity[0] >= 0.0  # the tilt |theta| grows again, on the other side
    return lane.velocity, (before - lane.energy()) / before


@given(velocities, rates, st.sampled_from([FLAT, 0.5]))
def test_flexible_always_loses_energy(floors: list[float], rate: float, rho: float) -> None:
    structure = podium(3, 0.15, rho, law=ImpactLaw("flexible"))
    after, lost = after_impact(structure, rate, floors)
    assert lost > 0.0
    # to modes and back
    assert after[1:] == pytest.approx(np.array(floors), abs=1e-13)


@given(velocities, rates)
def test_rigid_keeps_the_relative_velocities(floors: list[float], rate: float) -> None:
    structure = podium(3, 0.15, 0.5)
    e, reach = structure.restitution, 2.0 * structure.bearing.half_height
    after, _ = after_impact(structure, rate, floors)
    # theta keeps its sense of turning: theta'+ = e theta'-
    assert after[0] == pytest.approx(-e * rate, rel=1e-15)
    relative = np.array(floors) - reach * rate
    assert after[1:] - reach * e * rate == pytest.approx(relative, abs=1e-13)


def test_rigid_loses_energy_when_all_moves_together_and_creates_it_against_the_base() -> None:
    structure, rate = podium(3, 0.15, 0.5), -0.5
    base = 2.0 * structure.bearing.half_height * rate
    _, together = after_impact(structure, rate, [base] * 3)
    # the rigid frame's kinetic energy falls to e^2
    assert together == pytest.approx(1.0 - structure.restitution**2, rel=1e-10)
    _, against = after_impact(structure, rate, [-base] * 3)
    assert against < -0.01
    flexible = podium(3, 0.15, 0.5, law=ImpactLaw("flexible"))
    assert after_impact(flexible, rate, [-base] * 3)[1] > 0.0


@settings(max_examples=25)
@given(
    velocities, rates, st.sampled_from(["rigid", "flexible", "value"]), st.sampled_from([FLAT, 0.5])
)
def test_the_limit_is_what_endless_bounces_leave(
    floors: list[float], rate: float, law: ImpactKind, rho: float
) -> None:
    """Excursions too short for the springs return the tilt's speed and change no floor."""
    law_of = ImpactLaw(law, 0.9 if law == "value" else None, factor=0.5)
    structure = podium(3, 0.15, rho, law=law_of)
    bouncing, locking = (arriving(structure, -rate, floors) for _ in range(2))
    before, gone = locking.energy(), locking.recontact()  # after an impact, the tilt growing again
    assert gone == pytest.approx(before - locking.energy(), abs=1e-13 * before)
    assert locking.velocity[0] == 0.0
    while bouncing.velocity[0] > 1e-17:
        velocity = bouncing.velocity
        velocity[0] *= -1.0  # the floors' springs have no time to act
        bouncing.place(bouncing.position, velocity)
        bouncing.change_edge()
    # some fifty bounces round
    assert locking.velocity[1:] == pytest.approx(bouncing.velocity[1:], abs=1e-12)


LAWS: list[tuple[ImpactKind, float]] = [("rigid", FLAT), ("flexible", 0.5), ("value", FLAT)]
TOLERANCES = np.array([1e-5, 1e-6, 1e-7, 1e-8])


def vibration(structure: PodiumStructure, tolerance: float) -> Array:
    """Drifts of a released structure long after it came to rest, while the building rings on."""
    chosen = TimeHistorySettings(
        free_vibration=8.8,
        initial_rotation=0.02,
        recontact_tolerance=tolerance,
        accuracy=4.0,
    )
    result = time_history(structure, stillness(0.02), chosen)
    (locked,) = (event for event in result.events if event.kind == "recontact")
    assert locked.time < 8.0
    return result.trace.drifts[401:440]


@needs_compiled_kernels
@pytest.mark.parametrize(("law", "rho"), LAWS)
def test_errors_are_in_proportion_to_the_tolerance(law: ImpactKind, rho: float) -> None:
    """The excursions left out change the drift rates by about u_b', which is added (3.5).

    u_b' is of the size 2 R sqrt(2 theta'' tol alpha). What is left out besides is what springs do
    during them, the product of two such roots or less.
    """
    structure = podium(2, 0.15, rho, law=ImpactLaw(law, 0.8 if law == "value" else None))
    exact = vibration(structure, 1e-13)  # a millionth of the least tolerance
    gaps = np.array([np.max(np.abs(vibration(structure, t) - exact)) for t in TOLERANCES])
    assert np.polyfit(np.log(TOLERANCES), np.log(gaps), 1)[0] > 0.8
    assert gaps[1] < 1e-3 * np.max(np.abs(exact))  # at the default tolerance
