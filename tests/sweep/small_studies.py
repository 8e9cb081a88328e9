"""Texts of a small case and study, ways to read a file with one, and what a sweep leaves."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

from click.testing import Result

from rpscli.case.study.study import Study
from rpscli.studies import Study as LaidOut
from rpscli.studies import load_study

ROOT = Path(__file__).parents[2]
FOLDER = Path("results/study/sweep")
"""In the working folder: the results of its study."""

BASE = """\
rps: 1
superstructure:
  storeys: 3
  storey_mass: 200000
  storey_height: 3.0
  period: 0.3
  damping: {ratio: 0.05, modes: [1, 2]}
podium:
  bearing:
    semi_diagonal: 1.5
    slenderness: 0.15
    wedge_slenderness: 0.30
    curvature_ratio: 0.5
  cap_beam_mass_ratio: 10
  superstructure_mass_ratio: 3
analysis: {free_vibration: 1.0}
"""

STUDY = """\
rps: 1
title: "Test [study]"
base: base.yaml
vary:
  - podium.bearing.slenderness: [0.10, 0.15]
    podium.bearing.wedge_slenderness: [0.20, 0.30]
  - podium.bearing.curvature_ratio: [critical, 0.5, 0]
records:
  - {source: "synthetic:?pga=0.5g&duration=4&dt=0.02", seed: [1, 2, 3]}
scale: [0.5, 1.0]
"""
WITHOUT_RECORDS = STUDY[: STUDY.index("records:")]

Make = Callable[..., Study]
Sweep = Callable[..., Result]
SweepJson = Callable[..., dict[str, Any]]


def study_file(path: Path | str, *overrides: str) -> LaidOut:
    """A study as `rps sweep` reads it."""
    return load_study(path, overrides)


def csv_rows(name: str, folder: Path | str = FOLDER) -> list[dict[str, str]]:
    """Lines of a CSV file."""
    with (Path(folder) / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
