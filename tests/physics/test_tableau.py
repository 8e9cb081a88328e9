"""The rule of the step: its conditions of order, and what it does to a vibration."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from paper_structures import Array

from rpscli.analyses.kernels.systems import LOSS
from rpscli.physics.tableau import A2, END, ERROR, USED, A, C

SIXTH, FIFTH = A[END], A[END] - ERROR


def missed(b: Array) -> Iterator[float]:
    """What weights miss of the conditions of orders 1 to 5 (Butcher's trees)."""
    Ac, Ac2 = A @ C, A @ C**2
    yield float(b.sum() - 1.0)
    for k in range(1, 5):
        yield float(b @ C**k - 1.0 / (k + 1))
    for tree, value in (
        (Ac, 6), (C * Ac, 8), (Ac2, 12), (A @ Ac, 24), (C**2 * Ac, 10), (Ac**2, 20), (C * Ac2, 15),
        (A @ C**3, 20), (C * (A @ Ac), 30), (A @ (C * Ac), 40), (A @ Ac2, 60), (A @ (A @ Ac), 120),
    ):  # fmt: skip
        yield float(b @ tree - 1.0 / value)


@pytest.mark.parametrize("b", [SIXTH, FIFTH], ids=["6", "5"])
def test_conditions_up_to_order_five(b: Array) -> None:
    # weights of up to 176 multiply rounding
    assert max(map(abs, missed(b))) < 1e-10


def test_one_rule_is_of_order_six_and_the_other_is_not() -> None:
    assert pytest.approx(1.0 / 6.0, abs=1e-10) == SIXTH @ C**5
    assert abs(FIFTH @ C**5 - 1.0 / 6.0) > 1e-4


def test_positions_follow_by_the_squared_tableau() -> None:
    assert np.array_equal(A2, A @ A)
    assert pytest.approx(0.5, abs=1e-10) == SIXTH @ C
    assert not np.any(np.where(USED, 0.0, A))


@pytest.mark.parametrize("z", [0.5, 0.7, 0.9])
def test_what_a_step_takes_from_a_vibration(z: float) -> None:
    """Of its energy LOSS z^8: what the lengths of steps are bounded by."""
    stages = np.linalg.solve(np.eye(END + 1) - 1j * z * A, np.ones(END + 1))
    grown = abs(1.0 + 1j * z * (SIXTH @ stages))
    assert 1.0 - grown**2 == pytest.approx(LOSS * z**8, rel=0.06)
