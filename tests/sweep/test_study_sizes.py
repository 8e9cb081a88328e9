"""Studies and histories too large for any machine are refused before they begin."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import building, ground, podium, stillness

from rpscli.analyses.kernels.history import MOST_STEPS
from rpscli.analyses.kernels.systems import most_steps
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.study.rules import MOST_POINTS, MOST_SYSTEMS
from rpscli.case.study.study import parse_study
from rpscli.errors import CaseError
from rpscli.model.superstructure import RayleighDamping
from rpscli.report.study.registry import REPORTS

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


def test_a_history_of_endless_samples_is_refused() -> None:
    record = ground(np.zeros(5), 1e-8)
    with pytest.raises(
        CaseError, match=r"samples .* more than 8 GB; .*free_vibration, or resample"
    ):
        time_history(podium(0), record)
    assert time_history(podium(0), record, TimeHistorySettings(free_vibration=1e-7)).duration < 1e-6


def test_a_history_of_endless_steps_is_refused() -> None:
    stiff = building(60, 1e-3, RayleighDamping(1.5, (1, 1)))
    structure = podium(60, superstructure=stiff)
    settings, record = TimeHistorySettings(), stillness(0.02)
    assert most_steps(structure, settings, record.duration) > MOST_STEPS
    with pytest.raises(CaseError, match=r"steps, .* more than 1e\+10: .*; give a shorter"):
        time_history(structure, record, settings)
    short = TimeHistorySettings(free_vibration=0.0)
    assert most_steps(structure, short, record.duration) < MOST_STEPS
