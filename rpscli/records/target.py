"""A target spectrum: pseudo-acceleration over the period with its peaks, or a CSV file."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import cast, get_args

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, beginning, stem_of
from rpscli.records.measures import Of
from rpscli.records.quantities import KNOWN_UNITS, canonical_unit, hint, parse_query, unit_factor
from rpscli.records.requirements import Component

Array = NDArray[np.float64]

AMPLIFICATION = 1.65
"""Pseudo-velocity over PGV: median of Newmark and Hall, 1982, at 5 % damping."""

CONVENTION = "pseudo-velocity at 1 s over 1.65, a convention of Hazus, not of the code"
"""The PGV of a spectrum whose code gives none."""


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
    edition: str = "as the file has it"
    """Code, edition and clause."""
    checked: str = "the user's own"
    """Against what its formulae were compared."""
    rules: str = "mean90"
    """What its code asks of a set of motions, a name of `requirements.RULES`."""
    of: Component | None = None
    """What its ordinates are of; None if it is not said."""
    parameters: str = ""
    """Those of a code, with their units."""
    level: str = ""
    """What the code calls its level of shaking."""
    pgv_by: str = CONVENTION
    """How its PGV is found."""
    deviation: Callable[[Array], Array] | None = None
    """Standard deviation of ln Sa at periods (n,); None if motions need not scatter."""
    pinned: float | None = None
    """Period at which that is zero, the conditioning one; None without it [s]."""

    pga: float | None = None
    """Of the ground, where the spectrum does not begin with it [m/s2]."""

    @property
    def ground_acceleration(self) -> float | None:
        """PGA that goes with it; None if it has no value at T = 0 [m/s2]."""
        return float(self.shape(np.zeros(1))[0]) if self.span[0] == 0.0 else self.pga

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

    FEMA, Hazus-MH 2.1, Earthquake Model Technical Manual, section 4.1. Later studies (Earthquake
    Spectra 31, 2015) let the ratio grow with the magnitude: it is a convention.

    >>> round(velocity_of(lambda periods: 9.80665 * 0.6 / periods), 4)
    0.5676
    """
    return float(shape(np.ones(1))[0]) / (2.0 * math.pi) / AMPLIFICATION


_HEAD = re.compile(r"\s*(.*?)\s*[\[(]([^\])]*)[\])]\s*")
_DEVIATION = re.compile(r"\s*sigma_ln\s*(?:\[-\])?\s*", re.IGNORECASE)


def table_spectrum(path: Path, options: str, source: str) -> TargetSpectrum:
    """Columns period and acceleration, linear between logarithms, and perhaps `sigma_ln [-]`."""
    # With the third one, the standard deviation of ln Sa, the acceleration is the median.
    try:
        lines = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"{source}: cannot be read: {error}; name a CSV file") from None
    factor = _acceleration_unit(lines[0] if lines else [], path)
    rows = [(number, row) for number, row in enumerate(lines[1:], start=2) if any(row)]
    scatters = len(lines[0]) > 2 and _DEVIATION.fullmatch(lines[0][2]) is not None
    width = 3 if scatters else 2
    cells = np.array([_cells(row, width, f"{path}:{number}") for number, row in rows])
    cells = cells.reshape(-1, width)
    rigid, cells = cells[cells[:, 0] == 0.0], cells[cells[:, 0] > 0.0]  # 0 has no logarithm
    if len(cells) < 2 or (np.diff(cells[:, 0]) <= 0.0).any():
        raise RecordError(f"{path}: needs two rows at least, with periods that grow")
    known = np.log(cells[:, :2])

    def shape(T: Array) -> Array:
        return np.asarray(factor * np.exp(np.interp(np.log(T), *known.T)))

    def deviation(T: Array) -> Array:
        return np.asarray(np.interp(np.log(T), known[:, 0], cells[:, 2]))

    query = parse_query(options, source, ("damping", "component", "level"))
    damping = query.quantity("damping", "ratio", 0.05)
    of = query.values.get("component", "").lower()
    if of not in {"", *(known_of := get_args(Of))}:
        raise RecordError(f"{source}: component = {of!r} is not known; {hint(of, known_of)}")
    first, last = float(cells[0, 0]), float(cells[-1, 0])
    pgv = velocity_of(shape) if damping == 0.05 and first <= 1.0 <= last else None
    return TargetSpectrum(
        stem_of(path),
        source,
        shape,
        pgv,
        damping=damping,
        span=(first, last),
        of=cast("Of", of) if of else None,
        level=query.values.get("level", ""),
        deviation=deviation if scatters else None,
        pga=factor * float(rigid[0, 1]) if len(rigid) else None,
        pinned=float(cells[np.argmin(cells[:, 2]), 0])
        if scatters and not cells[:, 2].all()
        else None,
    )


def _acceleration_unit(head: list[str], path: Path) -> float:
    units = [match[2] if (match := _HEAD.fullmatch(cell)) else "" for cell in head[:2]]
    unit = canonical_unit(units[1]) if len(units) == 2 else None
    if unit is None or units[0].strip() != "s":
        raise RecordError(
            f"{path}:1: {beginning(','.join(head))} should name two columns with units, as in"
            f" 'period [s],acceleration [g]'; accelerations are in {KNOWN_UNITS}"
        )
    return unit_factor(unit)


def _cells(row: list[str], width: int, place: str) -> list[float]:
    try:
        found = [float(cell) for cell in row[:width]]
    except ValueError:
        found = []
    wrong = len(found) < width or not np.isfinite(found).all()
    if wrong or not (min(found) >= 0.0 and found[1] > 0.0):
        also = ", and a sigma_ln >= 0" if width > 2 else ""
        raise RecordError(
            f"{place}: {beginning(','.join(row[:width]))} must be a period >= 0 and an"
            f" acceleration > 0{also}"
        )
    return found
