"""What small functions of `rpscli.analyses` give, by example."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.fixed_base import largest_of_cubics
from rpscli.analyses.result_quantities import ResultQuantity


def test_fixed_base() -> None:
    t = np.arange(0.3, 4.0, 0.5)
    assert largest_of_cubics(np.sin(t), np.cos(t), 0.5) > 0.9998 > np.sin(t).max()


def test_result_quantities() -> None:
    assert ResultQuantity("duration", "s", "duration").axis_label == "duration [s]"
