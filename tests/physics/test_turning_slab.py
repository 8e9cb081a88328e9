"""A slab that turns about the vertical (Theory, 17): its kernel against other roads."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms

from rpscli import (
    Bearing,
    GroundMotion,
    ModalDamping,
    MotionComponents,
    PodiumStructure,
    Superstructure,
    TimeHistorySettings,
    Twist,
    profile_stiffnesses,
    time_history,
)
from rpscli.analyses.kernels import twist as kernel
from rpscli.model.twisting import plan_of, unstable_from
from rpscli.physics.laws.head import head_of
from rpscli.physics.records import record_type
from rpscli.physics.twist.passes import pass_together
from rpscli.physics.twist.resting import load_share
from rpscli.physics.twist.run import twist_kernel
from rpscli.physics.twist.slab import place_at, solved
from rpscli.physics.twist.state import SAMPLES
from tests.oracles.turning_slab import TurningSlab, factor_of

FLAT = Bearing(1.5, 0.15, 0.15, 0.0)
CURVED = Bearing(1.5, 0.15, 0.30, 0.5)
ROLLING = Bearing(1.5, 0.15, 0.30, 1.5)
SQUARE = (-5.0, 5.0)


def podium(bearing=FLAT, storeys=0, rows=SQUARE, rows_y=SQUARE, mass=1e3, **given):
    count = len(rows) * len(rows_y)
    building = None
    floors = 0.0
    if storeys:
        masses = np.full(storeys, 30.0 * mass * count / storeys)
        stiffnesses = profile_stiffnesses(masses, 0.3, "sine")
        building = Superstructure(masses, stiffnesses, ModalDamping(0.05))
    else:
        floors = 30.0 * mass * count
    given = {"twist": Twist(), **given}
    beam = 10.0 * mass * count + floors
    return PodiumStructure(
        bearing, mass * count, beam, building, rows=rows, rows_y=rows_y, **given
    )


def released(structure, way, rate=(0.0, 0.0, 0.0), seconds=1.0, accuracy=4.0, **fields):
    """Ways, rates and energies at every 5 ms of a slab let go, without losses."""
    still = GroundMotion(np.zeros(round(seconds / 0.005) + 1), 0.005)
    motion = MotionComponents(still, y=still)
    settings = TimeHistorySettings(free_vibration=0.0, accuracy=accuracy)
    places = plan_of(structure)
    twist = structure.twist
    bearings = [
        kernel.scaled_bearing(structure.bearing, float(factor))
        for factor in twist.factors_of(len(places))
    ]
    columns = kernel.columns_of(structure, bearings, places, settings)
    modes, offset = kernel.modes_of(structure, twist, places)
    slab = kernel.slab_of(structure, twist, columns, places)
    kernel.fill_course(slab, structure, modes, motion, settings)
    slab["way"], slab["rate"] = way, rate
    for name, value in {
        "stands": 0,
        "bowl": 0.0,
        "contact_time": 0.0,
        "holds": 0.0,
    }.items():
        slab[name] = fields.get(name, value)
    for name, value in fields.items():
        slab[name] = value
    samples = np.zeros((int(slab["intervals"][0]) + 1, SAMPLES))
    dampers = kernel.dampers_of(structure)
    given = [each.view(np.recarray) for each in (slab, columns, modes, dampers)]
    twist_kernel()(*given, offset, np.zeros((2, still.npts)), samples)
    return samples, slab[0], columns


def of_slab(quantity, expected, found, within, authority, source):
    conforms("turning slabs", quantity, expected, found, within, authority, source)


def balance(samples):
    """Largest part of the energy that is not accounted for."""
    kept = samples[:, 6] + samples[:, 8:12].sum(axis=1) + samples[:, 17] - samples[:, 7]
    return np.abs(kept - kept[0]).max() / samples[:, 6].max()


FACTORS = (1.02, 0.99, 1.01, 0.98)


@pytest.mark.evidence("turning slabs", "program")
@pytest.mark.parametrize(
    ("way", "factors"),
    [
        ((0.25, 0.1, 0.01), ()),
        ((0.3, 0.02, 0.0), FACTORS),
        ((0.05, -0.2, -0.02), FACTORS),
    ],
)
def test_flat_columns_move_as_lagranges_equations_have_it(way, factors):
    """Before the first pass; differences leave some 1e-9 of an acceleration."""
    structure = podium(twist=Twist(factors=factors))
    gyration = kernel.gyration(plan_of(structure))
    slab = structure.cap_beam_mass / 4
    oracle = TurningSlab(
        plan_of(structure),
        0.15 * np.array(factors or (1.0,) * 4),
        R=1.5,
        mass=1e3,
        slab=slab,
        floors=0.0,
        inertia=structure.cap_beam_mass * gyration**2,
    )
    seconds = np.arange(0.0, 0.41, 0.1)
    found = released(structure, way, seconds=0.4)[0][::20, :3]
    expected = oracle.free(way, seconds)
    assert np.abs(expected[-1] - expected[0]).max() > 0.01
    of_slab(
        "ways of the slab [m, rad], free, unequal columns" if factors else
        "ways of the slab [m, rad], free", expected, found, 2e-8, "independent program",
        "Lagrange's equations of each column, differences, adaptive rule",
    )  # fmt: skip


@pytest.mark.evidence("turning slabs", "exact")
@pytest.mark.parametrize("bearing", [FLAT, CURVED])
def test_without_a_turn_it_is_the_podium_of_both_components(bearing):
    """Released tilted along x, equal columns: the other kernel, until it passes."""
    structure = podium(bearing, storeys=1)
    tilt = 0.08
    moved = float(structure.path(np.array(tilt))[1])
    samples, _, _ = released(structure, (moved, 0.0, 0.0), seconds=0.3)
    still = GroundMotion(np.zeros(61), 0.005)
    settings = TimeHistorySettings(
        initial_rotation=tilt, accuracy=4.0, free_vibration=0.0
    )
    plain = replace(structure, twist=None)
    other = time_history(plain, MotionComponents(still, y=still), settings)
    expected = other.trace.cap_beam_displacement[:61]
    of_slab(
        "displacement without a turn [m]", expected, samples[:61, 0], 1e-9 * moved,
        "identity", "the kernel of both components",
    )  # fmt: skip
    assert np.abs(samples[:, 1:3]).max() == 0.0


@pytest.mark.parametrize("bearing", [FLAT, CURVED, ROLLING])
@pytest.mark.parametrize("storeys", [0, 3])
def test_energy_closes_with_seats_friction_dampers_and_eccentric_storeys(
    bearing, storeys
):
    twist = Twist(
        factors=FACTORS, seats=0.005, pivot_friction=0.005, eccentricity=(0.05, -0.1)
    )
    structure = podium(bearing, storeys, twist=twist)
    way = (0.2, 0.08, 0.01)
    coarse = balance(released(structure, way, seconds=2.0, accuracy=1.0)[0])
    fine = balance(released(structure, way, seconds=2.0, accuracy=2.0)[0])
    assert coarse < 1e-6
    assert fine < max(0.2 * coarse, 1e-11)


def test_mirrored_turned_and_renumbered_it_is_the_same():
    structure = podium(CURVED, twist=Twist(factors=FACTORS))
    one = released(structure, (0.2, 0.08, 0.01))[0][:, :3]
    # Columns count row by row in x; mirrored in y the rows change places.
    mirrored = replace(structure, twist=Twist(factors=(1.01, 0.98, 1.02, 0.99)))
    other = released(mirrored, (0.2, -0.08, -0.01))[0][:, :3]
    np.testing.assert_allclose(other * (1.0, -1.0, -1.0), one, rtol=0, atol=1e-12)
    # By 90 degrees: (x, y) -> (-y, x).
    turned = replace(structure, twist=Twist(factors=(1.01, 1.02, 0.98, 0.99)))
    other = released(turned, (-0.08, 0.2, 0.01))[0][:, :3]
    back = np.stack([other[:, 1], -other[:, 0], other[:, 2]], axis=1)
    np.testing.assert_allclose(back, one, rtol=0, atol=1e-12)


@pytest.mark.evidence("turning slabs", "exact")
def test_a_small_turn_grows_by_the_energy_of_the_plan():
    """psi'' over psi of (17.12) with all inertia that turns; none below the threshold."""
    structure = podium()
    critical = float(structure.path(np.array(structure.critical_rotation))[1])
    ratio = unstable_from(structure)
    rates = {}
    for part in (ratio - 0.05, ratio + 0.05, 0.8):
        way = (part * critical, 0.0, 1e-6)
        samples = released(structure, way, seconds=0.02)[0]
        rates[part] = 2.0 * (samples[1, 2] / 1e-6 - 1.0) / 0.005**2
    below, above, far = rates.values()
    assert below < 0.0 < above < far
    force, moved, _ = structure.path(np.linspace(0.05, 0.15, 2001))
    slope = np.gradient(force, moved)
    u = 0.8 * critical
    held = np.interp(u, moved, force) / u + np.interp(u, moved, slope)
    inertia = structure.cap_beam_mass * kernel.gyration(plan_of(structure)) ** 2
    columns = 1e3 / 4.0 * (1.0 + 1.0 / 3.0) * 4 * 50.0  # of M less its points, some 1 %
    wanted = -25.0 * held / (inertia + columns)
    of_slab(
        "growth of a small turn [1/s2]", wanted, far, 0.02 * wanted,
        "identity", "second derivative of the energy of the plan (17.12)",
    )  # fmt: skip


def state_of(structure, settings=None):
    places = plan_of(structure)
    bearings = [structure.bearing] * len(places)
    settings = settings or TimeHistorySettings()
    columns = kernel.columns_of(structure, bearings, places, settings)
    slab = kernel.slab_of(structure, structure.twist, columns, places)
    return slab.view(np.recarray)[0], columns.view(np.recarray)


@pytest.mark.evidence("turning slabs", "exact")
@pytest.mark.parametrize("lever", [0.0, 0.3])
@pytest.mark.parametrize("load", [(1.0, 0.0, 2.0), (1.0, 1.0, 5.0), (0.3, -1.0, 4.0)])
@pytest.mark.parametrize("rows_y", [SQUARE, (-15.0, 15.0)])
def test_full_contact_holds_up_to_the_limit_surface(load, rows_y, lever):
    structure = podium(rows_y=rows_y, twist=Twist(pivot_friction=lever))
    s, columns = state_of(structure)
    share = load_share(s, columns, *load)
    weights = np.array(columns["weight"] * columns["tan_a"])
    scale = weights.sum()
    expected = factor_of(
        plan_of(structure), weights / scale, load, float(s.pivot) / scale
    )
    wanted = scale * expected
    of_slab(
        "push and torque that full contact holds", wanted, 1.0 / share, 1e-7 * wanted,
        "independent program", "limit surface of a sliding plate, by a search over centres",
    )  # fmt: skip


@pytest.mark.evidence("turning slabs", "exact")
def test_push_and_torque_alone():
    """Translation: the circle of (13.11). A turn about the centre: W tan(alpha) r."""
    structure = podium()
    s, columns = state_of(structure)
    W = structure.weight
    assert 1.0 / load_share(s, columns, 3.0, 4.0, 0.0) == pytest.approx(
        0.15 * W / 5.0, rel=1e-9
    )
    torque = 1.0 / load_share(s, columns, 0.0, 0.0, 1.0)
    wanted = 0.15 * W * math.hypot(5.0, 5.0)
    of_slab(
        "torque that full contact holds [N m]", wanted, torque, 1e-9 * wanted,
        "hand calculation", "W tan(alpha) r",
    )  # fmt: skip


@pytest.mark.evidence("turning slabs", "exact")
@pytest.mark.parametrize(
    ("count", "single"), [(2, 0.9192008194233525), (4, 0.9791229103442267)]
)
def test_a_pass_of_one_column_and_of_all_together(count, single):
    """Of the masses at upright: e of all is that of section 4, of one that of its own."""
    rows = tuple(np.linspace(-5.0, 5.0, count))
    masses = np.full(3, 10.0 * count**2 * 1e3)  # eta 3 over gamma 10
    building = Superstructure(masses, np.full(3, 1e9), ModalDamping(0.05))
    structure = PodiumStructure(
        FLAT,
        1e3 * count**2,
        1e4 * count**2,
        building,
        rows=rows,
        rows_y=rows,
        twist=Twist(),
    )
    s, columns = state_of(structure)
    # The plan of the reference reaches a metre beyond its outer columns.
    s.inertia += 1e4 * count**2 * ((2 * 12.0**2) - (2 * 10.0**2)) / 12.0
    s.stands = 0
    modes = np.zeros(0, record_type(kernel.MODE)).view(np.recarray)
    places = plan_of(structure)
    # Heads at upright move across their cones; others lean along x, near upright.
    along, across = (1e3 * mass for mass in masses_of_head(columns[0]))
    every = range(len(places))
    for passing, expected in ((every, structure.restitution), ((0,), single)):
        own = np.array([across if i in passing else along for i in every])
        x, y = places.T
        s.M[:] = (
            own.sum(), 0.0, across * len(own), -own @ y, across * x.sum(),
            s.inertia + own @ y**2 + across * (x @ x),
        )  # fmt: skip
        s.rate[:] = (-1.0, 0.0, 0.0)
        for i, column in enumerate(columns):
            column.w_x, column.w_y, column.passed = -1.0, 0.0, 0.0
            column.u_x, column.u_y = (0.0, 0.0) if i in passing else (-0.1, 0.0)
        pass_together(s, columns, modes)
        head = s.rate[0] - s.rate[2] * y[0]
        assert head / -1.0 == pytest.approx(expected, rel=1e-12)


def masses_of_head(column):
    """Masses of a head at upright along its displacement and across it, over m_c."""
    at = place_at(column, 0.0)
    law = head_of(at, column.diameter, 0.0, (1e-9, 0.0), (0.0, 1.0))
    return law.xx, law.yy


def test_solved_solves():
    M = np.array([[4.0, 1.0, 0.5], [1.0, 3.0, -0.2], [0.5, -0.2, 2.0]])
    push = np.array([1.0, -2.0, 0.3])
    found = solved((4.0, 1.0, 3.0, 0.5, -0.2, 2.0), tuple(push))
    np.testing.assert_allclose(M @ found, push, rtol=1e-14)


def test_places_and_loads_of_one_slenderness_hardly_turn():
    """Rows at uneven distances: nothing of first order turns the slab."""
    rows = (0.0, 3.0, 10.0)
    plain = podium(CURVED, rows=rows)
    seeds = podium(CURVED, rows=rows, twist=Twist(scatter=0.02))
    turns = [
        np.abs(released(of, (0.3, 0.05, 0.0), seconds=0.6)[0][:, 2]).max()
        for of in (plain, seeds)
    ]
    assert turns[0] < 5e-3 * turns[1]


def test_friction_in_pivoting_holds_a_turn_back():
    levers = {0.0: 0.0, 0.005: 0.0, 0.02: 0.0}
    for lever in levers:
        twist = Twist(scatter=0.02, pivot_friction=lever)
        samples, _, _ = released(
            podium(CURVED, twist=twist), (0.3, 0.05, 0.0), seconds=0.6
        )
        levers[lever] = np.abs(samples[:, 2]).max()
    free, some, much = levers.values()
    assert free > 1.3 * some
    assert much < 1e-4


def test_stiffer_seats_steady_three_columns_a_side():
    """A slab that cannot warp rests on those that lift most: a turn decays."""
    rows = (-5.0, 0.0, 5.0)
    turns = {}
    for seats in (None, 0.005, 0.0005):
        structure = podium(rows=rows, rows_y=rows, twist=Twist(seats=seats))
        samples, _, _ = released(structure, (0.3, 0.0, 0.01), seconds=0.8)
        turns[seats] = samples[-1, 2]
    assert turns[None] > turns[0.005] > turns[0.0005] > 0.0
