"""Samples of uncertain parameters: points of the unit cube, seen through their distributions."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.case.study.schema import RangeSection, SampleSection

Array = NDArray[np.float64]


def sample(section: SampleSection) -> Array:
    """The sample, (size, keys), in the order of the section's keys.

    Notes
    -----
    A scrambled Sobol sequence, or a Latin hypercube; the seed fixes both. Each column goes through
    the inverse of its distribution function.
    """
    unit = unit_cube(section, len(section.ranges))
    columns = [_values(unit[:, i], given) for i, given in enumerate(section.ranges.values())]
    return np.column_stack(columns)


def unit_cube(section: SampleSection, dimensions: int) -> Array:
    """(size, dimensions) of the section's sequence, in the unit cube."""
    from scipy.stats import qmc

    engine = {"sobol": qmc.Sobol, "latin_hypercube": qmc.LatinHypercube}[section.method]
    sequence: Any = engine(dimensions, seed=np.random.default_rng(section.seed))
    with warnings.catch_warnings():
        # Sobol sequences are balanced at powers of two; `balance_note` tells the user.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(sequence.random(section.size), dtype=np.float64)


def balance_note(section: SampleSection) -> str | None:
    """What the user should know about the size of a Sobol sample."""
    size = section.size
    if section.method != "sobol" or size & (size - 1) == 0:
        return None
    better = 1 << (size.bit_length() - 1)
    return f"sample.size = {size} is no power of 2, where Sobol samples are even: {better} is"


def _values(unit: Array, given: RangeSection) -> Array:
    """One parameter from its place in the unit interval."""
    if given.low is not None and given.high is not None:
        return given.low + (given.high - given.low) * unit
    assert given.mean is not None, "the study's rules make sure that the moments are given"
    assert given.cov is not None, "the study's rules make sure that the moments are given"
    deviation = given.cov * abs(given.mean)
    if given.distribution == "uniform":
        return given.mean + math.sqrt(3.0) * deviation * (2.0 * unit - 1.0)
    normal = _normal_quantile(unit)
    if given.distribution == "normal":
        return given.mean + deviation * normal
    spread = math.sqrt(math.log1p(given.cov**2))
    median = given.mean / math.sqrt(1.0 + given.cov**2)
    return np.asarray(median * np.exp(spread * normal))


def _normal_quantile(unit: Array) -> Array:
    from scipy.special import ndtri

    # A scrambled sequence may hit zero, whose quantile is minus infinity.
    return np.asarray(ndtri(np.maximum(unit, 1e-16)))
