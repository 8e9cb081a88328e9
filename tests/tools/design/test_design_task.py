"""`rps design`: exact answers, refusals, workers, interruptions, and what hangs on the records."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner
from conformance import conforms
from paper_structures import needs_compiled_kernels, python
from sweep.small_studies import BASE, ROOT, csv_rows, document_of

from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.cli import program
from rpscli.sweep.evaluation import run_batch
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import LARGEST_BATCH
from rpscli.tools.design.keys import parse_design
from rpscli.tools.design.report import neighbours_note
from rpscli.tools.design.search import Search, weights_of

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
    f"{SLENDERNESS}: [0.05, 0.35]\n",
    f"{SLENDERNESS}: [0.05, 0.35]\n  {SIZE}: [800 mm, 2 m]\n",
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
minimise: max_base_shear
search: {{first: 8, most: 20, resamples: 50}}
"""


@pytest.fixture
def design(workplace, no_figures):
    """Run `rps design` on a text in this process."""

    def invoke(text, *arguments):
        (workplace / "design.yaml").write_text(text, encoding="utf-8")
        return CliRunner().invoke(program, ["design", "design.yaml", *arguments])

    return invoke


@pytest.fixture
def design_json(design):
    """The JSON document of `rps design`."""

    def invoke(text, *arguments, exit_code=0):
        return document_of(design(text, *arguments, "--json"), exit_code)

    return invoke


def test_a_limit_on_the_mean_is_met_by_the_best_design(design, design_json):
    """The search and the study of the best design find the same mean, at most the limit."""
    mean = "limits={max_cap_beam_displacement: {at_most: 3 mm, of: mean}}"
    words = FRAME, "--set", mean, "--set", "search.resamples=0"
    found = design_json(*words)
    (asked,) = (each for each in found["requirements"] if each["of"] == "mean")
    assert (asked["judged_by"], asked["met"]) == ("mean", True)
    assert asked["value"] == pytest.approx(asked["mean_of_maxima"], rel=1e-9)
    assert 0.002 < asked["value"] <= 0.003
    assert "mean 2.989 mm of 7" in design(*words, "--force").output
    six = FRAME.replace(", 0.29 g", "")
    (asked,) = (
        each for each in design_json(six, *words[1:], "-o", "six")["requirements"]
        if each["of"] == "mean"
    )  # fmt: skip
    assert asked["judged_by"] == "largest"
    assert asked["value"] <= 0.003


@pytest.mark.evidence("design", "exact")
def test_one_unknown_against_the_exact_answer(design, design_json):
    # 30 % of seven are two: the third largest peak must not lift the frame.
    found = design_json(FRAME, "--set", "search.resamples=0")
    exact, close = sorted(PEAKS)[-3], 1.01 * 0.001 * 0.3
    best = found["best"]["values"][SLENDERNESS]
    assert exact <= best < exact + close
    assert found["best"]["values"][WEDGE] == pytest.approx(2.0 * best + 0.1, rel=1e-5)
    # The same order statistic of each resample is known, and closed in upon as well.
    found = design_json(FRAME, "-o", "out")
    weights = weights_of(range(len(PEAKS)), 400, 1)[1:]
    answers = np.sort([np.sort(np.repeat(PEAKS, row.astype(int)))[-3] for row in weights])
    interval = found["records"]["intervals"][SLENDERNESS]
    for name, expected, mine in (
        ("least slenderness", exact, best),
        ("lower end of its interval", answers[9], interval[0]),
        ("upper end of its interval", answers[389], interval[1]),
    ):
        conforms(
            "design", f"{name}, a rigid frame", expected, mine, 0.3 * 0.01,
            "closed form", "order statistics of the peaks that lift the frame",
        )  # fmt: skip
    assert interval[0] < exact < interval[1]
    # What holds passes in 90 % of the resamples: 360 of the answers are not above it.
    assert 0.0 <= found["best"]["values"][SLENDERNESS] - answers[359] < close
    assert found["best"]["passing_share"] >= 0.9
    files = {Path(name).name for name in found["files"]}
    assert {"designs.csv", "points.csv", "verdicts.csv", "requirements.png"} <= files
    rows = csv_rows("designs.csv", "out")
    assert len(rows) == found["designs"]["looked_at"] <= 64
    # One unknown and a linked key: all of it is in the table of the terminal, as it was judged.
    shown = design(FRAME, "-o", "out")
    rounds = re.findall(r"round (\d+) of (\d+): \d+ designs", shown.stderr)
    assert [int(number) for number, _ in rounds] == [*range(1, len(rounds) + 1)]
    assert {int(most) for _, most in rounds} >= {len(rounds)}  # all designs were used
    told = re.findall(r"(\d+) designs tried, \d+ pass; the best so far: ", shown.stderr)
    assert len(told) == len(rounds) - 1
    assert [int(tried) for tried in told] == sorted(map(int, told))
    text = " ".join(shown.stdout.split())
    for key in (SLENDERNESS, WEDGE):
        best = f"{found['best']['values'][key]:.10g}"
        assert f" {best} " in text
        assert len(best) <= 8


@pytest.mark.evidence("design", "exact")
def test_two_unknowns_against_the_exact_answer(design_json):
    settings = ("search.most=128", "search.resolution=0.01", "search.resamples=0")
    found = design_json(TWO, *(word for text in settings for word in ("--set", text)))
    values = found["best"]["values"]
    # Size does not matter for uplift: the least one, and the least slenderness that stands.
    assert values[SIZE] == 0.8
    assert 0.0 <= values[SLENDERNESS] - sorted(PEAKS)[-3] < 0.3 * 0.02
    assert found["at_bounds"] == [{"key": SIZE, "end": "least"}]
    assert any(
        "better designs may lie beyond" in warning for warning in found["warnings"]
    )
    assert [requirement["binds"] for requirement in found["requirements"]] == [True]


def test_a_number_of_columns_stays_whole(design_json):
    text = FRAME.replace(f"{SLENDERNESS}: [0.05, 0.35]", "podium.columns: [4, 9]")
    text = text.replace(f"  {WEDGE}: {{{SLENDERNESS}: 2, plus: 0.1}}\n", "")
    text = text.replace("linked:\n", "").replace(
        f"minimise: {SLENDERNESS}", "minimise: podium.columns"
    )
    found = design_json(text, "-o", "out")
    assert found["best"]["values"]["podium.columns"] == 4
    rows = csv_rows("designs.csv", "out")
    assert {row["podium.columns [-]"] for row in rows} <= {str(n) for n in range(4, 10)}


def test_nothing_passes(design, design_json):
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
def test_verdicts_are_those_of_a_study(design_json):
    found = design_json(BUILDING, "-o", "out")
    designs = csv_rows("designs.csv", "out")
    verdicts = csv_rows("verdicts.csv", "out")
    assert len(verdicts) == 8 * len(designs)
    keys = [name for name in designs[0] if name.startswith("podium.")]
    assert len(keys) == 3
    rows = [tuple(row[key] for key in keys) for row in verdicts[::8]]
    assert rows == [tuple(design[key] for key in keys) for design in designs]
    exceeded = [row["exceeded [-]"] == "true" for row in verdicts]
    assert 0 < sum(exceeded) < len(exceeded)
    by_design = np.array(exceeded).reshape(len(designs), -1)
    passes = np.array([row["passes [-]"] == "true" for row in designs])
    assert passes.any()
    assert passes.tolist() == (~by_design.any(axis=1)).tolist()
    ((aim, best),) = found["best"]["aims"].items()
    least = np.array([float(row[f"least {aim.replace(',', '')} [N]"]) for row in designs])
    share = np.array([float(row["passing_share [-]"]) for row in designs])
    surely = passes & (share >= 0.9)
    assert best == pytest.approx(least[surely if surely.any() else passes].min())


HAZARD = "PGV [m/s],rate [1/year]\n0.1,1e-2\n0.3,2e-3\n0.8,3e-4\n2,2e-5\n"
RATE = (
    BUILDING.replace(
        "scale: [1.0, 1.5]", "scale: {measure: PGV, values: [0.9, 0.3, 0.6]}"
    )
    .replace(
        BUILDING[BUILDING.index("limits:") : BUILDING.index("minimise:")], "limits: {}\n"
    )
    .replace(
        "limits: {}",
        "limits: {annual_rate: 1e-4}\nhazard: {file: hazard.csv, measure: PGV}",
    )
)


@needs_compiled_kernels
def test_a_limit_on_the_annual_rate(design_json, workplace):
    """The rate is the integral of the shares, linear in ln PGV, over the hazard, in small steps."""
    (workplace / "hazard.csv").write_text(HAZARD)
    unseen = "validate: {records: ['synthetic:?pga=0.8g&duration=4&dt=0.02&seed=9']}\n"
    found = design_json(RATE + unseen, "-o", "out")
    points = csv_rows("points.csv", "out")
    levels = np.array([0.3, 0.6, 0.9])
    fine = np.geomspace(0.1, 20.0, 200_001)
    curve = np.array(
        [[float(x) for x in line.split(",")] for line in HAZARD.splitlines()[1:]]
    )
    x, height = np.log(curve.T)
    beyond = height[-1] + np.diff(height)[-1] / np.diff(x)[-1] * (np.log(fine) - x[-1])
    rates = np.exp(np.where(fine > 2.0, beyond, np.interp(np.log(fine), x, height)))
    middle = np.log(np.sqrt(fine[1:] * fine[:-1]))
    checked = set()
    for place, row in enumerate(csv_rows("designs.csv", "out")):
        own = points[15 * place : 15 * place + 15]
        fallen = [
            np.mean(
                [
                    p["outcome [-]"].startswith("over")
                    for p in own
                    if p["PGV [m/s]"] == f"{v:g}"
                ]
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
    (verdict,) = found["validation"]
    assert (
        verdict["exceeded"] == (verdict["value"] > 1e-4) == (found["validated"] is False)
    )
    life = RATE.replace(
        "annual_rate: 1e-4", f"probability_in_50_years: {-np.expm1(-50.0 * 1e-4)}"
    )
    assert design_json(life)["requirements"][0]["limit"] == pytest.approx(1e-4, rel=1e-12)


@needs_compiled_kernels
def test_perturbed_histories_are_parts_of_their_records(design_json):
    design_json(f"{BUILDING}perturb: {{members: 2}}\n", "-o", "out")
    points = csv_rows("points.csv", "out")
    designs = csv_rows("designs.csv", "out")
    assert len(points) == len(designs) * 5 * 2 * 2
    for place, row in enumerate(designs):
        own = points[20 * place : 20 * place + 20]
        for scale in ("1", "1.5"):
            fallen = [p["outcome [-]"].startswith("over") for p in own][
                2 * (scale != "1") :
            ]
            share = np.mean([each for n, each in enumerate(fallen) if n % 4 < 2])
            assert float(row[f"overturning at scale = {scale} [-]"]) == pytest.approx(
                share
            )


@pytest.mark.long
@needs_compiled_kernels
def test_interrupted_and_resumed_or_in_two_threads_it_ends_in_the_same_bytes(
    design, workplace
):
    assert design(BUILDING, "--jobs", "2", "-o", "calm").exit_code == 0
    interrupting = str(Path(__file__).parents[2] / "sweep" / "interrupted.py")
    words = ("design", "design.yaml", "--jobs", "1", "--json", "--figures", "none")
    stopped = python(interrupting, *words, folder=workplace, exit_code=130)
    assert json.loads(stopped.stdout)["points"]["stored"] > 0
    assert not (workplace / "results/design/design/designs.csv").exists()
    python("-mrpscli", *words, folder=workplace)
    for name in ("designs.csv", "points.csv"):
        resumed = workplace / "results/design/design" / name
        assert resumed.read_bytes() == (workplace / "calm" / name).read_bytes()


def test_validation(design, design_json, workplace):
    unseen = (
        'validate: {records: [{source: "pulse:half_sine?period=0.4", amplitude: [%s]}]}\n'
    )
    found = design_json(FRAME + unseen % "0.1 g, 0.2 g")
    assert found["validated"] is True
    found = design_json(FRAME + unseen % "0.1 g, 0.4 g", exit_code=10)
    assert found["validated"] is False
    assert found["passed"] is False
    (verdict,) = found["validation"]
    assert (verdict["beyond"]["count"], verdict["beyond"]["share"]) == (1, 0.5)
    assert any("best design does not keep" in warning for warning in found["warnings"])
    (workplace / "broken.at2").write_text("no record")
    found = design_json(FRAME + "validate: {records: [broken.at2]}\n", exit_code=5)
    assert found["validated"] is False
    assert "broken.at2" in found["error"]["message"]
    task = parse_design(FRAME + "validate: {share: 0.3}\n", "design.yaml")
    assert len(task.study.sources) == 5
    assert len(task.unseen) == 2
    assert not set(task.unseen) & set(task.study.sources)


def test_invalid_designs_count_as_failing(design_json):
    # The wedge must be outside the flat end.
    text = FRAME.replace("2, plus: 0.1", "-1, plus: 0.55")
    found = design_json(text)
    assert found["designs"]["valid"] < found["designs"]["looked_at"]
    assert found["best"]["values"][SLENDERNESS] < 0.275
    assert any("not valid cases" in warning for warning in found["warnings"])


def test_a_dry_run_computes_nothing(design_json, workplace):
    for most, designs in ((64, 8), (4, 4)):
        found = design_json(FRAME, "--set", f"search.most={most}", "--dry-run")
        assert (found["command"], found["systems"]) == ("design", designs)
    assert not (workplace / "results").exists()


@pytest.mark.parametrize(
    ("old", "new", "place", "said"),
    [
        ("0.35]", "0.02]", "12:31", "must rise from the least value to the largest"),
        ("[0.05, 0.35]", "[0.05]", "12:31", "must be two numbers, [least, largest]"),
        ("[0.05, 0.35]", "[low, high]", "12:31", "must be two numbers"),
        (
            f"{SLENDERNESS}: [0.05",
            "podium.devices[0].gap: [0.1",
            "12:3",
            "podium.devices.0.gap?",
        ),
        (
            f"{SLENDERNESS}: [0.05",
            "podium.bearing.slendernes: [0.05",
            "12:3",
            "did you mean",
        ),
        (
            f"{WEDGE}: {{{SLENDERNESS}: 2, plus: 0.1}}",
            f"{WEDGE}: 2",
            "14:",
            "must be a linear sum",
        ),
        ("[0.05, 0.35]", "", "12:3", "has no value; write one"),
        ("minimise:", "records: 3\nminimise:", "19:1", "twice"),
        ("2, plus", "2, pluss", "14:", "needs pluss, which is not under variables"),
        (MINIMISED, "minimise: max_rotatoin", "19:11", "did you mean max_rotation?"),
        (MINIMISED, "minimise: {max_rotation: {fractil: 1}}", "19:27", "fractile?"),
        (MINIMISED, "minimise: drift_ratio", "19:11", "drift_ratio needs superstr"),
        (MINIMISED, "minimise: max_roof_displacement", "19:11", "whole_histories: true"),
        (MINIMISED, f"minimise: {{{SLENDERNESS}: {{fractile: 0.5}}}}", "19:11", "a key"),
        ("limits: {uplift: 0.3}\n", "", "", "limits is missing"),
        (MINIMISED, "", "", "minimise is missing"),
        ("limits: {", "limits: {annual_rate: 1e-4, ", "18:", "needs a hazard curve"),
        (
            "search:",
            "tolerance: 0.02\nsearch:",
            "20:1",
            "tolerance is gone: every design",
        ),
        ("variables:", "find:", "11:1", "find is gone: write `variables`"),
        ("search:", "confirm: {}\nsearch:", "20:1", "confirm is gone: write `validate`"),
        (
            MINIMISED,
            "minimise: [max_rotation]",
            "19:11",
            "Pareto front, are gone; write a sum",
        ),
        (
            "search: {first: 8",
            "search: {first: 2",
            "20:",
            "must be a whole number from 4 to",
        ),
        ("search:", "validate: {}\nsearch:", "20:", "must have records or a share"),
        ("search:", "validate: {share: 0.01}\nsearch:", "20:", "leaves none"),
        ("search:", "vary: []\nsearch:", "20:", "vary is not a key of the format"),
        (
            "variables:",
            "variables:\n  limits.uplift: [0, 1]",
            "12:3",
            "must not change in",
        ),
        (f"{WEDGE}: {{", f"{SLENDERNESS}: {{", "14:", "varies"),
    ],
)
def test_refusals(design, old, new, place, said):
    assert old in FRAME
    result = design(FRAME.replace(old, new, 1), "--dry-run")
    assert result.exit_code == 3, result.stderr
    assert f"design.yaml:{place}" in result.stderr
    assert said in result.stderr


def test_the_constant_of_a_sum_may_have_a_unit():
    text = FRAME.replace(
        "linked:\n", f"linked:\n  {SIZE}: {{{SLENDERNESS}: 2, plus: 1400 mm}}\n"
    )
    assert parse_design(text, "design.yaml").file.linked[SIZE] == {
        SLENDERNESS: 2,
        "plus": 1.4,
    }


def test_what_a_design_takes_from_its_base_is_said_first(design, workplace):
    yielding = BASE.replace("  damping:", "  yield: {ratio: 1.2}\n  damping:")
    (workplace / "base.yaml").write_text(f"{yielding}limits: {{drift_ratio: 0.01}}\n")
    first, second, *_ = design(BUILDING, "--dry-run").stderr.splitlines()
    assert "the limits of the design replace those of the base case: drift_ratio" in first
    assert f"a multiple of V_st, which changes with {SLENDERNESS}" in second
    assert parse_design(FRAME, "design.yaml").study.notes == ()


def test_cases_studies_and_designs_are_told_apart(design, workplace):
    assert "is a case without `variables`" in design(BASE).stderr
    assert "is a file without `variables`" in design("rps: 1").stderr
    (workplace / "task.yaml").write_text(FRAME, encoding="utf-8")
    for command, said in (
        ("sweep", "is a design"),
        ("timehistory", "`rps design task.yaml`"),
    ):
        result = CliRunner().invoke(program, [command, "task.yaml"])
        assert result.exit_code == 3
        assert said in result.stderr


def test_shipped_designs_keep_the_schema():
    result = CliRunner().invoke(program, ["schema", "design"])
    schema = json.loads(result.stdout)
    files = sorted((ROOT / "cases/designs").glob("*.yaml"))
    assert files
    texts = [read_text(file) for file in files]
    for text in (*texts, FRAME, TWO, BUILDING):
        jsonschema.validate(read_yaml(text, "design").content, schema)
    wrong = read_yaml(FRAME, "design").content | {"fnd": {}}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, schema)


@pytest.mark.evidence("design", "exact")
@pytest.mark.long
@needs_compiled_kernels
def test_the_shipped_design_against_a_grid(no_figures):
    """The best design of a fine grid is hardly better than that of the search.

    Near the boundary verdicts are ragged: single designs hold among failing ones, of which grid and
    search find others. Their base shears are within 2 % (seeds 1 to 3: 0 to 0.2 %).
    """
    file = str(ROOT / "cases/designs/column_width.yaml")
    result = CliRunner().invoke(program, ["design", file, "--json", "-o", "out"])
    assert result.exit_code == 10, (
        result.stderr
    )  # two of the 14 other motions overturn it
    found = json.loads(result.stdout)
    text, axis = read_text(file), np.linspace(0.0, 1.0, 31)
    task = parse_design(text, file)
    values = task.values(np.array([(x, y) for x in axis for y in axis]))
    values = values[Search(task).valid_cases(values)]
    design = lay_out(task.study_of(values))
    context = design.context
    numbers = range(0, len(design), LARGEST_BATCH)
    batches = [
        [design[n] for n in range(f, min(f + LARGEST_BATCH, len(design)))]
        for f in numbers
    ]
    results = [run_batch(context, batch) for batch in batches]
    outcomes = np.concatenate([found.outcomes for found in results])
    fallen = np.char.startswith(outcomes, "overturned").reshape(-1, 22)

    shear = np.concatenate(
        [found.columns["max_base_shear"] for found in results]
    ).reshape(-1, 22)
    drift = np.concatenate([found.columns["drift_ratio"] for found in results]).reshape(
        -1, 22
    )
    shear = np.quantile(
        np.where(fallen, np.inf, shear), 0.5, axis=1, method="inverted_cdf"
    )
    # Of 22 one may overturn, and three may drift more than 84 % are to.
    weights = weights_of(range(22), 500, 1)
    passes = (weights @ fallen.T <= 1) & (weights @ (fallen | (drift > 0.006)).T <= 3)
    least = shear[passes[0] & (passes[1:].mean(axis=0) >= 0.9)].min()
    (best,) = found["best"]["aims"].values()
    assert best < 1.02 * least
    assert found["designs"]["looked_at"] < 0.6 * len(values)


@pytest.mark.parametrize(("beside", "fails"), [((3, 4, 5, 7, 8), 5), ((4, 5, 7), 0)])
def test_a_best_design_that_stands_alone_is_told(beside, fails):
    holds = np.array([[True] * 9])
    holds[0, list(beside)] = False
    answer = SimpleNamespace(places=np.linspace(0.0, 1.0, 9)[:, None], passes=holds)
    told = list(neighbours_note(answer, 6))
    assert len(told) == (fails > 0)
    assert not told or f"{fails} fail: it stands alone" in told[0]
