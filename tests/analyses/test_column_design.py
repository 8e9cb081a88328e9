"""What the most loaded column carries in a history: by hand, in the plane and in space."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from paper_structures import (
    building,
    ground,
    known,
    needs_compiled_kernels,
    podium,
    waves,
)

from rpscli.analyses.column_design import no_line
from rpscli.analyses.column_forces import no_bound
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.model.bearing import Bearing
from rpscli.model.column import ColumnDesign
from rpscli.model.impact import ImpactLaw
from rpscli.records.ground_motion import MotionComponents

SQUARE = ColumnDesign("square", 35e9, 0.2, 25e6, edge_length=0.45)
ROUND = ColumnDesign("round", 35e9, 0.2, 25e6)
AT_ONCE = TimeHistorySettings(free_vibration=0.0)


def frame(rho, design):
    return replace(podium(0, 0.15, rho), columns=4, column=design)


def designed(rho=0.5):
    heights = np.full(2, 3.0)
    above = replace(building(2, 0.4), vertical_period=0.1, storey_heights=heights)
    of = podium(2, 0.15, rho, superstructure=above, law=ImpactLaw())
    return replace(of, columns=16, rows=(0.0, 4.0, 8.0), column=SQUARE)


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("pair", [False, True])
def test_upright_columns_share_the_moment_of_the_shears(pair):
    """1 m/s2 on a beam and columns of 200 and 20 t: H (50 + 55 kN) at both ends, as 200 to 220."""
    of = frame(0.5, ROUND)
    push = ground([0.0, 1.0, 0.0], 0.1)
    motion = MotionComponents(push.scaled(0.6), y=push.scaled(0.8)) if pair else push
    result = time_history(of, motion, AT_ONCE)
    moment = of.bearing.half_height * 105e3 * 220.0 / 420.0
    conforms(
        "forces in columns, friction", "moment of an upright column [N m]", moment,
        result.column_moment, 1e-12 * moment, "hand calculation", "H (50 + 55 kN)",
    )  # fmt: skip
    assert (result.contact_pressure_ratio, result.crushed_width_ratio) == (0.0, 0.0)
    assert time_history(replace(of, column=None), motion, AT_ONCE).column_moment is None
    # An elastic joint or an edge cannot give more than N B.
    strong = time_history(replace(of, gravity=0.7), push, AT_ONCE)
    weight = 0.7 * (of.columns_mass + of.cap_beam_mass) / 4.0
    assert 0.0 < known(strong.column_moment) < 3.0 * weight * of.bearing.half_width


@needs_compiled_kernels
@pytest.mark.evidence("forces in columns, friction", "exact")
def test_flat_ends_turn_the_force_at_their_edge_into_moment():
    of = frame(0.0, SQUARE)
    result = time_history(of, waves(4.0, 0.01, 4.0, seed=1), AT_ONCE)
    t, b = denser_trace(result, 5e-4), of.bearing
    tilted = t.rotation != 0.0
    x, s = np.abs(t.rotation)[tilted], np.sign(t.rotation)[tilted]
    pressed = t.normal_bottom[tilted] * np.cos(x) + s * t.shear_bottom[tilted] * np.sin(x)
    assert result.column_moment == pytest.approx(
        b.half_width * np.max(pressed) / 4.0, rel=1e-9
    )
    N = np.max(t.normal_bottom[tilted]) / 4.0
    depth = N / (25e6 * 0.45)
    assert result.crushed_width_ratio == pytest.approx(
        depth / (2.0 * b.half_width), rel=1e-9
    )
    assert result.contact_pressure_ratio is None


@needs_compiled_kernels
@pytest.mark.evidence("forces in columns, friction", "exact")
def test_worst_instants_of_a_building():
    """No sample presses more, and the moment runs to the upper end as that end asks."""
    of = designed()
    result = time_history(of, waves(6.0, 0.01, 1.8 * of.uplift_acceleration, seed=2))
    t, b = denser_trace(result, 5e-4), of.bearing
    x, force = np.abs(t.rotation), known(result.axial).heaviest["bottom"]
    rolls = (t.phase == 1) & (x > 0.0)
    around = time_history(replace(of, column=ROUND), result.record)
    for design, found in ((SQUARE, result), (ROUND, around)):
        pressure, *_ = design.pressed(b, x[rolls], force[rolls])
        assert found.contact_pressure_ratio == pytest.approx(
            np.max(pressure) / 25e6, rel=1e-12
        )
    assert known(result.column_demand).instants[1].axial_force == result.max_column_force


@needs_compiled_kernels
@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("rho", [0.0, 0.2, 0.5])
def test_the_moment_ends_as_the_upper_end_asks(rho):
    """Of outer columns as well; with the mean shear they would be out of balance."""
    of = designed(rho)
    result = time_history(of, waves(6.0, 0.01, 1.8 * of.uplift_acceleration, seed=2))
    state, H = known(result.column_demand).at_largest_moment, of.bearing.half_height
    P, Q, M = state.section_forces(
        of.bearing, of.columns_mass / 16, np.array([0.0, 2.0 * H])
    )
    assert abs(M[0]) == pytest.approx(result.column_moment, rel=1e-12)
    assert M[1] == pytest.approx(-(state.lever * P[1] - state.rise * Q[1]), rel=1e-9)
    assert M[1] == pytest.approx(-M[0], rel=0.05)
    assert abs(state.shear_bottom) > 1.1 * np.max(np.abs(result.trace.shear_bottom)) / 16


@needs_compiled_kernels
@pytest.mark.evidence("forces in columns, friction", "exact")
def test_square_columns_of_pairs_stand_on_their_corners():
    """sqrt(2) B beside the axis on flat ends, so that M = sqrt(2) B P; round ones B P. One
    component tilts them along a side.
    """
    square, around = frame(0.0, SQUARE), frame(0.0, ROUND)
    push = waves(4.0, 0.01, 4.0, seed=1)
    pair = MotionComponents(push.scaled(0.6), y=push.scaled(0.8))
    result = time_history(square, pair, AT_ONCE)
    t, b = denser_trace(result, 5e-4), square.bearing
    tilted = t.phase != 0
    x, azimuth = t.rotation[tilted], known(t.azimuth)[tilted]
    y = known(t.y)
    F = t.shear_bottom[tilted] * np.cos(azimuth) + y.shear_bottom[tilted] * np.sin(
        azimuth
    )
    pressed = t.normal_bottom[tilted] * np.cos(x) + F * np.sin(x)
    by_hand = b.half_width * np.max(pressed) / 4.0
    assert known(result.column_moment) == pytest.approx(
        math.sqrt(2.0) * by_hand, rel=1e-6
    )
    assert time_history(around, pair, AT_ONCE).column_moment == pytest.approx(
        by_hand, rel=1e-6
    )
    demand = known(result.column_demand)
    assert demand.corner == math.sqrt(2.0)
    assert abs(demand.instants[0].eccentricity) > 1.3 * b.half_width
    plane = [time_history(of, push, AT_ONCE).column_moment for of in (square, around)]
    assert plane[0] == plane[1]


def test_upright_square_columns_carry_the_moment_of_their_shears():
    """1 m/s2: H (50 + 55 kN) 220/420 at an end, whatever the section; a joint gives sqrt(2) N B."""
    of = frame(0.5, SQUARE)
    push = ground([0.0, 1.0, 0.0], 0.1)
    pair = MotionComponents(push.scaled(0.6), y=push.scaled(0.8))
    assert time_history(of, pair, AT_ONCE).column_moment == pytest.approx(
        of.bearing.half_height * 105e3 * 220.0 / 420.0, rel=1e-12
    )


def ball(ends, design):
    bearing = Bearing(1.5, 0.0, 0.3, 0.7, ends=ends)
    return replace(podium(0, 0.15, 0.5), bearing=bearing, columns=4, column=design)


BARE = replace(SQUARE, edge_length=None)


@needs_compiled_kernels
@pytest.mark.parametrize("both", [False, True])
def test_spherical_ends_press_and_bend_alike_whatever_the_section(both):
    """Under one component and under both, on no corner; unsaid, the section tells nothing."""
    push = waves(4.0, 0.01, 1.0, seed=1)
    motion = MotionComponents(push.scaled(0.6), y=push.scaled(0.8)) if both else push
    cases = (None, ROUND), ("spherical", ROUND), ("spherical", BARE), (None, SQUARE)
    found = [time_history(ball(*each), motion, AT_ONCE) for each in cases]
    names = "column_moment", "contact_pressure_ratio", "max_rotation"
    wanted = [getattr(found[0], name) for name in names]
    assert min(map(known, wanted)) > 0.0
    for result in found[1:]:
        assert [getattr(result, name) for name in names] == wanted
        assert known(result.column_demand).corner == 1.0
    kinds = {str(each.contact) for each in known(found[2].column_demand).instants}
    assert kinds == {"point, r = 2.1 m"}
    assert not no_line(ball(None, SQUARE), both=True)


@needs_compiled_kernels
def test_cylindrical_ends_press_on_a_line_and_roll_in_one_direction():
    push = waves(4.0, 0.01, 1.0, seed=1)
    of = ball("cylindrical", SQUARE)
    line, point = (time_history(each, push, AT_ONCE) for each in (of, ball(None, SQUARE)))
    assert line.max_rotation == point.max_rotation
    assert line.column_moment == point.column_moment
    at = known(line.column_demand).instants[-1]
    by_hand = at.axial_force * SQUARE.contact_modulus / (math.pi * 0.45 * 2.1)
    assert at.contact_pressure == pytest.approx(math.sqrt(by_hand), rel=1e-12)
    assert known(line.contact_pressure_ratio) < known(point.contact_pressure_ratio)
    assert str(at.contact) == "line of 0.45 m, r = 2.1 m"
    with pytest.raises(ValueError, match="roll along one direction"):
        time_history(of, MotionComponents(push, y=push), AT_ONCE)


@needs_compiled_kernels
def test_a_pair_in_one_direction_is_the_plane_and_a_square_column_has_no_pressure():
    push = waves(3.0, 0.01, 4.0, seed=3)
    of = frame(0.5, ROUND)
    plane = time_history(of, push, AT_ONCE)
    pair = time_history(of, MotionComponents(push, y=push.scaled(0.0)), AT_ONCE)
    for name in ("column_moment", "contact_pressure_ratio", "crushed_width_ratio"):
        assert getattr(pair, name) == pytest.approx(getattr(plane, name), rel=1e-6)
    square = replace(of, column=SQUARE)
    result = time_history(square, MotionComponents(push, y=push), AT_ONCE)
    assert result.contact_pressure_ratio is None
    assert (result.column_moment or 0.0) > 0.0
    assert "corner" in no_bound("contact_pressure_ratio", square)
    assert "passes shorter" in no_bound("column_moment", square)
