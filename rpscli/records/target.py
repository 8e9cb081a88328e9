"""A target spectrum: pseudo-acceleration over the period with its peaks, or a CSV file."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records.quantities import KNOWN_UNITS, canonical_unit, parse_query, unit_factor

Array = NDArray[np.float64]

AMPLIFICATION = 1.65
"""Pseudo-velocity over PGV: median of Newmark and Hall, 1982, at 5 % damping."""


@dataclass(frozen=True)
class TargetSpectrum:
    """What the response spectra of motions are compared with."""

    name: str
    """Short, for figures."""
    source: str
    """As the user wrote it."""
    shape: Callable[[Array], Array]
    """Periods (n,) [s] to pseudo-accelerations (n,) [m/s2]."""
    pgv: float | None
    """Peak ground velocity that goes with it; None if it cannot be told [m/s]."""
    pgd: float | None = None
    """Peak ground displacement; None if the code gives none [m]."""
    damping: float = 0.05
    """Share of critical damping."""
    span: tuple[float, float] = (0.0, math.inf)
    """Periods between which it is defined [s]."""

    def acceleration(self, periods: Array) -> Array:
        """Pseudo-acceleration at periods (n,) [s], (n,) [m/s2]."""
        low, high = self.span
        outside = (periods < low * (1.0 - 1e-9)) | (periods > high * (1.0 + 1e-9))
        if outside.any():
            raise RecordError(
                f"{self.source}: has no value at {periods[outside][0]:g} s; it is defined from"
                f" {low:g} to {high:g} s: choose --periods within"
            )
        return self.shape(np.clip(periods, low, high))


def velocity_of(shape: Callable[[Array], Array]) -> float:
    """PGV [m/s] that goes with a 5 % spectrum: its pseudo-velocity at 1 s over 1.65.

    FEMA, Hazus-MH 2.1, Earthquake Model Technical Manual, section 4.1.

    >>> round(velocity_of(lambda periods: 9.80665 * 0.6 / periods), 4)
    0.5676
    """
    return float(shape(np.ones(1))[0]) / (2.0 * math.pi) / AMPLIFICATION


_HEAD = re.compile(r"\s*(.*?)\s*[\[(]([^\])]*)[\])]\s*")


def table_spectrum(path: Path, options: str, source: str) -> TargetSpectrum:
    """A spectrum of two columns, period and acceleration, linear between logarithms."""
    try:
        lines = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"{source}: cannot be read: {error}; name a CSV file") from None
    factor = _acceleration_unit(lines[0] if lines else [], path)
    rows = [(number, row) for number, row in enumerate(lines[1:], start=2) if any(row)]
    pairs = np.array([_pair(row, f"{path}:{number}") for number, row in rows]).reshape(-1, 2)
    pairs = pairs[pairs[:, 0] > 0.0]  # the rigid oscillator has no logarithm
    if len(pairs) < 2 or (np.diff(pairs[:, 0]) <= 0.0).any():
        raise RecordError(f"{path}: needs two rows at least, with periods that grow")
    known = np.log(pairs)

    def shape(T: Array) -> Array:
        return np.asarray(factor * np.exp(np.interp(np.log(T), *known.T)))

    query = parse_query(options, source, ("damping",))
    damping = query.quantity("damping", "ratio", 0.05)
    first, last = float(pairs[0, 0]), float(pairs[-1, 0])
    pgv = velocity_of(shape) if damping == 0.05 and first <= 1.0 <= last else None
    return TargetSpectrum(path.stem, source, shape, pgv, damping=damping, span=(first, last))


def _acceleration_unit(head: list[str], path: Path) -> float:
    units = [match[2] if (match := _HEAD.fullmatch(cell)) else "" for cell in head[:2]]
    unit = canonical_unit(units[1]) if len(units) == 2 else None
    if unit is None or units[0].strip() != "s":
        raise RecordError(
            f"{path}:1: {','.join(head)[:60]!r} should name two columns with units, as in"
            f" 'period [s],acceleration [g]'; accelerations are in {KNOWN_UNITS}"
        )
    return unit_factor(unit)


def _pair(row: list[str], place: str) -> tuple[float, float]:
    try:
        period, value = (float(cell) for cell in row[:2])
    except ValueError:
        period = value = math.nan
    if not (math.isfinite(period) and math.isfinite(value) and period >= 0.0 and value > 0.0):
        raise RecordError(
            f"{place}: {','.join(row[:2])[:40]!r} must be a period >= 0 and an acceleration > 0"
        )
    return period, value
