"""Kernels are compiled before the hunt: that takes longer than any trial may."""

from __future__ import annotations

import numpy as np
import pytest
from paper_structures import ground, podium

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.records.ground_motion import MotionComponents


@pytest.fixture(scope="session", autouse=True)
def _compiled() -> None:
    record, settings = ground(np.zeros(2), 0.01), TimeHistorySettings(0.0)
    for storeys in (1, 40):
        for worth_lanes in (1, 2):
            demands(
                [Request(podium(storeys), MotionComponents(record), settings)],
                worth_lanes=worth_lanes,
            )
