"""A study is read from its file; one too large for any machine is refused before it begins."""

from __future__ import annotations

import pytest
from paper_structures import building, podium, stillness

from rpscli.analyses.kernels.history import MOST_STEPS
from rpscli.analyses.kernels.systems import most_steps
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.study.schema import MeasureScale
from rpscli.case.study.study import MOST_POINTS, MOST_SYSTEMS, parse_study
from rpscli.errors import CaseError
from rpscli.model.superstructure import RayleighDamping
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.points import lay_out
from sweep.small_studies import STUDY, Make, study_file


def refusal(make: Make, *changes: tuple[str, str], overrides: tuple[str, ...] = ()) -> str:
    """Why a study is refused, whether alone or once its systems are made."""
    with pytest.raises(CaseError) as refused:
        lay_out(make(STUDY, *changes, overrides=overrides))
    return str(refused.value)


def test_all_faults_of_keys_are_told_together_then_those_between_keys(study_of: Make) -> None:
    unequal, twice = ("[0.20, 0.30]", "[0.2]"), ("scale:", "hazzard: 1\nscale:")
    text = refusal(study_of, ("title:", "titel:"), unequal, ("[0.5, 1.0]", "[]"), twice)
    assert len(text.splitlines()) == 3
    text = refusal(study_of, unequal, ("curvature_ratio:", "curvature_ration:"))
    assert len(text.splitlines()) == 2


def test_sa_at_t1_needs_storeys(study_of: Make) -> None:
    frame = (
        "base: {rps: 1, superstructure: {storeys: 0}, podium: {bearing: {semi_diagonal: 1.5,"
        " slenderness: 0.15, wedge_slenderness: 0.3, curvature_ratio: 0.5}, cap_beam_mass: 1000,"
        " cap_beam_mass_ratio: 10}}"
    )
    scale = ("scale: [0.5, 1.0]", "scale: {measure: Sa, values: [1.0]}")
    text = refusal(study_of, ("base: base.yaml", frame), scale)
    assert "scale.period is missing" in text


def test_overrides_reach_the_study_and_its_case(study_of: Make) -> None:
    study = study_of(overrides=("scale=[2]", "podium.cap_beam_mass_ratio=7", "analysis.accuracy=2"))
    assert study.file.scale == (2.0,)
    assert study.base.content["podium"]["cap_beam_mass_ratio"] == 7
    assert study.base.content["analysis"]["accuracy"] == 2
    measured = study_of(overrides=("scale={measure: PGV, values: [0.5]}",))
    assert isinstance(measured.file.scale, MeasureScale)


def test_what_is_asked_for_and_cannot_be_is_told(study_of: Make) -> None:
    text = refusal(study_of, overrides=("podium.bearing.slenderness=0.2",))
    assert "varies in the study" in text
    with pytest.raises(CaseError, match=r"did you mean study\.yaml"):
        study_file("stduy.yaml")


SLENDERNESS = "podium.bearing.slenderness"
HEIGHT = "superstructure.period"


PRODUCT = """
records:
- source: pulse:sine
  amplitude: {low: 1, high: 2, count: 100000}
  period: {low: 1, high: 2, count: 100000}
"""


def axis(key: str, count: int) -> str:
    return f"- {{{key}: {{low: 0.1, high: 0.2, count: {count}}}}}"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            f"sample: {{size: 1000000000, ranges: {{{SLENDERNESS}: [0.1, 0.2]}}}}",
            f"1000000000 systems .* more than {MOST_SYSTEMS}; use fewer",
        ),
        ("perturb: {members: 1000000000}", f"1000000000 points .* {MOST_POINTS};"),
        (
            f"vary:\n{axis(SLENDERNESS, 1000)}\n{axis(HEIGHT, 1001)}",
            r"1001000 systems \(1000 x 1001\)",
        ),
        (PRODUCT, "stands for 10000000000 ground motions"),
        (f"vary:\n{axis(SLENDERNESS, 3000)}\nscale: {{low: 1, high: 2, count: 2000}}", "6000000"),
    ],
)
def test_a_study_that_is_too_large_is_refused(text: str, told: str) -> None:
    study = f"rps: 1\nbase: cases/six_storey.yaml\n{text}\n"
    with pytest.raises(CaseError, match=told):
        parse_study(study, name="s.yaml", kinds=REPORTS)


def test_the_largest_study_is_none_too_many() -> None:
    text = f"sample: {{size: {MOST_SYSTEMS}, ranges: {{{SLENDERNESS}: [0.1, 0.2]}}}}"
    parse_study(f"rps: 1\nbase: cases/six_storey.yaml\n{text}\n", name="s.yaml", kinds=REPORTS)


def test_a_history_of_endless_steps_is_refused() -> None:
    stiff = building(60, 1e-3, RayleighDamping(1.5, (1, 1)))
    structure = podium(60, superstructure=stiff)
    settings, record = TimeHistorySettings(), stillness(0.02)
    assert most_steps(structure, settings, record.duration) > MOST_STEPS
    with pytest.raises(CaseError, match=r"steps, .* more than 1e\+10: .*; give a shorter"):
        time_history(structure, record, settings)
    short = TimeHistorySettings(free_vibration=0.0)
    assert most_steps(structure, short, record.duration) < MOST_STEPS
