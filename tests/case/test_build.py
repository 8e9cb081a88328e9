"""What a case describes is what is built: building, podium, devices, both directions, settings."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from model.test_device_statics import EQUIPMENT, equipped
from paper_structures import known

from rpscli.analyses.demand import demand
from rpscli.case.build import DEVICE_KEYS
from rpscli.case.case import load_case
from rpscli.case.plausibility import doubts_of_directions, doubts_of_motion
from rpscli.case.schema.case_file import DeviceSection
from rpscli.case.schema.keys import unit
from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import CaseError
from rpscli.model import devices
from rpscli.model.bearing import Bearing
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    ModalDamping,
    RayleighDamping,
    profile_stiffnesses,
)
from rpscli.records.ground_motion import GroundMotion, MotionComponents
from rpscli.records.loading import load_record
from rpscli.report.figures.bearing import DRAWN

from .conftest import BUILDING, EQUIPPED, FRAME, case_of

# Ratios of a few products of doubles.
ROUNDING = 1e-13
RIGID_FRAME = "cases/rigid_frame.yaml"


def built(*overrides, text=BUILDING):
    return case_of(*overrides, text=text).structure


def floors(*overrides, text=BUILDING):
    return known(built(*overrides, text=text).superstructure)


def test_the_building_of_ratios():
    structure = built()
    assert structure.cap_beam_mass == pytest.approx(2e5, rel=ROUNDING)
    assert structure.columns_mass == pytest.approx(2e4, rel=ROUNDING)
    assert (structure.gamma, structure.eta) == pytest.approx((10.0, 3.0), rel=ROUNDING)
    assert structure.gravity == STANDARD_GRAVITY
    assert floors().periods[0] == pytest.approx(0.3, rel=1e-9)  # eigenvalues
    assert floors().damping == RayleighDamping(0.05, (1, 2))
    assert floors().storey_heights == pytest.approx([3.0, 3.0, 3.0], abs=0.0)


def test_lists_go_from_the_bottom():
    masses = "superstructure.storey_mass=[3 t, 2 t, 1 t]"
    above = floors(
        masses, "superstructure.profile=linear", "superstructure.damping={ratio: 0.02}"
    )
    assert above.masses.tolist() == [3000.0, 2000.0, 1000.0]
    expected = profile_stiffnesses([3000.0, 2000.0, 1000.0], 0.3, "linear")
    assert above.stiffnesses == pytest.approx(expected, rel=ROUNDING)
    assert above.damping == ModalDamping(0.02)
    text = BUILDING.replace(
        "  period: 0.3\n  profile: sine", "  stiffness: [3 kN/mm, 2e6, 1e6]"
    )
    assert floors(text=text).stiffnesses.tolist() == [3e6, 2e6, 1e6]


@pytest.mark.parametrize(("old", "new"), [("  profile: sine\n", ""), ("200 t", "2.0e5")])
def test_two_ways_to_say_the_same(old, new):
    assert case_of(text=BUILDING.replace(old, new)).document == case_of().document


def test_one_storey_takes_two_modes():
    above = floors("superstructure.storeys=1", "superstructure.damping.modes=[1, 2]")
    assert above.damping_ratios.tolist() == pytest.approx([0.05], rel=1e-9)


def test_strengths_follow_a_ratio_or_are_given():
    """F_1 = ratio V_st, upwards as the shears of a first mode sin(pi i/6), in x and in y."""
    structure = built("superstructure.yield={ratio: 1.3}", "superstructure.y={profile: linear}",
                      "superstructure.y.period=0.4")  # fmt: skip
    height = np.arange(1, 4) / 3.0
    for above, shape in (
        (structure.superstructure, np.sin(0.5 * np.pi * height)),
        (structure.superstructure_y, height),
    ):
        shears = shape[::-1].cumsum()[::-1]
        wanted = 1.3 * 6e5 * STANDARD_GRAVITY * 0.15 * shears / shears[0]
        assert known(above).strengths == pytest.approx(wanted, rel=1e-9)
        assert known(above).hardening == 0.0
    given = floors("superstructure.yield={shears: [3 MN, 2e6, 1 MN], hardening: 0.05}")
    assert known(given.strengths).tolist() == [3e6, 2e6, 1e6]
    assert given.hardening == 0.05
    assert floors().strengths is None


def test_spherical_ends_have_no_ratio_of_strengths():
    round_ends = "podium.bearing.slenderness=0", "podium.bearing.curvature_ratio=0.6"
    with pytest.raises(
        CaseError, match=r"yield.ratio: columns without a flat part have no V_st"
    ):
        case_of(*round_ends, "superstructure.yield={ratio: 1.3}")
    assert case_of(
        *round_ends, "superstructure.yield={shears: 1 MN}"
    ).structure.superstructure


RATIOS = "cap_beam_mass_ratio: 10\n  superstructure_mass_ratio: 3"
MASSES = "cap_beam_mass: 200 t\n  column_mass: 5 t\n  columns: 4"


@pytest.mark.parametrize(
    ("text", "old", "given", "columns", "beam"),
    [
        (
            BUILDING,
            RATIOS,
            "column_mass: 5 t\n  columns: 4\n  cap_beam_mass: 150 t",
            2e4,
            1.5e5,
        ),
        (FRAME, MASSES, "cap_beam_mass: 100 t\n  cap_beam_mass_ratio: 10", 1e4, 1e5),
        (
            FRAME,
            MASSES,
            "cap_beam_mass_ratio: 10\n  column_mass: 5 t\n  columns: 4",
            2e4,
            2e5,
        ),
        (
            FRAME,
            MASSES,
            "cap_beam_mass: 100 t\n  column_mass: 5 t\n  columns: 4",
            2e4,
            1e5,
        ),
        (FRAME, MASSES, "cap_beam_mass_ratio: 0\n  column_mass: 5 t", 5e3, 0.0),
        (FRAME, MASSES, "cap_beam_mass: 0\n  column_mass: 5 t\n  columns: 3", 1.5e4, 0.0),
    ],
)
def test_masses_in_every_way(text, old, given, columns, beam):
    assert old in text
    structure = built(text=text.replace(old, given))
    assert (structure.columns_mass, structure.cap_beam_mass) == pytest.approx(
        (columns, beam)
    )
    assert (structure.superstructure is None) == (text == FRAME)


def test_keys_of_an_absent_building_are_warned_of():
    without = ["superstructure.storeys=0", "podium.superstructure_mass_ratio=null"]
    case = case_of(*without, "podium.cap_beam_mass=200 t")
    assert case.structure.superstructure is None
    (warning,) = case.warnings
    assert "superstructure.storey_mass" in warning
    assert case.document["superstructure"] == {"storeys": 0}
    assert case_of().warnings == ()


def test_dimensions_are_full_sizes():
    bearing = built(text=FRAME).bearing
    assert bearing.half_height == pytest.approx(1.5, rel=ROUNDING)
    assert bearing.half_width == pytest.approx(0.2, rel=ROUNDING)
    assert bearing.radius == pytest.approx(1.2, rel=ROUNDING)
    assert bearing.wedge_slenderness == pytest.approx(0.3, rel=ROUNDING)
    assert bearing.inertia_ratio == 4.0 / 3.0


@given(
    slenderness=st.floats(0.02, 0.5),
    widening=st.floats(1.0, 2.0),
    rho=st.floats(0.5, 3.0),
    diagonal=st.floats(0.1, 10.0),
)
def test_sizes_and_ratios_describe_one_column(slenderness, widening, rho, diagonal):
    podium = "cap_beam_mass: 2 t\n  cap_beam_mass_ratio: 1\n"
    head = "rps: 1\nsuperstructure: {storeys: 0}\npodium:\n  " + podium + "  bearing: "
    wedge = slenderness * widening
    ratios = {
        "semi_diagonal": diagonal,
        "slenderness": slenderness,
        "wedge_slenderness": wedge,
        "curvature_ratio": rho,
    }
    height = 2.0 * diagonal / math.hypot(1.0, slenderness)
    sizes = {
        "height": height,
        "width": slenderness * height,
        # The quotient of rounded products may fall below the slenderness when both are equal.
        "wedge_width": max(wedge * height, slenderness * height),
        "radius": rho * height,
    }
    one = built(text=f"{head}{ratios}".replace("'", "")).bearing
    other = built(text=f"{head}{{dimensions: {sizes}}}".replace("'", "")).bearing
    for name in ratios:
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=ROUNDING)


@pytest.mark.parametrize("wedge", ["0.3", "0.01", "null"])
def test_flat_ends_ignore_the_wedge(wedge):
    flat = "podium.bearing.curvature_ratio=0"
    bearing = built(flat, f"podium.bearing.wedge_slenderness={wedge}").bearing
    assert bearing.is_flat
    assert bearing.critical_rotation == pytest.approx(math.atan(0.15), rel=1e-12)


def test_critical_curvature_and_spherical_ends():
    case = case_of(
        "podium.bearing.curvature_ratio=critical", "podium.bearing.slenderness=0.2"
    )
    assert case.structure.bearing.curvature_ratio == pytest.approx(0.5 * (1 - 0.2 / 0.3))
    assert case.document["podium"]["bearing"]["curvature_ratio"] == "critical"
    for slenderness, rho in ((0, 0.7), (0.01, 0.5)):
        shape = (f"slenderness={slenderness}", f"curvature_ratio={rho}")
        bearing = built(*(f"podium.bearing.{value}" for value in shape)).bearing
        assert bearing.is_spherical == (slenderness == 0)


def test_impact_laws():
    for written in ("{law: flexible}", "flexible"):
        assert built(f"podium.impact={written}").impact_law.kind == "flexible"
    value = "podium.impact={law: value, restitution: 0.92, factor: 0.5, loss: 1}"
    assert built(value).restitution == pytest.approx(0.46)
    given = ("podium.impact.contact_time=5 ms", "podium.bearing.inertia_ratio_axial=0.02")
    assert built(*given).impact_law.contact_time == 5e-3
    assert built(*given).bearing.inertia_ratio_axial == 0.02
    assert built().impact_law.contact_time == 2e-3


def test_every_kind_of_device():
    case = case_of(text=EQUIPPED)
    assert case.structure.columns == 4
    assert case.structure.devices == (
        devices.ViscousDamper(2e6, 0.5),
        devices.FrictionDamper(4e5),
        devices.Stop(0.2, 5e7, 1e5),
        devices.Tendon(1e5, 2e7, 3e5),
        devices.RollingResistance(2e-3),
    )
    assert built(text=str(case.document)).devices == case.structure.devices
    short = EQUIPPED.replace(", exponent: 0.5", "").replace(", yield_force: 300 kN", "")
    viscous, _, _, tendon, _ = built(text=short).devices
    assert viscous == devices.ViscousDamper(2e6, 1.0)
    assert tendon == devices.Tendon(1e5, 2e7, math.inf)
    assert built().devices == ()
    assert "devices" not in case_of().document["podium"]


def test_a_value_of_a_device_may_vary():
    changed = built("podium.devices.1.force=0.5 MN", text=EQUIPPED)
    assert changed.devices[1] == devices.FrictionDamper(5e5)
    assert built("podium.devices=[]", text=EQUIPPED).devices == ()
    assert unit("podium.devices.1.force") == "N"
    assert unit("podium.devices.0.coefficient") == "N s/m"
    with pytest.raises(CaseError, match=r"podium\.devices has 5 values, counted from 0"):
        built("podium.devices.5.force=1", text=EQUIPPED)


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("viscous", (0.0, 1.0)), ("viscous", (1.0, 0.1)), ("friction", (math.inf,)),
        ("stop", (-0.1, 1.0, 0.0)), ("stop", (0.1, 0.0, 0.0)), ("tendon", (2.0, 1.0, 1.0)),
        ("tendon", (-1.0, 1.0, 1.0)), ("rolling_resistance", (0.0,)),
    ],
)  # fmt: skip
def test_the_model_refuses_devices_too(kind, values):
    with pytest.raises(ValueError, match="must be"):
        devices.DEVICES[kind](*values)


PAIR = "{x: 'pulse:sine?amplitude=1&period=1', y: 'pulse:sine?amplitude=2&period=1', rotation: 30}"


def test_a_pair_of_sources():
    case = case_of(f"record={PAIR}")
    assert case.record is not None
    assert (case.record.source[-19:], case.record.rotation) == (
        "mplitude=1&period=1",
        30.0,
    )
    assert case.document["record"]["source"] == case.record.source
    again = case_of(text=str(case.document).replace("None", "null"))
    assert again.document == case.document
    radians = known(case_of(f"record={PAIR}", "record.rotation='0.5 rad'").record)
    assert radians.rotation == pytest.approx(math.degrees(0.5), rel=1e-15)


def test_another_stiffness_in_y():
    structure = built("superstructure.y={period: 0.5}")
    x, y = known(structure.superstructure), known(structure.superstructure_y)
    assert y.periods[0] == pytest.approx(0.5, rel=1e-9)
    assert y.stiffnesses / x.stiffnesses == pytest.approx([0.36] * 3, rel=1e-12)
    assert (y.masses.tolist(), y.damping) == (x.masses.tolist(), x.damping)
    given = known(built("superstructure.y={stiffness: [3e6, 2e6, 1e6]}").superstructure_y)
    assert given.stiffnesses.tolist() == [3e6, 2e6, 1e6]


def test_what_both_components_bring_in():
    def told(*overrides, both=True):
        structure = built("podium.impact.law=flexible", *overrides)
        return "\n".join(map(str, doubts_of_directions(structure, both=both)))

    assert told() == told(both=False) == ""
    assert "lose nothing" in told("podium.impact.contact_time=0")
    assert "both components" in told("superstructure.y={period: 1}", both=False)
    free = "podium={bearing: {semi_diagonal: 1, slenderness: 0.2, curvature_ratio: 0},"
    free += " cap_beam_mass_ratio: 0, column_mass: 1 t, columns: 1}"
    assert "may roll away" in told("superstructure={storeys: 0}", free)


def test_settings_of_the_analysis():
    case = case_of()
    assert case.analysis.free_vibration is None
    assert case.analysis.max_events == 100_000
    case = case_of("analysis={free_vibration: 12 s, accuracy: 2, gravity: 981 cm/s2}")
    assert (case.analysis.free_vibration, case.analysis.accuracy) == (12.0, 2.0)
    assert case.structure.gravity == pytest.approx(9.81)
    case = load_case(RIGID_FRAME, ["analysis.initial_rotation=-0.05"])
    assert case.analysis.initial_rotation == -0.05


def test_a_rotation_beyond_the_overturning_limit_is_refused():
    case = load_case(RIGID_FRAME)
    limit = case.analysis.overturning_limit * case.structure.critical_rotation
    load_case(RIGID_FRAME, [f"analysis.initial_rotation={limit * (1 - 1e-9)!r}"])
    with pytest.raises(
        CaseError, match=r"initial_rotation = .* must stay below .* use a smaller"
    ):
        load_case(RIGID_FRAME, [f"analysis.initial_rotation={limit!r}"])


def test_an_overturning_limit_beyond_the_end_of_the_model_is_refused():
    bearing = load_case(RIGID_FRAME).structure.bearing
    most = bearing.largest_rotation / bearing.critical_rotation
    load_case(RIGID_FRAME, [f"analysis.overturning_limit={most * (1 - 1e-9)!r}"])
    said = r"overturning_limit = .* must not exceed .* use at most"
    with pytest.raises(CaseError, match=said) as refusal:
        load_case(RIGID_FRAME, [f"analysis.overturning_limit={most * (1 + 1e-9)!r}"])
    remedy = str(refusal.value).rpartition(" ")[2]
    load_case(RIGID_FRAME, [f"analysis.overturning_limit={remedy}"])
    # Half a circle of arc, and more than that: theta_cr itself is beyond 90 degrees.
    column = ["slenderness=0.9", "wedge_slenderness=3.0", "curvature_ratio=1.06"]
    stout = [f"podium.bearing.{value}" for value in column]
    law = "podium.impact={law: value, restitution: 0.5}"
    with pytest.raises(CaseError, match=r"overturning_limit = 2 .* use at most 1\."):
        load_case(RIGID_FRAME, [*stout, law])


def test_what_counts_as_overturned_is_the_lesser_of_what_the_case_names():
    structure = load_case(RIGID_FRAME).structure
    at_the_moat = structure.bearing.rotation_at(0.1) / structure.critical_rotation
    named = [
        ({}, 2.0),
        ({"displacement": "100 m"}, 2.0),
        ({"displacement": "0.1", "limit": "1.5"}, at_the_moat),
    ]
    for values, limit in named:
        overrides = [
            f"analysis.overturning_{name}={value}" for name, value in values.items()
        ]
        settings = load_case(RIGID_FRAME, overrides).analysis
        assert settings.overturning_limit == pytest.approx(limit, rel=1e-12)
    moat = "analysis.overturning_displacement=0.1"
    with pytest.raises(CaseError, match=r"must stay below the overturning limit, 0\."):
        load_case(RIGID_FRAME, [moat, "analysis.initial_rotation=0.5"])


@pytest.mark.parametrize("displacement", [1e-6, 0.05, 0.4])
def test_a_flat_column_moves_its_top_as_its_diagonal_turns(displacement):
    """The far corner is 2R away under alpha: u_b = 2R (sin(alpha) - sin(alpha - theta))."""
    bearing = Bearing(1.5, 0.15, 0.15, 0.0)
    alpha = math.atan(0.15)
    exact = alpha - math.asin(math.sin(alpha) - displacement / 3.0)
    assert bearing.rotation_at(displacement) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(("share", "overturns"), [(0.99, True), (1.01, False)])
def test_a_moat_counts_as_overturning(share, overturns):
    record = load_record("pulse:sine?amplitude=0.3g&period=0.8")
    free = load_case(RIGID_FRAME)
    reached = demand(free.structure, record, free.analysis).max_cap_beam_displacement
    moat = load_case(
        RIGID_FRAME, [f"analysis.overturning_displacement={share * reached!r}"]
    )
    assert demand(moat.structure, record, moat.analysis).overturned == overturns


@pytest.mark.parametrize("device", EQUIPMENT, ids=repr)
def test_bounds_cover_the_stiffness_at_rest(device):
    structure = equipped(0.5, device)
    x = np.linspace(0.0, structure.critical_rotation, 2001)
    force = np.broadcast_to(device.at_rest(structure, x, 0.0).restoring, x.shape)
    slope = np.diff(force) / np.diff(structure.path(x)[1])
    tension = 0.0
    if isinstance(device, devices.Tendon):
        most = device.prestress + device.stiffness * device.stroke(structure, x).max()
        tension = 6.0 * min(most, device.yield_force)
    curvature = tension / structure.bearing.half_height  # what a constant tension adds
    assert np.max(slope) <= device.bounds(structure)[0] * (1.0 + 1e-9) + curvature


@pytest.mark.parametrize("name", devices.DEVICES)
def test_a_law_can_be_written_and_drawn(name):
    assert DRAWN.keys() == {*devices.DEVICES.values(), devices.OwnDamper}
    needed, optional = DEVICE_KEYS[name]
    assert {*needed, *optional} == {field.name for field in fields(devices.DEVICES[name])}
    assert {*needed, *optional} <= set(DeviceSection.model_fields)


def test_a_pair_whose_component_is_zero_is_told():
    """It rattles by another rule; on ends that roll smoothly there is none."""
    still = GroundMotion(np.zeros(100), 0.01)
    moved = GroundMotion(np.sin(np.arange(100.0)), 0.01)
    flat = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
    round_ends = PodiumStructure(Bearing(1.5, 0.0, 0.3, 1.0), 4e4, 4e5)

    def told(structure, x, y):
        pair = MotionComponents(x, y=y)
        return any("is zero" in str(each) for each in doubts_of_motion(structure, pair))

    assert told(flat, moved, still)
    assert told(flat, still, moved)
    assert not told(flat, moved, moved)
    assert not told(flat, moved, None)
    assert not told(round_ends, moved, still)
