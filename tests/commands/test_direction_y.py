"""check, modal and pushover in y: as the case that has the building of y in place of that in x."""

import json
from pathlib import Path

import pytest

from rpscli.case.case import load_case

PLAN = (
    "  columns: 12\n  plan: {rows: [0 m, 6 m, 12 m], y: {rows: [0 m, 1 m, 5 m, 9 m]}}\n"
)
OTHER = "superstructure:\n  y: {period: 0.45}\n"


def write(name, building, plan, more=""):
    """A case of three storeys."""
    Path(name).write_text(
        f"""rps: 1
{building}  storeys: 3
  storey_mass: 200 t
  storey_height: 3 m
  period: 0.3
  damping: {{ratio: 0.05}}
  vertical_period: 0.1 s
podium:
  bearing: {{semi_diagonal: 2.0, slenderness: 0.2, wedge_slenderness: 0.4, curvature_ratio: 0.4}}
  cap_beam_mass_ratio: 10
  superstructure_mass_ratio: 3
{plan}{more}""",
        "utf-8",
    )


@pytest.fixture
def two_ways(workplace):
    """The case, and one whose x is its y."""
    write("both.yaml", OTHER, PLAN)
    turned = "  columns: 12\n  plan: {rows: [0 m, 1 m, 5 m, 9 m], y: {rows: [0 m, 6 m, 12 m]}}\n"
    write("turned.yaml", "superstructure:\n", turned)
    text = Path("turned.yaml").read_text("utf-8")
    Path("turned.yaml").write_text(text.replace("period: 0.3\n", "period: 0.45\n", 1))


NAMED = ("case", "direction", "command", "files", "warnings", "created", "duration")


def numbers(document):
    return {key: value for key, value in document.items() if key not in NAMED}


@pytest.mark.parametrize("command", ["check", "modal", "pushover"])
def test_y_is_the_case_that_was_turned(two_ways, rps, rps_json, command):
    in_y = rps_json(command, "both.yaml", "--direction", "y")
    turned = rps_json(command, "turned.yaml")
    in_x = rps_json(command, "both.yaml")
    assert (in_y["direction"], in_x["direction"]) == ("y", "x")
    assert json.dumps(numbers(in_y)) == json.dumps(numbers(turned))
    assert json.dumps(numbers(in_x)) != json.dumps(numbers(turned))
    shown = rps(command, "both.yaml", "--direction", "y")
    assert ", in y" in shown.stdout
    assert "--direction y" not in shown.stdout + shown.stderr
    other = rps(command, "both.yaml")
    assert "--direction y shows the other" in other.stdout + other.stderr


def test_results_in_y_stand_beside_those_in_x(two_ways, rps_json):
    for direction in "xy":
        rps_json("modal", "both.yaml", "--direction", direction)
    assert {path.name for path in Path("results/both").iterdir()} == {"modal", "modal_y"}
    run = json.loads(Path("results/both/modal_y/run.json").read_text("utf-8"))
    assert run["inputs"]["direction"] == "y"


def test_the_rows_of_y_come_first(two_ways):
    structure = load_case(Path("both.yaml")).structure
    assert structure.in_y().rows == structure.rows_y == (0.0, 1.0, 5.0, 9.0)
    assert structure.in_y().rows_y == structure.rows
    alike = load_case(Path("turned.yaml")).structure
    assert alike.in_y().superstructure is alike.superstructure


def test_periods_stand_beside_frequencies_and_vertical_modes_in_a_line(two_ways, rps):
    text = rps("modal", "both.yaml").stdout
    (head,) = [line for line in text.splitlines() if line.startswith("uplifted")]
    assert head.split()[:5] == ["uplifted", "mode", "rad/s", "T", "s"]
    kept = [line for line in text.splitlines() if line.startswith(("rolling", "rocking"))]
    first = next(line.split() for line in kept if line.split()[1] == "1")
    assert float(first[2]) * float(first[3]) == pytest.approx(6.2832, rel=1e-3)
    assert "Vertical modes when rolling and rocking differ from those above" in text
    assert not any("vertical" in line for line in kept)


def test_ends_that_never_lift_have_no_words_of_uplift(workplace, rps):
    round_ends = "  columns: 12\n  friction: 0.5\n  plan: {rows: [0 m, 6 m, 12 m]}\n"
    record = "record: {source: 'pulse:sine?amplitude=0.3g&period=0.8'}\n"
    write("ball.yaml", "superstructure:\n", round_ends, record)
    text = Path("ball.yaml").read_text("utf-8")
    start, end = text.index("  bearing:"), text.index("  cap_beam_mass_ratio")
    shape = "dimensions: {height: 3 m, width: 0, wedge_width: 0.8 m, radius: 2 m}"
    Path("ball.yaml").write_text(f"{text[:start]}  bearing: {{{shape}}}\n{text[end:]}")
    for command in ("check", "modal", "pushover", "timehistory"):
        said = rps(command, "ball.yaml").stdout
        for word in ("uplift", "chaotic", "tan(alpha)", "V_st"):
            assert word not in said, (command, word)
    for command, word in (("check", "rolling"), ("modal", "Both states")):
        assert word in rps(command, "ball.yaml").stdout
