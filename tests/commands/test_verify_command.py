"""`rps verify`: the certified problems by this installation, and what happens when one is off."""

import math

import pytest
from paper_structures import needs_compiled_kernels

from rpscli.analyses import verification
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


def test_what_is_no_number_does_not_agree():
    assert Comparison("made", "one", "-", 1.0, 1.0, 0.0).holds
    assert not Comparison("made", "one", "-", 1.0, math.nan, math.inf).holds
