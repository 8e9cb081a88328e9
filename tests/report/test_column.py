"""What the most loaded column carries: its table, formulas with numbers, drawing and section."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from paper_structures import needs_compiled_kernels

from report.small_results import drawn
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record
from rpscli.report import derived
from rpscli.report.case_page import column_sections
from rpscli.report.derived import column_derivations
from rpscli.report.figures.bearing import column_figure
from rpscli.report.page import Picture
from rpscli.report.table import Table
from rpscli.report.timehistory import column_table, timehistory_document

from .test_derivation import evaluated

CASE = Path(__file__).parents[2] / "cases" / "designed_columns.yaml"
pytestmark = needs_compiled_kernels

ROUND = "podium.column={section: round, modulus: 35 GPa, poisson: 0.2, contact_strength: 25 MPa}"
VARIANTS = {
    "square": (),
    "concrete": ("podium.column.modulus=35GPa", "podium.column.contact_strength=60MPa"),
    "round": (ROUND,),
    "flat": ("podium.bearing.dimensions.radius=0", "limits.contact_pressure_ratio=null"),
    "flat and round": (
        ROUND, "podium.bearing.dimensions.radius=0", "limits.contact_pressure_ratio=null"
    ),
}  # fmt: skip


def result_of(name: str, *, both: bool = False, factor: float = 1.0) -> TimeHistoryResult:
    case = load_case(CASE, VARIANTS[name])
    push = load_record(str(CASE.parent / "records" / "synthetic_far_field.at2")).scaled(factor)
    motion = MotionComponents(push, y=push) if both else push
    return time_history(case.structure, motion, replace(case.analysis, free_vibration=0.0))


@pytest.mark.parametrize("name", VARIANTS)
def test_instants_and_their_formulas(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(derived, "DIGITS", 17)
    result = result_of(name)
    found = list(column_derivations(result))
    second = "crushed_width_ratio" if "flat" in name else "contact_pressure_ratio"
    assert {row.name for row in found} == {"column_moment", second}
    for row in found:
        sides = [evaluated(side) for side in row.numbers.split(" = ")]
        wanted = sides[1] if len(sides) == 2 else row.value
        assert sides[0] == pytest.approx(wanted, rel=1e-8), row
    table, *_ = column_table(result)
    assert isinstance(table, Table)
    assert [row[0] for row in table.rows][:2] == ["moment", "axial force"]
    (section,) = column_sections(result, [])
    assert not any(isinstance(block, Picture) for block in section.blocks)
    assert "impulse of beam and columns" in str(section.blocks[0])
    assert drawn(column_figure, result, "title").axes
    instants = timehistory_document(result)["column_instants"]
    assert instants[0]["moment"] == pytest.approx(found[2].value, rel=1e-12)


def test_ends_of_concrete_would_not_do() -> None:
    """What the comment of the case says, at the scale of its record."""
    ratios = [
        result_of(n, factor=0.7).contact_pressure_ratio or 0.0 for n in ("square", "concrete")
    ]
    assert ratios[0] < 1.0 < ratios[1]


def test_what_the_model_and_codes_do_not_cover_is_said() -> None:
    strong = result_of("square", factor=2.0)
    assert any("EN 1337-4" in text for text in strong.warnings) == (strong.max_rotation > 0.05)
    assert strong.max_rotation > 0.05
    assert not any("EN 1337-4" in text for text in result_of("round", factor=2.0).warnings)
    of = load_case(CASE, VARIANTS["flat"]).structure
    assert of.column is not None
    weak = replace(of, column=replace(of.column, contact_strength=2e6))
    push = load_record(str(CASE.parent / "records" / "synthetic_far_field.at2"))
    assert any("no longer a line" in text for text in time_history(weak, push).warnings)
    pair = result_of("square", both=True)
    assert any("corner" in str(part) for part in column_table(pair))
    assert pair.contact_pressure_ratio is pair.crushed_width_ratio is None
