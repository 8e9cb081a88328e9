"""Vertical motion in a study: the same numbers as alone, and one time step for both components."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result
from paper_structures import needs_compiled_kernels

from rpscli.cli import program
from sweep.small_studies import BASE

HORIZONTAL = "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=1"
VERTICAL = "synthetic:?pga=0.3g&duration=4&dt={dt}&seed=2"
STUDY = "rps: 1\nbase: base.yaml\nvary: [{podium.bearing.curvature_ratio: [0.5, 0]}]\n"


@pytest.fixture
def prepared(workplace: Path) -> Callable[[float], None]:
    """A case with both components, and a study of it."""

    def write(dt: float) -> None:
        record = {"source": HORIZONTAL, "vertical": VERTICAL.format(dt=dt)}
        case = f"{BASE}record: {json.dumps(record)}\n"
        (workplace / "base.yaml").write_text(case, encoding="utf-8")
        (workplace / "study.yaml").write_text(STUDY, encoding="utf-8")

    return write


@needs_compiled_kernels
def test_points_are_those_of_single_histories(
    workplace: Path, prepared: Callable[[float], None], sweep: Callable[..., Result]
) -> None:
    prepared(0.02)
    made = sweep("study.yaml", "--quiet", "-o", "made")
    assert made.exit_code == 0, made.stderr
    with (workplace / "made" / "points.csv").open(encoding="utf-8", newline="") as file:
        points = list(csv.DictReader(file))
    (column,) = [name for name in points[0] if name.split(" [")[0] == "max_rotation"]

    def alone(*changes: str) -> float:
        found = CliRunner().invoke(
            program, ["timehistory", "base.yaml", "--json", "--force", *changes]
        )
        assert found.exit_code == 0, found.output
        document: dict[str, Any] = json.loads(found.stdout)
        return float(document["max_rotation"])

    for point, rho in zip(points, ("0.5", "0"), strict=True):
        change = ("--set", f"podium.bearing.curvature_ratio={rho}")
        # of histories in lanes and alone, the last digits may differ
        assert float(point[column]) == pytest.approx(alone(*change), rel=1e-9)
        without = alone(*change, "--set", f"record={{source: '{HORIZONTAL}'}}")
        assert float(point[column]) != pytest.approx(without, rel=1e-4)


def test_points_of_two_time_steps_fail(
    prepared: Callable[[float], None], sweep: Callable[..., Result]
) -> None:
    prepared(0.01)
    refused = sweep("study.yaml", "--quiet")
    assert refused.exit_code == 5
    assert "2 of 2 points failed" in refused.stderr
    assert "they must agree; resample one of them" in refused.stderr
    assert f"--vertical '{VERTICAL.format(dt=0.01)}'" in refused.stderr
