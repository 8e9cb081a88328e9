"""Limits in their three forms, for every result that may be limited."""

from __future__ import annotations

import pytest

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.case import parse_case
from rpscli.case.conditions import Condition, condition_text, conditions_of


def limited(building: str, text: str) -> tuple[Condition, ...]:
    """Conditions of a case with these limits."""
    changed = building.replace("limits: {rotation_ratio: 0.5}", f"limits: {text}")
    assert changed != building
    return conditions_of(parse_case(changed, name="c.yaml").limits, "the case")


def test_a_limit_is_a_number_or_has_a_share_or_a_fractile(building: str) -> None:
    found = limited(
        building,
        "{rotation_ratio: 0.25, max_cap_beam_displacement: {at_most: 300 mm, share: 0.1},"
        " drift_ratio: {at_most: 0.005, fractile: 0.84}, overturning: 0.05}",
    )
    assert found == (
        Condition("rotation_ratio", 0.25, "the case"),
        Condition("max_cap_beam_displacement", 0.3, "the case", share=0.1),
        Condition("drift_ratio", 0.005, "the case", fractile=0.84),
        Condition("overturning", 0.0, "the case", share=0.05),
    )
    assert [condition_text(condition) for condition in found] == [
        "at most 0.25 in every record",
        "at most 0.3 except in 10 % of the records",
        "at most 0.005 at the 84 % fractile",
        "at most 5 % of the records",
    ]


def test_full_contact_that_gives_way_is_limited_from_both_sides(building: str) -> None:
    """How often it is entered from above, how long it lasts from below."""
    found = limited(building, "{reentries: 20, full_contact_share: {at_least: 0.5, share: 0.1}}")
    assert [(c.name, c.from_below, condition_text(c)) for c in found] == [
        ("reentries", False, "at most 20 in every record"),
        ("full_contact_share", True, "at least 0.5 except in 10 % of the records"),
    ]


def with_columns(building: str) -> str:
    """What the force of a column is made of."""
    building = building.replace("  profile: sine\n", "  vertical_period: 0.1 s\n")
    return building.replace("  impact: {law: rigid}\n", "  plan: {length: 12 m}\n")


def test_a_least_force_is_limited_from_below(building: str) -> None:
    building = with_columns(building)
    found = limited(building, "{min_column_force: {at_least: 100 kN, share: 0.1}}")
    assert found == (Condition("min_column_force", 1e5, "the case", share=0.1),)
    assert condition_text(found[0]) == "at least 100000 except in 10 % of the records"
    (plain,) = limited(building, "{min_column_force: 0}")  # no tension
    assert condition_text(plain) == "at least 0 in every record"
    (above,) = limited(building, "{max_column_force: 100 kN}")
    assert (plain.sign, above.sign) == (-1.0, 1.0)


@pytest.mark.parametrize("name", [quantity.name for quantity in LIMITED])
def test_every_result_of_the_list_may_be_limited(building: str, name: str) -> None:
    ((found),) = limited(with_columns(building), f"{{{name}: 3}}")
    assert (found.name, found.limit) == (name, 3.0)
