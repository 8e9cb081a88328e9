"""`rps verify`: the numbers that are known, and what happens when one is off."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest
from click.testing import CliRunner
from oracles.second_integrator import simulate
from paper_structures import needs_compiled_kernels, oracle_system

from rpscli.analyses import verification as suite
from rpscli.analyses.verification import statics
from rpscli.analyses.verification.known import Known, block, compare, paper_podium
from rpscli.analyses.verification.motions import (
    FREE_VIBRATION,
    REFERENCES,
    Reference,
    shipped_record,
)
from rpscli.analyses.verification.overturning import least_amplitude
from rpscli.cli import program
from rpscli.records.loading import load_record


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what takes no time."""
    for name in (
        "buildings",
        "free_rocking",
        "pulses",
        "histories",
        "one_component",
        "compliant_ends",
    ):
        monkeypatch.setattr(suite, name, lambda: iter(()))


@needs_compiled_kernels
def test_this_installation_can_be_trusted() -> None:
    result = CliRunner().invoke(program, ["verify", "--json"])
    assert result.exit_code == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["status"] == "ok"
    assert document["mismatches"] == 0
    assert document["compared"] == len(document["comparisons"])
    assert len({line["group"] for line in document["comparisons"]}) == 16
    for line in document["comparisons"]:
        assert line["holds"]
        assert abs(line["computed"] - line["expected"]) <= line["tolerance"]


def test_the_table_has_a_verdict_for_each_number(short: None) -> None:
    # Wide enough that no name is broken, wherever the test runs.
    result = CliRunner().invoke(program, ["verify"], env={"COLUMNS": "200"})
    assert result.exit_code == 0
    assert "DIFFERS" not in result.stdout
    compared = int(result.stdout.splitlines()[-1].split()[0])
    assert result.stdout.count(" agrees") == compared > 90
    assert "theta_cr, tan a = 0.15, rho = 0.5 [rad]" in result.stdout


def test_a_number_that_is_off_ends_with_6(short: None, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = list(statics.GEOMETRIES)
    rows[4] = rows[4]._replace(critical_rotation="0.2947")
    monkeypatch.setattr(statics, "GEOMETRIES", tuple(rows))
    result = CliRunner().invoke(program, ["verify"])
    assert result.exit_code == 6
    assert result.stdout.count("DIFFERS") == 1
    assert "1 of 117 numbers differ" in result.stderr
    assert "theta_cr, tan a = 0.15, rho = 0.5: 0.2946034 instead of 0.2947" in result.stderr


def test_the_document_says_what_is_off(short: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(statics, "GEOMETRIES", statics.GEOMETRIES[:1])
    known = replace(compare("made", "one", "-", Known(1.0, 0.5), 1.6), unit="m")
    monkeypatch.setattr(suite, "modes", lambda: iter((known,)))
    result = CliRunner().invoke(program, ["verify", "--json"])
    assert result.exit_code == 6
    document = json.loads(result.stdout)
    assert document["status"] == "error"
    assert document["error"]["type"] == "VerificationMismatch"
    assert document["mismatches"] == 1
    assert [line["quantity"] for line in document["comparisons"] if not line["holds"]] == ["one"]


def test_counts_are_told_as_whole_numbers(short: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(statics, "GEOMETRIES", ())
    known = compare("made", "impacts", "-", Known(52.0, 0.0), 53.0)
    monkeypatch.setattr(suite, "modes", lambda: iter((known,)))
    result = CliRunner().invoke(program, ["verify"])
    assert result.exit_code == 6
    assert "impacts: 53 instead of 52 -, tolerance 0 (made)" in result.stderr


@needs_compiled_kernels
@pytest.mark.parametrize("near", [0.3, 0.9])
def test_a_least_pulse_that_is_not_near_is_no_number(near: float) -> None:
    assert math.isnan(least_amplitude(block(0.2, 0.6), "half-sine", near))


def test_what_is_no_number_does_not_agree() -> None:
    assert compare("made", "one", "-", Known(1.0, 0.0), 1.0).holds
    assert not compare("made", "one", "-", Known(1.0, math.inf), math.nan).holds


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize(
    "row",
    [REFERENCES[2], *(pytest.param(row, marks=pytest.mark.long) for row in REFERENCES)],
    ids=lambda row: f"{row.record}-{row.storeys}-{row.rho}",
)
def test_the_second_integrator_gives_the_reference_values(row: Reference) -> None:
    structure = paper_podium(row.storeys, row.tan_alpha, row.rho)
    record = load_record(shipped_record(row.record))
    result = simulate(
        oracle_system(structure), record.acceleration, record.dt, free_vibration=FREE_VIBRATION
    )
    # its default tolerance leaves up to 5e-8
    assert result.max_rotation == pytest.approx(row.max_rotation, rel=1e-7)
    shear = result.max_base_shear_at_samples / structure.static_base_shear
    assert shear == pytest.approx(row.base_shear_ratio, rel=1e-7)
    assert result.impacts == row.impacts
