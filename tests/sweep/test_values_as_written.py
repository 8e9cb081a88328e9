"""Values stand in tables, labels and errors as the study has them; CSV and JSON are in SI."""

from __future__ import annotations

from copy import copy
from pathlib import Path

import pytest

from rpscli.report.study.labels import key_cells, key_columns, label
from rpscli.report.table import records
from rpscli.sweep.points import lay_out
from rpscli.units import Written, in_si
from sweep.small_studies import STUDY, Make, Sweep, csv_rows

MEASURED = (
    STUDY.replace("scale: [0.5, 1.0]", "scale: {measure: PGA, values: [0.2 g, 0.6 g]}")
    .replace("[1, 2, 3]", "[1, 2]")
    .replace("podium.bearing.curvature_ratio: [critical, 0.5, 0]", "{}: [{}]")
    + "limits: {rotation_ratio: 0.001}\nreports: [fragility]\n"
)


@pytest.mark.parametrize("columns", [60, 80, 100, 120])
def test_a_study_fits_the_terminal_and_has_what_was_typed(
    sweep: Sweep, monkeypatch: pytest.MonkeyPatch, columns: int
) -> None:
    text = MEASURED.replace("{}: [{}]", "superstructure.storey_mass: [200 t, 300 t]")
    monkeypatch.setenv("COLUMNS", str(columns))
    result = sweep("study.yaml", "--all", study=text)
    assert result.exit_code == 10, result.stderr
    lines = [line.rstrip() for line in result.stdout.splitlines()]
    assert max(map(len, lines)) <= columns
    words = " ".join(lines)
    assert {"0.6 g", "200 t"} == {text for text in ("0.6 g", "200 t") if text in words}
    assert not [text for text in ("1.96133", "5.88399", "200000") if text in words]
    # 0.2 and 0.6 of standard gravity, 9.80665 m/s2 by definition.
    assert {row["PGA [m/s2]"] for row in csv_rows("verdicts.csv")} == {"1.96133", "5.88399"}


def test_columns_of_keys_hold_si_and_show_what_was_typed() -> None:
    (column,) = key_columns(["podium.cap_beam_mass"], [["200 t"], [3e5]])
    assert records([column]) == [{column.name: 2e5}, {column.name: 3e5}]
    assert key_cells(column, "mass") == ("mass", ["200 t", "300000 kg"])
    (column,) = key_columns(["podium.cap_beam_mass"], [[2e5], [300000]])
    assert key_cells(column, "mass") == ("mass kg", ["200000", "300000"])
    assert label("PGA", 5.0) == "PGA = 5 m/s2"
    assert label("PGA", Written(5.88399, " 0.6 g ")) == "PGA = 0.6 g"


def test_what_is_written_goes_with_the_number() -> None:
    value = copy(in_si("0.6 g", "m/s2"))  # as to workers of Dask
    assert isinstance(value, Written)
    assert (value, repr(value), value.text) == (5.88399, "5.88399", "0.6 g")


def test_what_a_case_scales_its_record_to_is_said_as_it_has_it(
    workplace: Path, study_of: Make
) -> None:
    base = workplace / "base.yaml"
    record = "record: {source: 'pulse:sine?amplitude=1&period=1',"
    record += " scale_to: {measure: PGA, value: 0.3 g}}"
    base.write_text(base.read_text(encoding="utf-8") + record, encoding="utf-8")
    layout = lay_out(study_of(STUDY, ("scale: [0.5, 1.0]\n", "")))
    assert layout.scaled_to == "PGA = 0.3 g"
    assert layout.scales == pytest.approx((2.941995,), rel=1e-15)


def test_a_record_that_is_listed_twice_is_named(study_of: Make) -> None:
    assert study_of(STUDY).notes == ()
    again = '  - "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"\nscale'
    study = study_of(STUDY, ("scale", again))
    source = "synthetic:?pga=0.5g&duration=4&dt=0.02&seed=2"
    assert study.notes == (f"records: {source}: given more than once, taken once",)
    assert study.sources == study_of(STUDY).sources
