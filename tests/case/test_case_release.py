"""A release from rest: analysis.initial_rotation."""

from __future__ import annotations

import pytest

from rpscli.case.case import load_case
from rpscli.errors import CaseError

FRAME = "cases/rigid_frame.yaml"


def test_the_rotation_reaches_the_settings() -> None:
    case = load_case(FRAME, ["analysis.initial_rotation=-0.05"])
    assert case.analysis.initial_rotation == -0.05


def test_a_rotation_beyond_the_overturning_limit_is_refused() -> None:
    case = load_case(FRAME)
    limit = case.analysis.overturning_limit * case.structure.critical_rotation
    load_case(FRAME, [f"analysis.initial_rotation={limit * (1 - 1e-9)!r}"])
    with pytest.raises(CaseError, match=r"initial_rotation = .* must stay below .* use less than"):
        load_case(FRAME, [f"analysis.initial_rotation={limit!r}"])


def test_an_overturning_limit_beyond_the_end_of_the_model_is_refused() -> None:
    bearing = load_case(FRAME).structure.bearing
    most = bearing.largest_rotation / bearing.critical_rotation
    load_case(FRAME, [f"analysis.overturning_limit={most * (1 - 1e-9)!r}"])
    with pytest.raises(
        CaseError, match=r"overturning_limit = 20 .* must not exceed .* use at most"
    ):
        load_case(FRAME, ["analysis.overturning_limit=20"])
    with pytest.raises(CaseError, match=r"use at most") as refusal:
        load_case(FRAME, [f"analysis.overturning_limit={most * (1 + 1e-9)!r}"])
    remedy = str(refusal.value).rpartition(" ")[2]
    load_case(FRAME, [f"analysis.overturning_limit={remedy}"])


def test_a_limit_that_is_not_written_is_refused_too() -> None:
    """Half a circle of arc, and more than that: theta_cr itself is beyond 90 degrees."""
    column = ["slenderness=0.9", "wedge_slenderness=3.0", "curvature_ratio=1.06"]
    stout = [f"podium.bearing.{value}" for value in column]
    law = "podium.impact={law: value, restitution: 0.5}"
    with pytest.raises(CaseError, match=r"overturning_limit = 2 .* use at most 1\."):
        load_case(FRAME, [*stout, law])
