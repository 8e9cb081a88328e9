"""Classical damping of the building on its fixed base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RayleighDamping:
    """C = a0 M + a1 K with one damping ratio in two modes.

    Parameters
    ----------
    ratio
        Critical damping ratio in both modes.
    modes
        The two modes, counted from 1. A building of one storey, or a mode named twice, takes
        stiffness-proportional damping (a0 = 0): one mode cannot fix two coefficients.

    Examples
    --------
    >>> a0, a1 = RayleighDamping(0.05, (1, 2)).coefficients(np.array([10.0, 30.0]))
    >>> float(round(a0, 6)), float(round(a1, 6))
    (0.75, 0.0025)
    """

    ratio: float
    modes: tuple[int, int] = (1, 2)

    def coefficients(self, frequencies: Array) -> tuple[float, float]:
        """a0 [1/s] and a1 [s], from circular frequencies (n,) [rad/s]."""
        first, second = (float(frequencies[min(i, len(frequencies)) - 1]) for i in self.modes)
        if first == second:
            return 0.0, 2.0 * self.ratio / first
        a1 = 2.0 * self.ratio / (first + second)
        return a1 * first * second, a1

    def ratios(self, frequencies: Array) -> Array:
        """Damping ratio of every mode, (n,): a0/(2 w) + a1 w/2."""
        a0, a1 = self.coefficients(frequencies)
        return 0.5 * (a0 / frequencies + a1 * frequencies)

    def matrix(self, M: Array, K: Array, w: Array, Phi: Array) -> Array:
        """C = a0 M + a1 K.

        Parameters
        ----------
        M, K
            Mass [kg] and stiffness [N/m], (n, n).
        w
            Fixed-base circular frequencies, (n,), ascending [rad/s].
        Phi
            Mass-normalised mode shapes, (n, n), one a column [kg^-1/2].

        Returns
        -------
        (n, n) [N s/m].
        """
        del Phi
        a0, a1 = self.coefficients(w)
        return a0 * M + a1 * K


@dataclass(frozen=True)
class ModalDamping:
    """The same damping ratio in every fixed-base mode."""

    ratio: float

    def ratios(self, frequencies: Array) -> Array:
        """Damping ratio of every mode, (n,)."""
        return np.full_like(frequencies, self.ratio)

    def matrix(self, M: Array, K: Array, w: Array, Phi: Array) -> Array:
        """C = M Phi diag(2 xi w) Phi^T M.

        Parameters
        ----------
        M, K, w, Phi
            As those of `RayleighDamping.matrix`.
        """
        del K
        weighted = M.diagonal()[:, None] * Phi
        return np.asarray((weighted * (2.0 * self.ratio * w)) @ weighted.T)
