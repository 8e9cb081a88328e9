"""Velocity and displacement of the ground, exact for acceleration linear between samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def velocity(acceleration: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Ground velocity at the samples, zero at the first one.

    Parameters
    ----------
    acceleration : array, shape (n,) [m/s2]
    dt : float [s]

    Returns
    -------
    array, shape (n,) [m/s]

    Examples
    --------
    >>> velocity(np.array([0.0, 2.0, 2.0]), 0.5).tolist()
    [0.0, 0.5, 1.5]
    """
    result = np.zeros_like(acceleration)
    np.cumsum(0.5 * dt * (acceleration[:-1] + acceleration[1:]), out=result[1:])
    return result


def displacement(acceleration: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Ground displacement at the samples, zero at the first one.

    Parameters
    ----------
    acceleration : array, shape (n,) [m/s2]
    dt : float [s]

    Returns
    -------
    array, shape (n,) [m]

    Notes
    -----
    Each step adds v dt + (2 a_0 + a_1) dt^2/6, the double integral of a linear acceleration.

    Examples
    --------
    >>> displacement(np.array([3.0, 3.0, 3.0]), 1.0).tolist()
    [0.0, 1.5, 6.0]
    """
    start = velocity(acceleration, dt)[:-1]
    step = dt * start + dt**2 * (2.0 * acceleration[:-1] + acceleration[1:]) / 6.0
    result = np.zeros_like(acceleration)
    np.cumsum(step, out=result[1:])
    return result
