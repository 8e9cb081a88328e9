"""Long histories are drawn with fewer samples, and no peak is lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from report.made_up_pairs import turned
from report.small_results import KINDS
from rpscli.analyses.results import TimeHistoryResult
from rpscli.report.bundles import timehistory_files
from rpscli.report.figures import history
from rpscli.report.files import Drawing


def test_extremes_of_every_stretch_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "MOST", 100)
    monkeypatch.setattr(history, "STRETCHES", 10)
    values = np.random.default_rng(1).normal(size=1003)
    kept = history.extremes(values)
    assert kept[0] == 0
    assert kept[-1] == 1002
    assert len(kept) <= 22
    for start in range(0, 1003, 101):
        stretch = values[start : start + 101]
        among = values[kept[(kept >= start) & (kept < start + 101)]]
        assert (among.min(), among.max()) == (stretch.min(), stretch.max())


def test_thinned_histories_keep_their_peaks(monkeypatch: pytest.MonkeyPatch) -> None:
    result = KINDS["rolls"]()
    assert history.thinned(result) is result
    monkeypatch.setattr(history, "MOST", 50)
    monkeypatch.setattr(history, "STRETCHES", 10)
    few = history.thinned(result)
    assert len(few.trace.time) < len(result.trace.time)
    for name in ("rotation", "ground_acceleration", "driving_moment", "time"):
        all_of_it, kept = getattr(result.trace, name), getattr(few.trace, name)
        assert (kept.min(), kept.max()) == (all_of_it.min(), all_of_it.max())
    assert replace(few, trace=result.trace).max_rotation == result.max_rotation


@pytest.mark.parametrize("make", [KINDS["rolls"], turned])
def test_every_figure_of_a_long_history_is_drawn(
    make: Callable[[], TimeHistoryResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(history, "MOST", 50)
    drawn = [each for _, each in timehistory_files(make(), "") if isinstance(each, Drawing)]
    assert len(drawn) >= 5
    assert all(each() for each in drawn), [each.fault for each in drawn]
