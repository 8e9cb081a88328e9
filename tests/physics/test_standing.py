"""The exact step of who stands: against the matrix exponential in fifty digits."""

import itertools
from decimal import Decimal, getcontext

import pytest

from rpscli.physics.standing import POINTS, WEIGHTS, responses

FREQUENCIES = (0.0, 1e-3, 1.0, 12.0, 180.0, 2.4e3)
RATIOS = (0.0, 0.05, 0.999999, 1.0, 1.000001, 3.0, 40.0)
STEPS = (0.0, 1e-7, 1e-4, 2e-3, 0.02)


def exact(omega2, c, h):
    """S, S', I and J by Taylor series over halved steps, doubled again: fifty digits."""
    getcontext().prec = 60
    w2, damping = Decimal(omega2), Decimal(c)
    halvings = 0
    part = Decimal(h)
    while part * (damping + w2.sqrt()) > Decimal("0.1"):
        part /= 2
        halvings += 1

    def rates(y):
        # y = q, q', its integral, that of it
        return [y[1], -w2 * y[0] - damping * y[1], y[0], y[2]]

    columns = []
    for k in range(4):
        term = [Decimal(int(i == k)) for i in range(4)]
        total = list(term)
        for n in range(1, 60):
            term = [part / n * each for each in rates(term)]
            total = [a + b for a, b in zip(total, term, strict=True)]
        columns.append(total)
    matrix = [[columns[j][i] for j in range(4)] for i in range(4)]
    for _ in range(halvings):
        matrix = [
            [
                sum((a * matrix[k][j] for k, a in enumerate(row)), Decimal(0))
                for j in range(4)
            ]
            for row in matrix
        ]
    return [matrix[0][1], matrix[1][1], matrix[2][1], matrix[3][1]]


@pytest.mark.parametrize("omega", FREQUENCIES)
def test_responses_of_an_oscillator(omega):
    """Relative errors: closed forms lose what differences cost, at most three digits."""
    for ratio, h in itertools.product(RATIOS, STEPS):
        c = 2.0 * ratio * omega
        found = responses(omega * omega, c, h)
        if h == 0.0:
            assert found == (0.0, 1.0, 0.0, 0.0)
            continue
        S, dS, I, J = exact(omega * omega, c, h)  # noqa: E741
        sizes = abs(S), max(abs(dS), Decimal(omega) * abs(S)), abs(I), abs(J)
        sizes = max(sizes[0], Decimal(1e-3 * h) * abs(dS)), *sizes[1:]
        for value, right, size in zip(found, (S, dS, I, J), sizes, strict=True):
            assert abs(Decimal(value) - right) <= Decimal("1e-13") * size, (
                omega,
                ratio,
                h,
            )


def test_the_rule_of_four_points_is_that_of_order_eight():
    for power in range(8):
        total = sum(w * x**power for w, x in zip(WEIGHTS, POINTS, strict=True))
        assert total == pytest.approx(1.0 / (power + 1), rel=1e-15)
