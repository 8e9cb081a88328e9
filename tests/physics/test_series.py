"""The Taylor series of the uplifted motion: it solves the equation of motion, order by order."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rpscli.analyses.kernels.systems import highest_frequency
from rpscli.physics.core.quintic import NO_PASSAGE
from rpscli.physics.core.records import ORDER
from rpscli.physics.planar.steps import end_step_at, fraction_at

from .one_lane import OneLane
from .test_equation_of_motion import State, states

pytestmark = pytest.mark.evidence("equation of motion", "exact")

slopes = st.floats(-50.0, 50.0)


def stepped(state: State, h: float, across: float, upwards: float) -> OneLane:
    """After a step of length h under accelerations of the ground with these slopes [m/s3]."""
    lane = state.in_a_lane()
    lane.s.a_g_slope[0], lane.s.g_up_slope[0] = across, upwards
    lane.accelerations(state.horizontal, state.vertical)
    lane.step(h)
    return lane


def fastest(state: State) -> float:
    """A rate at which the state changes [1/s]."""
    own = 10.0 * float(np.sqrt(state.structure.gravity / state.structure.bearing.semi_diagonal))
    return own + highest_frequency(state.structure) + abs(float(state.velocity[0]))


def residual(state: State, h: float, across: float, upwards: float, t: float) -> tuple[float, ...]:
    """What is left of the equations of tilt and modes within a step, over what they are made of."""
    lane = stepped(state, h, across, upwards)
    turn, changes = lane.go_along(t)
    s = lane.s
    time = float(s.time[0])
    s.time[0] = 0.0
    lane.accelerations(state.horizontal + across * time, state.vertical + upwards * time)
    ground = state.horizontal + across * time
    B, C, theta_dot, theta_ddot = s.B[0], s.C[0], s.theta_dot[0], s.theta_ddot[0]
    forced = s.side[0] * s.diameter[0] * (C * theta_ddot + B * theta_dot**2) + ground
    exact = -lane.modes("Gamma") * forced - lane.modes("modal_force")
    size = 1.0 + abs(float(theta_ddot)) + float(np.max(np.abs(exact), initial=0.0))
    modes = float(np.max(np.abs(changes - exact), initial=0.0))
    return abs(turn - float(theta_ddot)) / size, modes / size


@given(states(), slopes, slopes, st.floats(0.3, 1.0))
def test_the_polynomials_satisfy_the_equations_of_motion(
    state: State, across: float, upwards: float, t: float
) -> None:
    """Halved steps err 2^7 times less.

    Steps of w h = 0.3 err by (w h)^7/7! = 4e-8 where `fastest` is right; it is rough where heavy
    floors make the inertia a narrow valley, and 1.3e-5 was met in thousands of states.
    """
    for halvings in range(3):
        found = residual(state, 0.3 / fastest(state) * 0.5**halvings, across, upwards, t)
        # and a floor of rounding
        assert max(found) < 5e-5 * 2.0 ** (-ORDER * halvings) + 1e-11


@given(states(), slopes, slopes)
def test_the_end_of_a_step_is_the_sum_of_its_terms(
    state: State, across: float, upwards: float
) -> None:
    h = 0.15 / fastest(state)
    lane, other = (stepped(state, h, across, upwards) for _ in range(2))
    other.go_along(1.0)
    s = lane.s
    assert s.next_theta[0] == pytest.approx(other.s.theta[0], abs=1e-15)
    assert s.next_theta_dot[0] == pytest.approx(other.s.theta_dot[0], rel=1e-13, abs=1e-13)
    assert lane.modes("next_q") == pytest.approx(other.q, rel=1e-13, abs=1e-13)
    assert lane.modes("next_dq") == pytest.approx(other.dq, rel=1e-12, abs=1e-12)


@given(states(), st.floats(0.05, 0.95), st.floats(-0.05, 0.05))
def test_a_level_is_met_where_the_path_passes_it(state: State, t: float, miss: float) -> None:
    lane = stepped(state, 0.15 / fastest(state), 0.0, 0.0)
    guide = stepped(state, 0.15 / fastest(state), 0.0, 0.0)
    start, end = lane.s.theta[0], lane.s.next_theta[0]
    assume(abs(end - start) > 1e-6)
    rates = lane.s.theta_dot[0], lane.s.next_theta_dot[0]
    assume(rates[0] * rates[1] > 0.25 * max(abs(rate) for rate in rates) ** 2)  # no turning point
    guide.go_along(t)
    level = guide.s.theta[0]
    found = fraction_at(lane.s, 0, level, t + miss)
    assert found < NO_PASSAGE
    # the tilt is known to rounding, the instant to that over the rate
    assert found == pytest.approx(t, abs=1e-14 / abs(end - start))
    end_step_at(lane.s, 0, found, level)
    assert lane.s.next_theta[0] == level
    assert lane.s.next_theta_dot[0] == pytest.approx(guide.s.theta_dot[0], rel=1e-9)


@given(states())
def test_a_step_of_no_length_leads_nowhere(state: State) -> None:
    """One may be left after an event on the very sample."""
    lane = stepped(state, 0.0, 1.0, 1.0)
    s = lane.s
    assert s.next_theta[0] == s.theta[0]
    assert s.next_theta_dot[0] == s.theta_dot[0]
    assert s.next_theta_ddot[0] == s.theta_ddot[0]
    assert lane.modes("next_q").tolist() == lane.q.tolist()
    assert lane.modes("next_dq").tolist() == lane.dq.tolist()
