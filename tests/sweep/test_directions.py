"""Studies over directions: the worst one and RotD50, from made-up and from real histories."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from paper_structures import needs_compiled_kernels

from rpscli.report.study.directions import (
    NO_BOUND,
    DirectionsOptions,
    directions,
    without_directions,
)
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.points.layout import lay_out
from sweep.made_up import RHO, Stored, cells, results_of, stored, tabulate
from sweep.small_studies import Make

ANGLES = (0, 45, 90, 135)
STUDY = f"""\
rps: 1
base: base.yaml
vary:
  - {RHO}: [0.5, 0]
records:
  - {{source: "one_x.txt?dt=0.01&units=g&second=one_y.txt", angle: {list(ANGLES)}}}
  - {{source: "two_x.txt?dt=0.01&units=g&second=two_y.txt", angle: {list(ANGLES)}}}
  - "one_x.txt?dt=0.01&units=g"
"""
ROTATION = {"one": (0.1, 0.4, 0.2, 0.3), "two": (0.5, 0.5, 9.0, 0.6)}


@pytest.fixture
def records(workplace: Path) -> None:
    """Two pairs of components: one of 0.4 g at 0.8 s along 60 degrees, one twice as long."""
    t = np.arange(0.0, 1.6, 0.01)
    wave = 0.4 * np.sin(2.0 * np.pi * t / 0.8)
    for name, values in {
        "one_x": wave * np.cos(np.pi / 3.0),
        "one_y": wave * np.sin(np.pi / 3.0),
        "two_x": wave,
        "two_y": 0.5 * wave,
    }.items():
        text = "\n".join(f"{value:.9f}" for value in values)
        (workplace / f"{name}.txt").write_text(text, encoding="utf-8")


def answer(source: str) -> Stored:
    if "angle" not in source:
        return stored()
    name = source[:3]
    angle = int(source.rpartition("=")[2])
    value = ROTATION[name][ANGLES.index(angle)]
    if value > 1.0:
        return stored("overturned_rocking", rotation_ratio=2.0)
    return stored(rotation_ratio=value)


@pytest.mark.evidence("directions", "exact")
@pytest.mark.usefixtures("records")
def test_worst_direction_and_median(study_of: Make) -> None:
    layout = lay_out(study_of(STUDY))
    table = tabulate(layout, (answer(point.record.source) for point in layout if point.record))
    report = directions(results_of(table), DirectionsOptions())
    pairs, spread = cells(report, "_pairs"), cells(report)
    one, two = [n for n, name in enumerate(pairs["result"]) if name == "rotation_ratio"][:2]
    assert pairs["pair"][one] == "one_x.txt?dt=0.01&units=g&second=one_y.txt"
    assert pairs["directions"][one] == len(ANGLES)
    result = [pairs[name] for name in ("worst", "worst_angle", "rotd50", "overturned")]
    assert [values[one] for values in result] == [0.4, 45.0, 0.25, 0]
    assert [values[two] for values in result] == ["inf", 90.0, pytest.approx(0.55), 1]
    at = spread["result"].index("rotation_ratio")
    assert (spread["worst_median"][at], spread["worst_84"][at]) == (0.4, "inf")
    assert [spread[f"rotd50_{end}"][at] for end in ("median", "84")] == pytest.approx([0.25, 0.55])
    assert set(spread["overturned"]) == {1}
    assert set(spread[RHO]) == {0.5, 0}
    assert report.notes == (NO_BOUND,)
    drawn: Any = report.drawn("title")
    assert len([axes for axes in drawn.axes if axes.axison]) == 2


@pytest.mark.usefixtures("records")
def test_both_components_beside_the_directions(study_of: Make) -> None:
    """Each pair's own; a median only where every pair has them, over rotations of a pair."""
    names = [f"{name}_x.txt?dt=0.01&units=g&second={name}_y.txt" for name in ("one", "two")]
    more = [f"{names[0]}&both", f"{names[1]}&both", f"{names[1]}&both&rotation=30"]
    told = dict(zip(more, (0.45, 0.5, 0.9), strict=True))

    def found(sources: list[str]) -> Any:
        text = "".join(f'\n  - "{source}"' for source in sources)
        layout = lay_out(study_of(f"{STUDY.rstrip()}{text}\n"))
        sources = [point.record.source for point in layout if point.record]
        rows = [stored(rotation_ratio=told[s]) if s in told else answer(s) for s in sources]
        return directions(results_of(tabulate(layout, rows)), DirectionsOptions())

    report = found(more)
    pairs, spread = cells(report, "_pairs"), cells(report)
    at = [n for n, name in enumerate(pairs["result"]) if name == "rotation_ratio"][:2]
    assert [pairs["both"][n] for n in at] == [0.45, pytest.approx(0.7)]
    row = spread["result"].index("rotation_ratio")
    assert (spread["both_median"][row], spread["both_84"][row]) == (0.45, pytest.approx(0.7))
    assert spread["worst_median"][row] == 0.4
    assert report.notes == ()
    assert np.isnan(cells(found(more[:1]))["both_median"][row])


@pytest.mark.usefixtures("records")
def test_directions_that_are_not_even_are_named(study_of: Make) -> None:
    layout = lay_out(study_of(STUDY, (str(list(ANGLES)), "[0, 90, 180]")))
    missing = results_of(tabulate(layout, [None] * len(layout)))
    report = directions(missing, DirectionsOptions())
    assert "one_x.txt" in report.notes[1]
    assert "not spread evenly over 180 deg" in report.notes[1]
    assert not cells(report)["result"]
    drawn: Any = report.drawn("title")
    assert "12 failed points left out" in drawn.get_suptitle()


@pytest.mark.usefixtures("records")
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (str(list(ANGLES)), "30", "no pair of components is given at several angles"),
        ("vary:", "perturb: {members: 2}\nvary:", "several histories for each direction"),
    ],
)
def test_studies_without_directions(study_of: Make, old: str, new: str, message: str) -> None:
    layout = lay_out(study_of(STUDY, (old, new)))
    (text,) = without_directions(layout, DirectionsOptions())
    assert message in text
    assert REPORTS["directions"].requires is without_directions


@pytest.mark.evidence("directions", "exact")
@needs_compiled_kernels
@pytest.mark.usefixtures("records")
def test_a_motion_along_one_line_is_worst_along_it(
    workplace: Path, sweep: Callable[..., Result]
) -> None:
    """Across its own direction nothing moves, and at equal angles to it both sides are alike."""
    text = STUDY.replace(str(list(ANGLES)), "{low: 0, high: 150, count: 6}")
    (workplace / "study.yaml").write_text(f"{text}reports: [directions]\n", encoding="utf-8")
    made = sweep("study.yaml", "-o", "made")
    assert made.exit_code == 0, made.stderr
    with (workplace / "made/directions_pairs.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["pair [-]"].startswith("one")]
    shears = [row for row in rows if row["result [-]"] == "max_base_shear"]
    shears = [row for row in shears if row[f"{RHO} [-]"] == "0.5"]
    assert [row["worst_angle [deg]"] for row in shears] == ["60"]
    with (workplace / "made/points.csv").open(encoding="utf-8") as file:
        points = list(csv.DictReader(file))
    of_one = [p for p in points if "one_x" in p["record [-]"] and "angle" in p["record [-]"]]
    shear = {
        p["record [-]"].rpartition("=")[2]: float(p["max_base_shear [N]"])
        for p in of_one
        if p[f"{RHO} [-]"] == "0.5"
    }
    # 1e-6: the components are printed with nine digits.
    assert shear["150"] <= 1e-6 * shear["60"]
    assert shear["30"] == pytest.approx(shear["90"], rel=1e-6)
    assert shear["0"] == pytest.approx(shear["120"], rel=1e-6)
