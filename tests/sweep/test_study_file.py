"""What is wrong with a study is said before anything runs, at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpscli.case.json_schema import json_schema_of
from rpscli.case.study.schema import MeasureScale, StudyFile
from rpscli.errors import CaseError
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.points import lay_out
from sweep.small_studies import STUDY, Make, study_file

SAMPLE = "sample: {size: 4, ranges: {podium.cap_beam_mass_ratio: [5, 10]}}\n"


def refusal(make: Make, *changes: tuple[str, str], overrides: tuple[str, ...] = ()) -> str:
    """Why a study is refused, whether alone or once its systems are made."""
    with pytest.raises(CaseError) as refused:
        lay_out(make(STUDY, *changes, overrides=overrides))
    return str(refused.value)


def test_a_study_reads_its_case_axes_and_records(study_of: Make) -> None:
    study = study_of()
    assert study.title == "Test [study]"
    assert [axis.keys for axis in study.axes] == [
        ("podium.bearing.slenderness", "podium.bearing.wedge_slenderness"),
        ("podium.bearing.curvature_ratio",),
    ]
    assert study.axes[0].rows == ((0.10, 0.20), (0.15, 0.30))
    assert study.sources == tuple(
        f"synthetic:?pga=0.5g&duration=4&dt=0.02&seed={seed}" for seed in (1, 2, 3)
    )
    assert study.base_file == Path("base.yaml")


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ("[0.20, 0.30]", "[0.20]", ("study.yaml:6:5", "has 1 values", "line 5", "2")),
        ("critical, 0.5, 0]", "critical, null]", ("study.yaml:7:48", "no value")),
        ("[critical, 0.5, 0]", "0.5", ("study.yaml:7:37", "list of values")),
        ("[critical, 0.5, 0]", "{low: 0, hgh: 1, count: 2}", ("curvature_ratio.high?",)),
        ("curvature_ratio:", "curvature_ration:", ("study.yaml:7:5", "curvature_ratio?")),
        ("podium.bearing.curvature_ratio:", "analysis.recontact_rule:", ("study.yaml:7:5", "gone")),
        ("[critical, 0.5, 0]", "[0.5, -0.2]", ("study.yaml:7:43", "-0.2", ">= 0", "flat ends")),
        ("0.20, 0.30]", "0.20, 0.12]", ("study.yaml:6:", "0.12")),
        ("- podium.bearing.curv", "- podium.bearing.slen", ("not a key", "curvature_ratio")),
        ("base: base.yaml", "base: bsae.yaml", ("study.yaml:3:7", "base.yaml?")),
        ("base: base.yaml\n", "", ("base is missing",)),
        ("synthetic:", "synthtic:", ("study.yaml:9:5", "synthtic", "synthetic")),
        ("scale: [0.5, 1.0]", "scale: []", ("study.yaml:10:8", "empty")),
        ("scale: [0.5, 1.0]", "scale: {measure: PGX, values: [1]}", ("study.yaml:10:18", "PGV")),
        ("scale: [0.5, 1.0]", "scale: {measure: PGV, values: [0]}", ("> 0",)),
        ("scale: [0.5, 1.0]", "scale: {measure: PGA, values: [1], period: 1}", ("Sa",)),
        ("scale:", "scal:", ("did you mean scale?",)),
        ("scale:", "perturb: {members: 1}\nscale:", ("study.yaml:10:20", ">= 2")),
        ("scale:", "perturb: {restitution: 0.2}\nscale:", ("study.yaml:10:24", "above 1")),
        ("scale:", "analysis: modal\nscale:", ("scale has no meaning", "records has no meaning")),
        ("scale:", "analysis: dynamic\nscale:", ("timehistory, modal or pushover",)),
        ("scale:", "reports: [demnd]\nscale:", ("study.yaml:10:11", "did you mean demand?")),
        ("scale:", "reports: [demand: {panel: x}]\nscale:", ("did you mean", "panels")),
        ("scale:", "reports: [demand: {panels: x}]\nscale:", ("does not vary", "slenderness")),
        ("scale:", "reports: [rotation: {reference: 7}]\nscale:", ("7", "takes", "critical")),
        ("scale:", "reports: [lines: {x: scale, y: max_rotatio}]\nscale:", ("max_rotation?",)),
        ("scale:", "reports: [lines: {x: scale, y: zzz}]\nscale:", ("`rps timehistory CASE",)),
        ("scale:", "limits: {zzz: 1}\nscale:", ("more (rps explain limits)",)),
        ("scale: [0.5, 1.0]", "reports: [ida]", ("several intensities",)),
        (
            "curvature_ratio: [critical, 0.5, 0]",
            "curvature_ratio: [0.5]\nreports: [rotation]",
            ("report rotation", "curvature_ratio has one value"),
        ),
        ("scale:", SAMPLE.replace("[5, 10]", "[10, 5]") + "scale:", ("must be <",)),
        ("scale:", SAMPLE.replace("[5, 10]", "{mean: 5}") + "scale:", ("mean and cov",)),
        ("scale:", SAMPLE.replace("size: 4, ", "") + "scale:", ("sample.size is missing",)),
        ("scale:", SAMPLE.replace("cap_beam", "cab_beam") + "scale:", ("cap_beam_mass_ratio?",)),
        (
            "scale:",
            SAMPLE.replace("podium.cap_beam_mass_ratio", "podium.bearing.slenderness") + "scale:",
            ("varies already", "line 5"),
        ),
        ("scale:", "vary: []\nscale:", ("vary is written twice",)),
    ],
)
def test_faults_name_place_and_remedy(
    study_of: Make, old: str, new: str, parts: tuple[str, ...]
) -> None:
    text = refusal(study_of, (old, new))
    for part in parts:
        assert part in text, text


def test_all_faults_of_keys_are_told_together_then_those_between_keys(study_of: Make) -> None:
    unequal, twice = ("[0.20, 0.30]", "[0.2]"), ("scale:", "hazzard: 1\nscale:")
    text = refusal(study_of, ("title:", "titel:"), unequal, ("[0.5, 1.0]", "[]"), twice)
    assert len(text.splitlines()) == 3
    text = refusal(study_of, unequal, ("curvature_ratio:", "curvature_ration:"))
    assert len(text.splitlines()) == 2


def test_a_study_needs_a_record_from_somewhere(study_of: Make) -> None:
    start, end = STUDY.index("records:"), STUDY.index("scale:")
    assert "no record" in refusal(study_of, (STUDY[start:end], ""))


def test_sa_at_t1_needs_storeys(study_of: Make) -> None:
    frame = (
        "base: {rps: 1, superstructure: {storeys: 0}, podium: {bearing: {semi_diagonal: 1.5,"
        " slenderness: 0.15, wedge_slenderness: 0.3, curvature_ratio: 0.5}, cap_beam_mass: 1000,"
        " cap_beam_mass_ratio: 10}}"
    )
    scale = ("scale: [0.5, 1.0]", "scale: {measure: Sa, values: [1.0]}")
    text = refusal(study_of, ("base: base.yaml", frame), scale)
    assert "scale.period is missing" in text


def test_an_unknown_key_is_told_once(study_of: Make) -> None:
    text = refusal(study_of, ("curvature_ratio:", "curvature_ration:"))
    assert len(text.splitlines()) == 1


def test_overrides_reach_the_study_and_its_case(study_of: Make) -> None:
    study = study_of(overrides=("scale=[2]", "podium.cap_beam_mass_ratio=7", "analysis.accuracy=2"))
    assert study.file.scale == (2.0,)
    assert study.base.content["podium"]["cap_beam_mass_ratio"] == 7
    assert study.base.content["analysis"]["accuracy"] == 2
    measured = study_of(overrides=("scale={measure: PGV, values: [0.5]}",))
    assert isinstance(measured.file.scale, MeasureScale)


def test_an_override_cannot_fix_what_varies(study_of: Make) -> None:
    text = refusal(study_of, overrides=("podium.bearing.slenderness=0.2",))
    assert "varies in the study" in text


def test_a_missing_file_is_named(workplace: Path) -> None:
    with pytest.raises(CaseError, match=r"did you mean study\.yaml"):
        study_file("stduy.yaml")


def test_the_format_has_a_json_schema() -> None:
    keys = json_schema_of(StudyFile)["properties"]
    assert {"vary", "records", "scale", "sample", "perturb", "reports"} <= keys.keys()
    for report in REPORTS.values():
        assert json_schema_of(report.options)["additionalProperties"] is False
