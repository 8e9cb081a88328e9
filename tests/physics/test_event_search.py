"""The search for the first passage through zero, against the roots of random quintics."""

from __future__ import annotations

from itertools import pairwise
from math import comb

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from paper_structures import COMPILED, Array

from rpscli.physics.quintic import (
    NO_PASSAGE,
    Quintic,
    first_descent,
)

pytestmark = pytest.mark.evidence("steps, events, energy", "exact")

RANDOM_CURVES = 1500 if COMPILED else 100


def to_powers(b: Quintic) -> Array:
    """Coefficients of t^5 ... 1 from those of Bernstein's basis."""
    rising = np.zeros(6)
    for i, coefficient in enumerate(b):
        for j in range(6 - i):
            rising[i + j] += coefficient * comb(5, i) * comb(5 - i, j) * (-1) ** j
    return rising[::-1].copy()


def to_bernstein(powers: Array) -> Quintic:
    rising = np.pad(powers[::-1], (0, 6 - len(powers)))
    b = [sum(comb(i, j) / comb(5, j) * rising[j] for j in range(i + 1)) for i in range(6)]
    return (b[0], b[1], b[2], b[3], b[4], b[5])


def descent(b: Quintic) -> float:
    return first_descent(b, np.empty(6))


def descent_by_roots(b: Quintic) -> float:
    """The start of the first interval between real roots on which the curve is negative."""
    powers = to_powers(b)
    roots = np.roots(powers)
    real = np.sort(roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)])
    knots = [0.0, *real, 1.0]
    for left, right in pairwise(knots):
        if right - left > 1e-9 and np.polyval(powers, 0.5 * (left + right)) < 0.0:
            return float(left)
    return NO_PASSAGE


def random_curve(rng: np.random.Generator, kind: int) -> Quintic:
    if kind == 0:  # anything
        b = rng.normal(size=6)
    elif kind == 1:  # starts above, mostly stays there
        b = np.concatenate((np.abs(rng.normal(size=1)), rng.normal(size=5) + 0.5))
    elif kind == 2:  # starts at exactly zero, up or down
        b = np.concatenate(([0.0], rng.normal(size=5)))
    elif kind == 3:  # five real roots
        roots = rng.uniform(-0.3, 1.3, 5)
        return to_bernstein(np.atleast_1d(np.poly(roots)) * rng.choice([-1.0, 1.0]))
    else:  # dips below zero and back within a small part of the step
        middle, half = rng.uniform(0.01, 0.99), 10.0 ** rng.uniform(-6, -1)
        pair = np.array([1.0, -2.0 * middle, middle**2 - half**2])
        rest = np.poly(rng.uniform(1.2, 3.0, 3))
        powers = np.polymul(pair, rest)
        return to_bernstein(powers * np.sign(rest[-1]))
    return (b[0], b[1], b[2], b[3], b[4], b[5])


@pytest.mark.parametrize("kind", range(5))
def test_the_first_descent_is_found(kind: int) -> None:
    rng = np.random.default_rng(kind)
    for _ in range(RANDOM_CURVES):
        b = random_curve(rng, kind)
        # numpy's roots of a close pair are good to sqrt(eps) only
        assert descent(b) == pytest.approx(descent_by_roots(b), abs=1e-7), b


@pytest.mark.parametrize(
    ("b", "expected"),
    [
        ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0), NO_PASSAGE),  # resting on zero
        ((0.0, 0.0, 0.0, 0.0, 0.0, 1.0), NO_PASSAGE),  # leaving upwards with t^5
        ((0.0, 0.0, 0.0, 0.0, 0.0, -1.0), 0.0),  # leaving downwards with t^5
        ((0.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
        ((0.0, -1.0, 1.0, 1.0, 1.0, 1.0), 0.0),
        ((-0.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
        ((-1.0, 1.0, 1.0, 1.0, 1.0, 1.0), 0.0),  # begins below
        ((1.0, 1.0, 1.0, 1.0, 1.0, 0.0), NO_PASSAGE),  # ends on zero: the next step's affair
        ((1.0, 1.0, 1.0, 1.0, 1.0, 1.0), NO_PASSAGE),
    ],
)
def test_starts_and_ends_on_zero(b: Quintic, expected: float) -> None:
    assert descent(b) == expected


def test_two_crossings_right_after_a_start_on_zero() -> None:
    # t (t - a)(t - 2 a) (4 - t)^2 leaves upwards, dips below between a and 2 a
    for a in (0.3, 1e-2, 1e-4, 1e-7):
        powers = np.polymul(np.poly([0.0, a, 2.0 * a]), [1.0, -8.0, 16.0])
        b = to_bernstein(powers)
        # the conversion leaves the start on zero; coefficients round at 1e-16, slope there is a^2
        assert b[0] == 0.0
        assert descent(b) == pytest.approx(a, rel=1e-14 / a**2 + 1e-12)


@given(st.floats(0.1, 0.9), st.floats(1e-12, 1e-3))
def test_a_curve_that_stays_above_by_any_margin_is_left_alone(touch: float, above: float) -> None:
    powers = np.convolve([1.0, -2.0 * touch, touch**2], [1.0, 0.0, 0.0, 1.0])
    powers[-1] += above
    b = to_bernstein(powers)
    assume(above > 1e-15)
    assert descent(b) == NO_PASSAGE
