"""Motions, or pairs of them, that may be chosen: spectra, peaks and factors."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records import measures
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.recordings import event_of, pairs
from rpscli.records.source import Source
from rpscli.records.target import Component, TargetSpectrum
from rpscli.tools.selection.request import SelectionRequest

Array = NDArray[np.float64]

LEVELS = np.linspace(-1.5, 1.5, 7)
"""Levels that motions which must scatter may be scaled to, in standard deviations."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One motion that may be chosen, or a pair under one factor, with
    its event if that is known.

    `acceleration` (n,) [m/s2] is its unscaled spectrum, `pga`, `pgv` and `pgd` its
    unscaled peaks, `factor` what brings it nearest to the target. A `clamped` factor
    is at one of its bounds.
    """

    motions: tuple[GroundMotion, ...]
    event: str
    pga: float
    pgv: float
    pgd: float
    acceleration: Array
    factor: float = 1.0
    clamped: bool = False

    @property
    def name(self) -> str:
        """Of the motion, or of the pair by its first component,
        without the side in a set.
        """
        name = self.motions[0].name
        return name if len(self.motions) == 1 else name.removesuffix("_a")

    @property
    def source(self) -> Source:
        """Of the motion, or of both components together."""
        first, *others = (Source.parse(motion.source) for motion in self.motions)
        return (
            first.together(others[0]).plus(both=None)
            if others and not first.both
            else first
        )

    @property
    def scaled(self) -> Array:
        """(1 + n,) PGA and spectrum under the factor [m/s2]."""
        return self.factor * np.array([self.pga, *self.acceleration])


def motions_or_pairs(
    motions: list[GroundMotion], of: Component
) -> list[tuple[GroundMotion, ...]]:
    """Motions by themselves, or the pairs that they belong to."""
    sources = [motion.source for motion in motions]
    found = pairs(sources, "rotd50" if of == "srss" else of)
    if of == "component":
        return [(motion,) for motion in motions]
    both = {
        pair: source
        for pair, source in zip(found, sources, strict=True)
        if pair is not None
    }
    return [
        (
            replace(load_record(x), source=given if Source.parse(given).both else x),
            load_record(y),
        )
        for (x, y), given in both.items()
    ]


def spectrum_of(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Array:
    """(1 + n,) PGA and spectrum of a motion or a pair [m/s2]."""
    at = np.array([0.0, *periods])
    if len(motions) == 1:
        return measures.response_spectrum(motions[0], at, damping).pseudo_acceleration
    x, y = motions
    return measures.of_directions(measures.spectra_over_directions(x, y, at, damping), of)


def measured(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Candidate:
    """A motion or a pair with its spectrum and its peaks."""
    first = motions[0]
    spectrum = spectrum_of(motions, damping, periods, of)
    pgv, pgd = (
        measures.measured(first, measure)
        if len(motions) == 1
        else float(
            measures.of_directions(
                measures.over_directions(first, motions[1], measure), of
            )
        )
        for measure in ("PGV", "PGD")
    )
    if not spectrum.all() or pgv <= 0.0:
        raise RecordError(f"{first.source}: is zero throughout; leave it out")
    event = event_of(first.recording) or ""
    return Candidate(motions, event, float(spectrum[0]), pgv, pgd, spectrum[1:])


def under_own_factors(
    one: Candidate,
    target: TargetSpectrum,
    periods: Array,
    wanted: Array,
    request: SelectionRequest,
) -> list[Candidate]:
    """A motion under the factors that it may have; none if those are out of bounds."""
    low, high = request.factors
    offset = np.log(wanted / one.acceleration)
    if request.pgv is not None:
        factors = [request.pgv / one.pgv]
    elif target.pinned is not None:
        factors = [float(np.exp(offset[np.searchsorted(periods, target.pinned)]))]
    elif target.deviation is not None:
        factors = np.exp(
            (offset + LEVELS[:, None] * target.deviation(periods)).mean(axis=1)
        )
    else:
        best = float(np.exp(offset.mean()))
        held = replace(one, clamped=not low <= best <= high)
        return [under(min(max(best, low), high), held, request)]
    return [under(float(f), one, request) for f in factors if low <= f <= high]


def under(factor: float, one: Candidate, request: SelectionRequest) -> Candidate:
    """A motion under a factor more, as the list writes it."""
    low, high = request.factors
    factor = float(f"{factor * one.factor:.6g}")
    clamped = one.clamped or not low * (1.0 + 1e-5) < factor < high * (1.0 - 1e-5)
    return replace(one, factor=factor, clamped=clamped)
