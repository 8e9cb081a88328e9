"""Steps: the orders that are observed, where they are halved, and how many it takes."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    building,
    let_go,
    needs_compiled_kernels,
    podium,
    steps_an_interval,
    waves,
)

from rpscli.analyses.kernels import systems
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import RayleighDamping
from rpscli.physics.tableau import END, ERROR, SQUARED, USED
from rpscli.physics.tableau import STAGES as A
from rpscli.physics.tableau import TIMES as C

SIXTH, FIFTH = A[END], A[END] - ERROR


def missed(b):
    """What weights miss of the conditions of orders 1 to 5 (Butcher's trees)."""
    Ac, Ac2 = A @ C, A @ C**2
    yield float(b.sum() - 1.0)
    for k in range(1, 5):
        yield float(b @ C**k - 1.0 / (k + 1))
    for tree, value in (
        (Ac, 6), (C * Ac, 8), (Ac2, 12), (A @ Ac, 24), (C**2 * Ac, 10), (Ac**2, 20), (C * Ac2, 15),
        (A @ C**3, 20), (C * (A @ Ac), 30), (A @ (C * Ac), 40), (A @ Ac2, 60), (A @ (A @ Ac), 120),
    ):  # fmt: skip
        yield float(b @ tree - 1.0 / value)


@pytest.mark.parametrize("b", [SIXTH, FIFTH], ids=["6", "5"])
def test_conditions_up_to_order_five(b):
    # weights of up to 176 multiply rounding
    assert max(map(abs, missed(b))) < 1e-10


def test_one_rule_is_of_order_six_and_the_other_is_not():
    assert pytest.approx(1.0 / 6.0, abs=1e-10) == SIXTH @ C**5
    assert abs(FIFTH @ C**5 - 1.0 / 6.0) > 1e-4


def test_positions_follow_by_the_squared_tableau():
    assert np.array_equal(SQUARED, A @ A)
    assert pytest.approx(0.5, abs=1e-10) == SIXTH @ C
    assert not np.any(np.where(USED, 0.0, A))


ACCURACIES = (0.8, 1.6, 3.2)
REFERENCE = 48.0
LEAST_STATE, LEAST_ENERGY = 5.5, 5.5
"""Order six shows as 5.6 to 8, that of energy likewise: rounding is near, so the steps are few and
long, and the error that counts is not always that of the same quantity."""

LEAST_PARABOLA = 4.5
"""That of frames without stiffness, whose motion between events is almost a parabola."""


@pytest.fixture
def even_steps(monkeypatch):
    """No error shortens them."""
    monkeypatch.setattr(systems, "STEP_ERROR", math.inf)
    monkeypatch.setattr(systems, "_system", systems._system.__wrapped__)


class Orders(NamedTuple):
    """Slopes over three step lengths, and the history with the shortest step."""

    state: float
    energy: float
    reference: TimeHistoryResult


def observed(structure, record):
    """Released from 0.1 rad under the record, which ends the history."""

    def run(accuracy):
        settings = TimeHistorySettings(
            free_vibration=0.0, accuracy=accuracy, initial_rotation=0.1
        )
        return time_history(structure, record, settings)

    def last(result):
        t = result.trace
        ends = t.rotation[-1:], t.rotation_rate[-1:], t.drifts[-1], t.storey_shears[-1]
        return np.concatenate(ends)

    reference = run(REFERENCE)
    assert reference.trace.phase[-1] > 0
    exact = last(reference)
    steps, errors, residuals = [], [], []
    for whole in ACCURACIES:  # whose steps of one storey are shorter
        accuracy = 0.8 * whole if structure.storeys == 1 else whole
        result = run(accuracy)
        assert [e.kind for e in result.events] == [e.kind for e in reference.events]
        steps.append(steps_an_interval(structure, record.dt, accuracy))
        errors.append(np.max(np.abs(last(result) - exact) / np.abs(exact)))
        residual = abs(result.energy.residual) / result.trace.energy_stored[0]
        residuals.append(max(residual, 1e-17))  # below rounding it may be nothing
    assert min(errors) > 1e-14  # not yet rounding
    lengths = -np.log(steps)
    state, energy = (
        float(np.polyfit(lengths, np.log(e), 1)[0]) for e in (errors, residuals)
    )
    return Orders(state, energy, reference)


CURVED = [(n, rho) for n in (1, 3) for rho in (FLAT, 0.25, 0.5, 1.5)]


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
@pytest.mark.usefixtures("even_steps")
@pytest.mark.parametrize(
    ("storeys", "rho", "events"),
    [
        *(
            (n, rho, False)
            for n, rho in [(0, FLAT), (1, FLAT), (1, 0.5), (3, FLAT), (3, 0.5)]
        ),
        (6, 0.5, False),
        # a frame without stiffness is almost a parabola, whose error has no leading term
        *((n, rho, True) for n, rho in [(0, FLAT), (0, 0.25), (0, 1.5), *CURVED]),
    ],
)
def test_steps_are_of_order_six_and_events_cost_none(storeys, rho, events):
    """Impacts reset the state, and D jumps at beta: both only if met exactly."""
    # without springs the motion is slow: longer intervals, or one step would do for all
    dt = 0.02 if storeys else 0.2
    record = waves(2.4, dt, 2.0, seed=1) if events else waves(0.4, dt, 1.0, seed=1)
    orders = observed(podium(storeys, 0.15, rho), record)
    kinds = [event.kind for event in orders.reference.events]
    assert (kinds.count("impact") >= 1) if events else not kinds
    if rho == 1.5 and events:
        assert {"rolling_to_rocking", "rocking_to_rolling"} <= {*kinds}
    assert orders.state > (LEAST_STATE if storeys else LEAST_PARABOLA)
    assert orders.energy > (LEAST_ENERGY if storeys else LEAST_PARABOLA)


SHORT = PodiumStructure(
    Bearing(0.12, 0.3, 0.6, 2.5), 5.9e3, 5.6e4, None, ImpactLaw("value", 1.0)
)
"""Columns of a quarter of a metre with large radii: a tilt of 0.3 rad moves the contact far."""

HEAVY = PodiumStructure(
    Bearing(0.3, 0.15, 0.3, 0.5),
    1e3,
    1e3,
    building(2, damping=RayleighDamping(0.0)),
    ImpactLaw("value", 1.0),
)
"""Floors of hundreds of columns: near theta_cr, where they rise no more, A has a valley."""


def drift(structure, rotation, accuracy):
    """Largest change of the energy that should stay, over itself; steps over the plain number."""
    start = rotation * structure.bearing.critical_rotation
    result = let_go(structure, start, 2.0, 0.05, accuracy=accuracy)
    stored = result.trace.energy_stored
    plain = len(stored) * steps_an_interval(structure, 0.05, accuracy)
    return float(np.max(np.abs(stored / stored[0] - 1.0))), result.history.steps / plain


@needs_compiled_kernels
@pytest.mark.parametrize(("structure", "rotation"), [(SHORT, 0.55), (HEAVY, 0.95)])
def test_steps_are_halved_where_the_tilt_is_fast(structure, rotation, monkeypatch):
    # undamped buildings would have short steps anyway
    monkeypatch.setattr(systems, "MOST_LOST", math.inf)
    monkeypatch.setattr(
        systems, "_system", systems._system.__wrapped__
    )  # as if never made
    kept, steps = drift(structure, rotation, 1.0)
    with monkeypatch.context() as patch:
        patch.setattr(systems, "STEP_ERROR", math.inf)
        lost, plain = drift(structure, rotation, 1.0)
    assert steps > plain
    assert kept < 1e-5
    assert lost > 5.0 * kept
    assert drift(structure, rotation, 2.0)[0] < max(0.05 * kept, 1e-11)  # or rounding


BEYOND_A_PLAIN_STEP = 3.5
"""Steps that an event adds on average: those taken again to its root, the one that leads on from
it, and halves of steps in which the tilt changes fast."""


@pytest.mark.evidence("steps, events, energy", "exact")
@needs_compiled_kernels
@pytest.mark.parametrize(
    ("storeys", "rho"), [(0, FLAT), (0, 1.5), (3, 0.5), (6, FLAT), (9, 0.26), (9, 1.5)]
)
def test_an_event_costs_few_steps(storeys, rho):
    structure = podium(storeys, 0.10, rho)
    for seed in range(3):
        record = waves(12.0, 0.01, 2.5 * structure.uplift_acceleration, seed)
        result = time_history(structure, record, TimeHistorySettings(free_vibration=4.0))
        assert len(result.events) > 10
        plain = (len(result.trace.time) - 1) * steps_an_interval(structure, record.dt)
        assert result.history.steps - plain < BEYOND_A_PLAIN_STEP * len(result.events)
