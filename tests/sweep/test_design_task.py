"""`rps design`: exact answers, refusals, workers, interruptions, and what hangs on the records."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner, Result
from paper_structures import needs_compiled_kernels

from rpscli.case.design import OLD_WORDS, parse_design
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.cli import program
from rpscli.errors import CaseError
from rpscli.sweep.design.answer import interval_of, weights_of
from rpscli.sweep.design.regions import neighbours
from rpscli.sweep.design.search import Search, first_places, next_places
from rpscli.sweep.evaluation.batch import run_batch
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.points.layout import lay_out
from rpscli.sweep.run.schedule import LARGEST_BATCH
from rpscli.sweep.table import Array
from sweep.small_studies import BASE, ROOT
from sweep.test_interruption import ended

SLENDERNESS = "podium.bearing.slenderness"
WEDGE = "podium.bearing.wedge_slenderness"
SIZE = "podium.bearing.semi_diagonal"

PEAKS = (0.12, 0.17, 0.18, 0.21, 0.23, 0.26, 0.29)
"""Of half sines [g]: a rigid frame lifts where its slenderness is below one of them, exactly."""

MINIMISED = f"minimise: {SLENDERNESS}"

FRAME = f"""\
rps: 1
title: Least slenderness without uplift
base:
  rps: 1
  superstructure: {{storeys: 0}}
  podium:
    bearing: {{semi_diagonal: 1.5, slenderness: 0.3, wedge_slenderness: 0.6, curvature_ratio: 0.5}}
    cap_beam_mass_ratio: 10
    cap_beam_mass: 100 t
  analysis: {{free_vibration: 0.1}}
variables:
  {SLENDERNESS}: [0.05, 0.35]
linked:
  {WEDGE}: {{{SLENDERNESS}: 2, plus: 0.1}}
records:
  - source: "pulse:half_sine?period=0.5"
    amplitude: [{", ".join(f"{peak} g" for peak in PEAKS)}]
limits: {{uplift: 0.3}}
{MINIMISED}
search: {{first: 8, most: 64, resolution: 0.001, resamples: 400}}
"""

TWO = FRAME.replace(
    f"{SLENDERNESS}: [0.05, 0.35]\n", f"{SLENDERNESS}: [0.05, 0.35]\n  {SIZE}: [800 mm, 2 m]\n"
).replace(MINIMISED, f"minimise: {{{SLENDERNESS}: 10, {SIZE}: 1}}")

BUILDING = f"""\
rps: 1
base: base.yaml
variables: {{{SLENDERNESS}: [0.1, 0.25], podium.bearing.curvature_ratio: [0.2, 0.6]}}
linked: {{{WEDGE}: {{{SLENDERNESS}: 2}}}}
records:
  - {{source: "synthetic:?pga=0.8g&duration=4&dt=0.02", seed: [1, 2, 3, 4, 5]}}
scale: [1.0, 1.5]
limits:
  overturning: 0.2
  rotation_ratio: {{at_most: 0.5, share: 0.3}}
  drift_ratio: {{at_most: 0.004, fractile: 0.6}}
  base_shear_ratio: 3.0
minimise: [max_base_shear, max_cap_beam_displacement: {{fractile: 0.84}}]
search: {{first: 8, most: 20, resamples: 50}}
"""

StudyPoints = Callable[..., Result]


@pytest.fixture
def design(workplace: Path, no_figures: None) -> StudyPoints:
    """Run `rps design` on a text in this process."""

    def invoke(text: str, *arguments: str) -> Result:
        (workplace / "design.yaml").write_text(text, encoding="utf-8")
        return CliRunner().invoke(program, ["design", "design.yaml", *arguments])

    return invoke


@pytest.fixture
def design_json(design: StudyPoints) -> Callable[..., dict[str, Any]]:
    """The JSON document of `rps design`."""

    def invoke(text: str, *arguments: str, exit_code: int = 0) -> dict[str, Any]:
        result = design(text, *arguments, "--json")
        assert result.exit_code == exit_code, result.stderr
        document: dict[str, Any] = json.loads(result.stdout)
        return document

    return invoke


DesignJson = Callable[..., dict[str, Any]]


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8") as text:
        return list(csv.DictReader(text))


@pytest.mark.evidence("design", "exact")
def test_one_unknown_against_the_exact_answer(design_json: DesignJson, workplace: Path) -> None:
    # 30 % of seven are two: the third largest peak must not lift the frame.
    found = design_json(FRAME, "-o", "out")
    exact = sorted(PEAKS)[-3]
    below, above = found["bracket"]
    best = found["best"]["values"][SLENDERNESS]
    assert above is None
    assert below < exact <= best
    assert best - below < 1.01 * 0.001 * 0.3
    assert found["best"]["values"][WEDGE] == pytest.approx(2.0 * best + 0.1, rel=1e-5)
    # The same order statistic of each resample is known, and closed in upon as well.
    weights = weights_of(range(len(PEAKS)), 400, 1).rows[1:401]
    answers = [np.sort(np.repeat(PEAKS, row.astype(int)))[-3] for row in weights]
    low, high = interval_of(np.array(answers))
    interval = found["records"]["intervals"][SLENDERNESS]
    assert interval == pytest.approx([low, high], abs=0.3 * 0.01)
    assert low < exact < high
    # What is recommended holds in 90 % of the resamples, and all larger ones do; built within 1 %.
    fine = np.linspace(0.2, 0.35, 3001)
    built = fine[:, None] * (1.0 + 0.01 * np.linspace(-1.0, 1.0, 5))
    lifted = (np.array(PEAKS)[None, :, None] > built[:, None]).mean(axis=2)
    holds = ((weights @ lifted.T) / len(PEAKS) <= 0.3).mean(axis=0) >= 0.9
    least = fine[np.flatnonzero(~holds)[-1] + 1]
    assert 0.0 <= found["robust"]["values"][SLENDERNESS] - least < 1.01 * 0.001 * 0.3
    assert found["robust"]["passing_share"] >= 0.9
    # Without the largest record the next one decides, without a smaller one nothing changes.
    without = [each["best"]["values"][SLENDERNESS] for each in found["records"]["without_one"]]
    left = [np.sort(np.delete(PEAKS, place))[-2] for place in range(len(PEAKS))]
    assert without == pytest.approx(left, abs=0.3 * 0.01)
    files = {Path(name).name for name in found["files"]}
    assert {"designs.csv", "points.csv", "verdicts.csv", "requirements.png"} <= files
    rows = rows_of(workplace / "out/designs.csv")
    assert len(rows) == found["designs"]["looked_at"] <= 64 + found["designs"]["within_tolerances"]


@pytest.mark.evidence("design", "exact")
def test_two_unknowns_against_the_exact_answer(design_json: DesignJson) -> None:
    found = design_json(TWO, "--set", "search.most=128", "--set", "search.resolution=0.01")
    values = found["best"]["values"]
    # Size does not matter for uplift: the least one, and the least slenderness that stands.
    assert values[SIZE] == 0.8
    assert 0.0 <= values[SLENDERNESS] - sorted(PEAKS)[-3] < 0.3 * 0.02
    assert found["at_bounds"] == [{"key": SIZE, "end": "least"}]
    assert any("wider" in warning for warning in found["warnings"])
    (requirement,) = found["requirements"]
    assert requirement["binds"]
    assert requirement["aim_without_it"] == pytest.approx(10 * 0.05 + 0.8)


def test_a_number_of_columns_stays_whole(design_json: DesignJson, workplace: Path) -> None:
    text = FRAME.replace(f"{SLENDERNESS}: [0.05, 0.35]", "podium.columns: [4, 9]")
    text = text.replace(f"  {WEDGE}: {{{SLENDERNESS}: 2, plus: 0.1}}\n", "")
    text = text.replace("linked:\n", "").replace(
        f"minimise: {SLENDERNESS}", "minimise: podium.columns"
    )
    found = design_json(text, "-o", "out")
    assert found["best"]["values"]["podium.columns"] == 4
    rows = rows_of(workplace / "out/designs.csv")
    assert {row["podium.columns [-]"] for row in rows} <= {str(n) for n in range(4, 10)}


def test_nothing_passes(design: StudyPoints, design_json: DesignJson) -> None:
    found = design_json(FRAME.replace("0.35]", "0.2]"), exit_code=10)
    assert found["best"] is None
    assert found["passed"] is False
    (requirement,) = found["requirements"]
    # At the largest slenderness three of seven are beyond it; two may be.
    assert found["closest"]["values"][SLENDERNESS] >= 0.18
    assert requirement["value"] == pytest.approx(4 / 7)
    assert requirement["records_too_many"] == pytest.approx(2 / 7)
    result = design(FRAME.replace("0.35]", "0.2]"))
    assert result.exit_code == 10
    assert "no design of" in result.stderr
    assert "uplift: at most 30 % of the records" in result.stderr


@needs_compiled_kernels
def test_verdicts_are_those_of_a_study(design_json: DesignJson, workplace: Path) -> None:
    found = design_json(BUILDING, "-o", "out")
    designs = rows_of(workplace / "out/designs.csv")
    verdicts = rows_of(workplace / "out/verdicts.csv")
    assert len(verdicts) == 8 * len(designs)
    exceeded = [row["exceeded [-]"] == "true" for row in verdicts]
    assert 0 < sum(exceeded) < len(exceeded)
    by_design = np.array(exceeded).reshape(len(designs), -1)
    passes = [row["passes [-]"] == "true" for row in designs]
    assert passes == (~by_design.any(axis=1)).tolist()
    assert any(passes)
    best = found["best"]["aims"]
    aim = next(iter(best))
    least = [float(row[f"least {aim.replace(',', '')} [N]"]) for row in designs]
    assert best[aim] == pytest.approx(min(np.array(least)[passes]))
    front = rows_of(workplace / "out/front.csv")
    assert int(front[0]["design [-]"]) == found["best"]["design"]
    heads = [head for head in designs[0] if head.startswith("least ")]
    aims = np.array([[float(row[head]) for head in heads] for row in designs])[passes]
    numbers = [int(row["design [-]"]) for row in designs if row["passes [-]"] == "true"]
    bettered = [((aims <= own).all(axis=1) & (aims < own).any(axis=1)).any() for own in aims]
    undominated = {n for n, worse in zip(numbers, bettered, strict=True) if not worse}
    assert {int(row["design [-]"]) for row in front} == undominated


HAZARD = "PGV [m/s],rate [1/year]\n0.1,1e-2\n0.3,2e-3\n0.8,3e-4\n2,2e-5\n"
RATE = (
    BUILDING.replace("scale: [1.0, 1.5]", "scale: {measure: PGV, values: [0.9, 0.3, 0.6]}")
    .replace(BUILDING[BUILDING.index("limits:") : BUILDING.index("minimise:")], "limits: {}\n")
    .replace("limits: {}", "limits: {annual_rate: 1e-4}\nhazard: {file: hazard.csv, measure: PGV}")
)


@needs_compiled_kernels
def test_a_limit_on_the_annual_rate(design_json: DesignJson, workplace: Path) -> None:
    """The rate is the integral of the shares, linear in ln PGV, over the hazard, in small steps."""
    (workplace / "hazard.csv").write_text(HAZARD)
    unseen = "validate: {records: ['synthetic:?pga=0.8g&duration=4&dt=0.02&seed=9']}\n"
    found = design_json(RATE + unseen, "-o", "out")
    points = rows_of(workplace / "out/points.csv")
    levels = np.array([0.3, 0.6, 0.9])
    fine = np.geomspace(0.1, 20.0, 200_001)
    curve = np.array([[float(x) for x in line.split(",")] for line in HAZARD.splitlines()[1:]])
    x, height = np.log(curve.T)
    beyond = height[-1] + np.diff(height)[-1] / np.diff(x)[-1] * (np.log(fine) - x[-1])
    rates = np.exp(np.where(fine > 2.0, beyond, np.interp(np.log(fine), x, height)))
    middle = np.log(np.sqrt(fine[1:] * fine[:-1]))
    checked = set()
    for place, row in enumerate(rows_of(workplace / "out/designs.csv")):
        own = points[15 * place : 15 * place + 15]
        fallen = [
            np.mean(
                [p["outcome [-]"].startswith("over") for p in own if p["PGV [m/s]"] == f"{v:g}"]
            )
            for v in levels
        ]
        exact = float(np.interp(middle, np.log(levels), fallen) @ -np.diff(rates))
        exact += fallen[-1] * rates[-1]
        assert float(row["annual_rate [1/year]"]) == pytest.approx(exact, rel=1e-6)
        assert (row["passes [-]"] == "true") == (exact <= 1e-4)
        checked.add(row["passes [-]"])
    assert checked == {"true", "false"}
    (requirement,) = found["requirements"]
    assert requirement["met"]
    assert not requirement["shown"]  # five records cannot
    low, high = requirement["interval"]
    assert low <= requirement["value"] < 1e-4 < high
    (verdict,) = found["confirmation"]["robust"]
    assert verdict["exceeded"] == (verdict["value"] > 1e-4) == (found["confirmed"] is False)
    life = RATE.replace("annual_rate: 1e-4", f"probability_in_50_years: {-np.expm1(-50.0 * 1e-4)}")
    assert design_json(life)["requirements"][0]["limit"] == pytest.approx(1e-4, rel=1e-12)


@needs_compiled_kernels
def test_perturbed_histories_are_parts_of_their_records(
    design_json: DesignJson, workplace: Path
) -> None:
    found = design_json(f"{BUILDING}perturb: {{members: 2}}\ntolerance: 0\n", "-o", "out")
    points = rows_of(workplace / "out/points.csv")
    designs = rows_of(workplace / "out/designs.csv")
    assert len(points) == len(designs) * 5 * 2 * 2
    for place, row in enumerate(designs):
        own = points[20 * place : 20 * place + 20]
        for scale in ("1", "1.5"):
            fallen = [p["outcome [-]"].startswith("over") for p in own][2 * (scale != "1") :]
            share = np.mean([each for n, each in enumerate(fallen) if n % 4 < 2])
            assert float(row[f"overturning at scale = {scale} [-]"]) == pytest.approx(share)
    assert found["robust"]["within_tolerances"]


def test_values_are_printed_as_they_were_judged(design: StudyPoints, workplace: Path) -> None:
    """One unknown and a linked key: all of it is in the table of the terminal."""
    result = design(FRAME, "-o", "out")
    assert result.exit_code == 0, result.stderr
    text = " ".join(result.stdout.split())
    found = json.loads(design(FRAME, "-o", "out", "--json", "--force").stdout)
    for key in (SLENDERNESS, WEDGE):
        recommended, best = (f"{found[of]['values'][key]:.10g}" for of in ("robust", "best"))
        assert f" {recommended} {best} " in text
        assert len(recommended) <= 8
    assert "nearest designs that fail" in text


@needs_compiled_kernels
def test_one_thread_or_two_give_the_same_bytes(design: StudyPoints, workplace: Path) -> None:
    for jobs in ("1", "2"):
        assert design(BUILDING, "--jobs", jobs, "-o", jobs).exit_code == 0
    for name in ("designs.csv", "points.csv", "front.csv"):
        assert (workplace / "1" / name).read_bytes() == (workplace / "2" / name).read_bytes()


@needs_compiled_kernels
def test_interrupted_and_resumed_ends_in_the_same_bytes(workplace: Path) -> None:
    (workplace / "design.yaml").write_text(BUILDING, encoding="utf-8")
    interrupting = str(Path(__file__).with_name("interrupted.py"))
    words = ("design", "design.yaml", "--jobs", "1", "--json", "--figures", "none")
    code, out, _ = ended("SIGINT", *words, folder=workplace, program=interrupting)
    assert code == 130
    assert json.loads(out)["points"]["stored"] > 0
    assert not (workplace / "results/design/design/designs.csv").exists()
    for extra in ((), ("-o", "calm")):
        code, out, err = ended(*words, *extra, folder=workplace)
        assert code == 0, err
    for name in ("designs.csv", "points.csv"):
        resumed = workplace / "results/design/design" / name
        assert resumed.read_bytes() == (workplace / "calm" / name).read_bytes()


def test_confirmation(design: StudyPoints, design_json: DesignJson, workplace: Path) -> None:
    unseen = 'validate: {records: [{source: "pulse:half_sine?period=0.4", amplitude: [%s]}]}\n'
    found = design_json(FRAME + unseen % "0.1 g, 0.2 g")
    assert found["confirmed"] is True
    found = design_json(FRAME + unseen % "0.1 g, 0.4 g", exit_code=10)
    assert found["confirmed"] is False
    assert found["passed"] is False
    (verdict,) = found["confirmation"]["best"]
    assert verdict["beyond"]["share"] == 0.5
    assert any("recommended design does not keep" in warning for warning in found["warnings"])
    # Of two records none may be beyond 30 %: 51 % of designs at the limit are refused.
    said = " ".join(design(FRAME + unseen % "0.1 g, 0.4 g").stdout.split())
    assert "0 of 2 may be beyond; a design with exactly 30 % beyond fails here in 51 %" in said
    assert "one with 78 % passes in 5 %" in said
    (verdict,) = found["confirmation"]["robust"]
    assert verdict["beyond"]["count"] == 1
    (workplace / "broken.at2").write_text("no record")
    found = design_json(FRAME + "validate: {records: [broken.at2]}\n", exit_code=5)
    assert found["confirmed"] is False
    assert "broken.at2" in found["error"]["message"]
    task = parse_design(FRAME + "validate: {share: 0.3}\n", "design.yaml")
    assert len(task.study.sources) == 5
    assert len(task.confirming) == 2
    assert not set(task.confirming) & set(task.study.sources)


def test_invalid_designs_count_as_failing(design_json: DesignJson) -> None:
    # The wedge must be outside the flat end.
    text = FRAME.replace("2, plus: 0.1", "-1, plus: 0.55")
    found = design_json(text)
    assert found["designs"]["valid"] < found["designs"]["looked_at"]
    assert found["best"]["values"][SLENDERNESS] < 0.275
    assert any("not valid cases" in warning for warning in found["warnings"])


def test_a_dry_run_computes_nothing(design_json: DesignJson, workplace: Path) -> None:
    found = design_json(FRAME, "--dry-run")
    assert found["systems"] == 8
    assert not (workplace / "results").exists()


@pytest.mark.parametrize(
    ("old", "new", "place", "said"),
    [
        ("0.35]", "0.02]", "12:31", "must rise from the least value to the largest"),
        ("[0.05, 0.35]", "[0.05]", "12:31", "must be two numbers, [least, largest]"),
        ("[0.05, 0.35]", "[low, high]", "12:31", "must be two numbers"),
        (f"{SLENDERNESS}: [0.05", "podium.bearing.slendernes: [0.05", "12:3", "did you mean"),
        (f"{WEDGE}: {{{SLENDERNESS}: 2, plus: 0.1}}", f"{WEDGE}: 2", "14:", "must be a linear sum"),
        ("[0.05, 0.35]", "", "12:3", "has no value; write one"),
        ("minimise:", "records: 3\nminimise:", "19:1", "twice"),
        ("2, plus", "2, pluss", "14:", "needs pluss, which is not under variables"),
        (
            MINIMISED,
            "minimise: max_rotatoin",
            "19:11",
            "did you mean max_rotation?",
        ),
        (MINIMISED, "minimise: {max_rotation: {fractil: 1}}", "19:27", "fractile?"),
        (
            MINIMISED,
            "minimise: drift_ratio",
            "19:11",
            "drift_ratio needs superstr",
        ),
        (
            MINIMISED,
            "minimise: max_roof_displacement",
            "19:11",
            "whole_histories: true",
        ),
        (
            MINIMISED,
            f"minimise: {{{SLENDERNESS}: {{fractile: 0.5}}}}",
            "19:11",
            "a key",
        ),
        ("limits: {uplift: 0.3}\n", "", "", "limits is missing"),
        (MINIMISED, "", "", "minimise is missing"),
        ("limits: {", "limits: {annual_rate: 1e-4, ", "18:", "needs a hazard curve"),
        ("search:", "tolerance: {a: 0.1}\nsearch:", "20:", "tolerance.a is not under variables"),
        ("search:", "tolerance: 5\nsearch:", "20:", "1 % is 0.01"),
        ("search: {first: 8", "search: {first: 2", "20:", "must be a whole number from 4 to"),
        ("search:", "validate: {}\nsearch:", "20:", "must have records or a share"),
        ("search:", "validate: {share: 0.01}\nsearch:", "20:", "leaves none"),
        ("search:", "vary: []\nsearch:", "20:", "vary is not a key of the format"),
        (
            "variables:",
            "variables:\n  limits.uplift: [0, 1]",
            "12:3",
            "must not change in a design",
        ),
        (f"{WEDGE}: {{", f"{SLENDERNESS}: {{", "14:", "varies"),
    ],
)
def test_refusals(design: StudyPoints, old: str, new: str, place: str, said: str) -> None:
    assert old in FRAME
    result = design(FRAME.replace(old, new, 1), "--dry-run")
    assert result.exit_code == 3, result.stderr
    assert f"design.yaml:{place}" in result.stderr
    assert said in result.stderr


def test_old_words_are_understood_and_noted(design: StudyPoints) -> None:
    new = f"{FRAME}validate: {{share: 0.3}}\n"
    old = new
    for word, today in OLD_WORDS.items():
        old = old.replace(f"\n{today}:", f"\n{word}:")
    task, of_old = parse_design(new, "d.yaml"), parse_design(old, "d.yaml")
    assert task.file == of_old.file
    assert task.study.sources == of_old.study.sources
    assert task.study.notes == ()
    assert len(of_old.study.notes) == len(OLD_WORDS)
    assert "d.yaml:11:1: find is an old word; write variables" in of_old.study.notes[0]
    changed = parse_design(new, "d.yaml", overrides=["confirm.share=0.5", "scale=[2]"])
    assert changed.file.validation is not None
    assert changed.file.validation.share == 0.5
    (note,) = changed.study.notes
    assert note.startswith("--set confirm.share=0.5: confirm is an old word; write validate")
    assert "find is an old word" in design(old, "--dry-run").stderr
    faults = design(f"{new}find: {{}}\n", "--dry-run")
    assert faults.exit_code == 3
    assert "find is the old word for variables, which is given here as well" in faults.stderr


def test_cases_studies_and_designs_are_told_apart(design: StudyPoints, workplace: Path) -> None:
    assert "is a case without `variables`" in design(BASE).stderr
    (workplace / "task.yaml").write_text(FRAME, encoding="utf-8")
    for command, said in (("sweep", "is a design"), ("timehistory", "`rps design task.yaml`")):
        result = CliRunner().invoke(program, [command, "task.yaml"])
        assert result.exit_code == 3
        assert said in result.stderr


def test_shipped_designs_keep_the_schema() -> None:
    result = CliRunner().invoke(program, ["schema", "--design"])
    schema = json.loads(result.stdout)
    files = sorted((ROOT / "cases/designs").glob("*.yaml"))
    assert files
    texts = [read_text(file) for file in files]
    for text in (*texts, FRAME, TWO, BUILDING):
        jsonschema.validate(read_yaml(text, "design").content, schema)
    wrong = read_yaml(FRAME, "design").content | {"fnd": {}}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, schema)


def test_the_next_designs_halve_where_the_verdict_changes() -> None:
    places = np.array([[0.0], [0.25], [0.5], [1.0]])
    passes = np.array([[False, False, True, True]])
    first, second = neighbours(places)
    assert list(zip(first.tolist(), second.tolist(), strict=True)) == [(0, 1), (1, 2), (2, 3)]
    found = next_places(places, passes, places[:, 0], 2, 0.01, 8)
    assert found[:2, 0].tolist() == [0.375, 0.75]
    assert not len(next_places(places, passes, places[:, 0], 2, 0.6, 8))


def test_the_first_designs_are_even() -> None:
    assert first_places(1, 5, 1)[:, 0].tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    square = first_places(2, 64, 1)
    assert square[:4].tolist() == [[0, 0], [0, 1], [1, 0], [1, 1]]
    _, counts = np.unique((4.0 * square[4:]).astype(int), axis=0, return_counts=True)
    assert counts.tolist() == [4] * 16
    with pytest.raises(CaseError):
        parse_design("rps: 1", "empty.yaml")


@pytest.mark.evidence("design", "exact")
@pytest.mark.long
@needs_compiled_kernels
def test_the_shipped_design_against_a_grid(workplace: Path, no_figures: None) -> None:
    """The best design of a fine grid is hardly better than that of the search.

    Near the boundary verdicts are ragged: single designs pass among failing ones, of which grid and
    search find others. Their base shears are within 5 % (seeds 1 to 3: 0 to 4 %).
    """
    file = str(ROOT / "cases/designs/column_width.yaml")
    result = CliRunner().invoke(program, ["design", file, "--json", "-o", "out"])
    assert result.exit_code == 10, result.stderr  # two of the 14 other motions overturn the best
    found = json.loads(result.stdout)
    text, axis = read_text(file), np.linspace(0.0, 1.0, 31)
    task = parse_design(text, file)
    values = task.values(np.array([(x, y) for x in axis for y in axis]))
    values = values[Search(task).valid_cases(values)]
    design = lay_out(task.study_of(values))
    context = StudyContext(design.plan)
    numbers = range(0, len(design), LARGEST_BATCH)
    batches = [[design[n] for n in range(f, min(f + LARGEST_BATCH, len(design)))] for f in numbers]
    results = [run_batch(context, batch) for batch in batches]
    outcomes = np.concatenate([found.outcomes for found in results])
    fallen = np.char.startswith(outcomes, "overturned").reshape(-1, 22)

    def fractile(name: str, share: float) -> Array:
        reached = np.concatenate([found.columns[name] for found in results]).reshape(-1, 22)
        reached[fallen] = np.inf
        return np.asarray(np.quantile(reached, share, axis=1, method="inverted_cdf"))

    shear = fractile("max_base_shear", 0.5)
    passes = (fallen.sum(axis=1) <= 1) & (fractile("drift_ratio", 0.84) <= 0.006)
    least = shear[passes].min()
    best = next(iter(found["best"]["aims"].values()))
    assert best < 1.05 * least
    assert found["designs"]["looked_at"] < 0.6 * len(values)
