"""Studies beside observations, with made-up results whose agreement is known."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from click.testing import Result

from rpscli.case.study.reports import ReportOptions
from rpscli.errors import CaseError
from rpscli.report.study.comparison import REPORT, findings
from rpscli.report.study.comparison_numbers import (
    Comparison,
    ComparisonOptions,
    Outcomes,
    uncomparable,
)
from rpscli.sweep.points.layout import StudyPoints, lay_out
from rpscli.sweep.statistics.observations import Maxima, agreement, threshold
from sweep.made_up import ALPHA, place, results_of, stored, tabulate
from sweep.small_studies import Make

RECORDS = 8
STUDY = f"""\
rps: 1
base: base.yaml
vary:
  - title: [left, right]
  - {ALPHA}: [0.10, 0.15, 0.2]
    podium.bearing.wedge_slenderness: [0.20, 0.30, 0.4]
records:
  - {{source: "synthetic:?pga=0.5g&duration=2&dt=0.02", seed: [1, 2, 3, 4, 5, 6, 7, 8]}}
observed: seen.csv
reports: [comparison]
"""
SOURCE = "synthetic:?pga=0.5g&duration=2&dt=0.02&seed={}"


def seen(*rows: str, head: str = "record,title,overturned") -> None:
    Path("seen.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def report(
    layout: StudyPoints, options: ComparisonOptions, answer: Callable[[dict[str, object]], Any]
) -> Comparison:
    table = tabulate(layout, (answer(place(layout, n)) for n in range(len(layout))))
    assert not list(uncomparable(layout, options))
    return Comparison(results_of(table), options)


def overturns(at: dict[str, object]) -> Any:
    """Overturned under more records the smaller the slenderness: 6, 4 and 2 of 8."""
    limit = {0.10: 6, 0.15: 4, 0.2: 2}[cast("float", at[ALPHA])]
    fallen = cast("int", at["record"]) <= limit
    return stored("overturned +" if fallen else "survived")


def _rows(name: str) -> list[dict[str, str]]:
    return list(csv.DictReader(Path(name).read_text(encoding="utf-8").splitlines()))


def half(title: str, first: int) -> list[str]:
    """Observed: overturned under the first so many records."""
    return [f"{SOURCE.format(n)},{title},{int(n <= first)}" for n in range(1, RECORDS + 1)]


def test_outcomes_are_counted_for_each_system(study_of: Make) -> None:
    seen(*half("left", 4), *half("right", 6))
    found = report(lay_out(study_of(STUDY)), ComparisonOptions(resamples=0), overturns)
    agreed = {
        each.values: each.found.agreement
        for each in found.compared
        if isinstance(each.found, Outcomes)
    }
    assert agreed["left", 0.15][:4] == (4, 0, 0, 4)
    assert agreed["left", 0.10][:4] == (4, 2, 0, 2)
    assert agreed["left", 0.2][:4] == (2, 0, 2, 4)
    assert agreed["right", 0.2].agreed.number == 4
    assert agreed["right", 0.10].agreed.fraction == 1.0


def test_a_fit_learns_from_one_part_and_is_judged_on_the_other(study_of: Make) -> None:
    seen(*half("left", 4), *half("right", 6))
    options = ComparisonOptions.model_validate({"resamples": 0, "fit": {"share": 0.5, "seed": 3}})
    layout = lay_out(study_of(STUDY))
    found = report(layout, options, overturns)
    parts = {(each.values[0], each.part): each for each in found.compared}
    for title in ("left", "right"):
        fitted, held = parts[title, "fitted"], parts[title, "held out"]
        both = [set(layout.places[1][each.points].tolist()) for each in (fitted, held)]
        assert len(both[0]) == len(both[1]) == RECORDS // 2
        assert both[0] | both[1] == set(range(RECORDS))
        assert fitted.chosen == held.chosen
    assert [row.taken for row in found.candidates].count(True) == 2
    again = report(lay_out(study_of(STUDY)), options, overturns)
    for mine, theirs in zip(found.compared, again.compared, strict=True):
        np.testing.assert_array_equal(mine.points, theirs.points)


def test_what_is_held_out_has_no_say_in_the_fit(study_of: Make) -> None:
    """Turning every held-out outcome around changes neither the choice nor any threshold."""
    seen(*half("left", 4))
    options = ComparisonOptions.model_validate({"resamples": 0, "fit": {}})
    layout = lay_out(study_of(STUDY))
    found = report(layout, options, overturns)
    held = next(each for each in found.compared if each.part == "held out")
    turned = set(layout.places[1][held.points].tolist())
    seen(*(
        f"{SOURCE.format(n)},left,{int((n <= 4) != (n - 1 in turned))}"
        for n in range(1, RECORDS + 1)
    ))  # fmt: skip
    other = report(lay_out(study_of(STUDY)), options, overturns)
    assert [row.taken for row in other.candidates] == [row.taken for row in found.candidates]
    for mine, theirs in zip(found.compared, other.compared, strict=True):
        assert isinstance(mine.found, Outcomes)
        assert isinstance(theirs.found, Outcomes)
        assert [way.value for way in mine.found.thresholds] == [
            way.value for way in theirs.found.thresholds
        ]
    judged = other.judged[0].found
    assert isinstance(judged, Outcomes)
    assert judged.agreement.agreed.number + held.found.agreement.agreed.number == len(turned)  # type: ignore[union-attr]


def test_maxima_have_ratios_and_a_distance(study_of: Make) -> None:
    seen(
        *(f"{SOURCE.format(n)},left,{10.0 * n}" for n in range(1, RECORDS + 1)),
        head="record,title,max_rotation [mrad]",
    )
    ratios = [0.5, 1.0, 2.0, 4.0, 1.0, 1.0, 1.0]

    def answer(at: dict[str, object]) -> Any:
        n = cast("int", at["record"])
        if n == RECORDS:
            return stored("overturned -")
        return stored(max_rotation=0.01 * n * ratios[n - 1])

    found = report(lay_out(study_of(STUDY)), ComparisonOptions(resamples=0), answer).compared[0]
    assert isinstance(found.found, Maxima)
    assert (found.found.counted, found.found.overturned) == (7, 1)
    assert found.found.median == pytest.approx(1.0, rel=1e-12)
    assert found.found.dispersion == pytest.approx(np.std(np.log(ratios), ddof=1), rel=1e-12)
    # By hand: 5, 20, 50, 60, 60, 70, 160 mrad and infinity beside 10, 20 ... 80.
    mine = np.array([5, 20, 50, 60, 60, 70, 160, math.inf])
    theirs = np.arange(10, 90, 10)
    steps = np.concatenate([mine, theirs])
    apart = [abs(np.mean(mine <= x) - np.mean(theirs <= x)) for x in steps]
    assert found.found.distance == pytest.approx(max(apart), rel=1e-12)


def test_a_threshold_counts_best_among_those_that_agree_as_well() -> None:
    random = np.random.default_rng(5)
    for _ in range(50):
        im, over = random.lognormal(size=30), random.random(30) < 0.5
        told = [agreement(im >= cut, over, np.arange(len(im))) for cut in [0.0, *im, 1e9]]
        most = max(each.agreed.number for each in told)
        share = most / 30
        least = most - 30 * math.sqrt(share * (1.0 - share) / 30)
        off = min(abs(a.computed - a.observed) for a in told if a.agreed.number >= least)
        chosen = agreement(im >= threshold(im, over), over, np.arange(len(im)))
        assert chosen.agreed.number >= least
        assert abs(chosen.computed - chosen.observed) == off


@pytest.mark.parametrize(
    ("head", "row", "told"),
    [
        ("title,overturned", "left,1", "seen.csv:1:1: has no column `record`"),
        ("record,overturnt", "a,1", "did you mean overturned?"),
        ("record,title", "a,left", "has no column of what was observed"),
        ("record,overturned", "a,2", "seen.csv:2:1: overturned = '2' must be 1 or 0"),
        ("record,overturned", "a,1,2", "has 3 cells and 2 titles"),
        ("record,max_rotation [m]", "a,1", "must be an angle"),
        ("record,max_rotation", "a,-1", "must be a number >= 0"),
        ("record,overturned,overturned", "a,1,1", "appears twice"),
    ],
)
def test_faults_of_the_file_have_their_line(study_of: Make, head: str, row: str, told: str) -> None:
    seen(row, head=head)
    with pytest.raises(CaseError) as error:
        study_of(STUDY)
    assert told in str(error.value)
    assert "title" not in str(error.value) or "record" in head  # another file: nothing of it


def test_a_line_twice_and_a_missing_file_are_told(study_of: Make) -> None:
    with pytest.raises(CaseError, match=r"observed: .*there is no such file"):
        study_of(STUDY)
    seen("a,left,1", "a,left,0")
    with pytest.raises(CaseError, match=r"seen\.csv:3:1: 'a' of this system is already in line 2"):
        study_of(STUDY)


@pytest.mark.parametrize(
    ("change", "rows", "told"),
    [
        (("observed: seen.csv\n", ""), half("left", 4), "add `observed: FILE.csv`"),
        (("observed:", "scale: [1, 2]\nobserved:"), half("left", 4), "add a column `scale`"),
        (("observed:", "observed:"), ["nothing,left,1"], "has a record and a system of the study"),
    ],
)
def test_what_cannot_be_compared_is_told_before(
    study_of: Make, change: tuple[str, str], rows: list[str], told: str
) -> None:
    seen(*rows)
    layout = lay_out(study_of(STUDY, change))
    assert told in " ".join(uncomparable(layout, ComparisonOptions()))


def test_keys_that_tell_observations_apart_are_not_chosen(study_of: Make) -> None:
    seen(*half("left", 4))
    options = ComparisonOptions.model_validate({"fit": {"keys": ["title"]}})
    (told,) = uncomparable(lay_out(study_of(STUDY)), options)
    assert told.startswith("fit: title says what was observed, and cannot be chosen")
    with pytest.raises(CaseError, match=r"fit\.keys: scale does not vary"):
        study_of(STUDY.replace("[comparison]", "[{comparison: {fit: {keys: [scale]}}}]"))


def test_sweep_leaves_tables_and_says_what_it_found(
    sweep: Callable[..., Result], workplace: Path
) -> None:
    seen(*half("left", 4))
    text = STUDY.replace("[comparison]", "[{comparison: {resamples: 0, fit: {}}}]")
    (workplace / "study.yaml").write_text(text, encoding="utf-8")
    result = sweep("study.yaml", "-o", "out", "--json")
    assert result.exit_code == 0, result.stderr
    document = json.loads(result.stdout)
    assert "not conservative" in document["note"]
    rows = _rows("out/comparison.csv")
    model = [row for row in rows if row["told_by [-]"] == "model"]
    assert [row["records [-]"] for row in model] == ["fitted", "held out"]
    assert {row["title [-]"] for row in rows} == {"left"}
    assert len(document["findings"]["comparison"]) == len(rows)
    pairs = _rows("out/comparison_pairs.csv")
    assert len(pairs) == RECORDS
    assert any("have no observation" in warning for warning in document["warnings"])


def test_a_report_says_its_numbers_in_lines(study_of: Make) -> None:
    seen(*half("left", 4))
    found = report(lay_out(study_of(STUDY)), ComparisonOptions(resamples=0), overturns)
    lines = dict(findings(found))
    assert lines["left, tan α = 0.15, all records"].startswith("100.0 % agree, 8 of 8")
    assert issubclass(REPORT.options, ReportOptions)
