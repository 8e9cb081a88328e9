"""Every kind of end, device and floor, in a plane and in space: lanes, mirror, energy, the end.

And what a change of side, of scale and of mass must not change.
"""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import (
    COMPILED,
    FLAT,
    ground,
    known,
    needs_compiled_kernels,
    podium,
    waves,
    yielding,
)
from two_components import followed, frame, pair, two_pulses

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.contact import Contact
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.records.ground_motion import MotionComponents

ARCS = {"tan_wedge": 0.3, "rho": 0.5}
SPHERICAL = {"tan_alpha": 0.0, "tan_wedge": 0.3, "rho": 0.8}
SOFT, EDGES = (Contact(kind, period_ratio=1.2) for kind in ("plane", "edges"))
W = frame(3, 3.0).weight
FRICTION, ROLLING = FrictionDamper(0.02 * W), RollingResistance(0.02)


def usual(*devices, **options):
    return frame(3, 3.0, contact_time=2e-3, devices=devices, **options)


def of_its_own(*, sprung, yields):
    """With floors on vertical springs, that yield, or both."""
    plain = usual(**ARCS)
    above = replace(known(plain.superstructure), vertical_period=0.1 if sprung else None)
    if yields:
        above = yielding(above, 1.3 * plain.static_base_shear)
    return replace(plain, superstructure=above)


KINDS = {
    "flat": usual(),
    "arcs": usual(**ARCS),
    "viscous": usual(ViscousDamper(0.2 * W, 0.5), **ARCS),
    "friction": usual(FRICTION, **ARCS),
    "stop": usual(Stop(0.05, 20.0 * W, 2.0 * W), **ARCS),
    "tendon": usual(Tendon(0.05 * W, 3.0 * W, 0.11 * W), **ARCS),
    "rolling": usual(ROLLING, **ARCS),
    "plane": usual(contact=SOFT, loss=0.3),
    "plane arcs, friction": usual(FRICTION, contact=SOFT, loss=0.3, **ARCS),
    "edges": usual(contact=EDGES),
    "edges arcs, stop": usual(
        Stop(0.02, 5.0 * W, 0.1 * W), ViscousDamper(0.1 * W), contact=EDGES, **ARCS
    ),
    "spherical": usual(**SPHERICAL),
    "spherical, friction": usual(FRICTION, ROLLING, **SPHERICAL),
    "springs": of_its_own(sprung=True, yields=False),
    "yields": of_its_own(sprung=False, yields=True),
    "both": of_its_own(sprung=True, yields=True),
}


def shaken(seed, *, pairs, sign=1.0):
    """Eight seconds that lift the columns, with a vertical motion."""
    x, y, up = (
        ground(factor * waves(8.0, 0.01, 3.0, seed + i).acceleration, 0.01)
        for i, factor in enumerate((sign, sign, 0.3))
    )
    return MotionComponents(x, y=y if pairs else None, vertical=up)


of_kinds = pytest.mark.parametrize("kind", KINDS)
in_planes = pytest.mark.parametrize("pairs", [False, True], ids=["plane", "pair"])
MIRRORED = (
    "max_theta", "storey_shear", "floor_acceleration", "heavy_top", "normal_top", "friction_top",
    "ductility", "yielded", "energy_input", "energy_damped", "energy_lost", "bed_energy",
    "device_energy", "device_force", "events",
)  # fmt: skip


@of_kinds
@needs_compiled_kernels
@in_planes
def test_mirrored_and_in_company(kind, pairs):
    """Bit for bit: a mirrored motion, and a history among others in lanes."""
    motions = [shaken(3 * seed, pairs=pairs) for seed in range(8)]
    motions[7] = shaken(12, pairs=pairs, sign=-1.0)  # of the fourth
    found = demands([DemandRequest(KINDS[kind], motion) for motion in motions])
    assert len({each.max_rotation for each in found}) > 2  # some overturn
    for i in (4, 7):
        (alone,) = demands([DemandRequest(KINDS[kind], motions[i])], worth_lanes=1000)
        assert alone.history.tobytes() == found[i].history.tobytes()
    one, other = found[4].history, found[7].history
    for name in MIRRORED:
        assert np.array_equal(one[name], other[name]), name
    assert np.array_equal(one["slip"], -other["slip"])


@of_kinds
@needs_compiled_kernels
@in_planes
@pytest.mark.evidence("steps, events, energy", "exact")
def test_energy_is_booked_whole(kind, pairs):
    """To the accuracy of the rule, and by its order better with half the step."""
    residuals = []
    for accuracy in (1.0, 2.0):
        settings = TimeHistorySettings(free_vibration=1.0, accuracy=accuracy)
        motion = shaken(5, pairs=pairs)
        result = time_history(KINDS[kind], motion, settings, with_fixed_base=False)
        residuals.append(abs(result.energy.residual / result.energy.input))
        assert result.history["max_theta"] > 0.01
    assert residuals[0] < 1e-6
    assert residuals[1] < max(residuals[0] / 20.0, 1e-9)


@of_kinds
@needs_compiled_kernels
def test_nothing_new_comes_after_the_end(kind):
    motion, structure = shaken(8, pairs=False), KINDS[kind]
    auto = time_history(structure, motion, with_fixed_base=False).history
    assert auto["time"] < 60.0
    long = TimeHistorySettings(free_vibration=auto["time"] + 60.0 - 8.0)
    longer = time_history(structure, motion, long, with_fixed_base=False).history
    for name in (
        "max_theta",
        "storey_shear",
        "floor_acceleration",
        "heavy_top",
        "normal_top",
    ):
        assert np.array_equal(auto[name], longer[name]), name
    assert np.array_equal(auto["slip"], longer["slip"])


X, Y = two_pulses()
FINE = TimeHistorySettings(free_vibration=0.0, accuracy=4.0)


@of_kinds
@needs_compiled_kernels
@pytest.mark.evidence("both components", "exact")
def test_one_component_is_the_planar_program(kind):
    """Along x nothing moves in y; rotations until it rests, what floors and devices saw."""
    structure, still = KINDS[kind], np.zeros(len(X))
    history = followed(structure, pair(X, still, 0.01), FINE)
    planar = sampled_history(structure, MotionComponents(ground(X, 0.01)), FINE)
    left, other = history.left, planar.history
    assert not history.samples.beam[:, 1].any()
    assert not left.storey_shear_y.any()
    # bounces are summed in a plane, and followed in space
    until = round(history.recontacts.time[0] / 0.01) if len(history.recontacts) else None
    gap = np.max(np.abs(history.tilt.real - planar.samples.theta)[:until])
    assert gap < (5e-9 if structure.bed or structure.passes_smoothly else 1e-7)
    for name in ("device_force", "device_energy", "permanent"):
        np.testing.assert_allclose(
            left[name], other[name], rtol=1e-4, atol=1e-12, err_msg=name
        )
    for name in ("energy_input", "energy_damped", "bed_energy", "max_theta"):
        assert left[name] == pytest.approx(other[name], rel=1e-5), name
    for mine in ("storey_shear", "storey_shear_x"):
        assert np.allclose(left[mine][:3], other.storey_shear[:3], rtol=1e-4)
    # of the instants of passes
    for name in ("normal_bottom", "heavy_bottom", "friction_top"):
        assert left[name] == pytest.approx(other[name], rel=0.05), name


@needs_compiled_kernels
@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize(
    "kind", [kind for kind in KINDS if kind not in ("yields", "both")]
)
def test_no_axis_is_special(kind):
    """Turned by any angle, the pair turns the result; storeys yield along both axes alone."""
    turn = np.exp(0.64j)
    turned = turn * (X + 1j * Y)
    one, other = (
        followed(KINDS[kind], pair(x, y, 0.01), FINE)
        for x, y in ((X, Y), (turned.real, turned.imag))
    )
    assert np.max(np.abs(turn * one.tilt - other.tilt)) < 1e-8 * one.left.max_theta
    for name in ("device_force", "device_velocity", "device_energy"):
        np.testing.assert_allclose(
            other.left[name], one.left[name], rtol=1e-5, atol=1e-12
        )
    for name in ("max_theta", "friction_bottom", "heavy_bottom", "torsion_lever"):
        assert other.left[name] == pytest.approx(one.left[name], rel=2e-3), name


SETTINGS = TimeHistorySettings(free_vibration=2.0)
RECORD = waves(6.0 if COMPILED else 1.6, 0.02, 4.0, seed=11)

STRUCTURES = [
    podium(0, 0.15, 0.5),
    podium(1, 0.15, FLAT),
    podium(3, 0.20, 0.26),
    podium(3, 0.15, 1.5, law=ImpactLaw("flexible")),
]


of_structures = pytest.mark.parametrize(
    "structure",
    STRUCTURES,
    ids=lambda s: f"{s.storeys}-{s.bearing.curvature_ratio}-{s.impact_law.kind}",
)


@pytest.mark.evidence("equation of motion", "exact")
@of_structures
@pytest.mark.parametrize("start", [0.0, 0.3])
def test_without_gravity_the_push_chooses_the_side(structure, start):
    """Both margins against uplift are negative at once."""
    sway = start + 0.4 * np.linspace(0.0, 1.0, 30) ** 2
    falling = ground(np.full(30, -1.3 * structure.gravity), 0.02)
    here, there = (
        time_history(structure, ground(side * sway, 0.02), SETTINGS, vertical=falling)
        for side in (1.0, -1.0)
    )
    assert here.events[0].kind == "uplift"
    assert here.events[0].time == 0.0
    assert here.trace.rotation[1] < 0.0 < there.trace.rotation[1]
    assert np.array_equal(here.trace.rotation, -there.trace.rotation)


def with_building(structure, mass, stiffness):
    """All masses times `mass`, all storey stiffnesses times `stiffness`."""
    above = structure.superstructure
    if above is not None:
        above = Superstructure(
            mass * above.masses, stiffness * above.stiffnesses, above.damping
        )
    columns, beam = mass * structure.columns_mass, mass * structure.cap_beam_mass
    return replace(
        structure, columns_mass=columns, cap_beam_mass=beam, superstructure=above
    )


@pytest.mark.evidence("equation of motion", "exact")
@of_structures
def test_lengths_times_l_and_times_times_root_l(structure):
    scale = 2.7
    bearing = replace(
        structure.bearing, semi_diagonal=scale * structure.bearing.semi_diagonal
    )
    large = replace(with_building(structure, 1.0, 1.0 / scale), bearing=bearing)
    root = np.sqrt(scale)
    slow = ground(RECORD.acceleration, root * RECORD.dt)
    settings = replace(SETTINGS, free_vibration=2.0 * root)
    one, two = (
        time_history(structure, RECORD, SETTINGS),
        time_history(large, slow, settings),
    )
    assert one.impacts == two.impacts > 0
    # equal but for rounding, which impacts amplify to about 1e4 eps
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.trace.drifts == pytest.approx(scale * one.trace.drifts, abs=1e-10)
    assert two.storey_shears == pytest.approx(one.storey_shears, rel=1e-9)
    assert two.floor_accelerations == pytest.approx(one.floor_accelerations, rel=1e-9)
    times = np.array([event.time for event in one.events])
    assert [event.time for event in two.events] == pytest.approx(root * times, rel=1e-8)


@pytest.mark.evidence("equation of motion", "exact")
@of_structures
def test_masses_and_stiffnesses_times_anything(structure):
    factor = 3.1
    heavy = with_building(structure, factor, factor)
    one, two = (
        time_history(structure, RECORD, SETTINGS),
        time_history(heavy, RECORD, SETTINGS),
    )
    assert one.impacts == two.impacts > 0
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.storey_shears == pytest.approx(factor * one.storey_shears, rel=1e-9)
    for name in ("input", "damped", "impact", "stored"):
        larger, smaller = getattr(two.energy, name), getattr(one.energy, name)
        assert larger == pytest.approx(factor * smaller, rel=1e-7)
    for name in ("friction_top", "friction_bottom", "normal_top", "normal_bottom"):
        assert two.history[name] == pytest.approx(one.history[name], rel=1e-8)


@pytest.mark.evidence("equation of motion", "exact")
@pytest.mark.evidence("vertical motion", "exact")
@of_structures
def test_a_constant_vertical_acceleration_is_a_change_of_gravity(structure):
    """Up to the last sample, after which the ground stands still."""
    settings = replace(SETTINGS, free_vibration=0.0)
    rising = ground(np.full(RECORD.npts, 1.5), RECORD.dt)
    heavier = replace(structure, gravity=structure.gravity + 1.5)
    one = time_history(structure, RECORD, settings, vertical=rising)
    two = time_history(heavier, RECORD, settings)
    assert one.impacts == two.impacts > 0
    assert two.trace.rotation == pytest.approx(one.trace.rotation, abs=1e-10)
    assert two.storey_shears == pytest.approx(one.storey_shears, rel=1e-9)
    assert two.friction_demand == pytest.approx(one.friction_demand, rel=1e-8)


@pytest.mark.evidence("equation of motion", "exact")
def test_a_rigid_building_moves_like_a_heavier_cap_beam():
    """As the periods shrink, the storey becomes the frame with gamma (1 + eta)."""
    frame = PodiumStructure(podium(0, 0.15, 0.5).bearing, 2e4, 2e5 * 3.0)
    assert frame.gamma == podium(2).gamma_total
    record = waves(1.0, 0.02, 4.0, seed=11)
    differences = []
    for period in (0.04, 0.02):
        above = known(podium(2).superstructure)
        above = replace(above, stiffnesses=above.stiffnesses * (0.2 / period) ** 2)
        stiff = time_history(podium(2, superstructure=above), record, SETTINGS)
        rigid = time_history(frame, record, SETTINGS)
        before_impact = int(rigid.events[1].time / record.dt)
        assert before_impact > 10
        gap = stiff.trace.rotation[:before_impact] - rigid.trace.rotation[:before_impact]
        differences.append(np.max(np.abs(gap)) / rigid.max_rotation)
    # drifts are of the size of a_g T^2/(4 pi^2)
    assert differences[0] < 0.05
    assert differences[1] == pytest.approx(differences[0] / 4.0, rel=0.5)


@pytest.mark.evidence("equation of motion", "exact")
def test_quiet_before_the_record_only_delays_the_history():
    structure = podium(3, 0.2, 0.5)
    later = ground(np.pad(RECORD.acceleration, (17, 0)), RECORD.dt)
    one, two = (time_history(structure, record, SETTINGS) for record in (RECORD, later))
    assert np.array_equal(one.trace.rotation, two.trace.rotation[17:])
    assert one.storey_shears.tolist() == two.storey_shears.tolist()
