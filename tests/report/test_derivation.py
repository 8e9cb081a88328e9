"""What a checker finds who follows the formulas with the numbers that are put in."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest

from rpscli.case.case import Case, load_case, parse_case
from rpscli.report import derived
from rpscli.report.derived import FUNCTIONS, Derivation, derivations

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.yaml"))
SIX = next(path for path in CASES if path.stem == "six_storey")

VARIANTS = {
    "overturns rolling": ["podium.bearing.curvature_ratio=0.2"],
    "critical": ["podium.bearing.curvature_ratio=critical"],
    "flat": ["podium.bearing.curvature_ratio=0"],
    "stiffens": ["podium.bearing.curvature_ratio=1.5"],
    "rigid law": ["podium.impact={law: rigid, factor: 0.9}"],
    "loss": ["podium.impact={law: flexible, loss: 0.7, factor: 0.98}"],
    "measured": ["podium.impact={law: value, restitution: 0.9, factor: 0.95}"],
    "unequal floors": ["superstructure.storey_mass=[3e5, 2e5, 2e5, 1e5, 1e5, 5e4]"],
    "between the two critical ratios": ["podium.bearing.curvature_ratio=0.253"],
}

SIGNS = {"·": "*", "−": "-", "²": "**2", "³": "**3", "√": "sqrt"}


def case_of(name: str) -> Case:
    if name in VARIANTS:
        return load_case(SIX, VARIANTS[name])
    return load_case(next(path for path in CASES if path.stem == name))


def evaluated(text: str) -> float:
    """What a calculator says."""
    for sign, operator in SIGNS.items():
        text = text.replace(sign, operator)
    assert set(re.findall(r"[a-z_]{2,}", text)) <= set(FUNCTIONS)
    return float(eval(text, {name: getattr(math, name) for name in FUNCTIONS}))  # noqa: S307


def found(case: Case) -> list[Derivation]:
    return list(derivations(case.structure, case.document["podium"]))


@pytest.mark.parametrize("name", [*(path.stem for path in CASES), *VARIANTS])
def test_the_formula_with_its_numbers_gives_the_value(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(derived, "DIGITS", 17)  # all digits: what is left is rounding
    case = case_of(name)
    for row in found(case):
        if not row.numbers:
            continue
        sides = [evaluated(side) for side in row.numbers.split(" = ")]
        wanted = sides[1] if len(sides) == 2 else row.value
        # Rounding of terms that nearly cancel: the stiffness of a bearing near rho = 0.5.
        size = case.structure.weight / case.structure.bearing.semi_diagonal
        tolerance = 1e-13 * size if row.name == "initial_stiffness" else 0.0
        assert sides[0] == pytest.approx(wanted, rel=1e-9, abs=tolerance), row


@pytest.mark.parametrize("name", [*(path.stem for path in CASES), *VARIANTS])
def test_what_has_no_formula_stands_in_the_case(name: str) -> None:
    case = case_of(name)
    numbers = set(leaves(case.document["podium"]))
    for row in found(case):
        if not row.formula:
            assert any(row.value == pytest.approx(number, rel=1e-12) for number in numbers), row


def leaves(content: Any) -> list[float]:
    if isinstance(content, dict):
        return [number for value in content.values() for number in leaves(value)]
    return [float(content)] if isinstance(content, int | float) else []


def test_the_branch_of_the_critical_rotation_is_the_one_that_is_travelled() -> None:
    def formula(case: Case, name: str) -> str:
        return next(row.formula for row in found(case) if row.name == name)

    rolling, rocking = "atan(tan α / (1 − 2 ρ))", "atan(tan α′ / (1 − 2 ρ (1 − cos(β))))"
    between = case_of("between the two critical ratios")
    assert formula(between, "critical_rotation") == rolling
    assert formula(between, "critical_rotation_paper") == rocking
    assert formula(case_of("overturns rolling"), "critical_rotation") == rolling
    # Where both are the same in all digits shown, one row is enough.
    for name, rows in (("between the two critical ratios", 2), ("stiffens", 1), ("flat", 1)):
        shown = [row.name for row in found(case_of(name))]
        assert sum(each.startswith("critical_rotation") for each in shown) == rows
    assert formula(case_of("stiffens"), "critical_rotation") == rocking


def test_numbers_have_six_digits() -> None:
    row = next(row for row in found(case_of("six_storey")) if row.name == "column_height")
    assert (row.symbol, row.formula, row.numbers) == (
        "2H",
        "2 R cos(α)",
        "2 · 1.5 · cos(0.14889)",
    )


def test_a_case_in_memory_will_do() -> None:
    text = SIX.read_text("utf-8")
    assert found(parse_case(text, name="x")) == found(case_of("six_storey"))
