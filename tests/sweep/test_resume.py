"""A run goes on where the last one stopped; a changed study keeps what still applies."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from click.testing import Result

from sweep.small_studies import STUDY

Sweep = Callable[..., Result]
Document = Callable[..., dict[str, Any]]


def rewrite(workplace: Path, *changes: tuple[str, str]) -> None:
    text = STUDY
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (workplace / "study.yaml").write_text(text)


def test_a_second_run_computes_nothing(sweep_json: Document, workplace: Path) -> None:
    first = sweep_json("study.yaml")
    csv = (workplace / "results/study/sweep/points.csv").read_bytes()
    second = sweep_json("study.yaml")
    assert (first["points"]["computed"], first["points"]["kept"]) == (36, 0)
    assert (second["points"]["computed"], second["points"]["kept"]) == (0, 36)
    assert (workplace / "results/study/sweep/points.csv").read_bytes() == csv
    assert sweep_json("study.yaml", "--fresh")["points"]["computed"] == 36
    assert (workplace / "results/study/sweep/points.csv").read_bytes() == csv


def test_a_changed_study_keeps_what_applies_and_says_what_changed(
    sweep_json: Document, workplace: Path
) -> None:
    sweep_json("study.yaml")
    rewrite(workplace, ("critical, 0.5, 0]", "critical, 1.5]"), ("Test", "Renamed"))
    changed = sweep_json("study.yaml")
    assert changed["points"] == {"total": 24, "computed": 12, "kept": 12, "failed": 0, "unused": 24}
    notes = " ".join(changed["notes"])
    assert "curvature_ratio drops [0.5, 0]" in notes
    assert "adds [1.5]" in notes
    assert "12 points still apply, 12 are to be computed" in notes
    assert "24 stored points are no longer in the study" in notes
    # Nothing was thrown away: the first study is whole again at once.
    rewrite(workplace)
    assert sweep_json("study.yaml")["points"]["computed"] == 0


def test_a_changed_case_applies_to_nothing(sweep_json: Document, workplace: Path) -> None:
    sweep_json("study.yaml")
    base = workplace / "base.yaml"
    base.write_text(base.read_text().replace("ratio: 0.05", "ratio: 0.04"))
    changed = sweep_json("study.yaml")
    assert changed["points"]["computed"] == 36
    assert "base.superstructure.damping.ratio: 0.05 -> 0.04" in " ".join(changed["notes"])


def test_the_folder_of_another_study_is_refused(sweep: Sweep, workplace: Path) -> None:
    assert sweep("study.yaml", "-o", "there").exit_code == 0
    text = (workplace / "study.yaml").read_text().replace("scale: [0.5, 1.0]", "scale: [2]")
    (workplace / "other.yaml").write_text(text)
    refused = sweep("other.yaml", "-o", "there")
    assert refused.exit_code == 7
    assert "another study (study)" in refused.stderr
    assert sweep("other.yaml", "-o", "there", "--fresh").exit_code == 0


def test_report_only_computes_nothing(sweep: Sweep, workplace: Path) -> None:
    lacking = sweep("study.yaml", "--report-only")
    assert lacking.exit_code == 7
    assert "lacks 36 of 36 points" in lacking.stderr
    assert sweep("study.yaml").exit_code == 0
    rewrite(workplace, ("scale:", "reports: [overturning]\nscale:"))
    assert sweep("study.yaml", "--report-only").exit_code == 0
    folder = workplace / "results/study/sweep"
    assert (folder / "overturning.csv").exists()
    assert (folder / "overturning.png").exists()


def test_options_that_contradict_each_other_are_refused(sweep: Sweep) -> None:
    for options in (("--fresh",), ("--retry-failed",), ("--scheduler", "tcp://x:1")):
        assert sweep("study.yaml", "--report-only", *options).exit_code == 2
    assert sweep("study.yaml", "--jobs", "2", "--scheduler", "tcp://x:1").exit_code == 2
