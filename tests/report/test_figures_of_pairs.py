"""Figures under both components: a motion in one plane, turned, looks as it does in its own."""

from dataclasses import fields, replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from report.small_results import (
    ANGLE,
    KINDS,
    curve,
    drawn,
    is_drawn,
    legend,
    prefix,
    turned,
)
from rpscli import figures
from rpscli.analyses.trace import DirectionTrace
from rpscli.errors import UsageError
from rpscli.model.devices import Stop
from rpscli.report.figures import history
from rpscli.report.figures.floors import draw_accelerations
from rpscli.report.figures.look import FilmRequest
from rpscli.tools.animation.film import PlanView, Scene, frame_plan, history_film


@pytest.fixture(params=["rolls", "overturns", "frame", "at rest"])
def kind(request):
    return str(request.param)


def test_a_plane_motion_is_found_again(kind):
    """In the plane of the tilt all is as it was, but for which side is called right."""
    plane, pair = KINDS[kind]().trace, turned(kind)
    seen = history.in_plane(pair).trace
    peak = int(np.argmax(np.abs(plane.rotation)))
    side = 1.0 if seen.rotation[peak] * plane.rotation[peak] >= 0.0 else -1.0
    if not plane.rotation.any():  # it never leans, and is looked at along x
        side = 1.0 / np.cos(ANGLE)
    names = ["rotation", "rotation_rate", *(each.name for each in fields(DirectionTrace))]
    for name in names:
        if getattr(plane, name) is None:  # nothing yields
            continue
        was, found = getattr(plane, name), side * getattr(seen, name)
        rounding = 1e-12 * (1.0 + np.abs(was).max(initial=0.0))
        np.testing.assert_allclose(found, was, rtol=0.0, atol=rounding)
    assert seen.y is None
    assert history.in_plane(KINDS[kind]()).trace.rotation is not None


def test_the_plane_turns_without_jumps_and_on_while_all_stands():
    """Columns that go round at 2 rad/s and pass upright each second lean in a plane that turns."""
    pair = turned()
    time = pair.trace.time
    steady = turned("rolls", 2.0 * time)
    leans = steady.trace.rotation > 0.0
    found = history.lean_azimuth(steady.trace)
    from_first = found[leans] - found[leans][0]
    np.testing.assert_allclose(
        from_first, 2.0 * (time[leans] - time[leans][0]), atol=1e-9
    )
    assert np.abs(np.diff(found)).max() < 2.0 * pair.record.dt + 1e-9


def test_displacements_in_x_and_in_y():
    pair, plane = turned(), KINDS["rolls"]().trace
    figure = drawn(history.displacement_figure, pair, "a title")
    axes = figure.axes
    assert [of.get_ylabel()[:2] for of in axes] == ["x:", "y:"] * 2
    for of, part in zip(axes[:2], (np.cos(ANGLE), np.sin(ANGLE)), strict=True):
        is_drawn(curve(of, "cap beam"), plane.time, part * plane.cap_beam_displacement)
    assert "x, y: y" in figure.get_suptitle()
    assert history.component(pair, "y").trace.y is None


def test_rotation_and_azimuth():
    pair = turned()
    ground, rotation, azimuth, events = drawn(
        history.rotation_figure, pair, "a title"
    ).axes
    assert legend(ground) == [
        "± resultant",
        "in y",
        "in x",
        "$g\\,\\tan\\alpha$ (uplift)",
    ]
    (band,) = ground.collections
    resultant = np.asarray(band.get_paths()[0].vertices)[:, 1].max()
    assert resultant == pytest.approx(
        np.abs(KINDS["rolls"]().trace.ground_acceleration).max()
    )
    assert rotation.get_ylim()[0] == 0.0
    shown = np.asarray(azimuth.lines[0].get_ydata(), float)
    towards = np.degrees(ANGLE)
    assert set(np.round(shown[~np.isnan(shown)], 9)) <= {
        round(towards, 9),
        round(towards - 180, 9),
    }
    passes = sum(event.kind == "pass" for event in pair.events)
    assert passes
    assert f"pass: {passes}" in [label.get_text() for label in events.get_yticklabels()]


def circles(axes):
    return [float(patch.radius) for patch in axes.patches if isinstance(patch, Circle)]


def test_orbit_and_its_circles():
    pair, trace = turned("frame"), KINDS["frame"]().trace
    orbit, push, bar = drawn(history.orbit_figure, pair, "a title").axes
    assert bar.get_xlabel() == "time [s]"
    made, critical = pair.structure, pair.structure.critical_rotation
    # One block rolls about its edges: 2 R times what leaning moves the middle of a flat end.
    alpha, diameter = made.bearing.alpha, 2.0 * made.bearing.semi_diagonal
    moved = diameter * (np.sin(alpha) - np.sin(alpha - critical))
    assert circles(orbit) == pytest.approx([moved])
    weight = made.gravity * (0.5 * made.columns_mass + made.cap_beam_mass)
    assert circles(push) == pytest.approx([1e-6 * weight * diameter * np.sin(alpha)])
    (lines,) = (c for c in orbit.collections if isinstance(c, LineCollection))
    points = np.concatenate([np.asarray(piece) for piece in lines.get_segments()])
    across = points @ (-np.sin(ANGLE), np.cos(ANGLE))
    assert np.abs(across).max() < 1e-12
    assert np.hypot(*points.T).max() == np.abs(trace.cap_beam_displacement).max()
    stopped = replace(made, devices=(Stop(3.0, 1e6), Stop(0.1 * moved, 1e6)))
    orbit, *_ = drawn(history.orbit_figure, replace(pair, structure=stopped), "").axes
    assert circles(orbit) == pytest.approx([moved, 0.1 * moved, 3.0])
    assert f"stop: {0.1 * moved:.3g} m" in legend(orbit)
    assert orbit.get_aspect() == 1.0
    assert (orbit.get_xlabel(), orbit.get_ylabel()) == (
        "cap beam $u_{b,x}$ [m]", "cap beam $u_{b,y}$ [m]",
    )  # fmt: skip


def test_the_moment_along_the_tilt_is_that_of_the_plane():
    """Of a pair to one side: the driving moment away from upright, over the size of the tilt."""
    trace, axes = KINDS["rolls"]().trace, Figure().subplots()
    history.draw_moment(axes, turned())
    rotation, moment = curve(axes, "driving moment (ground and building)")
    leans = trace.rotation != 0.0
    assert np.isnan(moment[~leans]).all()
    away = (
        prefix(axes.get_ylabel(), "N m") * np.sign(trace.rotation) * trace.driving_moment
    )
    np.testing.assert_allclose(
        moment[leans], away[leans], atol=1e-12 * np.abs(away).max()
    )
    np.testing.assert_allclose(rotation, np.abs(trace.rotation))
    assert axes.get_xlim()[0] == 0.0


def test_the_ground_beside_floors_is_the_resultant():
    axes, peak = Figure().subplots(), KINDS["rolls"]().record.pga
    draw_accelerations(axes, turned())
    assert curve(axes, f"PGA, resultant = {peak:.3g} m/s²")[0][0] == pytest.approx(peak)


def test_panels_of_pairs_refuse_one_component():
    for panel in (figures.orbit, figures.azimuth):
        with pytest.raises(
            UsageError, match="needs a history under both horizontal components"
        ):
            panel(Figure().subplots(), KINDS["frame"]())


def test_film_from_the_side_and_from_above(tmp_path):
    pair, plane = turned(), KINDS["rolls"]().trace
    sample = int(np.argmax(np.abs(plane.rotation)))
    side, above = (Figure().subplots() for _ in range(2))
    scene, view = Scene(side, pair, "a title", 1.0), PlanView(above, pair)
    scene.show(sample)
    view.show(sample)
    middle = plane.cap_beam_displacement[sample]
    beam = np.asarray(scene.beam.get_xy())[:, 0]
    assert abs(0.5 * (beam.min() + beam.max())) == pytest.approx(abs(middle))
    expected = middle * np.array([np.cos(ANGLE), np.sin(ANGLE)])
    assert view.head.get_center() == pytest.approx(tuple(expected))
    # What leans to the right there stands on that end of the line from above.
    shift = 0.5 * (beam.min() + beam.max())
    assert np.sign(shift) == np.sign(np.dot(view.right.get_position(), expected))
    x, y = (np.asarray(of, float) for of in view.plane.get_data())
    assert np.abs(x * np.sin(ANGLE) - y * np.cos(ANGLE)).max() < 1e-9
    wanted = FilmRequest(tmp_path / "film.gif", size=300, first=0.2, last=0.4)
    assert history_film(pair, "a title", wanted, frame_plan(pair, wanted)).startswith(
        b"GIF"
    )
