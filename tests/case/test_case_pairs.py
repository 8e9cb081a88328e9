"""Both horizontal components in a case: what is read, and what is refused."""

from __future__ import annotations

import math

import pytest

from rpscli.case.case import Case, parse_case
from rpscli.case.rules.plausibility import doubts_of_directions
from rpscli.errors import CaseError

PAIR = "{x: 'pulse:sine?amplitude=1&period=1', y: 'pulse:sine?amplitude=2&period=1', rotation: 30}"


def case_of(text: str, *overrides: str) -> Case:
    return parse_case(text, name="c.yaml", overrides=overrides)


def test_a_pair_of_sources(building: str) -> None:
    case = case_of(building, f"record={PAIR}")
    assert case.record is not None
    assert case.record.is_pair
    assert (case.record.source[-19:], case.record.rotation) == ("amplitude=1&period=1"[1:], 30.0)
    assert case.document["record"]["source"] == case.record.source
    again = case_of(str(case.document).replace("None", "null"))
    assert again.document == case.document
    radians = case_of(building, f"record={PAIR}", "record.rotation='0.5 rad'").record
    assert radians is not None
    assert radians.rotation == pytest.approx(math.degrees(0.5), rel=1e-15)


@pytest.mark.parametrize(
    ("record", "reason"),
    [
        ("{x: a.at2}", "record.y is missing"),
        ("{y: a.at2}", "record.source is missing"),
        ("{x: a.at2, source: b.at2, y: c.at2}", "both name the first component"),
        ("{source: 'a.at2?second=b.at2&both&angle=3'}", "angle= is one direction"),
        ("{source: a.at2, rotation: 3}", "record.rotation turns a pair"),
        ("{x: 'a.at2?second=b.at2&both', y: c.at2}", "record.x names a pair"),
        ("{x: c.at2, y: 'a.at2?second=b.at2&angle=3'}", "record.y names a pair"),
    ],
)
def test_pairs_that_cannot_be_meant(building: str, record: str, reason: str) -> None:
    with pytest.raises(CaseError, match=reason):
        case_of(building, f"record={record}")


def test_another_stiffness_in_y(building: str) -> None:
    structure = case_of(building, "superstructure.y={period: 0.5}").structure
    x, y = structure.superstructure, structure.superstructure_y
    assert x is not None
    assert y is not None
    assert y.periods[0] == pytest.approx(0.5, rel=1e-9)
    assert y.stiffnesses / x.stiffnesses == pytest.approx([0.36] * 3, rel=1e-12)
    assert (y.masses.tolist(), y.damping) == (x.masses.tolist(), x.damping)
    given = case_of(building, "superstructure.y={stiffness: [3e6, 2e6, 1e6]}").structure
    assert given.superstructure_y is not None
    assert given.superstructure_y.stiffnesses.tolist() == [3e6, 2e6, 1e6]
    for across, reason in (
        ("{profile: sine}", "superstructure.y has no stiffness"),
        ("{period: 1, stiffness: 2e6}", "superstructure.y.period both fix"),
        ("{stiffness: [1e6, 2e6]}", "superstructure.y.stiffness has 2 values"),
    ):
        with pytest.raises(CaseError, match=reason):
            case_of(building, f"superstructure.y={across}")


def test_contact_time_and_axial_inertia(building: str) -> None:
    keys = ("podium.impact.contact_time=5 ms", "podium.bearing.inertia_ratio_axial=0.02")
    structure = case_of(building, *keys).structure
    assert structure.impact_law.contact_time == 5e-3
    assert structure.bearing.inertia_ratio_axial == 0.02
    assert case_of(building).structure.impact_law.contact_time == 2e-3
    with pytest.raises(CaseError, match=r"contact_time = '30 ms' must be .* <= 0.02 s"):
        case_of(building, "podium.impact.contact_time=30 ms")


def test_what_both_components_bring_in(building: str) -> None:
    def told(*overrides: str, both: bool = True) -> str:
        structure = case_of(building, "podium.impact.law=flexible", *overrides).structure
        return "\n".join(map(str, doubts_of_directions(structure, both=both)))

    assert told() == told(both=False) == ""
    assert "lose nothing" in told("podium.impact.contact_time=0")
    assert "both components" in told("superstructure.y={period: 1}", both=False)
    free = "podium={bearing: {semi_diagonal: 1, slenderness: 0.2, curvature_ratio: 0},"
    free += " cap_beam_mass_ratio: 0, column_mass: 1 t, columns: 1}"
    assert "may roll away" in told("superstructure={storeys: 0}", free)
