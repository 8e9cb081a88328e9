"""What small functions of `rpscli.case` give, by example."""

from __future__ import annotations

from rpscli.case.plausibility import Doubt, doubts_of_many
from rpscli.case.schema.fields import ValueRange
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.case.study.observed import comparable


def test_doubts_of_many_systems() -> None:
    wide = Doubt("the width {0} is unusual", 9.0)
    assert doubts_of_many(
        [[wide], [], [wide._replace(value=7.5)], [Doubt("it is odd{1}", None, "!")]]
    ) == ["2 of 4 systems: the width 7.5 to 9 is unusual", "1 of 4 systems: it is odd"]


def test_values_at_equal_spaces() -> None:
    assert ValueRange(low=0.1, high=0.3, count=3).values == (0.1, 0.2, 0.3)
    assert ValueRange(low=0.1, high=10.0, count=3, spacing="log").values == (0.1, 1.0, 10.0)


def test_what_a_record_is_scaled_to() -> None:
    assert (scale_to_of("PGV=50 cm/s").value, scale_to_of("Sa(0.6 s)=0.5 g").period) == (0.5, 0.6)
    assert scale_to_of("PGV(RotD100)=0.5").of == "rotd100"
    assert scale_to_of("Sa(0.6 s, geomean)=1 g").of == "geomean"


def test_values_of_observed_systems() -> None:
    diagonal = "podium.bearing.semi_diagonal"
    assert comparable(diagonal, "1500 mm") == comparable(diagonal, 1.5) == "1.5"
    assert (comparable("title", "tower A"), comparable("scale", "0.50")) == ("tower A", "0.5")
