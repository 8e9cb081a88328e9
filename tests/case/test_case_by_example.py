"""What small functions of `rpscli.case` give, by example."""

from __future__ import annotations

import pytest

from rpscli.case.build import each_storey
from rpscli.case.conditions import Condition, condition_text, parse_condition
from rpscli.case.rules.consistency import above, largest_slenderness
from rpscli.case.rules.plausibility import Doubt, doubts_of_many
from rpscli.case.schema.fields import ValueRange
from rpscli.case.schema.keys import is_whole
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.case.study.axes import _text
from rpscli.case.study.observed import comparable
from rpscli.case.text.document import dotted, shown
from rpscli.errors import UsageError
from rpscli.model.impact import ImpactLaw


def test_build() -> None:
    assert (each_storey(3.0, 2), each_storey((4.0, 3.0), 2)) == ([3.0, 3.0], [4.0, 3.0])


def test_conditions() -> None:
    assert (
        condition_text(Condition("rotation_ratio", 0.5, "", share=0.1))
        == "at most 0.5 except in 10 % of the records"
    )
    assert (
        condition_text(Condition("overturning", 0.0, "")),
        condition_text(Condition("a", 2.0, "")),
    ) == ("no record", "at most 2 in every record")
    assert (
        condition_text(Condition("min_column_force", 1e5, "", fractile=0.1))
        == "at least 100000 at the 10 % fractile"
    )


def test_rules_plausibility() -> None:
    assert (
        str(Doubt("a storey drifts by {0} of its height{1}", 0.03, " (storey 2)"))
        == "a storey drifts by 0.03 of its height (storey 2)"
    )
    wide = Doubt("the width {0} is unusual", 9.0)
    assert doubts_of_many(
        [[wide], [], [wide._replace(value=7.5)], [Doubt("it is odd{1}", None, "!")]]
    ) == ["2 of 4 systems: the width 7.5 to 9 is unusual", "1 of 4 systems: it is odd"]


def test_rules_podium() -> None:
    assert (above(0.0750123), above(0.075)) == ("0.07502", "0.075")
    assert round(largest_slenderness(ImpactLaw("rigid"), 4 / 3, 0.0, 0.0) ** 2, 12) == 2.0


def test_schema_fields() -> None:
    assert ValueRange(low=0.1, high=0.3, count=3).values == (0.1, 0.2, 0.3)
    assert ValueRange(low=0.1, high=10.0, count=3, spacing="log").values == (0.1, 1.0, 10.0)


def test_schema_keys() -> None:
    assert (is_whole("podium.columns"), is_whole("superstructure.period")) == (True, False)


def test_schema_scale_to() -> None:
    assert (scale_to_of("PGV=50 cm/s").value, scale_to_of("Sa(0.6 s)=0.5 g").period) == (0.5, 0.6)
    assert (scale_to_of("PGV(RotD100)=0.5").of, scale_to_of("Sa(0.6 s, geomean)=1 g").of) == (
        "rotd100",
        "geomean",
    )


def test_study_axes() -> None:
    assert (_text(20.0), _text(0.5), _text("0.4 g")) == ("20", "0.5", "0.4 g")


def test_study_observed() -> None:
    assert (
        comparable("podium.bearing.semi_diagonal", "1500 mm"),
        comparable("title", "tower A"),
    ) == ("1.5", "tower A")
    assert (comparable("podium.bearing.semi_diagonal", 1.5), comparable("scale", "0.50")) == (
        "1.5",
        "0.5",
    )


def test_text_document() -> None:
    assert dotted(("superstructure", "storey_mass", 0)) == "superstructure.storey_mass.0"
    assert (shown("200 t"), shown(0.5), shown(None), shown(True)) == (
        "'200 t'",
        "0.5",
        "null",
        "true",
    )


def test_conditions_of_options() -> None:
    assert parse_condition("max_base_shear=2 kN").limit == 2000.0
    with pytest.raises(UsageError, match="or '0"):
        parse_condition("max_base_shear=2 m")
    assert parse_condition("rotation_ratio=0.5") == Condition("rotation_ratio", 0.5, "--fail-on")
