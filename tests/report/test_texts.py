"""CSV and JSON are what was computed; texts and numbers by example."""

from __future__ import annotations

import csv
import io
import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpscli.analyses.result_quantities import plain
from rpscli.report import table
from rpscli.report.figures import floors, style
from rpscli.report.files import json_text
from rpscli.report.study.fragility import LimitState
from rpscli.report.study.report import add_notes, label, with_band
from rpscli.report.table import Column, Table, csv_text, records

values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=10,
)  # fmt: skip


@given(st.dictionaries(st.text(), values, max_size=4))
def test_json_is_read_back_as_it_was(document: dict[str, object]) -> None:
    assert json.loads(json_text(document)) == document


def test_json_knows_no_nan_and_no_numpy() -> None:
    document = {
        "a": np.array([1.0, math.nan, -math.inf]),
        "b": np.float64(2.5),
        "c": np.array([1 + 2j]),
        "d": (np.int64(3), True),
        "e": -0.0,
    }
    expected = {"a": [1.0, None, None], "b": 2.5, "c": [[1.0, 2.0]], "d": [3, True], "e": 0.0}
    assert plain(document) == expected
    assert "-0.0" not in json_text(document)


def test_lists_of_numbers_stay_on_one_line() -> None:
    assert json_text({"a": [1, 2, 3]}) == '{\n  "a": [1, 2, 3]\n}\n'


@given(st.lists(st.floats(-1e300, 1e300), min_size=1))
def test_a_csv_holds_ten_digits(numbers: list[float]) -> None:
    lines = csv_text([Column("x", "m", np.array(numbers))]).splitlines()
    assert lines[0] == "x [m]"
    assert [float(line) for line in lines[1:]] == pytest.approx(numbers, rel=1e-9, abs=0.0)


def test_what_does_not_exist_is_an_empty_cell() -> None:
    columns = [Column("x", "m", [1.0, math.nan, None]), Column("kind", "-", ["a", "b", "c"])]
    assert csv_text(columns) == "x [m],kind [-]\n1,a\n,b\n,c\n"


def test_columns_of_different_lengths_are_a_mistake() -> None:
    with pytest.raises(ValueError, match="zip"):
        csv_text([Column("x", "m", [1.0]), Column("y", "m", [1.0, 2.0])])


texts = st.text(st.characters(codec="utf-8", exclude_characters="\0"))


@given(st.lists(texts, min_size=1), texts)
def test_a_cell_may_hold_anything(cells: list[str], head: str) -> None:
    text = csv_text([Column(head, "-", cells), Column("x", "m", range(len(cells)))])
    rows = [[f"{head} [-]", "x [m]"], *([cell, str(i)] for i, cell in enumerate(cells))]
    assert list(csv.reader(io.StringIO(text, newline=""))) == rows


def test_lists_and_mappings_are_written_as_json() -> None:
    assert (
        csv_text([Column("a", "-", [[1, 2], {"b": None}])]) == 'a [-]\n"[1, 2]"\n"{""b"": null}"\n'
    )


def test_a_table_has_one_row_for_readers_files_and_documents() -> None:
    shear = Column("max_base_shear", "N", [1.5e6, None], "base shear kN")
    columns = [Column("record", "-", ["El Centro, 1940.at2", "b"], "record", str), shear]
    assert Table(columns).heads == ["record", "base shear kN"]
    assert Table(columns).rows == [("El Centro, 1940.at2", "1500"), ("b", "-")]
    assert csv_text(columns).splitlines()[1:] == ['"El Centro, 1940.at2",1500000', "b,"]
    assert records(columns)[1] == {"record": "b", "max_base_shear": None}


EXAMPLES: dict[str, list[tuple[Any, Any]]] = {
    "figures": [
        (floors.shown_floors(6), [1, 4, 6]),
        (style.folded(r"$|\theta_{max}|$ [-], flat", 0.6, 8.0), "$|\\theta_{max}|$ [-],\nflat"),
        (style.folded("a_name_of_many_letters", 0.6, 8.0), "a_name_of\n_many_let\nters"),
        ([style.engineering(size)[1] for size in (999.0, 1e3, 5e5, 1e6)], ["", "k", "k", "M"]),
        (LimitState("min_column_force", 1e5).label, "min_column_force < 100000"),
        (label("superstructure.period", "300 ms"), "T₁ = 300 ms"),
    ],
    "numbers": [
        ([table.shown(value) for value in (0.10501282, 17321.4, 3)], ["0.1050", "17321", "3"]),
        ([table.shown(value) for value in (None, 2.4e-9)], ["-", "2.400e-09"]),
        ([table.large(*of) for of in ((0.1, "rad"), (0.2, "-"))], [(0.1, "rad"), (0.2, "")]),
        ([table.measured(*of) for of in ((1.5e6, "N"), (None, "s"))], ["1500 kN", "-"]),
        ([table.percent(1.0, of) for of in (3.0, 0.0)], ["33.3 %", "-"]),
        (with_band(*[math.nan] * 3), "-"),
    ],
}


@pytest.mark.parametrize("of", EXAMPLES)
def test_examples(of: str) -> None:
    for found, wanted in EXAMPLES[of]:
        assert found == wanted


def test_notes_of_several_reports_are_said_once() -> None:
    notes = ["fragility: the data are separated"]
    add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    assert notes == ["fragility: the data are separated", "risk: the hazard curve is continued"]
