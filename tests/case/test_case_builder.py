"""What a case describes is what is built."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.case.case import parse_case
from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import CaseError
from rpscli.model.superstructure import ModalDamping, RayleighDamping, profile_stiffnesses

# Ratios of a few products of doubles.
ROUNDING = 1e-13


def test_the_building_of_ratios(building: str) -> None:
    case = parse_case(building, name="c.yaml")
    structure = case.structure
    assert structure is case.structure
    assert structure.cap_beam_mass == pytest.approx(2e5, rel=ROUNDING)
    assert structure.columns_mass == pytest.approx(2e4, rel=ROUNDING)
    assert (structure.gamma, structure.eta) == pytest.approx((10.0, 3.0), rel=ROUNDING)
    assert structure.gravity == STANDARD_GRAVITY
    assert structure.superstructure is not None
    assert structure.superstructure.periods[0] == pytest.approx(0.3, rel=1e-9)  # eigenvalues
    assert structure.superstructure.damping == RayleighDamping(0.05, (1, 2))
    assert structure.superstructure.storey_heights is not None
    assert structure.superstructure.storey_heights.tolist() == [3.0, 3.0, 3.0]


def test_lists_go_from_the_bottom(building: str) -> None:
    overrides = ["superstructure.storey_mass=[3 t, 2 t, 1 t]", "superstructure.profile=linear"]
    overrides += ["superstructure.damping={ratio: 0.02}"]
    floors = parse_case(building, name="c.yaml", overrides=overrides).structure.superstructure
    assert floors is not None
    assert floors.masses.tolist() == [3000.0, 2000.0, 1000.0]
    expected = profile_stiffnesses([3000.0, 2000.0, 1000.0], 0.3, "linear")
    assert floors.stiffnesses == pytest.approx(expected, rel=ROUNDING)
    assert floors.damping == ModalDamping(0.02)


def test_given_stiffnesses(building: str) -> None:
    text = building.replace("  period: 0.3\n  profile: sine", "  stiffness: [3 kN/mm, 2e6, 1e6]")
    floors = parse_case(text, name="c.yaml").structure.superstructure
    assert floors is not None
    assert floors.stiffnesses.tolist() == [3e6, 2e6, 1e6]


def test_sine_is_the_profile_of_a_period_alone(building: str) -> None:
    text = building.replace("  profile: sine\n", "")
    case = parse_case(text, name="c.yaml")
    assert case.document == parse_case(building, name="c.yaml").document


def test_one_storey_takes_two_modes(building: str) -> None:
    overrides = ["superstructure.storeys=1", "superstructure.damping.modes=[1, 2]"]
    floors = parse_case(building, name="c.yaml", overrides=overrides).structure.superstructure
    assert floors is not None
    assert floors.damping_ratios.tolist() == pytest.approx([0.05], rel=1e-9)


def test_masses_given_as_such(building: str) -> None:
    text = building.replace("cap_beam_mass_ratio: 10", "column_mass: 5 t\n  columns: 4")
    text = text.replace("superstructure_mass_ratio: 3", "cap_beam_mass: 150 t")
    structure = parse_case(text, name="c.yaml").structure
    assert (structure.columns_mass, structure.cap_beam_mass) == (2e4, 1.5e5)


@pytest.mark.parametrize(
    ("given", "columns", "beam"),
    [
        ("cap_beam_mass: 100 t\n  cap_beam_mass_ratio: 10", 1e4, 1e5),
        ("cap_beam_mass_ratio: 10\n  column_mass: 5 t\n  columns: 4", 2e4, 2e5),
        ("cap_beam_mass: 100 t\n  column_mass: 5 t\n  columns: 4", 2e4, 1e5),
        ("cap_beam_mass_ratio: 0\n  column_mass: 5 t", 5e3, 0.0),
        ("cap_beam_mass: 0\n  column_mass: 5 t\n  columns: 3", 1.5e4, 0.0),
    ],
)
def test_two_of_three_masses_make_a_frame(
    frame: str, given: str, columns: float, beam: float
) -> None:
    masses = "cap_beam_mass: 200 t\n  column_mass: 5 t\n  columns: 4"
    structure = parse_case(frame.replace(masses, given), name="c.yaml").structure
    assert (structure.columns_mass, structure.cap_beam_mass) == pytest.approx((columns, beam))
    assert structure.superstructure is None


def test_keys_of_an_absent_building_are_warned_of(building: str) -> None:
    overrides = ["superstructure.storeys=0", "podium.superstructure_mass_ratio=null"]
    overrides += ["podium.cap_beam_mass=200 t"]
    case = parse_case(building, name="c.yaml", overrides=overrides)
    assert case.structure.superstructure is None
    (warning,) = case.warnings
    assert "superstructure.storey_mass" in warning
    assert case.document["superstructure"] == {"storeys": 0}
    assert parse_case(building, name="c.yaml").warnings == ()


def test_dimensions_are_full_sizes(frame: str) -> None:
    bearing = parse_case(frame, name="c.yaml").structure.bearing
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
@settings(deadline=None)
def test_sizes_and_ratios_describe_one_column(
    slenderness: float, widening: float, rho: float, diagonal: float
) -> None:
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
    one = parse_case(f"{head}{ratios}".replace("'", ""), name="a").structure.bearing
    other = parse_case(f"{head}{{dimensions: {sizes}}}".replace("'", ""), name="b").structure
    for name in ratios:
        assert getattr(other.bearing, name) == pytest.approx(getattr(one, name), rel=ROUNDING)


def test_flat_ends_ignore_the_wedge(building: str) -> None:
    flat = ["podium.bearing.curvature_ratio=0"]
    for wedge in ("0.3", "0.01", "null"):
        overrides = [*flat, f"podium.bearing.wedge_slenderness={wedge}"]
        bearing = parse_case(building, name="c.yaml", overrides=overrides).structure.bearing
        assert bearing.is_flat
        assert bearing.critical_rotation == pytest.approx(math.atan(0.15), rel=1e-12)


def test_critical_curvature(building: str) -> None:
    overrides = ["podium.bearing.curvature_ratio=critical", "podium.bearing.slenderness=0.2"]
    case = parse_case(building, name="c.yaml", overrides=overrides)
    assert case.structure.bearing.curvature_ratio == pytest.approx(0.5 * (1 - 0.2 / 0.3))
    assert case.document["podium"]["bearing"]["curvature_ratio"] == "critical"


@pytest.mark.parametrize("written", ["{law: flexible}", "flexible"])
def test_a_law_may_stand_alone(building: str, written: str) -> None:
    text = building.replace("{law: rigid}", written)
    assert parse_case(text, name="c.yaml").structure.impact_law.kind == "flexible"


def test_measured_restitution(building: str) -> None:
    text = building.replace("{law: rigid}", "{law: value, restitution: 0.92, factor: 0.5, loss: 1}")
    assert parse_case(text, name="c.yaml").structure.restitution == pytest.approx(0.46)


def test_settings_of_the_analysis(building: str) -> None:
    case = parse_case(building, name="c.yaml")
    assert case.analysis.free_vibration is None
    assert case.analysis.max_events == 100_000
    overrides = ["analysis={free_vibration: 12 s, accuracy: 2, gravity: 981 cm/s2}"]
    case = parse_case(building, name="c.yaml", overrides=overrides)
    assert (case.analysis.free_vibration, case.analysis.accuracy) == (12.0, 2.0)
    assert case.structure.gravity == pytest.approx(9.81)


def test_what_only_the_model_refuses_is_placed(
    building: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refusing(*_: object) -> None:
        raise ValueError("no such column")

    monkeypatch.setattr("rpscli.case.case.structure_of", refusing)
    with pytest.raises(CaseError, match=r"c\.yaml:9:1: podium: no such column"):
        parse_case(building, name="c.yaml")
