"""The sampling interval behind a column of printed times."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from rpscli.records.quantities import last_digit

_SUMMED = (1e-6, 1e-3)
"""Shares of a step by which times may be off besides their rounding, from summing steps in double
and in single precision."""

_COARSEST = 0.25
"""Share of a step beyond which rounding can no longer tell uniform times from others."""


def printed_resolution(
    printed: NDArray[np.float64], numerals: Iterable[str]
) -> NDArray[np.float64]:
    """The unit of the last digit of each time of a column, dropped zeros included.

    Writers keep either a number of decimals or a number of significant digits: a unit holds for
    a whole decade of times, and from one decade to the next grows by no more than ten.

    Parameters
    ----------
    printed : array, shape (n,) [s]
        The times.
    numerals : iterable of str
        As they are printed.

    Returns
    -------
    array, shape (n,) [s]

    Examples
    --------
    >>> printed_resolution(np.array([0.0, 0.5, 1.0, 1.5]), ["0", "0.5", "1", "1.5"]).tolist()
    [0.1, 0.1, 0.1, 0.1]
    """
    times = np.abs(printed)
    units = np.fromiter(map(last_digit, numerals), dtype=np.float64, count=times.size)
    decades = np.floor(np.log10(np.maximum(times, 1e-12)))
    result = np.empty_like(units)
    finest = math.inf
    for decade in np.unique(decades[times > 0.0]):
        inside = decades == decade
        finest = min(10.0 * finest, float(units[inside].min()))
        result[inside] = finest
    result[times == 0.0] = result[times > 0.0].min(initial=1.0)
    return result


def uniform_step(times: NDArray[np.float64], resolution: NDArray[np.float64] | float) -> float:
    """The step of uniform times, the shortest decimal number that fits all of them.

    Parameters
    ----------
    times : array, shape (n,) [s]
        At least two.
    resolution : array, shape (n,), or float [s]
        Unit of the last digit of the times.

    Raises
    ------
    ValueError
        If no step fits all times, and the first, within half a unit of their last digits (at most
        a quarter of the step) and a thousandth of the step; the first sample off is named.

    Examples
    --------
    >>> uniform_step(np.array([0.0, 0.0039, 0.0078, 0.0117, 0.0156]), 1e-4)
    0.0039
    """
    steps = np.diff(times)
    if not steps.min() > 0.0:
        raise ValueError(f"the times do not increase after sample {int(np.argmin(steps)) + 1}")
    typical = _median(steps)
    rounding = np.minimum(0.5 * np.asarray(resolution), _COARSEST * typical)
    for summed in _SUMMED:
        step = _shortest_step(times, rounding + summed * typical)
        if step is not None:
            return step
    off = np.abs(steps - typical)
    first = int(np.argmax(off > 0.5 * off.max()))
    raise ValueError(
        f"the step after sample {first + 1} is {steps[first]:.6g} s, most others {typical:.6g} s"
    )


def _median(values: NDArray[np.float64]) -> float:
    # What numpy's function gives, without the masked arrays that it imports.
    ordered = np.sort(values)
    return 0.5 * float(ordered[(values.size - 1) // 2] + ordered[values.size // 2])


def _shortest_step(times: NDArray[np.float64], allowance: NDArray[np.float64]) -> float | None:
    # Each time bounds the step from both sides; the bounds close in as the samples go on.
    allowance = np.broadcast_to(allowance, times.shape)
    count = np.arange(1, times.size)
    elapsed = times[1:] - times[0]
    either = allowance[1:] + (allowance[0] if times[0] else 0.0)  # a printed zero is exact
    lowest = float(np.max((elapsed - either) / count))
    highest = float(np.min((elapsed + either) / count))
    if not 0.0 < lowest <= highest:
        return None
    middle = 0.5 * (lowest + highest)
    candidates = (round(middle, decimals) for decimals in range(17))
    return next((step for step in candidates if lowest <= step <= highest), middle)
