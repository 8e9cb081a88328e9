"""Devices at rest against the second integrator's generalised forces and closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from conformance import conforms
from oracles.devices import Equipment
from oracles.storey_lagrangian import Contact, StoreyLagrangian
from paper_structures import (
    FLAT,
    known,
    needs_compiled_kernels,
    oracle_devices,
    oracle_system,
    podium,
)

from rpscli.analyses.modal import linearised_matrices, modal
from rpscli.analyses.pushover import pushover
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.bearing import Bearing, uplifted_state
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.podium import PodiumStructure
from rpscli.model.statics import (
    dead_band,
    device_consequences,
    restoring_force,
    returns,
    secant_period,
    uplift_force,
    wind_on,
)
from rpscli.records.ground_motion import GroundMotion

pytestmark = [
    pytest.mark.evidence("devices", "exact"),
    pytest.mark.evidence("devices", "program"),
]
EQUIPMENT = (
    FrictionDamper(1.2e5),
    RollingResistance(0.02),
    Stop(0.15, 2e6, 1e5),
    Stop(0.0, 3e4),
    Tendon(3e4, 5e5, 4e4),
    Tendon(1e4, 2e5),
    ViscousDamper(1e5, 0.5),
)


def equipped(rho, *devices, tan_alpha=0.15):
    return replace(podium(2, tan_alpha, rho), devices=devices, columns=6)


@pytest.mark.parametrize("rho", [FLAT, 0.26, 0.5, 1.5])
def test_both_branches_of_the_storey_curve(rho):
    structure = equipped(rho, *EQUIPMENT)
    curve = pushover(structure, points=50).curve
    motion = StoreyLagrangian(oracle_system(structure))
    end = structure.critical_rotation
    returning = Equipment(motion, oracle_devices(structure))
    returning.unload(end, rolling=end < motion.beta)
    assert max(returning.plastic) > 0.0
    wanted = []
    for x in curve.rotation:
        contact = Contact(1, rolling=bool(x < motion.beta))
        shift, slope, _ = motion.cap_beam(float(x), rolling=contact.rolling)
        weight = motion.lifted_mass * structure.gravity * slope.imag
        gear = Equipment(motion, oracle_devices(structure))
        gear.unload(float(x), rolling=contact.rolling)
        active, held = gear.at_rest(contact, float(x))
        out = (weight - active + held) / slope.real
        # on the way back tendons are longer by what they yielded; slack if nothing is left
        active, held = returning.at_rest(contact, float(x))
        back = (weight - active - held) / slope.real
        wanted.append((shift.real, out, back))
    moved, out, back = np.transpose(wanted)
    for name, expected, found, within in (
        ("u_b [m]", moved, curve.displacement, 1e-14),
        ("force, out [N]", out, curve.force, 1e-12 * np.abs(out)),
        ("force, back [N]", back, curve.unloading_force, 1e-11 * np.abs(back)),
    ):
        conforms(
            "devices", f"{name}, seven devices, {'flat' if rho == FLAT else f'rho {rho}'}",
            expected, found, within,
            "independent program", "second integrator's forces at rest",
        )  # fmt: skip


@pytest.mark.parametrize("rho", [FLAT, 0.5, 1.5])
def test_uplift_force_and_the_stiffness_after_it(rho):
    structure = equipped(rho, *EQUIPMENT)
    found = pushover(structure)
    bearing = structure.bearing
    tan, H = bearing.slenderness, bearing.half_height
    by_hand = (structure.weight + 6 * 4e4) * tan + 1.2e5 + structure.weight * 0.02 / H
    conforms(
        "devices", "uplift force with seven devices [N]", by_hand, found.uplift_force,
        1e-12 * by_hand, "hand calculation", "(W + 6 P) tan(alpha) + F_d + W f/H",
    )  # fmt: skip
    assert uplift_force(structure) == pytest.approx(by_hand, rel=1e-12)
    path = pushover(structure, points=20_001).curve
    slope = np.diff(path.force[:3]) / np.diff(path.displacement[:3])
    # extrapolated to zero: a parabola through three points, 1e-4 of the curve
    size = structure.weight / (2.0 * bearing.semi_diagonal)
    conforms(
        "devices", "stiffness after uplift [N/m]", 1.5 * slope[0] - 0.5 * slope[1],
        found.initial_stiffness, 1e-5 * size, "identity", "slope of the curve, extrapolated",
    )  # fmt: skip


def test_without_devices_the_way_back_is_the_way_out():
    curve = pushover(podium(2, 0.15, 0.4)).curve
    assert np.array_equal(curve.force, curve.unloading_force)


def test_a_slender_storey_recentres_below_its_constant_force():
    base = equipped(0.5, tan_alpha=1e-3)
    base = replace(base, bearing=replace(base.bearing, wedge_slenderness=0.5))
    constant = base.weight * 1e-3
    for share, comes_back in ((0.98, True), (1.01, False)):
        held = replace(base, devices=(FrictionDamper(share * constant),))
        found = returns(held)[0]
        assert found.recentres is comes_back
        # B = sin(alpha) cos(x), and C = cos(alpha) but for alpha x
        least = constant * math.cos(found.rotation)
        conforms(
            "devices", f"largest friction that recentres [N], share {share}", least,
            found.largest_friction, 1e-3 * least, "closed form", "W tan(alpha) cos(theta)",
        )  # fmt: skip
    lever = base.bearing.half_width
    assert returns(replace(base, devices=(RollingResistance(0.98 * lever),)))[0].recentres
    assert not returns(replace(base, devices=(RollingResistance(1.01 * lever),)))[
        0
    ].recentres


def by_hand(quantity, expected, found):
    conforms(
        "devices", quantity, expected, found, 1e-12 * expected,
        "hand calculation", "geometry of flat ends",
    )  # fmt: skip


def test_consequences_by_hand():
    structure = equipped(
        FLAT, Stop(0.1, 1e6), Tendon(3e4, 5e5, 4e4), ViscousDamper(4e4, 2.0)
    )
    stop, tendon, viscous = device_consequences(structure)["devices"]
    x, bearing = stop["met_rotation"], structure.bearing
    alpha, R = bearing.alpha, bearing.semi_diagonal
    by_hand(
        "displacement at which a stop is met [m]",
        0.1, 2.0 * R * (math.sin(alpha) - math.sin(alpha - x)),
    )  # fmt: skip
    assert stop["met_rotation_ratio"] == pytest.approx(x / structure.critical_rotation)
    stretch = 4.0 * bearing.half_width * math.sin(tendon["yield_rotation"] / 2.0)
    by_hand("elongation at which a tendon yields [m]", 1e4 / 5e5, stretch)
    share = tendon["uplift_share"]
    by_hand("share of tendons in the uplift force", 6 * 3e4 / structure.weight, share)
    plastic = (
        4.0 * bearing.half_width * math.sin(structure.critical_rotation / 2.0) - 0.02
    )
    left = max(0.0, 3e4 - 5e5 * plastic)
    assert tendon["prestress_after_critical"] == pytest.approx(left)
    speed = viscous["velocity_at_uplift_force"]
    by_hand(
        "force of a damper at its velocity [N]", structure.uplift_force, 4e4 * speed**2
    )
    far = equipped(FLAT, Stop(5.0, 1e6))
    assert device_consequences(far)["devices"][0]["met_rotation"] is None


@pytest.mark.parametrize("rolling", [True, False])
def test_linearised_tendons_are_the_slope_of_their_moment(rolling):
    structure = equipped(0.7, Tendon(3e4, 5e5), tan_alpha=1e-3)
    structure = replace(
        structure, bearing=replace(structure.bearing, wedge_slenderness=2e-3)
    )
    state = uplifted_state(structure.bearing, rolling=rolling, exact=False)
    bare = replace(structure, devices=())
    added = linearised_matrices(structure, state)[2][0, 0]
    added -= linearised_matrices(bare, state)[2][0, 0]
    motion = StoreyLagrangian(oracle_system(structure))
    gear = Equipment(motion, oracle_devices(structure))
    x = np.array([1e-5, 3e-5]) + (0.0 if rolling else motion.beta)
    contact = Contact(1, rolling=rolling)
    moments = [-gear.at_rest(contact, float(tilt))[0] for tilt in x]
    slope = (
        (moments[1] - moments[0])
        / (x[1] - x[0])
        / (2.0 * structure.bearing.semi_diagonal) ** 2
    )
    # first order in alpha, of which e is one itself: 1e-3 of what prestress and stiffness add
    size = 6 * (3e4 / structure.bearing.semi_diagonal + 5e5 * 1e-6)
    conforms(
        "devices", "stiffness of tendons to first order [N/m]", slope, added, 3e-3 * size,
        "independent program", "slope of the second integrator's moment",
    )  # fmt: skip


@pytest.mark.parametrize("c", [0.0, 2e5, 3e6])
@pytest.mark.parametrize("stiffness", [0.0, 3e7])
def test_the_own_mode_of_a_rigid_frame_with_damper_and_tendons(c, stiffness):
    devices = (FrictionDamper(1e4),)
    devices += (ViscousDamper(c),) if c else ()
    devices += (Tendon(0.0, stiffness),) if stiffness else ()
    structure = replace(podium(0, 0.15, 0.4), devices=devices, columns=6)
    result = modal(structure)
    for name, kappa, angle, modes in (
        ("rolling", -0.2, structure.bearing.alpha, result.rolling),
        ("rocking", -1.0, structure.bearing.alpha_wedge, result.rocking),
    ):
        assert modes is not None
        paper = known(modes.first_order)
        mass = structure.columns_mass / 3.0 + structure.cap_beam_mass
        spring = structure.weight * kappa / 3.0 + 6 * stiffness * angle**2
        roots = np.sort_complex(np.roots([mass, c, spring]))
        assert np.sort_complex(paper.eigenvalues) == pytest.approx(roots, rel=1e-10)
        product = math.sqrt(abs(roots[0] * roots[1]))
        conforms(
            "devices", f"p_ext [rad/s] with damper and tendons, {name}", product,
            paper.frequency_parameter, 1e-10 * product,
            "closed form", "roots of m z^2 + c z + k",
        )  # fmt: skip
        assert paper.frequency_parameter_rigid == pytest.approx(product, rel=1e-10)
    assert result.left_out[0] == "friction"


@pytest.mark.parametrize("c", [2e5, 5e6])
def test_a_damper_leaves_each_building_mode_a_pair(c):
    structure = equipped(0.4, ViscousDamper(c))
    for modes in modal(structure).uplifted.values():
        growing, partner = modes.eigenvalues[:2]
        assert growing.real > 0.0 > partner.real
        assert growing.imag == partner.imag == 0.0
        assert np.all(modes.damping > 0.0)


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.8])
def test_the_secant_period_of_flat_ends(ratio):
    """Of angles that are small u = 2 R theta and F = W (alpha - theta), whatever the masses are."""
    structure = equipped(FLAT, tan_alpha=0.02)
    rotation = ratio * structure.critical_rotation
    R, g = structure.bearing.semi_diagonal, structure.gravity
    wanted = 2.0 * math.pi * math.sqrt(2.0 * R / g * ratio / (1.0 - ratio))
    # cos(alpha) and the like: 0.02^2.
    conforms(
        "devices", "secant period [s], flat ends", wanted, secant_period(structure, rotation),
        1e-3 * wanted, "closed form", "2 pi sqrt(2 R/g x/(1 - x))",
    )  # fmt: skip
    # A spring of the secant stiffness beside it halves the square.
    stiffness = structure.restoring_mass * (2.0 * math.pi / wanted) ** 2
    held = replace(structure, devices=(Stop(0.0, stiffness),))
    conforms(
        "devices", "secant period [s], flat ends and a spring", wanted / math.sqrt(2.0),
        secant_period(held, rotation), 1e-3 * wanted, "closed form", "twice the stiffness",
    )  # fmt: skip


def test_wind_moves_what_neither_weight_nor_friction_holds():
    """100 t on flat ends of tan(alpha) = .03 resist 29.4 kN, and 20 kN of friction more."""
    bearing = Bearing(1.5, 0.03, 0.03, 0.0)
    structure = PodiumStructure(bearing, 2e4, 9e4, None, gravity=9.8, columns=4)
    weight = 9.8 * (9e4 + 0.5 * 2e4)  # a column is held at its ends: half of it counts
    assert wind_on(structure) is None
    for devices, held in ((), 0.0), ((FrictionDamper(2e4), ViscousDamper(1e6)), 2e4):
        most = 0.03 * weight + held
        for part, moves in (0.999, False), (1.001, True):
            seen = replace(structure, devices=devices, wind=part * most)
            wind = known(wind_on(seen))
            assert wind.moving_force == pytest.approx(most, rel=1e-12)
            assert wind.friction == pytest.approx(held, abs=1e-9)
            assert wind.ratio == pytest.approx(part, rel=1e-12)
            assert wind.moves is moves


def test_wind_moves_ends_without_a_flat_part_but_for_friction():
    free = replace(on_spheres(0.01), devices=(), wind=1.0)
    wind = known(wind_on(free))
    assert (wind.ratio, wind.moving_force, wind.moves) == (None, 0.0, True)
    held = known(wind_on(replace(on_spheres(0.01), wind=0.5e-2 * free.weight)))
    assert held.ratio == pytest.approx(0.5, rel=1e-12)
    assert not held.moves


@pytest.mark.parametrize("wind", [0.0, -1.0, math.nan, math.inf])
def test_wind_is_a_force(wind):
    with pytest.raises(ValueError, match="wind = "):
        replace(podium(2, 0.15, 0.5), wind=wind)


def on_spheres(friction):
    """A rigid storey on ends of 2 m radius."""
    bearing = Bearing(1.5, 0.0, 0.3, 2.0 / 3.0, 4.0 / 3.0)
    base = PodiumStructure(bearing, 2e4, 2e5, None, columns=4)
    return replace(base, devices=(FrictionDamper(friction * base.weight),))


@pytest.mark.parametrize("friction", [0.002, 0.01, 0.03])
def test_the_dead_band_of_ends_that_restore(friction):
    """F is K u_b but for some cosines as long as columns roll on arcs."""
    structure = on_spheres(friction)
    x = np.array([0.01])
    stiffness = float(restoring_force(structure, x)[0] / structure.path(x)[1][0])
    band = structure.devices[0].force / stiffness
    for number, found in enumerate(returns(structure)):
        conforms(
            "devices", f"dead band [m] of return {number + 1}", band, found.dead_band,
            5e-3 * band, "closed form", "F/K on arcs",
        )  # fmt: skip
        assert found.largest_friction == 0.0
        assert not found.recentres


@needs_compiled_kernels
@pytest.mark.parametrize("friction", [0.002, 0.01, 0.03])
def test_the_rest_after_the_last_swing_is_that_of_a_history(friction):
    structure = on_spheres(friction)
    for found in returns(structure)[:2]:
        settings = TimeHistorySettings(
            free_vibration=200.0, initial_rotation=found.rotation
        )
        still = GroundMotion(np.zeros(2), 0.01, "still", "still", "")
        history = time_history(structure, still, settings, with_fixed_base=False)
        angle = np.abs(history.trace.rotation[-1:])
        rest = float(structure.path(angle)[1][0])
        assert abs(found.rest) == pytest.approx(rest, rel=1e-3, abs=1e-5)
        assert abs(found.rest) <= found.dead_band


def test_friction_that_holds_everywhere_has_no_band():
    structure = on_spheres(0.5)
    assert dead_band(structure) is None
    for found in returns(structure):
        assert found.rest == pytest.approx(found.displacement)
    assert dead_band(equipped(FLAT, FrictionDamper(1e3))) == 0.0
