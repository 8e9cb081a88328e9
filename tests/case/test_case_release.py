"""A release from rest: analysis.initial_rotation."""

from __future__ import annotations

import math

import pytest

from rpscli.analyses.demand import demand
from rpscli.case.case import load_case
from rpscli.errors import CaseError
from rpscli.model.bearing import Bearing
from rpscli.records.loading import load_record

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


def test_what_counts_as_overturned_is_the_lesser_of_what_the_case_names() -> None:
    structure = load_case(FRAME).structure
    at_the_moat = structure.bearing.rotation_at(0.1) / structure.critical_rotation
    named: list[tuple[dict[str, str], float]] = [
        ({}, 2.0),
        ({"displacement": "100 m"}, 2.0),
        ({"displacement": "0.1", "limit": "1.5"}, at_the_moat),
    ]
    for values, limit in named:
        case = load_case(FRAME, [f"analysis.overturning_{name}={v}" for name, v in values.items()])
        assert case.analysis.overturning_limit == pytest.approx(limit, rel=1e-12)
    with pytest.raises(CaseError, match=r"must stay below the overturning limit, 0\."):
        load_case(FRAME, ["analysis.overturning_displacement=0.1", "analysis.initial_rotation=0.5"])


@pytest.mark.parametrize("displacement", [1e-6, 0.05, 0.4])
def test_a_flat_column_moves_its_top_as_its_diagonal_turns(displacement: float) -> None:
    """The far corner is 2R away under alpha: u_b = 2R (sin(alpha) - sin(alpha - theta))."""
    bearing = Bearing(1.5, 0.15, 0.15, 0.0)
    alpha = math.atan(0.15)
    exact = alpha - math.asin(math.sin(alpha) - displacement / 3.0)
    assert bearing.rotation_at(displacement) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize(("share", "overturns"), [(0.99, True), (1.01, False)])
def test_a_moat_counts_as_overturning(share: float, overturns: bool) -> None:
    record = load_record("pulse:sine?amplitude=0.3g&period=0.8")
    free = load_case(FRAME)
    reached = demand(free.structure, record, free.analysis).max_cap_beam_displacement
    moat = load_case(FRAME, [f"analysis.overturning_displacement={share * reached!r}"])
    assert demand(moat.structure, record, moat.analysis).overturned == overturns
