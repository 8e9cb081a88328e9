"""The default step over an ensemble: impacts make single histories chaotic, so a share counts."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import Array, needs_compiled_kernels, podium

from rpscli.analyses.demand import demand
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.records.loading import load_record

pytestmark = [needs_compiled_kernels, pytest.mark.evidence("steps, events, energy", "exact")]

ACCURATE = 1e-4
"""Relative error of the largest rotation below which a history counts as accurate."""


def errors(seeds: range, seconds: int) -> Array:
    """Errors of the default step against one sixteenth of it; overturned histories left out."""
    found = []
    for seed in seeds:
        record = load_record(f"synthetic:?pga=0.4g&seed={seed}&duration={seconds}")
        for storeys in (3, 6, 9):
            for rho in (0.25, 0.5, 1.5):
                structure = podium(storeys, 0.15, rho)
                coarse, fine = (
                    demand(structure, record, TimeHistorySettings(accuracy=accuracy))
                    for accuracy in (1.0, 16.0)
                )
                if fine.outcome == "survived":
                    found.append(abs(coarse.max_rotation / fine.max_rotation - 1.0))
    return np.array(found)


def test_nine_of_ten_short_histories_are_accurate() -> None:
    share = errors(range(3), 10)
    assert len(share) > 20
    assert np.mean(share < ACCURATE) >= 0.9


@pytest.mark.long
def test_93_of_100_long_histories_are_accurate() -> None:
    share = errors(range(20), 30)
    assert len(share) > 100
    assert np.mean(share < ACCURATE) >= 0.93
