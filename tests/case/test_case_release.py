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
