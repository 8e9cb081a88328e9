"""What small functions of `rpscli.sweep` give, by example."""

from __future__ import annotations

import numpy as np
import pytest

from rpscli.sweep.evaluation import quantity, split
from rpscli.sweep.points import yaml_scalar
from rpscli.sweep.statistics.fractiles import fractiles, share, shown_by
from rpscli.sweep.statistics.grouping import statistic_words
from rpscli.sweep.statistics.observations import agreement, maxima
from rpscli.sweep.table import _cell, array, unit_of


@pytest.mark.parametrize(
    ("found", "wanted"),
    [
        (split("rolling.frequency_ratio.0"), ("rolling.frequency_ratio", (0,))),
        (split("max_rotation"), ("max_rotation", ())),
        (quantity("modal", "rolling.period"), None),
        ([unit_of(name) for name in ("PGA(RotD50)", "superstructure.period")], ["m/s2", "s"]),
        (unit_of("scale"), "-"),
        ([yaml_scalar(value) for value in (0.1, "critical", "0.1")], ["0.1", "critical", '"0.1"']),
        ([_cell(0.1, "-"), _cell([1, 2], "-"), _cell("500 mm", "m")], ["0.1", "[1, 2]", "0.5"]),
        (array([0.5, "critical"]).tolist(), [0.5, "critical"]),
        (statistic_words("mean"), "mean of survivors"),
        (statistic_words(0.84), "84 % fractile"),
        ([shown_by(share(number, 31), 0.05) for number in (0, 1)], [59, 110]),
    ],
)
def test_examples(found: object, wanted: object) -> None:
    assert found == wanted


def test_numbers_that_are_missing_or_infinite() -> None:
    np.testing.assert_equal(array([1, None, "inf"]), [1.0, np.nan, np.inf])
    demands = np.array([3.0, np.inf, 1.0, 2.0])
    assert fractiles(demands, [0.5, 0.75, 0.76]).tolist() == [2.0, 3.0, np.inf]


def test_computed_beside_observed() -> None:
    computed, observed = np.array([True, True, False]), np.array([True, False, False])
    assert agreement(computed, observed, np.arange(3))[:4] == (1, 1, 0, 1)
    found = maxima(np.array([2.0, 8.0, np.inf]), np.array([1.0, 1.0, 1.0]))
    assert (found.counted, found.overturned, found.distance) == (2, 1, 1.0)
    assert found.median == pytest.approx(2.0)
