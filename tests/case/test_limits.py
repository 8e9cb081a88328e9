"""Limits in their forms, for every result that may be limited, and those of `--fail-on`."""

import pytest

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.case import case_from_mapping
from rpscli.case.conditions import Condition, conditions_of, parse_condition
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import UsageError
from rpscli.report.limits import bound_text, reached_text, requirement_text
from rpscli.units import Written

from .conftest import BUILDING

WITH_COLUMNS = BUILDING.replace(
    "  profile: sine\n", "  vertical_period: 0.1 s\n  yield: {ratio: 1.3}\n"
).replace(
    "  impact: {law: rigid}\n",
    "  plan: {length: 12 m}\n  columns: 4\n"
    "  column: {section: round, modulus: 1, poisson: 0, contact_strength: 1}\n",
)
"""What the force of a column is made of, and the column, and strengths."""


def limited(text):
    """Conditions of a case with these limits, whatever it has."""
    changed = WITH_COLUMNS.replace("limits: {rotation_ratio: 0.5}", f"limits: {text}")
    case = case_from_mapping(read_yaml(changed, "c.yaml"), "c.yaml")
    return conditions_of(case.limits, "the case")


def condition(name, at, share=0.0, fractile=None, of=None):
    return Condition(name, at, "the case", share, fractile, of)


@pytest.mark.parametrize(
    ("text", "expected", "words"),
    [
        ("{rotation_ratio: 0.25}", condition("rotation_ratio", 0.25),
         "at most 0.25 in every record"),
        ("{max_lift: {at_most: 300 mm, share: 0.1}}", condition("max_lift", 0.3, 0.1),
         "at most 300 mm except in 10 % of the records"),
        ("{drift_ratio: {at_most: 0.005, fractile: 0.84}}",
         condition("drift_ratio", 0.005, fractile=0.84), "at most 0.005 at the 84 % fractile"),
        ("{drift_ratio: {at_most: 0.005, of: mean}}",
         condition("drift_ratio", 0.005, of="mean"), "at most 0.005 in the mean"),
        ("{min_column_force: {at_least: 100 kN, of: mean}}",
         condition("min_column_force", 1e5, of="mean"), "at least 100 kN in the mean"),
        ("{overturning: 0.05}", condition("overturning", 0.0, 0.05), "at most 5 % of the records"),
        ("{overturning: 0}", condition("overturning", 0.0), "no record"),
        ("{min_column_force: {at_least: 100 kN, share: 0.1}}",
         condition("min_column_force", 1e5, 0.1), "at least 100 kN except in 10 % of the records"),
        ("{min_column_force: {at_least: 100 kN, fractile: 0.1}}",
         condition("min_column_force", 1e5, fractile=0.1), "at least 100 kN at the 10 % fractile"),
        ("{min_column_force: 0}", condition("min_column_force", 0.0),  # no tension
         "at least 0 kN in every record"),
        # full contact is entered, which is limited from above, and lasts, from below
        ("{reentries: 20}", condition("reentries", 20.0), "at most 20 in every record"),
        ("{full_contact_share: {at_least: 0.5, share: 0.1}}",
         condition("full_contact_share", 0.5, 0.1), "at least 0.5 except in 10 % of the records"),
    ],
)  # fmt: skip
def test_a_limit_may_have_a_share_a_fractile_or_a_mean(text, expected, words):
    (found,) = limited(text)
    assert found == expected
    assert requirement_text(found) == words
    assert found.sign == (-1.0 if "least" in words else 1.0)


@pytest.mark.parametrize("name", [quantity.name for quantity in LIMITED])
def test_every_result_of_the_list_may_be_limited(name):
    ((found),) = limited(f"{{{name}: 3}}")
    assert (found.name, found.limit) == (name, 3.0)


def test_the_mean_is_judged_of_seven_recordings_and_more():
    mean = condition("drift_ratio", 0.005, of="mean")
    assert mean.under(7) == mean
    assert mean.under(6) == mean.under(1) == condition("drift_ratio", 0.005)


@pytest.mark.parametrize(
    ("value", "limit", "text"),
    [
        (0.50004, 0.5, "0.50004"),
        (0.5, 0.5, "0.5000"),
        (0.499996, 0.5, "0.499996"),
        (0.5 * (1.0 + 1e-15), 0.5, "0.5000"),  # rounding
        (0.51, 0.5, "0.5100"),
        (0.3000049, Written(0.3, "300 mm"), "300.005 mm"),
        (0.3, Written(0.3, "300 mm"), "300.0 mm"),
    ],
)
def test_a_value_is_told_from_its_limit(value, limit, text):
    name = "max_lift" if isinstance(limit, Written) else "rotation_ratio"
    assert reached_text(condition(name, limit), value) == text


def test_limits_are_printed_as_they_were_written():
    (found,) = limited("{rotation_ratio: 0.50000012}")
    assert bound_text(found) == "at most 0.50000012"


def test_conditions_of_options():
    assert parse_condition("max_base_shear=2 kN").limit == 2000.0
    with pytest.raises(UsageError, match="or '0"):
        parse_condition("max_base_shear=2 m")
    assert parse_condition("rotation_ratio=0.5") == Condition(
        "rotation_ratio", 0.5, "--fail-on"
    )
