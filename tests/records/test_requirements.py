"""What codes ask of a set, by numbers of one's own; what recordings are kept."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from rpscli.errors import UsageError
from rpscli.records.filters import parse_filter
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.requirements import RULES, Component, Periods


class Have(NamedTuple):
    """What a set has, in the order in which it is judged."""

    number: int
    of: Component
    level: str
    pga_ratio: float
    least: float
    span: tuple[float, float]


HAVE = Have(7, "component", "", 1.02, 0.91, (0.1, 1.0))
STRUCTURE = Periods(0.5, 2.0)


def words(rules: str, have: Have, periods: Periods | None) -> list[str]:
    return [rule.word for rule in RULES[rules].judged(*have, periods)]


@pytest.mark.parametrize(
    ("have", "periods", "wanted"),
    [
        # Three or more, mean PGA, 0.9, and 0.2 x 0.5 = 0.1 s to 2 x 0.5 = 1 s.
        (HAVE, STRUCTURE, ["met", "met", "met", "met"]),
        (HAVE._replace(number=2), STRUCTURE, ["NOT MET", "met", "met", "met"]),
        (HAVE._replace(pga_ratio=0.99), STRUCTURE, ["met", "NOT MET", "met", "met"]),
        (HAVE._replace(least=0.899), STRUCTURE, ["met", "met", "NOT MET", "met"]),
        (HAVE._replace(span=(0.11, 1.0)), STRUCTURE, ["met", "met", "met", "NOT MET"]),
        (HAVE._replace(span=(0.1, 0.99)), STRUCTURE, ["met", "met", "met", "NOT MET"]),
        (HAVE, None, ["met", "met", "met", "not checked"]),
        (HAVE._replace(pga_ratio=float("nan")), STRUCTURE, ["met", "not checked", "met", "met"]),
    ],
)
def test_en1998(have: Have, periods: Periods | None, wanted: list[str]) -> None:
    assert words("en1998", have, periods) == wanted


def test_asce7() -> None:
    pairs = Have(11, "rotd100", "MCE_R", float("nan"), 0.9, (0.1, 1.0))
    assert words("asce7-ch16", pairs, STRUCTURE) == ["met"] * 5
    few = pairs._replace(number=10, of="rotd50", level="design", least=0.89)
    assert words("asce7-ch16", few, STRUCTURE) == [*["NOT MET"] * 4, "met"]
    assert words("asce7-ch16", pairs._replace(level=""), STRUCTURE)[2] == "not checked"
    # Isolated: 7 pairs, SRSS, the whole target from 0.75 x 2 = 1.5 s to 1.25 x 2 = 2.5 s.
    isolated = Have(7, "srss", "MCE_R", float("nan"), 1.0, (1.5, 2.5))
    assert words("asce7-ch17", isolated, STRUCTURE) == ["met"] * 5
    assert words("asce7-ch17", isolated._replace(least=0.99), STRUCTURE)[3] == "NOT MET"


def test_nobody_takes_an_unverified_clause_for_the_code() -> None:
    assert RULES["asce7-ch17"].checked.startswith("NOT VERIFIED")
    assert all("not with the text" in r.checked or "VERIFIED" in r.checked or r.span is None
               for r in RULES.values())  # fmt: skip


def test_filters() -> None:
    known = Recording("a 1999", "b", None, 6.7, 12e3, 300.0, 4.0, pulse=True)
    motion = GroundMotion(np.ones(101), 0.1, recording=known)
    kept = {
        "magnitude=6.5..6.7": True,
        "magnitude=6.8..": False,
        "distance=10 km..20 km": True,
        "distance=..11 km": False,
        "vs30=180..360": True,
        "usable_period=4..": True,
        "pulse=yes": True,
        "pulse=no": False,
        # A flat motion of 10 s: 70 % and 90 % of it.
        "d5_75=6.9..7.1": True,
        "d5_95=..8.9": False,
    }
    assert {text: parse_filter(text).keeps(motion) for text in kept} == kept
    unknown = GroundMotion(np.ones(3), 0.1)
    assert parse_filter("magnitude=6..7").keeps(unknown) is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("magnitud=6..7", "did you mean magnitude"),
        ("magnitude=6", "write magnitude=LOW..HIGH"),
        ("magnitude=a..7", "must be a number"),
        ("distance=3 kg..", "an end of the range"),
        ("vs30=500..200", "must not fall"),
        ("pulse=maybe", "pulse=yes or pulse=no"),
    ],
)
def test_filters_that_are_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_filter(text)
