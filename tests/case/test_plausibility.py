"""What is possible but hardly meant: warnings with numbers by hand."""

import pytest

from rpscli.case.plausibility import Doubt, doubts_of_many

from .conftest import case_of

CASE = """\
rps: 1
superstructure:
  storeys: 3
  storey_mass: [200 t, 200 t, 240 t]
  storey_height: 3.0
  stiffness: [850 kN/mm, 600 kN/mm, 400 kN/mm]
  damping: {ratio: 0.05}
podium:
  bearing:
    dimensions: {height: 2 m, width: 300 mm, wedge_width: 500 mm, radius: 800 mm}
  cap_beam_mass_ratio: 10
  superstructure_mass_ratio: 3
"""


def doubts(old="", new=""):
    assert old in CASE
    return list(case_of(text=CASE.replace(old, new)).warnings)


SLIPS = [
    # R = sqrt(1000^2 + 150^2) = 1011 m: dimensions of millimetres without a unit
    ("height: 2 m, width: 300 mm, wedge_width: 500 mm, radius: 800 mm",
     "height: 2000, width: 300, wedge_width: 500, radius: 800",
     ["2H = 2000 m is unusual: 0.3 to 10 m is", "R = 1011 m is unusual"]),
    # tonnes forgotten: 240 t beside 240 kg
    ("240 t", "240", ["storey 2 has 2e+05 kg, storey 3 240 kg"]),
    # tonnes forgotten in the columns
    ("cap_beam_mass_ratio: 10", "column_mass: 3\n  columns: 4", ["a column = 0.003 t is unusual"]),
    # tonnes forgotten in all storeys: T1 is too short as well
    ("[200 t, 200 t, 240 t]", "[200, 200, 240]",
     ["mean mass of a storey = 0.2133 t is unusual", "T1 = 0.0"]),
    ("400 kN/mm", "29 kN/mm", ["storey 2 has 6e+08 N/m, storey 3 2.9e+07 N/m"]),
    # 240 t g 0.15 over 30 kN/mm is 11.8 mm of 0.5 m
    ("400 kN/mm]\n", "30 kN/mm]\n", []),
    ("storey_height: 3.0", "storey_height: 0.03", ["by 0.03692 of its height (storey 1"]),
    # V_st/(M_tot g) = tan(alpha) = 0.9/2; flexible impacts on it hardly rebound
    ("width: 300 mm, wedge_width: 500 mm", "width: 900 mm, wedge_width: 1 m",
     ["is 0.45 of the building's weight", "e = 0.1189 is unusual", "= 0.45 is above 0.25"]),
    ("  cap_beam_mass_ratio",
     "  impact: {law: value, restitution: 0.4}\n  cap_beam_mass_ratio",
     ["e = 0.4 is unusual: 0.5 to 1 is"]),
    ("  damping", "  vertical_period: 10 s\n  damping",
     ["superstructure.vertical_period = 10 s is unusual: 0.01 to 1 s is"]),
    # V_st = 640 t g tan(alpha); of the second storey 440 t
    ("  damping", "  yield: {shears: [300 kN, 2 MN, 2 MN]}\n  damping",
     ["yield before columns lift, at 0.3187 of their shear at uplift (storey 1)"]),
    ("  cap_beam_mass_ratio", "  friction: 5\n  cap_beam_mass_ratio", ["friction = 5 is"]),
    # W = 640 t (1 + 1/3 + 1/60) g = 8.473 MN, and tan(alpha) = 0.15
    ("  cap_beam_mass_ratio", "  wind: 1.2 MN\n  cap_beam_mass_ratio", []),
    ("  cap_beam_mass_ratio", "  wind: 1.5 MN\n  cap_beam_mass_ratio",
     ["podium.wind is 1.18 times the force that moves the cap beam (1500 kN over 1271 kN)"]),
    # 874.7 t on four columns: p_0^2 = N E*/(pi L r) of (16.4), with E* = E/1.92
    ("  cap_beam_mass_ratio",
     "  columns: 4\n  column: {section: square, edge_length: 0.4, modulus: 30 GPa,"  # noqa: ISC004
     " poisson: 0.2, contact_strength: 100 MPa}\n  cap_beam_mass_ratio",
     ["1.826 times contact_strength (182.6 MPa over 100 MPa)"]),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "told"), SLIPS)
def test_slips_are_told_with_their_number(old, new, told):
    assert doubts() == []
    found = doubts(old, new)
    assert len(found) == len(told), found
    for part in told:
        assert any(part in text for text in found), found


def test_the_first_period_is_looked_at():
    """One storey of 200 t on 900 N/m: T1 = 2 pi sqrt(200000/900) = 93.66 s."""
    text = CASE.replace("storeys: 3", "storeys: 1").replace(
        "[200 t, 200 t, 240 t]", "200 t"
    )
    text = text.replace("[850 kN/mm, 600 kN/mm, 400 kN/mm]", "900").replace(
        "  storey_height: 3.0\n", ""
    )
    (doubt,) = case_of(text=text).warnings
    assert "T1 = 93.66 s is unusual: 0.02 to 5 s is" in doubt


DESIGNED = (
    "  columns: 36\n  column: {section: square, edge_length: 0.4, modulus: 210 GPa,"
    " poisson: 0.3, contact_strength: 940 MPa}\n  cap_beam_mass_ratio"
)


@pytest.mark.parametrize(
    ("width", "ends", "asked"),
    [
        ("0", "", True),
        ("0", "ends: cylindrical\n    ", False),
        ("300 mm", "", False),
    ],
)
def test_square_columns_without_a_flat_part_are_asked_for_their_ends(width, ends, asked):
    text = CASE.replace("  cap_beam_mass_ratio", DESIGNED)
    text = text.replace("width: 300 mm", f"width: {width}")
    text = text.replace("radius: 800 mm", "radius: 2 m")
    text = text.replace("    dimensions:", f"    {ends}dimensions:")
    found = [each for each in case_of(text=text).warnings if "bearing.ends" in each]
    assert ["taken as spherical" in each for each in found] == [True] * asked


def test_doubts_of_many_systems():
    wide = Doubt("the width {0} is unusual", 9.0)
    assert doubts_of_many(
        [[wide], [], [wide._replace(value=7.5)], [Doubt("it is odd{1}", None, "!")]]
    ) == ["2 of 4 systems: the width 7.5 to 9 is unusual", "1 of 4 systems: it is odd"]
