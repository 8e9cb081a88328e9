"""What the figures of one analysis draw: every line, limit, label and unit against its result."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch
from paper_structures import known
from PIL import Image

from report.small_results import (
    CURVED,
    FLAT,
    KINDS,
    ROLLER,
    curve,
    drawn,
    is_drawn,
    legend,
    prefix,
    second_axis,
    structure,
)
from rpscli import figures
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.errors import UsageError
from rpscli.model.devices import FrictionDamper, Stop, Tendon, ViscousDamper
from rpscli.records import measures
from rpscli.records.loading import load_record
from rpscli.records.measures import response_spectrum
from rpscli.report.figures import style
from rpscli.report.figures.bearing import devices_figure
from rpscli.report.figures.floors import (
    MOST_STOREYS,
    draw_loop,
    loops_figure,
    profile_figure,
    shown_floors,
)
from rpscli.report.figures.history import displacement_figure, rotation_figure
from rpscli.report.figures.look import FilmRequest
from rpscli.report.figures.motions import record_figure
from rpscli.report.figures.structure import (
    ELASTIC,
    capacity_figure,
    level_heights,
    modes_figure,
    storey_curve_figure,
)
from rpscli.tools.animation.film import Scene, frame_plan, history_film, modes_film


@pytest.fixture(params=KINDS)
def result(request):
    return KINDS[request.param]()


def reach(axes, label):
    """Lowest and highest ordinate of a filled area."""
    (area,) = [c for c in axes.collections if c.get_label() == label]
    assert isinstance(area, PolyCollection)
    y = np.concatenate([path.vertices[:, 1] for path in area.get_paths()])
    return float(np.nanmin(y)), float(np.nanmax(y))


def steps(axes, label):
    (patch,) = [p for p in axes.patches if p.get_label() == label]
    assert isinstance(patch, StepPatch)
    assert patch.orientation == "horizontal"
    return patch


def test_rotation(result):
    trace, made = result.trace, result.structure
    figure = drawn(rotation_figure, result, "a title")
    words = " ".join(figure.get_suptitle().replace("|", " ").split())
    every = f"samples every {result.record.dt:g} s, between which maxima may lie"
    assert words == f"a title {result.record.name} {every}"
    ground, rotation, *events = figure.axes

    is_drawn(curve(ground, "_child0"), trace.time, trace.ground_acceleration)
    assert legend(ground) == ["$g\\,\\tan\\alpha$ (uplift)"]
    for place, sign in ((1, 1.0), (2, -1.0)):
        limit = sign * made.uplift_acceleration
        assert curve(ground, f"_child{place}")[1].tolist() == [limit, limit]

    blue = next(line for line in rotation.lines if len(np.asarray(line.get_xdata())) > 2)
    is_drawn(curve(rotation, str(blue.get_label())), trace.time, trace.rotation)
    low, high = rotation.get_ylim()
    assert -low == high > result.max_rotation
    ratio = second_axis(rotation)
    assert ratio.get_ylim()[1] == pytest.approx(high / made.critical_rotation, rel=1e-12)

    names = legend(rotation)
    for code, name in ((1, "rolling"), (2, "rocking")):
        assert (name in names) == bool((trace.phase == code).any())
    for symbol, value in (
        ("\\theta_{cr}", made.critical_rotation),
        ("\\beta", made.bearing.beta),
    ):
        if value > 0.0:
            label = f"${symbol}$ = {value:.3f} rad"
            assert (label if value <= high else f"{label} (outside)") in names
            if value <= high:
                assert curve(rotation, label)[1].tolist() == [value, value]

    assert figure.axes[-1].get_xlim() == (0.0, trace.time[-1])
    assert len(events) == bool(result.events)  # none at rest
    marks = {
        text.get_text(): np.asarray(line.get_xdata()).tolist()
        for axes in events
        for text, line in zip(axes.get_yticklabels(), axes.lines, strict=True)
    }
    for name, kinds in (
        ("uplift", {"uplift"}),
        ("impact", {"impact"}),
        ("passing $\\beta$", {"rolling_to_rocking", "rocking_to_rolling"}),
        ("critical", {"critical_rotation_passed", "overturning"}),
    ):
        times = [e.time for e in result.events if e.kind in kinds]
        assert marks.get(f"{name}: {len(times)}", []) == times


def test_the_shades_of_the_phases_begin_and_end_with_them():
    result = KINDS["overturns"]()
    time, phase = result.trace.time, result.trace.phase
    axes = drawn(rotation_figure, result, "").axes[1]
    for code, name in ((1, "rolling"), (2, "rocking")):
        (shade,) = [c for c in axes.collections if c.get_label() == name]
        x = np.concatenate([path.vertices[:, 0] for path in shade.get_paths()])
        inside = np.flatnonzero(phase == code)
        assert x.min() == time[inside[0]]
        # the last sample of a phase is shaded up to itself or to the next one
        assert x.max() in time[inside[-1] :][:2]


def test_displacements(result):
    trace, storeys = result.trace, result.structure.storeys
    whole, *elastic = drawn(displacement_figure, result, "").axes
    is_drawn(curve(whole, "cap beam"), trace.time, trace.cap_beam_displacement)
    assert [whole, *elastic][-1].get_xlim() == (0.0, trace.time[-1])
    assert len(elastic) == (storeys > 0)
    for axes in elastic:
        for floor in range(1, storeys + 1):
            name = "roof" if floor == storeys else f"floor {floor}"
            displacement = trace.floor_displacements[:, floor - 1]
            if floor == storeys:  # those below would only cover it
                is_drawn(curve(whole, name), trace.time, displacement)
            is_drawn(
                curve(axes, name), trace.time, displacement - trace.cap_beam_displacement
            )
            assert name in legend(axes)


def energies(result, axes, *names):
    """Require that parts of the energy stand on top of each other, with these between."""
    trace, made = result.trace, result.structure
    factor = prefix(axes.get_ylabel(), "J")
    is_drawn(curve(axes, "input"), trace.time, factor * trace.energy_input)
    below = np.zeros_like(trace.time)
    parts = [
        *[("damped in the building", trace.energy_damped)] * bool(made.storeys),
        *[("yielding of storeys", trace.energy_yielded)] * made.yields,
        *zip(names, trace.devices.energy.T, strict=True),
        ("lost at impacts (net)", trace.energy_impact),
        ("kinetic, elastic and gravitational", trace.energy_stored),
    ]
    for name, part in parts:
        above = below + factor * part
        both = np.concatenate([below, above])
        assert reach(axes, name) == pytest.approx(
            (np.nanmin(both), np.nanmax(both)), rel=1e-12
        )
        below = above
    assert {*legend(axes)} == {*(name for name, _ in parts), "input"}


def test_energy(result):
    axes = Figure().subplots()
    figures.energy(axes, result)
    assert axes.get_xlim() == (0.0, result.trace.time[-1])
    energies(result, axes)


DEVICES = (
    FrictionDamper(1e5),
    Stop(0.02, 4e6, 1e5),
    Tendon(2e4, 1e6, 3e4),
    ViscousDamper(2e5),
)


@pytest.fixture(scope="module")
def equipped():
    made = replace(structure(CURVED, 3), devices=DEVICES, columns=4)
    record = load_record("pulse:sine?amplitude=0.4g&period=0.8&dt=0.01")
    return time_history(made, record, TimeHistorySettings(free_vibration=2.0))


def test_a_stop_that_is_not_reached_says_so(equipped):
    """Its gap is drawn, and how far it was away; of one that is reached only the gap."""
    largest = np.nanmax(np.abs(equipped.trace.devices.displacement[:, 1]))
    gap = equipped.structure.devices[1].gap
    assert largest > gap
    panels = drawn(devices_figure, equipped, "").axes
    assert f"gap {gap:.3g} m" in [text.get_text() for text in panels[1].texts]
    far = replace(equipped.structure, devices=(replace(DEVICES[1], gap=9.0 * largest),))
    missed = time_history(far, equipped.record, TimeHistorySettings(free_vibration=2.0))
    reached = np.nanmax(np.abs(missed.trace.devices.displacement[:, 0]))
    assert reached < 9.0 * largest
    (axes, *_) = drawn(devices_figure, missed, "").axes
    words = [text.get_text() for text in axes.texts]
    assert f"not reached:\n{reached:.3g} m" in words
    assert 9.0 * largest in [line.get_xdata()[0] for line in axes.lines[1:]]


def test_loops_of_devices(equipped):
    trace = equipped.trace.devices
    panels = drawn(devices_figure, equipped, "").axes
    names = [
        "device 1: friction",
        "device 2: stop",
        "device 3: tendon",
        "device 4: viscous",
    ]
    assert [axes.get_title() for axes in panels[:4]] == names
    for index, axes in enumerate(panels[:4]):
        tendon = index == 2
        factor = prefix(axes.get_ylabel(), "N")
        assert axes.get_ylabel().startswith(
            "tension of one [" if tendon else "resistance ["
        )
        assert axes.get_xlabel() == ("elongation of one [m]" if tendon else "$u_b$ [m]")
        force = trace.force[:, index] * (1.0 if tendon else -1.0)
        x, y = (np.asarray(line, dtype=float) for line in axes.lines[0].get_data())
        is_drawn((x, y), trace.displacement[:, index], factor * force)
        # a loop that dissipates runs clockwise: what it encloses is not negative
        work = np.trapezoid(force, trace.displacement[:, index])
        taken = trace.energy[-1, index] / (4.0 if tendon else 1.0)
        stored = trace.stored[-1, index] / (4.0 if tendon else 1.0)
        size = float(np.max(np.abs(force)) * np.max(np.abs(trace.displacement[:, index])))
        assert work == pytest.approx(taken + stored, abs=0.05 * size)
    axes = Figure().subplots()
    figures.energy(axes, equipped)
    energies(equipped, axes, *names)


def test_loops_of_storeys_that_yield():
    result = KINDS["yields"]()
    trace, above = result.trace, known(result.structure.superstructure)
    panels, F = drawn(loops_figure, result, "").axes, known(above.strengths)
    assert len(panels) == 2
    for i, axes in enumerate(panels):
        assert (
            axes.get_title() == f"storey {i + 1}, ductility {result.ductilities[i]:.3g}"
        )
        loop = curve(axes, "shear $f$ of springs")
        is_drawn(loop, 1e3 * trace.drifts[:, i], 1e-3 * trace.storey_shears[:, i])
        low, high = (np.asarray(line.get_ydata(), float) for line in axes.lines[:2])
        elastic = 1e3 * F[i] / above.stiffnesses[i]
        at = np.asarray(axes.lines[1].get_xdata(), float)
        assert float(np.interp(elastic, at, high)) == pytest.approx(
            1e-3 * F[i], rel=1e-12
        )
        assert low[::-1] == pytest.approx(-high, rel=1e-12)
        assert axes.get_ylabel() == ("storey shear $f$ [kN]" if i == 0 else "")
    with pytest.raises(UsageError, match="needs storeys that yield"):
        draw_loop(panels[0], KINDS["rolls"](), 1)
    with pytest.raises(UsageError, match="is none of the storeys; there are 1, 2"):
        draw_loop(panels[0], result, 3)
    assert shown_floors(7, MOST_STOREYS[True]) == [1, 2, 3, 4, 5, 6, 7]
    assert shown_floors(9, MOST_STOREYS[False]) == [*range(1, 10)]
    assert shown_floors(20, MOST_STOREYS[True])[::7] == [1, 20]


def test_moment(result):
    trace = result.trace
    axes = Figure().subplots()
    figures.moment_rotation(axes, result)
    factor = prefix(axes.get_ylabel(), "N m")
    names = legend(axes)
    driving, restoring = (
        "driving moment (ground and building)",
        "restoring moment of the weight",
    )
    swing = [name for name in names if name not in {driving, restoring}]
    assert {*names} - {*swing} == {driving, restoring}
    is_drawn(curve(axes, driving), trace.rotation, factor * trace.driving_moment)
    assert len(swing) == (result.max_rotation > 0.0)
    for name in swing:
        x, y = curve(axes, name)
        peak = int(np.nanargmax(np.abs(trace.rotation)))
        assert trace.rotation[peak] in x
        assert np.unique(np.sign(x[np.isfinite(x)])).size == 1
        first = trace.rotation.tolist().index(x[0])
        is_drawn(
            (x, y),
            *(
                v[first : first + len(x)]
                for v in (trace.rotation, factor * trace.driving_moment)
            ),
        )
        assert name.startswith(f"the largest swing, {trace.time[first]:.2f} to ")
        assert axes.texts  # arrows
    left = curve(axes, restoring)
    is_drawn(left, left[0], factor * result.restoring_moment(left[0]))
    assert left[0].min() == axes.get_xlim()[0] < -result.max_rotation


@pytest.mark.parametrize("kind", ["rolls", "overturns", "flat, one storey, no heights"])
def test_profiles(kind):
    result = KINDS[kind]()
    made, fixed = result.structure, result.fixed_base
    assert made.superstructure is not None
    assert fixed is not None
    heights, storeys = made.superstructure.storey_heights, made.storeys
    figure = drawn(profile_figure, result, "")
    shear, drift, acceleration = figure.axes
    factor = prefix(shear.get_xlabel(), "N")
    ratio = "storey drift [mm]" if heights is None else "storey drift ratio [%]"
    assert drift.get_xlabel() == ratio
    unit = 1e-3 if heights is None else heights * 1e-2
    for name, shears, drifts, accelerations in (
        (
            "on bearings",
            result.storey_shears,
            result.max_drifts,
            result.floor_accelerations,
        ),
        ("fixed base", fixed.storey_shears, fixed.drifts, fixed.floor_accelerations),
    ):
        values, edges, _ = steps(shear, name).get_data()
        is_drawn((values, edges), shears * factor, np.arange(storeys + 1))
        values, edges, _ = steps(drift, name).get_data()
        is_drawn((values, edges), drifts / unit, np.arange(storeys + 1))
        is_drawn(curve(acceleration, name), accelerations, np.arange(1, storeys + 1))
    pga, static = result.record.pga, made.static_base_shear * factor
    peak, level = f"PGA = {pga:.3g} m/s²", f"$V_{{st}}$ = {static:.4g} "
    assert curve(acceleration, peak)[0].tolist() == [pga] * 2
    *names, last = legend(figure)
    assert names == ["on bearings", "fixed base", peak]
    assert last.startswith(level)
    assert curve(shear, last)[0] == pytest.approx([static] * 2, rel=1e-13)


@pytest.mark.parametrize(("bearing", "storeys"), [(CURVED, 4), (FLAT, 1), (ROLLER, 0)])
def test_modes(bearing, storeys):
    result = modal(structure(bearing, storeys))
    states = {"rolling": result.rolling, "rocking": result.rocking}
    figure = drawn(modes_figure, result, "")
    columns = 1 + min(storeys, 3)
    levels = np.concatenate([[0.0], level_heights(result.structure)])
    rows = [modes for modes in states.values() if modes is not None]
    names = [name for name, modes in states.items() if modes is not None]
    panels = np.array(figure.axes).reshape(len(rows), columns)
    for name, modes, row in zip(names, rows, panels, strict=True):
        assert row[0].get_ylabel() == f"{name}\nheight [m]"
        for mode, axes in enumerate(row):
            shape = modes.shapes[:, mode]
            is_drawn(curve(axes, "uplifted"), [0.0, *shape], levels)
            if storeys:
                elastic = [0.0, *(shape[1:] - shape[0])]
                is_drawn(curve(axes, ELASTIC), elastic, levels[1:])
            if mode == 0:
                rate = modes.frequency_parameter
                words = f"{rate:#.3g} rad/s" if rate else "0 (neutral)"
                title = f"podium: $p_{{ext}}$ = {words}"
            else:
                title = (
                    f"mode {mode}: $\\omega$ = {modes.frequencies[mode - 1]:#.3g} rad/s"
                )
                assert result.fixed_base is not None
                fixed = [0.0, 0.0, *result.fixed_base.shapes[:, mode - 1]]
                is_drawn(curve(axes, "full contact"), fixed, levels)
            assert axes.get_title().replace("\n", " ") == title
    contact = ["full contact"] if storeys else []
    relative = [ELASTIC] if storeys else []
    assert {*legend(figure)} == {*contact, "uplifted", *relative}


@pytest.fixture
def pushed():
    return pushover(structure(CURVED, 3))


def test_storey_curve(pushed):
    found, beta = pushed.curve, pushed.structure.bearing.beta
    force, lift = drawn(storey_curve_figure, pushed, "").axes
    factor = prefix(force.get_ylabel(), "N")
    assert legend(force) == ["full contact", "rolling", "rocking"]
    for name, inside in (
        ("rolling", found.rotation <= beta),
        ("rocking", found.rotation >= beta),
    ):
        assert 1 < np.count_nonzero(inside) < len(inside)
        is_drawn(
            curve(force, name), found.displacement[inside], factor * found.force[inside]
        )
    is_drawn(curve(force, "full contact"), [0.0, 0.0], [0.0, factor * found.force[0]])
    x, y = (
        np.concatenate([np.asarray(line.get_data()[place], float) for line in lift.lines])
        for place in (0, 1)
    )
    at = np.unique(x)
    np.testing.assert_array_equal(at, found.displacement)
    np.testing.assert_allclose(
        y[np.unique(x, return_index=True)[1]], 1e3 * found.lift, rtol=1e-13
    )
    where = {text.get_text(): text.xy for text in force.texts}
    assert where["uplift"] == pytest.approx(
        (0.0, factor * pushed.uplift_force), rel=1e-13
    )
    end = where[f"$\\theta_{{cr}}$ = {pushed.critical_rotation:.3f} rad"]
    assert end == (pushed.critical_displacement, factor * found.force[-1])
    assert f"$\\beta$ = {beta:.3f} rad" in where
    ratio = second_axis(force)
    assert ratio.get_ylabel() == "$F/(W \\tan\\alpha)$ [-]"
    top = force.get_ylim()[1] / (factor * pushed.uplift_force)
    assert ratio.get_ylim()[1] == pytest.approx(top, rel=1e-12)


def test_capacity(pushed):
    figure = drawn(capacity_figure, pushed, "")
    whole, close = figure.axes
    factor = prefix(whole.get_ylabel(), "N")
    assert close.get_title() == "near uplift"
    # curves that lie upon each other are all seen
    widths = [line.get_linewidth() for line in whole.lines if line.get_marker() != "o"]
    assert widths == sorted(widths, reverse=True)
    assert len(set(widths)) == len(pushed.capacity)
    assert legend(figure) == ["uniform", "triangular", "first mode", "uplift"]
    marks = [line.get_data() for line in close.lines if line.get_marker() == "o"]
    for capacity, (at, force) in zip(pushed.capacity, marks[:-1], strict=True):
        name = capacity.pattern.replace("_", " ")
        for axes in (whole, close):
            shears = factor * capacity.sum_of_floor_forces
            is_drawn(curve(axes, name), capacity.roof_displacement, shears)
        assert at == [capacity.roof_displacement_at_uplift]
        assert force == [factor * pushed.uplift_force]
    uplift = max(c.roof_displacement_at_uplift for c in pushed.capacity)
    assert close.get_xlim() == (0.0, 3.0 * uplift)


def test_record():
    motion = load_record("pulse:sine?amplitude=0.3g&period=0.8")
    spectrum = response_spectrum(motion, np.linspace(0.1, 2.0, 20))
    figure = drawn(record_figure, motion, spectrum, None)
    *panels, right = figure.axes
    a, dt = motion.acceleration, motion.dt
    for axes, label, values in zip(
        panels,
        ("acceleration\n[m/s²]", "velocity\n[m/s]", "displacement\n[m]"),
        (a, measures.velocity(a, dt), measures.displacement(a, dt)),
        strict=True,
    ):
        assert axes.get_ylabel() == label
        is_drawn(curve(axes, "_child0"), motion.time, values)
        at = int(np.argmax(np.abs(values)))
        is_drawn(curve(axes, "_child1"), [motion.time[at]], [values[at]])
        peak = f"peak {abs(values[at]):.3g} at {motion.time[at]:.2f} s"
        peak += f", {motion.pga / 9.80665:.3g} g" * (axes is panels[0])
        assert axes.get_title(loc="right") == peak
    is_drawn(curve(right, "_child0"), spectrum.periods, spectrum.pseudo_acceleration)


@pytest.mark.parametrize("kind", KINDS)
def test_a_scene_is_true_to_scale_but_for_the_drifts(kind):
    result = KINDS[kind]()
    trace, storeys = result.trace, result.structure.storeys
    axes = Figure().subplots()
    scene = Scene(axes, result, "a title", 0.5)
    levels = level_heights(result.structure)
    for sample in (0, len(trace.time) // 2, len(trace.time) - 1):
        scene.show(sample)
        u, lift = trace.cap_beam_displacement[sample], trace.lift[sample]
        corners = scene.beam.get_xy()[:4]
        assert corners[:, 0].mean() == pytest.approx(u, abs=1e-12)
        assert corners[:, 1].min() == pytest.approx(levels[0] + lift, rel=1e-12)
        assert scene.clock.get_text() == f"t = {trace.time[sample]:.2f} s"
        assert len(scene.floors) == storeys
        for floor, line in enumerate(scene.floors):
            drift = trace.floor_displacements[sample, floor] - u
            x, y = line.get_data()
            middle = u + scene.magnification * drift
            assert np.asarray(x, float).mean() == pytest.approx(middle, abs=1e-12)
            height = levels[floor + 1] + lift + scene.thickness
            assert np.asarray(y).tolist() == pytest.approx([height, height], rel=1e-12)
    drifts = f"; storey drifts x {scene.magnification:g}" if storeys else ""
    assert axes.get_xlabel() == f"bearings to scale{drifts}; 2 times slower than real"
    # a metre is as high as it is wide
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert (high - low) / (right - left) == pytest.approx(
        axes.get_box_aspect(), rel=1e-12
    )


GIF = FilmRequest(Path("film.gif"))


@pytest.fixture
def filmed(monkeypatch):
    """Figures of which films were made."""
    found = []

    def sheet():
        found.append(made())
        return found[-1]

    made = style.sheet
    monkeypatch.setattr(style, "sheet", sheet)
    return found


def test_an_animation_runs_along_the_record(filmed):
    result = KINDS["rolls"]()
    trace, (samples, _) = result.trace, frame_plan(result, GIF)
    cursors = []
    contacts = []

    def progress(done, total):
        assert total == len(samples)
        _, end, record = filmed[0].axes
        cursors.append(float(np.asarray(record.lines[1].get_xdata())[0]))
        contacts.append(float(np.asarray(end.lines[1].get_xdata(), float)[0]))
        assert done == len(cursors)

    history_film(result, "a title", GIF, frame_plan(result, GIF), progress=progress)
    assert cursors == trace.time[samples].tolist()
    # the contact of the enlarged end wanders with the rotation
    bearing, rotation = result.structure.bearing, trace.rotation[samples]
    reach = bearing.half_width + bearing.radius * np.minimum(
        np.abs(rotation), bearing.beta
    )
    leaning = rotation != 0.0
    wanted = np.copysign(reach, rotation)[leaning]
    np.testing.assert_allclose(np.array(contacts)[leaning], wanted, rtol=1e-12)
    _, end, record = filmed[0].axes
    assert end.get_title() == "lower end of a column, enlarged"
    low, high = end.get_xlim()
    assert high - low < 4.0 * 0.3 * bearing.half_height  # less than twice its width
    is_drawn(curve(record, "x"), trace.time, trace.ground_acceleration)
    assert record.get_xlim() == (cursors[0], cursors[-1])


def test_mode_shapes_swing_there_and_back_and_the_rest_stays(filmed):
    """Curves and the frames themselves: between two of them only what moves has changed."""
    result = modal(structure(CURVED, 2))
    assert result.rolling is not None
    seen = []

    def progress(_done, _total):
        seen.append(np.array(curve(filmed[0].axes[0], "uplifted")[0]))

    made, frames = modes_film(result, "a title", GIF, progress=progress), []
    shape = np.array([0.0, *result.rolling.shapes[:, 0]])
    steps = np.cos(2.0 * np.pi * np.arange(len(seen)) / len(seen))
    assert len(seen) == 40
    np.testing.assert_allclose(seen, steps[:, None] * shape, atol=1e-12)
    with Image.open(io.BytesIO(made)) as film:
        for number in (0, 10, 20):
            film.seek(number)
            frames.append(np.asarray(film.convert("L"), dtype=int))
    moved = np.abs(frames[0] - frames[2]) > 60
    assert 0.002 < moved.mean() < 0.1
    assert not moved[: len(moved) // 25].any()  # the title
    assert (frames[0] < 200).mean() == pytest.approx((frames[2] < 200).mean(), abs=0.02)
