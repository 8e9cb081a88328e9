"""Every inadmissible case is refused with place, value, rule and remedy."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from rpscli.case.case import case_from_mapping, parse_case
from rpscli.case.schema.keys import REMOVED
from rpscli.errors import CaseError

Faults = Callable[..., str]

SINGLE_VALUES = [
    ("storeys: 3", "storeys: 3.0", "3:12: superstructure.storeys = 3.0", ["whole number; write 3"]),
    ("storeys: 3", "storeys: three", "3:12: superstructure.storeys = 'three'", ["whole number"]),
    ("storeys: 3", "storeys: -1", "3:12", ["from 0 to 200", "0 = no building"]),
    ("storeys: 3", "storeys: true", "3:12: superstructure.storeys = true", ["whole number"]),
    ("200 t", "-200 t", "4:16: superstructure.storey_mass = '-200 t'", ["> 0 kg"]),
    ("200 t", "[200 t, no, 3]", "4:24: superstructure.storey_mass.1 = 'no'", ["a mass"]),
    ("200 t", "[]", "4:16: superstructure.storey_mass = []", ["empty list"]),
    ("200 t", "1e300", "4:16", ["outside", "check the unit"]),
    ("200 t", ".nan", "4:16: superstructure.storey_mass = nan", ["finite"]),
    ("200 t", "{a: 1}", "4:16: superstructure.storey_mass = {a: 1}", ["a mass in kg"]),
    ("  impact", "  plan: {rows: 200}\n  impact", "17:16", ["podium.plan.rows = 200", "[0, 4 m"]),
    ("  impact", "  plan: {rows: [0 m]}\n  impact", "17:16", ["rows = ['0 m']", "positions"]),
    ("  impact", "  plan: {rows: [4, 4 m]}\n  impact", "17:16", ["podium.plan.rows", "as in [0, "]),
    ("period: 0.3", "period: .inf", "6:11", ["finite"]),
    (
        "limits: {rotation_ratio: 0.5}",
        "limits: 3",
        "20:9: limits = 3",
        ["rotation_ratio, ", " more"],
    ),
    ("period: 0.3", f"period: {'9' * 350}", "6:11", ["finite"]),
    ("period: 0.3", "period: true", "6:11: superstructure.period = true", ["a time in s"]),
    ("profile: sine", "profile: sin", "7:12", ["sine, uniform, linear or flexural", "mean sine?"]),
    ("ratio: 0.05", "ratio: 5", "8:20", ["< 1", "5 % is 0.05"]),
    ("ratio: 0.05", "ratio: 5 %", "8:20: superstructure.damping.ratio = '5 %'", ["a number"]),
    ("[1, 2]", "[1]", "8:33", ["two modes, as in [1, 2]"]),
    ("[1, 2]", "[0, 2]", "8:34", ["modes count from 1"]),
    ("[1, 2]", "[1, 4]", "8:33", ["from 1 to superstructure.storeys = 3 (line 3)"]),
    ("modes: [1, 2]", "modes: both", "8:33", ["two modes"]),
    ("semi_diagonal: 1.5", "semi_diagonal: 0", "11:20", ["> 0 m"]),
    ("slenderness: 0.15", "slenderness: '0.15'", "12:18", ["without quotes"]),
    ("ratio: 0.5\n  cap", "ratio: -0.2\n  cap", "14:22", ["= -0.2 must be >= 0 (rho = r/2H)"]),
    ("ratio: 0.5\n  cap", "ratio: criticl\n  cap", "14:22", ["did you mean critical?"]),
    ("cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: -1", "15:24", [">= 0"]),
    ("law: rigid", "law: elastic", "17:17", ["flexible, rigid or value"]),
    ("impact: {law: rigid}", "impact: flexibel", "17:11", ["did you mean flexible?"]),
    ("law: rigid", "law: value, restitution: 1.5", "17:37", ["> 0 and <= 1"]),
    ("law: rigid", "law: rigid, loss: 1.6", "17:30", [">= 0 and <= 1.5", "kappa"]),
    ("record: {source: motion.at2}", "record: motion.at2", "18:9", ["mapping", "source"]),
    ("motion.at2", "12", "18:18: record.source = 12", ["put it in quotes"]),
    ("motion.at2", "' '", "18:18", ["empty"]),
    ("vibration: auto", "vibration: atuo", "19:28", ["a time in s", "did you mean auto?"]),
    ("free_vibration: auto", "overturning_limit: 0.5", "19:31", [">= 1"]),
    ("free_vibration: auto", "recontact_tolerance: 1", "19:33", ["> 0 and < 1"]),
    ("free_vibration: auto", "gravity: 0", "19:21", ["> 0 m/s2"]),
    ("free_vibration: auto", "max_events: 0", "19:24", ["whole number from 1 to 1000000000"]),
    ("rps: 1", "rps: 2", "1:6: rps = 2", ["this program reads version 1"]),
]


@pytest.mark.parametrize(("old", "new", "start", "parts"), SINGLE_VALUES)
def test_single_values(
    building: str, faults: Faults, old: str, new: str, start: str, parts: list[str]
) -> None:
    message = faults(building, old, new)
    assert message.startswith(f"c.yaml:{start}")
    assert "\n" not in message
    for part in parts:
        assert part in message


MISSING_AND_TWICE = [
    ("rps: 1\n", "", "1:1: rps is missing", ["write `rps: 1`"]),
    ("  storeys: 3\n", "", "2:1: superstructure.storeys is missing", ["number of storeys"]),
    ("  storey_mass: 200 t\n", "", "2:1: superstructure.storey_mass is missing", ["200 t"]),
    ("  damping: {ratio: 0.05, modes: [1, 2]}\n", "", "2:1", ["damping is missing", "ratio: 0.05"]),
    ("{ratio: 0.05, modes", "{modes", "8:3: superstructure.damping.ratio is missing", ["ratio"]),
    ("  period: 0.3\n", "", "2:1: superstructure has no stiffness", ["period", "stiffness"]),
    (
        "  profile: sine",
        "  stiffness: 3e7",
        "7:3",
        ["stiffness and", "period (line 6)", "keep one"],
    ),
    ("  period: 0.3\n", "  stiffness: 1\n", "6:3", ["profile (line 7)", "keep one"]),
    ("200 t", "[2 t, 2 t]", "4:16: superstructure.storey_mass has 2 values", ["= 3 (line 3)"]),
    ("t: 3.0", "t: [3, 3, 3, 4]", "5:18: superstructure.storey_height has 4 values", ["bottom"]),
    ("    slenderness: 0.15\n", "", "10:3: podium.bearing.slenderness is missing", ["B/H"]),
    ("    wedge_slenderness: 0.30\n", "", "10:3", ["wedge_slenderness is missing", "flat ends"]),
    ("    curvature_ratio: 0.5\n", "", "10:3", ["curvature_ratio is missing", "0 for flat"]),
    ("    slenderness: 0.15\n", "    dimensions: {height: 1, width: 1, radius: 0}\n", "11:5", []),
    ("  cap_beam_mass_ratio: 10\n", "", "9:1: podium leaves the mass of the columns open", []),
    ("  superstructure_mass_ratio: 3\n", "", "9:1", ["mass of the cap beam open", "cap_beam_mass"]),
    ("  impact", "  cap_beam_mass: 1\n  impact", "17:3", ["_mass_ratio (line 16) both fix"]),
    ("  impact", "  column_mass: 1\n  columns: 2\n  impact", "17:3", ["(line 15) both fix"]),
    ("cap_beam_mass_ratio: 10", "column_mass: 1", "9:1: podium.columns is missing", []),
    ("cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: 0", "15:24", ["> 0", "(line 3) stands"]),
    ("{law: rigid}", "{law: value}", "17:3: podium.impact.restitution is missing", ["0.92"]),
    ("{law: rigid}", "value", "17:3: podium.impact.restitution is missing", ["0.92"]),
    ("law: rigid", "law: value, restitution: 0.9, loss: 0.5", "17:42", ["loss", "law value"]),
    ("law: rigid", "restitution: 0.9", "17:12", ["law flexible, which gives its own"]),
    ("source: motion.at2", "scale: 2", "18:1: record.source is missing", ["file"]),
    ("  storey_height: 3.0\n", "  storey_height: 3.0\n  storey_height: 4\n", "6:3", ["twice"]),
    ("  period: 0.3", "  period:", "6:3: superstructure.period has no value", ["remove the key"]),
    ("200 t", "[1, null, 3]", "4:20: superstructure.storey_mass.1 has no value", []),
]


@pytest.mark.parametrize(("old", "new", "start", "parts"), MISSING_AND_TWICE)
def test_missing_and_twice(
    building: str, faults: Faults, old: str, new: str, start: str, parts: list[str]
) -> None:
    message = faults(building, old, new)
    assert message.startswith(f"c.yaml:{start}")
    for part in parts:
        assert part in message


UNKNOWN_KEYS = [
    ("  impact", "  cap_beam_mas: 3\n  impact", "17:3", "did you mean podium.cap_beam_mass?"),
    ("  profile", "  stifness: 3\n  profile", "7:3", "did you mean superstructure.stiffness?"),
    ("  bearing:", "  baering:", "10:3", "did you mean podium.bearing?"),
    ("    slenderness: 0.15", "    slendernes: 0.15", "12:5", "did you mean podium.bearing.slend"),
    ("  storey_mass", "  storey-mass", "4:3", "did you mean superstructure.storey_mass?"),
    ("  cap_beam_mass_ratio", "  Cap_Beam_Mass_Ratio", "15:3", "mean podium.cap_beam_mass_ratio?"),
    ("limits: {", "limits: {gravity: 9.8, ", "20:10", "gravity belongs under analysis"),
    ("  impact: {law: rigid}", "  restitution: 1", "17:3", "belongs under podium.impact"),
    ("record:", "title: a\nstoreys: 3\nrecord:", "19:1", "storeys belongs under superstructure"),
    ("limits: {", "limits: {title: x, ", "20:10", "it belongs at the top level"),
    ("analysis: {", "analysis: {foo: 3, ", "19:12", "known here: free_vibration, recontact"),
    ("analysis: {", "analysis: {foo: , ", "19:12", "known here: free_vibration, recontact"),
    ("analysis: {", "analysis: {foo: {bar: }, ", "19:12", "analysis.foo is not a key"),
]


@pytest.mark.parametrize(("old", "new", "place", "hint"), UNKNOWN_KEYS)
def test_an_unknown_key_is_the_only_fault(
    building: str, faults: Faults, old: str, new: str, place: str, hint: str
) -> None:
    message = faults(building, old, new)
    assert message.startswith(f"c.yaml:{place}: ")
    assert "is not a key of the format" in message
    assert hint in message
    assert "\n" not in message


def test_a_removed_key_says_what_holds_without_it(building: str, faults: Faults) -> None:
    for key, now in REMOVED.items():
        with pytest.raises(CaseError) as refused:
            parse_case(building, name="c.yaml", overrides=[f"{key}=1"])
        assert str(refused.value) == f"--set {key}=1: {key} is gone: {now}"
    message = faults(building, "analysis: {", "analysis: {recontact_rule: limit, ")
    assert message.startswith("c.yaml:19:12: analysis.recontact_rule is gone: floors always get")


def test_a_section_under_the_wrong_parent(frame: str, faults: Faults) -> None:
    message = faults(frame, "  bearing:\n    dimensions:", "  dimensions:")
    assert "3:1: podium.bearing is missing" in message
    assert "4:3: podium.dimensions" in message
    assert "dimensions belongs under podium.bearing" in message


GEOMETRY = [
    ("slenderness: 0.30", "slenderness: 0.10", "13:24", ["= 0.1 must be >=", "0.15 (line 12)"]),
    ("ratio: 0.5\n  c", "ratio: 0.05\n  c", "14:22", ["at least 0.075", "at most 0.25"]),
    ("slenderness: 0.30", "slenderness: 1.60", "14:22", ["at least 0.725", "at most 1.15"]),
    ("slenderness: 0.15", "slenderness: 1.2", "13:24", ["wedge_slenderness = 0.3"]),
]


@pytest.mark.parametrize(("old", "new", "place", "parts"), GEOMETRY)
def test_an_arc_that_does_not_fit(
    building: str, faults: Faults, old: str, new: str, place: str, parts: list[str]
) -> None:
    message = faults(building, old, new)
    assert message.startswith(f"c.yaml:{place}: podium.bearing.")
    for part in parts:
        assert part in message


def test_what_is_proposed_for_an_arc_fits(building: str) -> None:
    for override in ("curvature_ratio=0.075", "wedge_slenderness=0.25"):
        base = ["podium.bearing.curvature_ratio=0.05", f"podium.bearing.{override}"]
        shape = parse_case(building, name="c.yaml", overrides=base).structure.bearing
        # sin(beta) = 1 exactly, but asin steepens there: half the digits are left.
        assert shape.beta == pytest.approx(1.5707963, abs=1e-7)


def test_a_critical_arc_past_a_right_angle(building: str, faults: Faults) -> None:
    overrides = ["podium.bearing.wedge_slenderness=1.3", "podium.bearing.curvature_ratio=critical"]
    message = faults(building, overrides=overrides)
    assert message.startswith("--set podium.bearing.wedge_slenderness=1.3: ")
    assert "must be <= 1 with curvature_ratio: critical" in message


DIMENSIONS = [
    ("radius: 1.2", "radius: 200 mm", "5:79", ["0.2 m", "at least 0.25 m", "at most 0.8 m"]),
    ("wedge_width: 900 mm", "wedge_width: 300 mm", "5:63", [">= width = 400 mm (line 5)"]),
    (", wedge_width: 900 mm", "", "5:5", ["dimensions.wedge_width is missing", "flat ends"]),
    (", radius: 1.2", "", "5:5", ["dimensions.radius is missing", "0 = flat ends"]),
    ("dimensions:", "slenderness: 1\n    dimensions:", "5:5", ["(line 6)", "both describe"]),
    ("    dimensions", "    inertia_ratio: 0.3\n    dimensions", "5:20", ["4/3 is a rect"]),
]


@pytest.mark.parametrize(("old", "new", "place", "parts"), DIMENSIONS)
def test_dimensions(
    frame: str, faults: Faults, old: str, new: str, place: str, parts: list[str]
) -> None:
    message = faults(frame, old, new)
    assert message.startswith(f"c.yaml:{place}: podium.bearing")
    for part in parts:
        assert part in message


def test_a_bearing_without_a_shape(frame: str, faults: Faults) -> None:
    message = faults(frame, "dimensions: {", "#")
    assert "c.yaml:4:3: podium.bearing has no value" in message
    message = faults(frame, overrides=["podium.bearing.dimensions=null"])
    assert "podium.bearing has no shape" in message


FRAMES = [
    ("  columns: 4\n", "", ["3:1: podium.columns is missing"]),
    ("  columns: 4\n", "  cap_beam_mass_ratio: 10\n", ["8:3", "(line 6)", "(line 7)", "together"]),
    ("  cap_beam_mass: 200 t\n", "", ["3:1", "give one of cap_beam_mass or cap_beam_mass_ratio"]),
    ("  column_mass: 5 t\n", "", ["3:1", "give one of cap_beam_mass_ratio or column_mass"]),
    ("  column_mass: 5 t\n", "  cap_beam_mass_ratio: 0\n", ["6:18", "(line 7) contradict"]),
    ("cap_beam_mass: 200 t\n  column_mass: 5 t", "cap_beam_mass_ratio: 0", ["column_mass is miss"]),
    ("columns: 4", f"columns: {'9' * 400}", ["8:12: podium.columns", "from 1 to 100000"]),
    ("  columns: 4", "  superstructure_mass_ratio: 3", ["8:3", "storeys = 0 (line 2)", "instead"]),
]


@pytest.mark.parametrize(("old", "new", "parts"), FRAMES)
def test_masses_of_a_frame(
    frame: str, faults: Faults, old: str, new: str, parts: list[str]
) -> None:
    message = faults(frame, old, new)
    assert "\n" not in message
    for part in parts:
        assert part in message


def test_limits_need_what_they_limit(building: str, frame: str, faults: Faults) -> None:
    message = faults(frame, overrides=["limits.base_shear_ratio=2", "limits.drift_ratio=0.01"])
    assert message.count("needs a building, but superstructure.storeys = 0 (line 2)") == 2
    message = faults(
        building.replace("  storey_height: 3.0\n", ""), "rotation_ratio", "drift_ratio"
    )
    assert "c.yaml:19:10: limits.drift_ratio needs superstructure.storey_height" in message


@pytest.mark.parametrize(
    ("law", "loss", "widest"),
    [
        ("rigid", 1, 1.0377),
        ("flexible", 1, 0.6202),
        ("rigid", 1.5, 0.7268),
        ("flexible", 1.5, 0.4344),
    ],
)
def test_no_restitution(
    building: str, faults: Faults, law: str, loss: float, widest: float
) -> None:
    bearing = "podium.bearing={semi_diagonal: 1.5, slenderness: %s, curvature_ratio: 0}"
    masses = ["podium.cap_beam_mass_ratio=0.5", f"podium.impact.law={law}"]
    masses.append(f"podium.impact.loss={loss}")
    message = faults(building, overrides=[bearing % 2, *masses])
    assert "restitution" in message
    assert f"law {law}" in message
    proposed = float(message.split("use less than ")[1].split(",")[0])
    # sin^2(alpha) = (4/3 + 8)/18 kappa and (4/3 + 2)/(18 kappa - 6) by hand, to four digits.
    assert proposed == pytest.approx(widest, abs=1e-3)
    case = parse_case(building, name="c.yaml", overrides=[bearing % proposed, *masses])
    # Four digits of the slenderness leave a restitution of the order of 1e-3 at most.
    assert 0.0 < case.structure.restitution < 2e-3
    slightly_more = faults(building, overrides=[bearing % (proposed + 1e-3), *masses])
    assert "must be > 0" in slightly_more


def test_a_heavy_building_has_no_restitution(building: str, faults: Faults) -> None:
    """The ratio of building to cap beam, a gentler loss and a measured value are remedies too."""
    bearing = "podium.bearing={semi_diagonal: 1.5, slenderness: 0.15, curvature_ratio: 0}"
    masses = ["podium.cap_beam_mass_ratio=10", "podium.impact.law=flexible"]
    heavy = "podium.superstructure_mass_ratio={}".format
    message = faults(building, overrides=[bearing, *masses, heavy(50)])
    assert "under a building of 50 times the cap beam's mass gives the restitution -0.05" in message
    proposed = float(message.split("a building of less than ")[1].split(" ")[0])
    # 2 (1 + 40 + 40 eta) - 40 eta = (4/3 + 40)/sin^2(alpha) by hand
    assert proposed == pytest.approx(((4 / 3 + 40) * (1 + 0.15**-2) - 82) / 40, abs=0.1)
    for remedy in (heavy(proposed), "podium.impact.loss=0.5"):
        case = parse_case(building, name="c", overrides=[bearing, *masses, heavy(50), remedy])
        assert 0.0 < case.structure.restitution < 0.5
    more = faults(building, overrides=[bearing, *masses, heavy(1.01 * proposed)])
    assert "must be > 0" in more


def test_a_factor_must_not_create_energy(building: str, faults: Faults) -> None:
    message = faults(building, "law: rigid", "law: rigid, factor: 1.2")
    assert message.startswith("c.yaml:17:32: podium.impact.factor = 1.2")
    proposed = float(message.split("at most ")[1])
    case = parse_case(building, name="c", overrides=[f"podium.impact.factor={proposed}"])
    assert case.structure.restitution == pytest.approx(1.0, abs=1e-3)  # four digits proposed


def test_all_faults_together_in_order(building: str, faults: Faults) -> None:
    text = building.replace("period: 0.3", "period: -1").replace("law: rigid", "lw: rigid")
    text = text.replace("    curvature_ratio: 0.5\n", "    curvature_ratio: 0.5\n    x: 1\n")
    message = faults(text, "rps: 1", "rps: 3", ["record.scale=big", "limits.rotation_ratio=0"])
    places = [line.split(": ")[0] for line in message.splitlines()]
    assert places == [
        "c.yaml:1:6",
        "c.yaml:6:11",
        "c.yaml:15:5",
        "c.yaml:18:12",
        "--set record.scale=big",
        "--set limits.rotation_ratio=0",
    ]


def test_a_faulty_value_counts_as_given(building: str, faults: Faults) -> None:
    assert "\n" not in faults(building, "cap_beam_mass_ratio: 10", "cap_beam_mass_ratio: ten")
    assert "\n" not in faults(building, "200 t", "heavy")


@pytest.mark.parametrize("text", ["podium: 3", "podium: [1]", "podium: text", "podium:"])
def test_a_section_that_is_no_mapping(faults: Faults, text: str) -> None:
    message = faults(f"rps: 1\nsuperstructure: {{storeys: 0}}\n{text}\n")
    assert message.startswith("c.yaml:3:")
    assert "\n" not in message


def test_a_mapping_in_memory_has_its_name_for_a_place() -> None:
    with pytest.raises(CaseError) as error:
        case_from_mapping({"rps": 1, "superstructure": {"storeys": 0}, "podium": {}}, "base of x")
    assert str(error.value).splitlines()[0].startswith("base of x: podium")


SPHERES = [
    ("slenderness: 0", {}, "", []),
    ("slenderness: 0.01", {"curvature_ratio": 0.5}, "", []),
    (
        "slenderness: 0",
        {"curvature_ratio": 0.5},
        "curvature_ratio = 0.5",
        ["must be > 0.5", "hold"],
    ),
    ("slenderness: 0", {"curvature_ratio": "critical"}, "curvature_ratio = 0.5", ["must be > 0.5"]),
    ("slenderness: 0", {"curvature_ratio": 0}, "curvature_ratio = 0", ["must be > 0.5"]),
]


@pytest.mark.parametrize(("slenderness", "changes", "start", "parts"), SPHERES)
def test_spherical_ends_stand_on_a_large_arc(
    building: str, slenderness: str, changes: dict[str, object], start: str, parts: list[str]
) -> None:
    text = building.replace("slenderness: 0.15", slenderness, 1)
    shape = {"curvature_ratio": 0.7} | changes
    overrides = [f"podium.bearing.{key}={value}" for key, value in shape.items()]
    if not start:
        bearing = parse_case(text, name="c.yaml", overrides=overrides).structure.bearing
        assert bearing.is_spherical == (slenderness == "slenderness: 0")
        return
    with pytest.raises(CaseError) as error:
        parse_case(text, name="c.yaml", overrides=overrides)
    assert all(part in str(error.value) for part in (f"podium.bearing.{start}", *parts))


def test_spherical_ends_have_no_impact_and_no_tendons(building: str) -> None:
    sphere = ["podium.bearing.slenderness=0", "podium.bearing.curvature_ratio=0.7"]
    tendon = "podium.devices=[{kind: tendon, prestress: 1 kN, stiffness: 1 kN/mm}]"
    for more, said in (
        (["podium.impact.factor=0.9"], "have no impact; remove restitution and factor"),
        ([tendon, "podium.columns=4"], "podium.devices.0: tendons are not followed"),
    ):
        with pytest.raises(CaseError, match=said):
            parse_case(building, name="c.yaml", overrides=[*sphere, *more])
    dimensions = "{height: 3 m, width: 0, wedge_width: 0.9 m, radius: 1.4 m}"
    text = building.replace("slenderness: 0.15", f"dimensions: {dimensions}", 1)
    for key in ("semi_diagonal", "wedge_slenderness", "curvature_ratio"):
        text = "\n".join(line for line in text.splitlines() if f" {key}:" not in line)
    with pytest.raises(CaseError, match=r"radius = 1\.4 m must be > 1\.5 m, half the height"):
        parse_case(text, name="c.yaml")
