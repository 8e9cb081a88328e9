"""A run goes on where the last one stopped; a changed study keeps what still applies."""

from __future__ import annotations

from pathlib import Path

from sweep.small_studies import BASE, FOLDER, STUDY, Sweep, SweepJson


def test_a_second_run_computes_nothing(sweep_json: SweepJson, workplace: Path) -> None:
    first = sweep_json("study.yaml")
    csv = (workplace / FOLDER / "points.csv").read_bytes()
    second = sweep_json("study.yaml")
    assert (first["points"]["computed"], first["points"]["kept"]) == (36, 0)
    assert (second["points"]["computed"], second["points"]["kept"]) == (0, 36)
    assert (workplace / FOLDER / "points.csv").read_bytes() == csv
    assert sweep_json("study.yaml", "--fresh")["points"]["computed"] == 36
    assert (workplace / FOLDER / "points.csv").read_bytes() == csv


def test_a_changed_study_keeps_what_applies_and_says_what_changed(sweep_json: SweepJson) -> None:
    sweep_json("study.yaml")
    text = STUDY.replace("critical, 0.5, 0]", "critical, 1.5]").replace("Test", "Renamed")
    changed = sweep_json("study.yaml", study=text)
    assert changed["points"] == {"total": 24, "computed": 12, "kept": 12, "failed": 0, "unused": 24}
    notes = " ".join(changed["notes"])
    assert "curvature_ratio drops [0.5, 0]" in notes
    assert "adds [1.5]" in notes
    assert "12 points still apply, 12 are to be computed" in notes
    assert "24 stored points are no longer in the study" in notes
    # Nothing was thrown away: the first study is whole again at once.
    assert sweep_json("study.yaml", study=STUDY)["points"]["computed"] == 0


def test_a_changed_case_applies_to_nothing(sweep_json: SweepJson) -> None:
    sweep_json("study.yaml")
    changed = sweep_json("study.yaml", base=BASE.replace("ratio: 0.05", "ratio: 0.04"))
    assert changed["points"]["computed"] == 36
    assert "base.superstructure.damping.ratio: 0.05 -> 0.04" in " ".join(changed["notes"])


def test_the_folder_of_another_study_is_refused(sweep: Sweep, workplace: Path) -> None:
    assert sweep("study.yaml", "-o", "there").exit_code == 0
    other = STUDY.replace("scale: [0.5, 1.0]", "scale: [2]")
    (workplace / "other.yaml").write_text(other)
    refused = sweep("other.yaml", "-o", "there")
    assert refused.exit_code == 7
    assert "another study (study)" in refused.stderr
    assert sweep("other.yaml", "-o", "there", "--fresh").exit_code == 0


def test_report_only_computes_nothing(sweep: Sweep, workplace: Path) -> None:
    lacking = sweep("study.yaml", "--report-only")
    assert lacking.exit_code == 7
    assert "lacks 36 of 36 points" in lacking.stderr
    assert sweep("study.yaml").exit_code == 0
    text = STUDY.replace("scale:", "reports: [overturning]\nscale:")
    assert sweep("study.yaml", "--report-only", study=text).exit_code == 0
    for name in ("overturning.csv", "overturning.png"):
        assert (workplace / FOLDER / name).exists()


def test_options_that_contradict_each_other_are_refused(sweep: Sweep) -> None:
    for options in (("--fresh",), ("--retry-failed",), ("--scheduler", "tcp://x:1")):
        assert sweep("study.yaml", "--report-only", *options).exit_code == 2
    assert sweep("study.yaml", "--jobs", "2", "--scheduler", "tcp://x:1").exit_code == 2
