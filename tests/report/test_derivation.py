"""Formulas with numbers put in, of a case and of its most loaded column."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from paper_structures import needs_compiled_kernels

from report.small_results import drawn
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case, parse_case
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record
from rpscli.report import derived
from rpscli.report.case_page import column_sections
from rpscli.report.column_table import column_table
from rpscli.report.derived import FUNCTIONS, column_derivations, derivations
from rpscli.report.figures.bearing import column_figure
from rpscli.report.page import Picture
from rpscli.report.table import Table
from rpscli.report.timehistory import timehistory_document

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.yaml"))
SIX = next(path for path in CASES if path.stem == "six_storey")

VARIANTS = {
    "overturns rolling": ["podium.bearing.curvature_ratio=0.2"],
    "critical": ["podium.bearing.curvature_ratio=critical"],
    "flat": ["podium.bearing.curvature_ratio=0"],
    "stiffens": ["podium.bearing.curvature_ratio=1.5"],
    "spherical": [
        "podium.bearing={dimensions: {height: 3, width: 0, wedge_width: 1, radius: 2}}",
        "limits.base_shear_ratio=null",  # of V_st, which such ends have not
    ],
    "rigid law": ["podium.impact={law: rigid, factor: 0.9}"],
    "loss": ["podium.impact={law: flexible, loss: 0.7, factor: 0.98}"],
    "measured": ["podium.impact={law: value, restitution: 0.9, factor: 0.95}"],
    "unequal floors": ["superstructure.storey_mass=[3e5, 2e5, 2e5, 1e5, 1e5, 5e4]"],
    "between the two critical ratios": ["podium.bearing.curvature_ratio=0.253"],
}

SIGNS = {"·": "*", "−": "-", "²": "**2", "³": "**3", "√": "sqrt"}


def case_of(name):
    if name in VARIANTS:
        return load_case(SIX, VARIANTS[name])
    return load_case(next(path for path in CASES if path.stem == name))


def evaluated(text):
    """What a calculator says."""
    for sign, operator in SIGNS.items():
        text = text.replace(sign, operator)
    assert set(re.findall(r"[a-z_]{2,}", text)) <= set(FUNCTIONS)
    return float(eval(text, {name: getattr(math, name) for name in FUNCTIONS}))  # noqa: S307


def found(case):
    return list(derivations(case.structure, case.document["podium"]))


@pytest.mark.parametrize("name", [*(path.stem for path in CASES), *VARIANTS])
def test_the_formula_with_its_numbers_gives_the_value_or_it_stands_in_the_case(
    name, monkeypatch
):
    monkeypatch.setattr(derived, "DIGITS", 17)  # all digits: what is left is rounding
    case = case_of(name)
    given = set(leaves(case.document["podium"]))
    for row in found(case):
        if not row.formula:
            assert any(
                row.value == pytest.approx(number, rel=1e-12) for number in given
            ), row
        if not row.numbers:
            continue
        sides = [evaluated(side) for side in row.numbers.split(" = ")]
        wanted = sides[1] if len(sides) == 2 else row.value
        # Rounding of terms that nearly cancel: the stiffness of a bearing near rho = 0.5.
        size = case.structure.weight / case.structure.bearing.semi_diagonal
        tolerance = 1e-13 * size if row.name == "initial_stiffness" else 0.0
        assert sides[0] == pytest.approx(wanted, rel=1e-9, abs=tolerance), row


def leaves(content):
    if isinstance(content, dict):
        return [number for value in content.values() for number in leaves(value)]
    return [float(content)] if isinstance(content, int | float) else []


def test_the_branch_of_the_critical_rotation_is_the_one_that_is_travelled():
    def formula(case, name):
        return next(row.formula for row in found(case) if row.name == name)

    rolling, rocking = "atan(tan α / (1 − 2 ρ))", "atan(tan α′ / (1 − 2 ρ (1 − cos(β))))"
    between = case_of("between the two critical ratios")
    assert formula(between, "critical_rotation") == rolling
    assert formula(between, "critical_rotation_paper") == rocking
    assert formula(case_of("overturns rolling"), "critical_rotation") == rolling
    # Where both are the same in all digits shown, one row is enough.
    for name, rows in (
        ("between the two critical ratios", 2),
        ("stiffens", 1),
        ("flat", 1),
    ):
        shown = [row.name for row in found(case_of(name))]
        assert sum(each.startswith("critical_rotation") for each in shown) == rows
    assert formula(case_of("stiffens"), "critical_rotation") == rocking


def test_numbers_have_six_digits():
    row = next(row for row in found(case_of("six_storey")) if row.name == "column_height")
    assert (row.symbol, row.formula, row.numbers) == (
        "2H",
        "2 R cos(α)",
        "2 · 1.5 · cos(0.14889)",
    )


def test_a_case_in_memory_will_do():
    text = SIX.read_text("utf-8")
    assert found(parse_case(text, name="x")) == found(case_of("six_storey"))


DESIGNED = next(path for path in CASES if path.stem == "designed_columns")

ROUND = "podium.column={section: round, modulus: 35 GPa, poisson: 0.2, contact_strength: 25 MPa}"
FLAT_ENDS = ("podium.bearing.dimensions.radius=0", "limits.contact_pressure_ratio=null")
COLUMNS = {
    "square": (),
    "concrete": ("podium.column.modulus=35GPa", "podium.column.contact_strength=60MPa"),
    "round": (ROUND,),
    "flat": FLAT_ENDS,
    "flat and round": (ROUND, *FLAT_ENDS),
    "flat, crushed whole": (ROUND.replace("25", "0.5"), *FLAT_ENDS),
}


def result_of(name, *, both=False, factor=1.0):
    case = load_case(DESIGNED, COLUMNS[name])
    push = load_record(
        str(DESIGNED.parent / "records" / "synthetic_far_field.at2")
    ).scaled(factor)
    motion = MotionComponents(push, y=push) if both else push
    return time_history(
        case.structure, motion, replace(case.analysis, free_vibration=0.0)
    )


@needs_compiled_kernels
@pytest.mark.parametrize("name", COLUMNS)
def test_instants_and_their_formulas(name, monkeypatch):
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
    (section,) = column_sections(result, [], "a record")
    assert not any(isinstance(block, Picture) for block in section.blocks)
    assert "under a record, without the impulse of beam" in str(section.blocks[0])
    assert drawn(column_figure, result, "title").axes
    instants = timehistory_document(result)["column_instants"]
    assert instants[0]["moment"] == pytest.approx(found[3].value, rel=1e-12)


@needs_compiled_kernels
def test_ends_of_concrete_would_not_do():
    """What the comment of the case says, at the scale of its record."""
    ratios = [
        result_of(n, factor=0.7).contact_pressure_ratio or 0
        for n in ("square", "concrete")
    ]
    assert ratios[0] < 1.0 < ratios[1]


@needs_compiled_kernels
def test_what_the_model_and_codes_do_not_cover_is_said():
    strong = result_of("square", factor=2.0)
    assert any("EN 1337-4" in text for text in strong.warnings) == (
        strong.max_rotation > 0.05
    )
    assert strong.max_rotation > 0.05
    assert not any(
        "EN 1337-4" in text for text in result_of("round", factor=2.0).warnings
    )
    of = load_case(DESIGNED, COLUMNS["flat"]).structure
    assert of.column is not None
    weak = replace(of, column=replace(of.column, contact_strength=2e6))
    push = load_record(str(DESIGNED.parent / "records" / "synthetic_far_field.at2"))
    assert any("no longer a line" in text for text in time_history(weak, push).warnings)
    pair = result_of("square", both=True)
    assert any("corner" in str(part) for part in column_table(pair))
    assert pair.contact_pressure_ratio is pair.crushed_width_ratio is None
    (moment,) = (row for row in column_derivations(pair) if row.symbol == "M")
    assert moment.formula == "√(2) (e P − d Q)"
    sides = [evaluated(side) for side in moment.numbers.split(" = ")]
    assert sides[0] == pytest.approx(moment.value, rel=1e-3)
    assert "about a corner" in str(list(column_table(pair)))
