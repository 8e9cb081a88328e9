"""Short texts: progress, times, labels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from rpscli.analyses.kernels import compilation
from rpscli.analyses.kernels.compilation import Listener
from rpscli.case.schema.keys import unit
from rpscli.commands.shell import waiting as sweep_progress
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation, progress_line, progress_report
from rpscli.report.study.labels import labels
from rpscli.report.study.shown import of_first_system
from rpscli.studies import load_study
from rpscli.sweep.run import Progress
from rpscli.sweep.statistics.grouping import statistic_words
from rpscli.sweep.table import _cell, array


def progress(computed: int, failed: int = 0, seconds: float = 10.0) -> Progress:
    return Progress(total=100, kept=20, computed=computed, failed=failed, seconds=seconds)


def test_a_line_has_rate_and_time_left() -> None:
    assert progress_line(progress(40)) == "60 of 100 points, 4 points/s, 10 s left"
    assert progress_line(progress(40, 2)).startswith("60 of 100 points, 2 failed, 4 ")
    assert progress_line(progress(0)) == "20 of 100 points"


def test_the_wait_for_a_compilation_does_not_count() -> None:
    # 40 s for the first 10 points, of which compiling took most; then 30 points in 6 s.
    now = Progress(100, 20, computed=40, failed=0, seconds=46.0, first=10, first_seconds=40.0)
    assert progress_line(now) == "60 of 100 points, 5 points/s, 8 s left"
    begun = Progress(100, 20, computed=10, failed=0, seconds=40.0, first=10, first_seconds=40.0)
    assert progress_line(begun) == "30 of 100 points"


def test_plain_lines_become_rarer(capsys: pytest.CaptureFixture[str]) -> None:
    with progress_report(Terminal(), 20, 100) as report:
        for second in range(1, 61):
            report(progress(second, seconds=float(second)))
    lines = capsys.readouterr().err.splitlines()
    assert 4 <= len(lines) <= 9
    with progress_report(Terminal(quiet=True), 20, 100) as report:
        report(progress(60))
    assert capsys.readouterr().err == ""


def test_a_terminal_gets_a_bar(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sweep_progress.sys.stderr, "isatty", lambda: True)  # type: ignore[attr-defined]
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    with progress_report(Terminal(), 20, 100) as report:
        report(progress(40, 1))
    text = capsys.readouterr().err
    assert "60/100" in text
    assert "1 failed, 4 points/s, 10 s left" in text


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


@pytest.mark.parametrize(
    ("key", "value", "text"),
    [
        ("superstructure.storeys", 3, "n = 3"),
        ("podium.bearing.curvature_ratio", 0, "flat ends"),
        ("podium.bearing.curvature_ratio", 0.25, "ρ = 0.25"),
        ("podium.impact", {"law": "rigid"}, 'impact = {"law": "rigid"}'),
        ("record", "a.at2", "record = a.at2"),
    ],
)
def test_labels_use_the_letters_of_the_paper(key: str, value: object, text: str) -> None:
    assert labels([key], [value]) == text


def test_statistics_cells_and_columns() -> None:
    assert statistic_words("mean") == "mean of survivors"
    assert statistic_words(0.84) == "84 % fractile"
    assert [_cell(0.1, "-"), _cell([1, 2], "-"), _cell("500 mm", "m")] == ["0.1", "[1, 2]", "0.5"]
    np.testing.assert_equal(array([1, None, "inf"]), [1.0, np.nan, np.inf])
    assert array([0.5, "critical"]).tolist() == [0.5, "critical"]


def test_units_come_from_the_case_format() -> None:
    assert unit("superstructure.storey_mass") == "kg"
    assert unit("superstructure.stiffness.0") == "N/m"
    assert unit("podium.bearing.slenderness") == "-"
    assert unit("record") == "-"


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
