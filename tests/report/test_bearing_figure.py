"""The drawing of the bearing: true to scale, and its numbers are those of the structure."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from matplotlib.figure import Figure

from report.small_results import CURVED, FLAT, ROLLER, drawn, structure
from rpscli.analyses.pushover import pushover
from rpscli.model.bearing import Bearing
from rpscli.model.devices import FrictionDamper, Stop, Tendon
from rpscli.report.figures import style
from rpscli.report.figures.bearing import BearingView, draw_bearing, draw_end
from rpscli.report.figures.look import Look
from rpscli.report.figures.structure import bearing_figure

WIDE = Bearing(1.0, 0.75, 1.2, 0.5)


def texts(axes):
    return [text for each in axes.texts if (text := each.get_text())]


@pytest.mark.parametrize(
    ("bearing", "titles"),
    [
        (
            CURVED,
            [
                "at rest",
                "end of rolling $\\beta$ = 0.151",
                "critical $\\theta_{cr}$ = 0.295",
            ],
        ),
        (FLAT, ["at rest", "critical $\\theta_{cr}$ = 0.149 rad"]),
        (ROLLER, ["at rest", "critical $\\theta_{cr}$ = 0.291 rad"]),
    ],
)
@pytest.mark.parametrize("columns", [1, 2])
def test_states_an_end_and_the_force(bearing, titles, columns):
    result = pushover(structure(bearing, 2))
    figure = drawn(bearing_figure, result, "a title", look=Look(columns=columns))
    assert figure.get_suptitle() == "a title"
    (force,) = [axes for axes in figure.axes if axes.get_xlabel()]
    *states, end = [axes for axes in figure.axes if axes.get_title()]
    assert len(states) == len(titles)
    for axes, title in zip(states, titles, strict=True):
        assert axes.get_title().replace(":", "").replace("\n", " ").startswith(title)
    widths = [axes.get_xlim()[1] - axes.get_xlim()[0] for axes in states]
    assert widths == pytest.approx([widths[0]] * len(states))  # one scale
    assert end.get_title().startswith("an end, enlarged")
    assert force.get_ylabel().startswith("force at the cap beam [")
    marks = [line for line in force.lines if line.get_marker() == "o"]
    assert len(marks) == len(states)  # uplift, beta, theta_cr


@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize("gap", [1e2, 1e9])
def test_stops_far_away_leave_room_for_all_panels(gap, columns):
    made = replace(structure(CURVED, 2), devices=(Stop(gap, 4e6),))
    draw = partial(bearing_figure, pushover(made), "a title")
    assert style.picture(
        draw, Look(columns=columns), "png"
    )  # no warning that the layout collapses


@pytest.mark.parametrize("bearing", [CURVED, FLAT, ROLLER, WIDE])
@pytest.mark.parametrize("part", [-1.0, 0.4, 1.0])
def test_a_column_leans_between_ground_and_cap_beam(bearing, part):
    made = structure(bearing, 0)
    rotation = part * made.critical_rotation
    axes = Figure().subplots()
    view = BearingView(axes, made)
    u, v = view.show(rotation)
    _, path, lift = made.path(np.array([abs(rotation)]))
    assert (u, v) == (math.copysign(path[0], rotation), lift[0])
    corners = np.asarray(view.beam.get_xy()) if view.beam else np.empty(0)
    assert corners[:4, 0].mean() == pytest.approx(u)
    assert corners[:, 1].min() == pytest.approx(view.height + v)
    corners = np.asarray(view.column.get_xy())
    (x0, x1), (y0, y1) = np.asarray(view.contacts.get_data(), float)
    assert (y0, y1) == pytest.approx((0.0, view.height + v))
    # nothing of the column is nearer to the ground than its contact, or than its chords' sagitta
    step = bearing.beta / 11
    sagitta = bearing.radius * (1.0 - math.cos(0.5 * step)) + 1e-12
    assert corners[:, 1].min() == pytest.approx(0.0, abs=sagitta)
    assert corners[:, 1].max() == pytest.approx(view.height + v, abs=sagitta)
    centre = [0.5 * u, 0.5 * (view.height + v)]
    assert corners[:-1].mean(axis=0) == pytest.approx(
        centre, abs=1e-12
    )  # closed at its end
    near = corners[np.argmin(corners[:, 1]), 0]
    reach = bearing.half_width + bearing.radius * min(abs(rotation), bearing.beta)
    assert x0 == pytest.approx(math.copysign(reach, rotation))
    assert near == pytest.approx(x0, abs=bearing.radius * step + 1e-12)
    # the contacts stand in one line at the critical rotation: the weight restores no more
    assert (x1 - x0) * math.copysign(1.0, rotation) == pytest.approx(
        -2.0 * bearing.semi_diagonal * _arm(made, abs(rotation)), abs=1e-12
    )


def _arm(made, rotation):
    """B from F = W B/C (Theory, section 5)."""
    x = np.array([rotation])
    force, _, _ = made.path(x)
    return float(
        (force * made.lever_arm(x))[0] / (2.0 * made.bearing.semi_diagonal * made.weight)
    )


def test_dimensions_are_written_and_drawn_to_scale():
    axes = Figure().subplots()
    draw_bearing(axes, structure(CURVED, 0))
    assert texts(axes) == ["$R$", "$\\alpha$", "2H = 2.967 m"]
    assert axes.get_title() == "at rest\n$\\alpha$ = 0.149 rad, $R$ = 1.5 m"
    (upright,) = [each for each in axes.texts if not each.get_text()]
    assert upright.xy[1] == pytest.approx(2.0 * CURVED.half_height)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert (high - low) / (right - left) == pytest.approx(axes.get_box_aspect())

    axes = Figure().subplots()
    draw_end(axes, CURVED)
    edge = 1e3 * CURVED.radius * (1.0 - math.cos(CURVED.beta))
    wanted = [
        "2B = 0.445 m",
        "2B' = 0.89 m",
        "r = 1.483 m\nβ = 0.151 rad",
        f"{edge:.3g} mm",
    ]
    assert texts(axes) == wanted
    spans = [
        abs(each.xy[0] - each.xyann[0]) for each in axes.texts if not each.get_text()
    ]
    assert spans == pytest.approx(
        [2.0 * CURVED.half_width, 0.3 * 2.0 * CURVED.half_height]
    )

    axes = Figure().subplots()
    draw_end(axes, FLAT)
    assert texts(axes) == ["2B = 0.445 m"]


def test_displacement_and_lift_are_written_and_drawn_to_scale():
    made = structure(CURVED, 0)
    axes = Figure().subplots()
    draw_bearing(axes, made, 0.1)
    _, u, v = made.path(np.array([0.1]))
    assert axes.get_title() == (
        f"$\\theta$ = 0.1 rad\n$u_b$ = {u[0]:.3g} m, $v_b$ = {1e3 * v[0]:.3g} mm"
    )
    assert texts(axes) == ["$u_b$", "$v_b$"]
    across, upwards = (each for each in axes.texts if not each.get_text())
    assert across.xy[0] - across.xyann[0] == pytest.approx(u[0])
    assert upwards.xy[1] - upwards.xyann[1] == pytest.approx(v[0])


def test_a_free_standing_block_carries_nothing():
    block = replace(structure(FLAT, 0), cap_beam_mass=0.0)
    assert BearingView(Figure().subplots(), block).beam is None


def test_devices_are_in_the_drawing():
    devices = (Stop(0.2, 4e6), Tendon(2e4, 1e6), FrictionDamper(1e5))
    made = replace(structure(CURVED, 0), devices=devices)
    axes = Figure().subplots()
    view = BearingView(axes, made)
    u, v = view.show(0.1)
    assert u > 0.2
    posts = [post for _, _, post in view.devices.stops]
    (left, _), (right, pushed) = (np.asarray(post.get_xdata(), float) for post in posts)
    assert (left, right) == pytest.approx((-view.half - 0.2, view.half + 0.2))
    assert pushed == pytest.approx(view.half + u)  # its head stands at the beam's end
    assert [post.get_color() for post in posts] == ["#000000", "#D55E00"]
    (tendon,) = view.devices.tendons
    assert np.asarray(tendon.get_data()).T.tolist() == pytest.approx(
        np.array([[0.0, 0.0], [u, view.height + v]])
    )
    assert view.devices.brace is not None
    (brace,) = [view.devices.brace]
    assert brace.get_color() not in {
        tendon.get_color(),
        "#D55E00",
    }  # nor that of contacts
    named = {"contact", "stop", "stop, reached", "tendon", "friction damper"}
    assert {*axes.get_legend_handles_labels()[1]} == named
    axes = Figure().subplots()
    draw_bearing(axes, made, 0.1)
    assert axes.get_xlim()[1] > view.half + 0.2  # the stops are in view
