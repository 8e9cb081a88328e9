"""`rps verify`: the certified problems by this installation, and what happens when one is off."""

import math
from dataclasses import replace

import pytest
from paper_structures import needs_compiled_kernels

from rpscli.analyses import conformance, verification
from rpscli.analyses.conformance import Recomputed, known_rows, own_numbers
from rpscli.analyses.verification import LEFT_OUT, Comparison, certified
from rpscli.commands.verify import OWN_DIGITS


@pytest.fixture
def short(monkeypatch):
    """Only what takes no time."""
    known = {key: found for key, found in certified().items() if key[0] == "capacity"}
    monkeypatch.setattr(verification, "certified", lambda: known)


@needs_compiled_kernels
def test_this_installation_can_be_trusted(rps_json):
    document = rps_json("verify")
    assert document["status"] == "ok"
    assert document["mismatches"] == 0
    assert document["not_answered"] == [*LEFT_OUT]
    asked = [key for key in certified() if key[0] not in LEFT_OUT]
    assert [
        (line["group"], line["quantity"]) for line in document["comparisons"]
    ] == asked
    assert document["compared"] == len(asked)
    for line in document["comparisons"]:
        assert line["holds"]
        assert line["digits"] >= min(OWN_DIGITS, line["certified_digits"])


def test_the_table_has_a_verdict_for_each_number(short, rps):
    # Wide enough that no name is broken, wherever the test runs.
    result = rps("verify", env={"COLUMNS": "200"})
    assert "6 numbers compared, none off" in result.stdout
    assert result.stdout.count(" digits\n") == 6
    assert "critical rotation [rad]" in result.stdout


def test_a_number_that_is_off_ends_with_6(short, rps, rps_json):
    known = verification.certified()
    known["capacity", "critical rotation"] = ("rad", 12, [0.24738])
    result = rps("verify", exit_code=6)
    assert "6 numbers compared, 1 off" in result.stdout
    assert "1 of 6 numbers differ from what is known: do not trust" in result.stderr
    assert "critical rotation: 0.2473784284 instead of 0.2473800000 rad" in result.stderr
    document = rps_json("verify", exit_code=6)
    assert document["status"] == "error"
    assert document["error"]["type"] == "VerificationMismatch"
    off = [line["quantity"] for line in document["comparisons"] if not line["holds"]]
    assert (off, document["mismatches"]) == (["critical rotation"], 1)


@needs_compiled_kernels
def test_the_rows_that_need_no_test_are_computed_again(rps_json):
    document = rps_json("verify", "--table")
    assert (document["status"], document["mismatches"]) == ("ok", 0)
    assert document["compared"] == len(document["rows"]) > 250
    assert document["rows_of_tests"] == len(known_rows()) >= 500
    file = {(row.capability, row.quantity, row.test): row for row in known_rows()}
    for line in document["rows"]:
        row = file[line["capability"], line["quantity"], line["test"]]
        assert line["expected"] == row.expected
        assert line["holds"]
        share = abs(line["computed"] - row.expected) / row.tolerance
        assert line["share"] == pytest.approx(share, abs=1e-12)
        assert share <= 1.0


@needs_compiled_kernels
def test_every_known_number_has_a_row():
    """None that the command computes is left out for want of a row of its name."""
    names = [row.quantity for row in known_rows()]
    certified_ones = {key: [1.0] for key in certified() if key[0] not in LEFT_OUT}
    own = [name for name, _ in own_numbers(certified_ones)]
    assert {name: names.count(name) for name in own} == dict.fromkeys(own, 1)


@pytest.fixture
def two_rows(monkeypatch):
    """A row that holds and one that does not, of numbers that take no time."""
    (row,) = (row for row in known_rows() if row.quantity == "rho_cr, tan(alpha) 0.10")
    off = replace(row, capability="modes", quantity="e", expected=0.25261)
    monkeypatch.setattr(conformance, "known_rows", lambda: [row, off])
    numbers = {row.quantity: 0.2525, "e": 0.2525}
    monkeypatch.setattr(conformance, "own_numbers", lambda _: numbers.items())


def test_rows_stand_by_capability_with_their_verdicts(short, two_rows, rps, rps_json):
    result = rps("verify", "--table", exit_code=6, env={"COLUMNS": "200"})
    lines = [" ".join(line.split()) for line in result.stdout.splitlines()]
    assert "rho_cr, tan(alpha) 0.10 0.2525 0.2525 0 agrees" in lines
    assert "2 rows computed again, 1 off" in lines
    assert any(
        line.startswith("e 0.25261 0.2525 ") and "DIFFERS" in line for line in lines
    )
    assert "1 of 2 rows differ from what is known: do not trust" in result.stderr
    assert "e: 0.2525 instead of 0.25261" in result.stderr
    document = rps_json("verify", "--table", exit_code=6)
    assert [row["holds"] for row in document["rows"]] == [True, False]


@pytest.mark.parametrize("other", [("--problems", "p"), ("--score", "s.csv")])
def test_the_table_goes_alone(other, rps, tmp_path):
    file = tmp_path / other[1]
    file.write_text("problem,quantity,value\n")
    result = rps("verify", "--table", other[0], str(file), exit_code=2)
    assert "--table computes rows here; take it without the others" in result.stderr


def test_what_is_no_number_does_not_agree():
    assert Comparison("made", "one", "-", 1.0, 1.0, 0.0).holds
    assert not Comparison("made", "one", "-", 1.0, math.nan, math.inf).holds
    assert not Recomputed(known_rows()[0], math.nan).holds
