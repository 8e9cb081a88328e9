"""A small case and study, what a sweep leaves, and made-up results whose statistics are known."""

import csv
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from rpscli.studies import load_study
from rpscli.sweep.evaluation import (
    FAILED,
    MISSING,
    SCALARS,
    PointResults,
    at_path,
    stacked,
)
from rpscli.sweep.points import lay_out
from rpscli.sweep.table import PointTable

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


def study_file(path, *overrides):
    """A study as `rps sweep` reads it."""
    return load_study(path, overrides)


def document_of(result, exit_code):
    """The JSON document that a command printed, which ended with an exit code."""
    assert result.exit_code == exit_code, result.stderr
    return json.loads(result.stdout)


def csv_rows(name, folder=FOLDER):
    """Lines of a CSV file."""
    with (Path(folder) / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Stored(NamedTuple):
    """What a study might hold of a point."""

    outcome: str
    message: str | None
    results: dict[str, Any]


RHO, ALPHA = "podium.bearing.curvature_ratio", "podium.bearing.slenderness"
BROKEN = Stored("failed", "why", {})


def stored(outcome="survived", **results):
    """A made-up result."""
    whole = dict.fromkeys(SCALARS["timehistory"], 0.0)
    shears = results.pop("storey_shears", [3.0, 2.0, 1.0])
    return Stored(
        outcome, None, {**whole, "scale": 1.0, **results, "storey_shears": shears}
    )


def fallen(falls, **results):
    """A made-up result, of a structure that overturned or survived."""
    return stored("overturned_rolling" if falls else "survived", **results)


def reader(rows):
    """Reads columns of rows by their names, as a store does."""
    points = [row or Stored(MISSING, None, {}) for row in rows]
    names = dict.fromkeys(name for point in points for name in point.results)
    columns = {
        name: stacked([point.results.get(name) for point in points]) for name in names
    }
    outcomes = np.array([point.outcome for point in points], dtype="U20")
    told = {
        n: point.message or ""
        for n, point in enumerate(points)
        if point.outcome == FAILED
    }

    def read(wanted):
        known = {name: at_path(columns, name) for name in wanted}
        found = {name: column for name, column in known.items() if column is not None}
        return PointResults(outcomes, told, found)

    return read


def place(layout, number):
    point = layout[number]
    named = dict(zip(layout.plan.keys, point.values, strict=True))
    source = point.record.source if point.record else "-"
    record = int(source[-1]) if source[-1].isdigit() else source
    return {**named, "record": record, "scale": point.scale, "number": number}


def made(make, answer, *changes, text=STUDY, fixed=None):
    """Results, as reports take them, of 2 slendernesses x 3 curvatures x 3 records x 2 scales."""
    layout = lay_out(make(text, *changes))
    read = reader(answer(place(layout, number)) for number in range(len(layout)))
    table = PointTable.of(layout, read)
    return SimpleNamespace(
        table=table, context=layout.context, stored=read, fixed_base=fixed
    )


def fixed_base(layout, shears):
    """The same storey shears on a fixed base of all systems under all records."""
    systems, known = (
        range(len(layout.properties)),
        [each for each in layout.records if each],
    )
    return {(system, record): np.array(shears) for system in systems for record in known}


def cells(found, suffix=""):
    """Values of the columns of a table of a report, by name."""
    return {
        c.name: np.asarray(c.values, dtype=object).tolist() for c in found.tables[suffix]
    }
