"""The exact step of the linear oscillator against the matrix exponential."""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from paper_structures import Array
from scipy.linalg import expm

from rpscli.physics.core.oscillator import decay, transition

pytestmark = pytest.mark.evidence("buildings on bearings under earthquakes", "exact")


def exact_decay(omega: float, xi: float, h: float) -> tuple[float, float]:
    """c(h) and s(h) with 60 digits: one power series for all dampings."""
    with localcontext() as context:
        context.prec = 60
        w, x, t = Decimal(omega), Decimal(xi), Decimal(h)
        square = ((x * w) ** 2 - w**2) * t**2
        cosine = sine = Decimal(0)
        term = Decimal(1)
        for k in range(60):
            cosine += term
            sine += term / (2 * k + 1)
            term *= square / ((2 * k + 1) * (2 * k + 2))
        envelope = (-x * w * t).exp()
        return float(envelope * cosine), float(envelope * sine * t)


def exponential(omega: float, xi: float, h: float) -> Array:
    """[q, q', p, p'] -> [q, q'] of q'' + 2 xi w q' + w^2 q = p, p' constant."""
    flow = np.zeros((4, 4))
    flow[0, 1] = flow[2, 3] = 1.0
    flow[1] = [-(omega**2), -2.0 * xi * omega, 1.0, 0.0]
    return np.asarray(expm(flow * h)[:2])


@given(st.floats(0.1, 50.0), st.floats(0.0, 3.0), st.floats(1e-4, 0.1))
@example(10.0, 1.0, 0.02)
@example(10.0, 1.0 + 1e-9, 0.02)
@example(10.0, 1.0 - 1e-9, 0.02)
@example(50.0, 3.0, 0.1)
def test_one_step_is_the_matrix_exponential(omega: float, xi: float, h: float) -> None:
    got = np.reshape(transition(omega, xi, h), (2, 4))
    # p/w^2 of a slow oscillator is large and cancels: eps/w^2, and eps (h + 2 xi/w)/w^2 for p'
    load = 1.0 / omega**2
    trend = load * (h + (1.0 + 2.0 * xi) / omega)
    size = np.array([[1.0, h, load, trend], [omega**2 * h, 1.0, h, load]])
    # scipy's own exponential of a matrix of norm w^2 h <= 250 squares that many times over
    assert np.all(np.abs(got - exponential(omega, xi, h)) <= 1e-13 * size)


@given(st.floats(0.1, 50.0), st.floats(0.0, 3.0), st.floats(1e-3, 1.0), st.floats(0.01, 0.99))
def test_two_steps_are_one(omega: float, xi: float, h: float, part: float) -> None:
    """The map over h under a linear load is that over a part and that over the rest."""

    def step(length: float) -> Array:
        """Of [q, q', p, p'], the load going on as it does."""
        load = [[0.0, 0.0, 1.0, length], [0.0, 0.0, 0.0, 1.0]]
        return np.vstack([np.reshape(transition(omega, xi, length), (2, 4)), load])

    whole, parts = step(h), step(h - part * h) @ step(part * h)
    size = np.outer([1.0, omega + 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0 + 1.0 / omega])
    assert np.all(np.abs(whole - parts) <= 1e-13 * size * (1.0 + (1.0 + xi) / omega**2))


@pytest.mark.parametrize(
    "xi",
    [0.0, 0.05, 0.99, 1.0 - 1e-9, 1.0, 1.0 + 1e-14, 1.0 + 1e-12, 1.0 + 1e-8, 1.0001, 1.5, 10.0],
)
def test_decaying_functions(xi: float) -> None:
    for h in (1e-3, 0.01, 0.02, 0.3):
        assert decay(10.0, xi, h) == pytest.approx(exact_decay(10.0, xi, h), rel=2e-14, abs=1e-15)
