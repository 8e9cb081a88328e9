"""The building above the cap beam, one horizontal freedom a floor,
and its classical damping.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rpscli.constants import MOST_STOREYS
from rpscli.errors import is_size, require_fields
from rpscli.shown import Shown, frozen

Array = NDArray[np.float64]

VERTICAL_DAMPING = 0.05
"""Of each vertical mode of the building, over critical, where nothing else is known."""


@dataclass(frozen=True)
class RayleighDamping:
    """C = a0 M + a1 K with one damping ratio in two modes.

    Parameters
    ----------
    ratio
        Critical damping ratio in both modes.
    modes
        The two modes, counted from 1. A building of one storey, or a mode
        named twice, takes stiffness-proportional damping (a0 = 0): one mode
        cannot fix two coefficients.

    Examples
    --------
    >>> a0, a1 = RayleighDamping(0.05, (1, 2)).coefficients(np.array([10.0, 30.0]))
    >>> float(round(a0, 6)), float(round(a1, 6))
    (0.75, 0.0025)
    """

    ratio: float
    modes: tuple[int, int] = (1, 2)

    def __post_init__(self) -> None:
        """Refuse what damps no mode."""
        _require_ratio(self)
        if any(mode < 1 or mode % 1 for mode in self.modes):
            raise ValueError(f"modes = {self.modes} must be two whole numbers from 1 on")

    def coefficients(self, frequencies: Array) -> tuple[float, float]:
        """a0 [1/s] and a1 [s], from circular frequencies (n,) [rad/s]."""
        first, second = (
            float(frequencies[min(i, len(frequencies)) - 1]) for i in self.modes
        )
        if first == second:
            return 0.0, 2.0 * self.ratio / first
        a1 = 2.0 * self.ratio / (first + second)
        return a1 * first * second, a1

    def ratios(self, frequencies: Array) -> Array:
        """Damping ratio of every mode, (n,): a0/(2 w) + a1 w/2."""
        a0, a1 = self.coefficients(frequencies)
        return 0.5 * (a0 / frequencies + a1 * frequencies)


@dataclass(frozen=True)
class ModalDamping:
    """One damping ratio in every fixed-base mode.

    >>> ModalDamping(0.05).ratios(np.array([20.0, 60.0])).tolist()
    [0.05, 0.05]
    """

    ratio: float

    def __post_init__(self) -> None:
        """Refuse what is no ratio."""
        _require_ratio(self)

    def ratios(self, frequencies: Array) -> Array:
        """Damping ratio of every mode, (n,)."""
        return np.full_like(frequencies, self.ratio)


def _require_ratio(damping: RayleighDamping | ModalDamping) -> None:
    require_fields(damping)
    if damping.ratio < 0.0:
        raise ValueError(f"ratio = {damping.ratio:g} must be >= 0")


Profile = Literal["sine", "uniform", "linear", "flexural"]


def profile_stiffnesses(
    masses: ArrayLike, period: float, profile: Profile = "sine"
) -> Array:
    """Storey stiffnesses that give a fixed-base first period and mode.

    Parameters
    ----------
    masses
        (n,) floor masses from the bottom [kg].
    period
        T_1 of the building on a fixed base [s].
    profile
        First mode ``sine``, sin(pi i/2n), ``linear``, ``flexural``; stiffness ``uniform``.

    Returns
    -------
    (n,) stiffnesses from the bottom [N/m].

    Notes
    -----
    k_i (Phi_i - Phi_{i-1}) = w1^2 sum_{j>=i} m_j Phi_j: the storey shear of free
    vibration in the mode Phi (Theory (7.1)).

    Examples
    --------
    One storey: k = m (2 pi/T)^2.

    >>> float(profile_stiffnesses([1000.0], 2.0 * math.pi).round(6)[0])
    1000.0
    """
    m = np.asarray(masses, dtype=float)
    if not (np.isfinite(m) & (m > 0.0)).all() or not 0.0 < period < math.inf:
        raise ValueError(f"masses {m} and period {period} must be finite and > 0")
    w1 = 2.0 * math.pi / period
    if profile == "uniform":
        first = shear_modes(m, np.ones_like(m))[0][0]
        return np.full_like(m, (w1 / first) ** 2)
    height = np.arange(1, len(m) + 1) / len(m)
    shape = {
        "sine": np.sin(0.5 * math.pi * height),
        "linear": height,
        "flexural": 1.0 - np.cos(0.5 * math.pi * height),
    }[profile]
    shear = w1**2 * np.cumsum((m * shape)[::-1])[::-1]
    return np.asarray(shear / np.diff(shape, prepend=0.0))


def first_mode_strengths(masses: Array, stiffnesses: Array, first: float) -> Array:
    """Storey strengths (n,) [N] in the proportions of the shears of the first mode."""
    shears = np.cumsum((masses * shear_modes(masses, stiffnesses)[1][:, 0])[::-1])[::-1]
    return np.asarray(first * shears / shears[0])


def stiffness_matrix(stiffnesses: Array) -> Array:
    """K of a shear building, (n, n), from storey stiffnesses (n,) [N/m]."""
    k = stiffnesses
    above = np.append(k[1:], 0.0)
    return np.asarray(np.diag(k + above) - np.diag(k[1:], 1) - np.diag(k[1:], -1))


def shear_modes(masses: Array, stiffnesses: Array) -> tuple[Array, Array]:
    """Frequencies (n,) [rad/s], ascending, and mass-normalised
    shapes (n, n), one a column.

    The sign of a shape is fixed by a positive roof.
    """
    root = 1.0 / np.sqrt(masses)
    squares, vectors = np.linalg.eigh(
        root[:, None] * stiffness_matrix(stiffnesses) * root
    )
    shapes = root[:, None] * vectors
    return np.sqrt(squares), shapes * np.where(shapes[-1] < 0.0, -1.0, 1.0)


@dataclass(frozen=True, eq=False, repr=False)
class Superstructure(Shown):
    """A shear building of n floors.

    Parameters
    ----------
    masses
        (n,) floor masses from the bottom [kg].
    stiffnesses
        (n,) storey stiffnesses from the bottom [N/m].
    damping
        Rayleigh or modal damping of the building on a fixed base.
    storey_heights
        (n,) [m]; only for drift ratios, pictures and the overturning moment.
    vertical_period
        First period of the vertical vibration on the cap beam [s], in which floors stand
        on springs and columns; None for floors that ride rigidly on the beam.
    vertical_damping
        Critical damping ratio of each vertical mode.
    strengths
        (n,) shears at which storeys yield, from the bottom [N];
        None of an elastic building.
    hardening
        Stiffness of a storey that yields over its elastic one, kinematic, 0 <= h < 1.

    Raises
    ------
    ValueError
        If lengths differ, or a value is not positive or no hardening.

    Examples
    --------
    >>> stiffnesses = profile_stiffnesses([2e5] * 3, 0.3)
    >>> Superstructure([2e5] * 3, stiffnesses, ModalDamping(0.05)).periods.round(3)
    array([0.3  , 0.099, 0.068])
    """

    masses: Array
    stiffnesses: Array
    damping: RayleighDamping | ModalDamping
    storey_heights: Array | None = None
    vertical_period: float | None = None
    vertical_damping: float = VERTICAL_DAMPING
    strengths: Array | None = None
    hardening: float = 0.0

    def __post_init__(self) -> None:
        """Take any sequence; refuse what is not a building."""
        require_fields(self)
        lengths = set()
        needed = "masses", "stiffnesses"
        for name in (*needed, "storey_heights", "strengths"):
            if (value := getattr(self, name)) is not None or name in needed:
                array: Array = np.zeros((0, 0))  # of what is no list
                with suppress(TypeError, ValueError, OverflowError):
                    array = np.array(value, dtype=float)
                if array.ndim != 1 or not all(map(is_size, array.tolist())):
                    raise ValueError(
                        f"{name} must be a list of finite sizes > 0, from the bottom"
                    )
                object.__setattr__(self, name, frozen(array))
                lengths.add(len(array))
        if lengths != {self.storeys} or not self.storeys:
            raise ValueError(
                "masses, stiffnesses, heights and strengths must have one length:"
                f" {lengths}"
            )
        if not 0.0 <= self.hardening < 1.0:
            raise ValueError(f"hardening = {self.hardening:g} must be >= 0 and < 1")
        if self.vertical_period is not None and not self.vertical_period > 0.0:
            raise ValueError("vertical_period must be > 0")
        if not 0.0 <= self.vertical_damping < 1.0:
            raise ValueError("vertical_damping must be >= 0 and < 1")
        if self.storeys > MOST_STOREYS:
            raise ValueError(
                f"{self.storeys} storeys: there is room for {MOST_STOREYS} at most"
            )

    @property
    def storeys(self) -> int:
        """n."""
        return len(self.masses)

    @property
    def mass(self) -> float:
        """M_tot [kg]."""
        return float(self.masses.sum())

    def drift_ratios(self, drifts: Array) -> Array | None:
        """Storey drifts (n,) [m] over the storey heights; None
        where no heights are given.
        """
        return None if self.storey_heights is None else drifts / self.storey_heights

    @cached_property
    def mass_matrix(self) -> Array:
        """M, (n, n) [kg]."""
        return frozen(np.diag(self.masses))

    @cached_property
    def stiffness_matrix(self) -> Array:
        """K, (n, n) [N/m]."""
        return frozen(stiffness_matrix(self.stiffnesses))

    @cached_property
    def damping_matrix(self) -> Array:
        """C, (n, n) [N s/m]: a0 M + a1 K, or M Phi diag(2 xi w) Phi^T M."""
        if isinstance(self.damping, RayleighDamping):
            a0, a1 = self.damping.coefficients(self.frequencies)
            return frozen(a0 * self.mass_matrix + a1 * self.stiffness_matrix)
        weighted = self.masses[:, None] * self.shapes
        ratios = 2.0 * self.damping_ratios * self.frequencies
        return frozen(np.asarray((weighted * ratios) @ weighted.T))

    @cached_property
    def _modes(self) -> tuple[Array, Array]:
        return frozen(shear_modes(self.masses, self.stiffnesses))

    @property
    def frequencies(self) -> Array:
        """Fixed-base circular frequencies, (n,), ascending [rad/s]."""
        return self._modes[0]

    @property
    def shapes(self) -> Array:
        """Fixed-base mass-normalised mode shapes, (n, n), one a column [kg^-1/2]."""
        return self._modes[1]

    @cached_property
    def damping_ratios(self) -> Array:
        """Critical damping ratio of each fixed-base mode, (n,)."""
        return frozen(self.damping.ratios(self.frequencies))

    @property
    def periods(self) -> Array:
        """Fixed-base periods, (n,), descending [s]."""
        return frozen(2.0 * math.pi / self.frequencies)

    @cached_property
    def upwards(self) -> Superstructure | None:
        """The building that vibrates upwards: the floors on equal springs; None where
        they ride on the beam.
        """
        if self.vertical_period is None:
            return None
        stiffnesses = profile_stiffnesses(self.masses, self.vertical_period, "uniform")
        return replace(
            self,
            stiffnesses=stiffnesses,
            damping=ModalDamping(self.vertical_damping),
            strengths=None,
        )

    @property
    def carried(self) -> Array:
        """Mass above each storey, (n,) from the bottom [kg]."""
        return frozen(self.masses[::-1].cumsum()[::-1])

    @property
    def yields(self) -> bool:
        """True if its storeys have strengths."""
        return self.strengths is not None

    @property
    def back_stiffness(self) -> Array:
        """X_i/delta_i, back force of hardening over plastic drift, (n,) [N/m]."""
        return frozen(self.stiffnesses * self.hardening / (1.0 - self.hardening))

    @property
    def yields_by_first_mode(self) -> bool:
        """True if strengths are in the proportions of the shears of the first mode."""
        if self.strengths is None or self.storeys == 1:
            return False
        shears = first_mode_strengths(self.masses, self.stiffnesses, self.strengths[0])
        return bool(np.allclose(self.strengths, shears, rtol=1e-3))

    @property
    def participation(self) -> Array:
        """Gamma_r = phi_r^T M 1 of the mass-normalised modes, (n,) [kg^1/2]."""
        return frozen(self.shapes.T @ self.masses)
