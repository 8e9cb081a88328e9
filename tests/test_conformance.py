"""The table of conformance: its file has a row for each number compared, and tells what moves."""

import ast
import json
import math
import os
import re
import subprocess
import sys

import conformance
import evidence
import numpy as np
import pytest
from conformance import conforms, differences, rows_of_file

ROWS = rows_of_file()
CLOSED = "closed form", "made here"
ONE_TEST = "tests/model/test_bearing.py::test_limits_of_overturning_while_rolling"


def test_the_file_has_rows_of_every_kind():
    assert len(ROWS) >= 500
    assert {row["capability"] for row in ROWS} <= set(evidence.CAPABILITIES)
    assert {row["authority"] for row in ROWS} <= set(conformance.AUTHORITIES)
    keys = [(row["capability"], row["quantity"], row["test"]) for row in ROWS]
    assert len(set(keys)) == len(keys)
    for row in ROWS:
        assert row["tolerance"] > 0.0
        assert 0.0 <= row["share"] <= 1.0
        off = abs(row["computed"] - row["expected"])
        # numbers are written down to a hundredth of it; differences of doubles round
        within = 0.02 * row["tolerance"] + 4e-16 * abs(row["expected"])
        assert off == pytest.approx(row["share"] * row["tolerance"], abs=within), row


def test_capabilities_without_a_program_say_so():
    lines = json.loads(conformance.DATA.read_text("utf-8"))["rows"]
    none = [line[0] for line in lines if "none" in line]
    assert none == evidence.without("program")
    assert len(none) > 0
    having = {
        row["capability"] for row in ROWS if row["authority"] == "independent program"
    }
    assert not having & set(none)


def test_every_row_has_its_test():
    """One that is gone or renamed cannot say that its rows vanish."""
    functions = {}
    for row in ROWS:
        path, _, name = row["test"].partition("::")
        if path not in functions:
            tree = ast.parse((conformance.ROOT / path).read_text("utf-8"))
            functions[path] = {
                each.name for each in tree.body if isinstance(each, ast.FunctionDef)
            }
        assert re.sub(r"\[.*", "", name) in functions[path], row["test"]


def test_every_parameter_of_a_row_is_collected(request):
    """Of tests that this run has, when nothing but long tests was left out."""
    options = request.config.option
    if (
        options.keyword
        or options.markexpr
        or any("::" in at for at in request.config.args)
    ):
        pytest.skip("some parameters were left out on purpose")
    there = {item.nodeid for item in request.session.items}
    files = {each.partition("::")[0] for each in there}
    lost = {
        row["test"] for row in ROWS if row["test"].partition("::")[0] in files
    } - there
    assert lost == set()


def test_the_page_is_what_rows_and_marks_say():
    text = conformance.DOCUMENT.read_text("utf-8")
    assert conformance.with_tables(text) == text, (
        "write it: cd tests; python -m conformance"
    )


def test_the_file_is_written_as_it_stands():
    again = conformance.text_of([*ROWS, *conformance.without_program()])
    assert again == conformance.DATA.read_text("utf-8")


@pytest.fixture
def own_rows(monkeypatch):
    """Rows of this test, which are none of the file."""
    rows = []
    monkeypatch.setattr(conformance, "_recorded", rows)
    return rows


def test_what_conforms_is_recorded(own_rows):
    conforms("risk", "three", [1.0, 2.0, 3.0], [1.0, 2.05, 3.01], 0.1, *CLOSED)
    (row,) = own_rows
    assert (row["expected"], row["computed"], row["share"]) == (2.0, 2.05, 0.5)
    assert row["test"].endswith("::test_what_conforms_is_recorded")
    assert row["count"] == 3
    conforms("risk", "fine", 1.0, 1.0 + 1e-13, 1e-12, *CLOSED)
    assert own_rows[1]["computed"] == 1.0000000000001
    with pytest.raises(ValueError, match="'fine' is named twice"):
        conforms("risk", "fine", 1.0, 1.0, 1e-12, *CLOSED)
    own_rows.clear()  # what is left would be compared with the file


@pytest.mark.parametrize(
    ("expected", "found", "within"),
    [
        (1.0, 1.2, 0.1),
        (1.0, math.nan, 0.1),
        (math.nan, 1.0, 0.1),
        ([1.0, 2.0], [1.0, math.nan], 0.1),
        ([1.0, 2.0], [1.0, 2.0], [0.1, 0.0]),
        ([1.0, 2.0], [1.0, 2.2], [1.0, 0.1]),
        ([1.0, 2.0], 1.0, 5.0),
        (1.0, 1.0, 0.0),
        ([], [], 0.1),
    ],
)
def test_what_does_not_conform_fails(own_rows, expected, found, within):
    with pytest.raises(AssertionError, match="it"):
        conforms("risk", "it", np.array(expected), np.array(found), within, *CLOSED)
    assert own_rows == []


@pytest.mark.parametrize("words", [("risks", "closed form"), ("risk", "belief")])
def test_words_that_are_not_known(own_rows, words):
    with pytest.raises(ValueError, match=words[0]):
        conforms(words[0], "it", 1.0, 1.0, 0.1, words[1], "made here")


ROW = {
    "capability": "risk", "quantity": "rate", "expected": 2.0, "computed": 2.01,
    "tolerance": 0.1, "share": 0.1, "count": 1, "authority": "closed form",
    "source": "made here", "test": "t",
}  # fmt: skip


@pytest.mark.parametrize(
    ("now", "told"),
    [
        ({}, []),
        ({"share": 0.34}, []),
        ({"share": 0.36}, ["rate: uses 0.36 of its tolerance, used 0.1"]),
        ({"expected": 2.02}, []),
        ({"expected": 2.03}, ["rate: 2.03 is expected, 2.0 was"]),
        ({"tolerance": 0.2}, ["rate: the tolerance is 0.2, was 0.1"]),
        ({"source": "print"}, ["rate: source is 'print', was 'made here'"]),
        ({"quantity": "more"}, ["vanished: risk, rate", "not in the file: risk, more"]),
    ],
)
def test_what_moves_or_vanishes_is_told(now, told):
    assert differences([ROW], [ROW | now]) == told


def test_another_number_of_an_array_may_be_the_worst():
    curve = ROW | {"count": 9}
    assert differences([curve], [curve | {"expected": 7.0, "tolerance": 0.4}]) == []
    assert differences([curve], [curve | {"share": 0.5}]) != []
    assert differences([curve], [curve | {"count": 8}]) == ["rate: count is 8, was 9"]


def test_rounding_may_use_all_of_its_tolerance():
    fine = ROW | {"tolerance": 1e-9}
    assert differences([fine], [fine | {"share": 1.0}]) == []


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda rows: rows, None),
        (
            lambda rows: [r for r in rows if "0.15" not in r["quantity"]],
            "not in the file",
        ),
        (lambda rows: [*rows, rows[0] | {"quantity": "another"}], "vanished: .*another"),
        (lambda rows: [r | {"expected": 0.3} for r in rows], "is expected, 0.3 was"),
    ],
)
def test_a_run_of_pytest_fails_where_rows_differ(change, told, tmp_path, monkeypatch):
    """In workers as well, each of which knows its own tests alone."""
    rows = [row for row in ROWS if row["test"].startswith(ONE_TEST)]
    assert len(rows) == 3
    monkeypatch.delenv(conformance.WRITING, raising=False)
    (tmp_path / "rows.json").write_text(
        conformance.text_of(change(rows)), encoding="utf-8"
    )
    (tmp_path / "damaged.py").write_text(
        "import conformance\nfrom pathlib import Path\n"
        "conformance.DATA = Path(__file__).with_name('rows.json')\n"
    )
    path = os.pathsep.join(map(str, (tmp_path, conformance.TESTS, conformance.ROOT)))
    command = [sys.executable, "-m", "pytest", "-q", "-n", "1", "-p", "damaged"]
    command += ["-p", "no:cacheprovider", ONE_TEST]
    done = subprocess.run(
        command, cwd=conformance.ROOT, env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == (0 if told is None else 1), done.stdout + done.stderr
    if told is not None:
        assert re.search(told, done.stdout)
        assert "python -m conformance" in done.stdout
