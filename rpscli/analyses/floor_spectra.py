"""Response spectra of the floors: what impacts and uplift do to equipment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.results import TimeHistoryResult
from rpscli.frozen import frozen
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.spectrum import response_spectrum
from rpscli.shown import Shown

Array = NDArray[np.float64]

PERIODS = frozen(np.geomspace(0.05, 4.0, 50))
"""Periods of equipment [s]."""

DAMPING = 0.05


@dataclass(frozen=True, eq=False, repr=False)
class FloorSpectra(Shown):
    """Spectra of light equipment on each floor, which does not act back.

    Attributes
    ----------
    periods : array, shape (p,) [s]
        Natural periods.
    damping : float
        Share of critical damping.
    pseudo_acceleration : array, shape (n, p) [m/s2]
        By floors from the bottom.
    displacement : array, shape (n, p) [m]
        Relative to the floor.
    """

    periods: Array
    damping: float
    pseudo_acceleration: Array
    displacement: Array


def isolated_floor_spectra(
    result: TimeHistoryResult, periods: Array = PERIODS, damping: float = DAMPING
) -> FloorSpectra:
    """Spectra of the floors of the building on its bearings.

    Parameters
    ----------
    result : TimeHistoryResult
        With a superstructure.
    periods : array, shape (p,) [s]
        Natural periods.
    damping : float
        Share of critical damping.

    Notes
    -----
    From the absolute floor accelerations at the samples, linear between them. Impacts make
    them jump, which smooths short periods: under a record of 0.01 s the spectra of a six-storey
    building were up to 3 % low at 0.1 s and 8 % at 0.03 s against those from samples five times as
    dense, on a fixed base less than 1 %.
    """
    return floor_spectra(result.trace.floor_accelerations, result.record.dt, periods, damping)


def fixed_base_floor_spectra(
    result: TimeHistoryResult, periods: Array = PERIODS, damping: float = DAMPING
) -> FloorSpectra | None:
    """Spectra of the same floors on a fixed base; None where that was not computed.

    Parameters
    ----------
    result
        With a superstructure.
    periods
        (p,) natural periods [s].
    damping
        Share of critical damping.
    """
    fixed = result.fixed_base
    if fixed is None:
        return None
    return floor_spectra(fixed.acceleration_histories, result.record.dt, periods, damping)


def floor_spectra(accelerations: Array, dt: float, periods: Array, damping: float) -> FloorSpectra:
    """Spectra of histories side by side."""
    spectra = [
        response_spectrum(GroundMotion(floor, dt, "floor", "floor", "response"), periods, damping)
        for floor in accelerations.T
    ]
    return FloorSpectra(
        np.array(periods, dtype=float),
        damping,
        np.array([spectrum.pseudo_acceleration for spectrum in spectra]),
        np.array([spectrum.displacement for spectrum in spectra]),
    )
