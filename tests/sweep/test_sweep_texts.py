"""Progress, times and labels; values as the study has them in texts, and in SI in files."""

from __future__ import annotations

from copy import copy
from pathlib import Path
from typing import Any

import pytest
import yaml

from rpscli.analyses.kernels import compilation
from rpscli.analyses.kernels.compilation import Listener
from rpscli.commands.shell import waiting as sweep_progress
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation, progress_line, progress_report
from rpscli.report.study.labels import key_cells, key_columns, label
from rpscli.report.study.shown import of_first_system
from rpscli.report.table import records
from rpscli.studies import load_study
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import Progress
from rpscli.units import Written, in_si
from sweep.small_studies import STUDY, Make, Sweep, csv_rows


def progress(computed: int, failed: int = 0, seconds: float = 10.0) -> Progress:
    return Progress(total=100, kept=20, computed=computed, failed=failed, seconds=seconds)


@pytest.mark.parametrize(
    ("now", "line"),
    [
        (progress(40), "60 of 100 points, 4 points/s, 10 s left"),
        (progress(40, 2), "60 of 100 points, 2 failed, 4 points/s, 10 s left"),
        (progress(0), "20 of 100 points"),
        # 40 s for the first 10 points, of which compiling took most; then 30 points in 6 s.
        (Progress(100, 20, 40, 0, 46.0, 10, 40.0), "60 of 100 points, 5 points/s, 8 s left"),
        (Progress(100, 20, 10, 0, 40.0, 10, 40.0), "30 of 100 points"),
    ],
)
def test_a_line_has_rate_and_time_left_without_compiling(now: Progress, line: str) -> None:
    assert progress_line(now) == line


def test_plain_lines_become_rarer(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_report(Terminal(), 20, 100) as report:
        for second in range(1, 61):
            report(progress(second, seconds=float(second)))
    lines = capsys.readouterr().err.splitlines()
    assert 4 <= len(lines) <= 9
    with progress_report(Terminal(quiet=True), 20, 100) as report:
        report(progress(60))
    assert capsys.readouterr().err == ""


def test_a_compilation_stands_in_the_bar_of_a_study_and_says_how_long_it_takes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("RPS_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(sweep_progress.sys.stderr, "isatty", lambda: True)  # type: ignore[attr-defined]
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    listeners: list[Listener] = []
    monkeypatch.setattr(compilation, "_listeners", listeners)
    for quiet in (False, True):
        announce_compilation(Terminal(quiet=quiet))
        with progress_report(Terminal(quiet=quiet), 20, 100) as report, listeners[0]("kernel"):
            report(progress(40, 1))
        text = capsys.readouterr().err
        for shown in (
            "compiling the kernel, once for this version: half a minute, some minutes on a busy",
            "compiling the kernel (half a minute",
            "60/100",
        ):
            assert (shown in text) != quiet


def test_limits_of_the_base_that_do_not_count_are_named() -> None:
    case = Path(__file__).parents[2] / "cases" / "six_storey.yaml"
    base: dict[str, Any] = yaml.safe_load(case.read_text(encoding="utf-8"))
    del base["limits"], base["analysis"]  # whose 1e-6 is text to this reader
    study: dict[str, Any] = {"rps": 1, "vary": [{"superstructure.period": [0.3, 0.4]}]}
    study["records"] = ["pulse:sine?amplitude=0.3g&period=0.8"]
    said = []
    of_base, own = {"limits": {"drift_ratio": 0.01}}, {"limits": {"overturning": 0.1}}
    for first, second in ((of_base, own), (of_base, {}), ({}, own)):
        layout = load_study(study | {"base": base | first} | second).layout
        said.append(of_first_system(layout).partition("; own limits")[2])
    assert said == [" replace all of the base: drift_ratio", "", ""]


MEASURED = (
    STUDY.replace("scale: [0.5, 1.0]", "scale: {measure: PGA, values: [0.2 g, 0.6 g]}")
    .replace("[1, 2, 3]", "[1, 2]")
    .replace("podium.bearing.curvature_ratio: [critical, 0.5, 0]", "{}: [{}]")
    + "limits: {rotation_ratio: 0.001}\nreports: [fragility]\n"
)


@pytest.mark.parametrize("columns", [60, 80, 100, 120])
def test_a_study_fits_the_terminal_and_has_what_was_typed(
    sweep: Sweep, monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
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
    assert {row["PGA [m/s2]"] for row in csv_rows("verdicts.csv")} == {"1.96133", "5.88399"}


def test_columns_of_keys_hold_si_and_show_what_was_typed() -> None:
    (column,) = key_columns(["podium.cap_beam_mass"], [["200 t"], [3e5]])
    assert records([column]) == [{column.name: 2e5}, {column.name: 3e5}]
    assert key_cells(column, "mass") == ("mass", ["200 t", "300000 kg"])
    (column,) = key_columns(["podium.cap_beam_mass"], [[2e5], [300000]])
    assert key_cells(column, "mass") == ("mass kg", ["200000", "300000"])
    assert label("PGA", 5.0) == "PGA = 5 m/s2"
    assert label("PGA", Written(5.88399, " 0.6 g ")) == "PGA = 0.6 g"


def test_keys_are_linked_to_those_of_an_axis(study_of: Make) -> None:
    linked = "linked: {podium.columns: {podium.bearing.semi_diagonal: 4, plus: 1}}\n"
    vary = "  - podium.bearing.semi_diagonal: [1 m, 150 cm, 2.0]\n"
    (axis, _) = study_of(STUDY.replace("vary:\n", linked + "vary:\n" + vary)).axes[:2]
    assert axis.keys == ("podium.bearing.semi_diagonal", "podium.columns")
    assert [columns for _, columns in axis.rows] == [5, 7, 9]


def test_what_is_written_goes_with_the_number() -> None:
    value = copy(in_si("0.6 g", "m/s2"))  # as to workers of Dask
    assert isinstance(value, Written)
    assert (value, repr(value), value.text) == (5.88399, "5.88399", "0.6 g")


def test_what_a_case_scales_its_record_to_is_said_as_it_has_it(
    workplace: Path, study_of: Make
) -> None:
    base = workplace / "base.yaml"
    record = "record: {source: 'pulse:sine?amplitude=1&period=1',"
    record += " scale_to: {measure: PGA, value: 0.3 g}}"
    base.write_text(base.read_text(encoding="utf-8") + record, encoding="utf-8")
    layout = lay_out(study_of(STUDY, ("scale: [0.5, 1.0]\n", "")))
    assert layout.scaled_to == "PGA = 0.3 g"
    assert layout.scales == pytest.approx((2.941995,), rel=1e-15)


def test_a_record_that_is_listed_twice_is_named(study_of: Make) -> None:
    assert study_of(STUDY).notes == ()
    again = '  - "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"\nscale'
    study = study_of(STUDY, ("scale", again))
    source = "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"
    assert study.notes == (f"records: {source}: given more than once, taken once",)
    assert study.sources == study_of(STUDY).sources
