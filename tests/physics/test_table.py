"""Podiums as rows of numbers."""

from __future__ import annotations

import numpy as np
from paper_structures import podium

from rpscli.analyses.kernel_input import podium_parameters
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.physics.parameters import podium_numbers
from rpscli.physics.table import podium_of


def test_a_podium_is_read_back_field_by_field() -> None:
    """All numbers differ, so none can stand in another's place."""
    podiums = [podium_parameters(podium(n, 0.15, 0.5), TimeHistorySettings()) for n in (0, 2)]
    rows = np.arange(2.0 * len(podium_numbers(podiums[0]))).reshape(2, -1)
    for s in range(2):
        assert podium_numbers(podium_of(rows, s)) == rows[s].tolist()
    table = np.array([podium_numbers(p) for p in podiums])
    assert [podium_of(table, s) for s in range(2)] == podiums
