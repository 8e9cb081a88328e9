"""Studies beside observations, with made-up results whose agreement is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpscli.errors import CaseError
from rpscli.report.study.comparison import ComparisonOptions, comparison, uncomparable
from rpscli.report.study.report import Found
from rpscli.report.table import Table, records
from rpscli.sweep.points import lay_out
from sweep.made_up import ALPHA, Answer, Place, Stored, fallen, made
from sweep.small_studies import Make, SweepJson, csv_rows

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


def report(make: Make, answer: Answer) -> Found:
    results, options = made(make, answer, text=STUDY), ComparisonOptions()
    assert not list(uncomparable(results.table.layout, options))
    return comparison(results, options)


def overturns(at: Place) -> Stored:
    """Overturned under more records the smaller the slenderness: 6, 4 and 2 of 8."""
    return fallen(at["record"] <= {0.10: 6, 0.15: 4, 0.2: 2}[at[ALPHA]])


def half(title: str, first: int) -> list[str]:
    """Observed: overturned under the first so many records."""
    return [f"{SOURCE.format(n)},{title},{int(n <= first)}" for n in range(1, RECORDS + 1)]


def test_outcomes_are_counted_for_each_system(study_of: Make) -> None:
    seen(*half("left", 4), *half("right", 6))
    found = report(study_of, overturns)
    table = {(row["title"], row[ALPHA]): row for row in records(found.tables[""])}
    cells = ("both", "computed_only", "observed_only", "neither")
    assert [table["left", 0.15][cell] for cell in cells] == [4, 0, 0, 4]
    assert [table["left", 0.10][cell] for cell in cells] == [4, 2, 0, 2]
    assert [table["left", 0.2][cell] for cell in cells] == [2, 0, 2, 4]
    assert table["right", 0.2]["agreed"] == 4
    assert table["right", 0.10]["agreed_share"] == 1.0
    (shown, remark) = found.parts()
    assert isinstance(shown, Table)
    assert shown.rows[1][:5] == ("left", "0.15", "8", "1.00 (0.69 to 1.0)", "4")
    assert "95 %" in str(remark)


def test_maxima_have_ratios(study_of: Make) -> None:
    seen(
        *(f"{SOURCE.format(n)},left,{10.0 * n}" for n in range(1, RECORDS + 1)),
        head="record,title,max_rotation [mrad]",
    )
    ratios = [0.5, 1.0, 2.0, 4.0, 1.0, 1.0, 1.0]

    def answer(at: Place) -> Stored:
        n = at["record"]
        return fallen(n == RECORDS, max_rotation=0.01 * n * [*ratios, 1.0][n - 1])

    found, *_ = records(report(study_of, answer).tables["_maxima"])
    assert (found["counted"], found["overturned_computed"]) == (7, 1)
    assert found["median_ratio"] == pytest.approx(1.0, rel=1e-12)
    assert found["dispersion"] == pytest.approx(np.std(np.log(ratios), ddof=1), rel=1e-12)


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


def test_sweep_leaves_tables_and_says_what_it_found(sweep_json: SweepJson) -> None:
    seen(*half("left", 4))
    document = sweep_json("study.yaml", study=STUDY)
    assert "not conservative" in document["note"]
    rows = csv_rows("comparison.csv")
    assert [row["title [-]"] for row in rows] == ["left"] * 3
    assert len(document["reports"]["comparison"]["rows"]) == len(rows)
    assert len(csv_rows("comparison_pairs.csv")) == 3 * RECORDS
    assert any("have no observation" in warning for warning in document["warnings"])
