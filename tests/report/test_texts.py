"""CSV and JSON: what is written is what was computed."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpscli.analyses.result_quantities import plain
from rpscli.report.files.csv_text import Column, csv_text
from rpscli.report.files.json_text import json_text

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
