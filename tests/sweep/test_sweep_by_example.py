"""What small functions of `rpscli.sweep` give, by example."""

from __future__ import annotations

import numpy as np

from rpscli.sweep.evaluation import quantity, split
from rpscli.sweep.points import yaml_scalar
from rpscli.sweep.statistics.fractiles import clustered, fractiles, share, shown_by
from rpscli.sweep.statistics.grouping import statistic_words
from rpscli.sweep.statistics.observations import agreement, maxima
from rpscli.sweep.table import _cell, array, unit_of


def test_evaluation_results() -> None:
    known = quantity("modal", "rolling.frequency_ratio.0")
    assert known is not None
    assert known.unit == "-"
    assert quantity("modal", "rolling.period") is None
    assert (split("rolling.frequency_ratio.0"), split("max_rotation")) == (
        ("rolling.frequency_ratio", (0,)),
        ("max_rotation", ()),
    )


def test_intensities() -> None:
    assert (unit_of("PGA(RotD50)"), unit_of("superstructure.period"), unit_of("scale")) == (
        "m/s2",
        "s",
        "-",
    )


def test_points_layout() -> None:
    assert (yaml_scalar(0.1), yaml_scalar("critical"), yaml_scalar("0.1"), yaml_scalar([1, 2])) == (
        "0.1",
        "critical",
        '"0.1"',
        "[1, 2]",
    )


def test_points_csv() -> None:
    assert (_cell(0.1, "-"), _cell("critical", "-"), _cell([1, 2], "-"), _cell("500 mm", "m")) == (
        "0.1",
        "critical",
        "[1, 2]",
        "0.5",
    )


def test_statistics_fractiles() -> None:
    assert (
        share(0, 22).interval,
        share(3, 22).interval,
        share(5, 5).interval,
        share(0, 0).interval,
    ) == ("below 0.13", "0.029 to 0.35", "above 0.55", "-")
    assert (str(share(0, 22)), str(clustered(np.zeros(48, dtype=bool), np.arange(48) // 12))) == (
        "0 of 22 (95 %: below 0.13)",
        "0 of 48 from 4 recordings (95 %: below 0.53)",
    )


def test_statistics_grouping() -> None:
    assert (statistic_words("mean"), statistic_words(0.84)) == (
        "mean of survivors",
        "84 % fractile",
    )


def test_statistics_observations() -> None:
    assert agreement(np.array([True, True, False]), np.array([True, False, False]), np.arange(3))[
        :4
    ] == (1, 1, 0, 1)
    found = maxima(np.array([2.0, 8.0, np.inf]), np.array([1.0, 1.0, 1.0]))
    assert (found.counted, found.overturned, round(found.median, 6), found.distance) == (
        2,
        1,
        2.0,
        1.0,
    )


def test_points_csv_columns() -> None:
    np.testing.assert_equal(array([1, None, "inf"]), [1.0, np.nan, np.inf])
    assert array([0.5, "critical"]).tolist() == [0.5, "critical"]


def test_statistics_fractiles_of_demands() -> None:
    wanted = [0.5, 0.75, 0.76]
    assert fractiles(np.array([3.0, np.inf, 1.0, 2.0]), wanted).tolist() == [2.0, 3.0, np.inf]
    assert [shown_by(share(number, 31), 0.05) for number in (0, 1)] == [59, 110]
    assert shown_by(share(0, 5), 0.1) == 29
