"""Motions and factors whose mean spectrum fits a target."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.measures import intensity_measures
from rpscli.records.spectrum import response_spectrum
from rpscli.records.target import TargetSpectrum

Array = NDArray[np.float64]

PERIODS = 60
"""Periods of comparison, spread evenly over the logarithm."""

STARTS = 12
"""Choices that are improved, each from another first motion."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One motion that may be chosen.

    `acceleration` (n,) [m/s2] is its unscaled spectrum, `factor` what brings it nearest to the
    target, `misfit` how far it is from it then.
    """

    motion: GroundMotion
    event: str
    pgv: float
    pgd: float
    acceleration: Array
    factor: float
    misfit: float


@dataclass(frozen=True, eq=False)
class Selection:
    """The choice, in the order of the candidates, beside its target.

    `periods`, `wanted` and `mean` are (n,) [s, m/s2, m/s2], the mean that of the scaled spectra.
    `misfit` is the root mean square over the periods of ln(mean/wanted). `candidates` counts the
    motions that were looked at, `refused` those that would need a factor out of bounds.
    """

    target: TargetSpectrum
    periods: Array
    wanted: Array
    chosen: tuple[Candidate, ...]
    mean: Array
    misfit: float
    candidates: int
    refused: int

    @property
    def least_ratio(self) -> float:
        """Least mean over target within the range of periods."""
        return float(np.min(self.mean / self.wanted))

    @property
    def mean_pgv(self) -> float:
        """Mean PGV of the scaled motions [m/s]."""
        return float(np.mean([abs(c.factor) * c.pgv for c in self.chosen]))

    @property
    def mean_pgd(self) -> float:
        """Mean PGD of the scaled motions [m]."""
        return float(np.mean([abs(c.factor) * c.pgd for c in self.chosen]))


@dataclass(frozen=True)
class SelectionRequest:
    """What is wanted of a choice."""

    count: int
    """Number of motions."""
    periods: tuple[float, float]
    """Range in which spectra are compared [s]."""
    factors: tuple[float, float] = (0.25, 4.0)
    """Least and largest factor on a motion."""
    per_event: int = 2
    """At most so many motions of one earthquake."""
    pgv: float | None = None
    """Bring every motion to this peak velocity, in place of the factor that fits it best
    [m/s]."""

    def __post_init__(self) -> None:
        (short, long), (low, high) = self.periods, self.factors
        if not 0.0 < short < long < np.inf:
            raise RecordError(f"--periods {short:g} {long:g}: must be > 0 and grow")
        if not 0.0 < low <= high < np.inf:
            raise RecordError(f"--factors {low:g} {high:g}: must be > 0 and not fall")
        if self.count < 1 or self.per_event < 1:
            raise RecordError("the numbers of motions and of motions per event must be >= 1")
        if self.pgv is not None and not 0.0 < self.pgv < np.inf:
            raise RecordError(f"--pgv {self.pgv:g}: must be > 0, in m/s")


def select(
    motions: Iterable[GroundMotion], target: TargetSpectrum, request: SelectionRequest
) -> Selection:
    """The motions and factors whose mean spectrum is nearest to the target.

    Each motion alone gets the factor that makes the mean over the periods of ln(spectrum/target)
    zero, which is the best one in least squares, or the bound next to it; or the factor that
    brings it to a PGV. Which motions then have the mean spectrum nearest to the target is sought
    by exchange: one motion for another as long as that helps, from several first choices
    (N. Jayaram, T. Lin and J. W. Baker, Earthquake Spectra 27, 2011, without the simulation).
    """
    low, high = request.periods
    periods = np.geomspace(low, high, PERIODS)
    wanted = target.acceleration(periods)
    every = [_candidate(motion, target.damping, periods, wanted, request) for motion in motions]
    fitting = [candidate for candidate in every if candidate is not None]
    _require_enough(fitting, len(every), request)
    scaled = np.array([c.factor * c.acceleration for c in fitting])
    places = choose(scaled, wanted, [c.event for c in fitting], request.count, request.per_event)
    mean = scaled[places].mean(axis=0)
    return Selection(
        target=target,
        periods=periods,
        wanted=wanted,
        chosen=tuple(fitting[place] for place in places),
        mean=mean,
        misfit=float(misfit(mean, wanted)),
        candidates=len(every),
        refused=len(every) - len(fitting),
    )


def misfit(spectra: Array, wanted: Array) -> Array:
    """Root mean square of ln(spectrum/target) over the last axis.

    >>> round(float(misfit(np.array([2.0, 0.5]), np.ones(2))), 6)  # ln 2
    0.693147
    """
    return np.asarray(np.sqrt(np.mean(np.log(spectra / wanted) ** 2, axis=-1)))


def event_of(motion: GroundMotion) -> str:
    """The earthquake of a motion, where its file says so; else its name, an event of its own.

    >>> text = "PEER STRONG MOTION DATABASE; NORTHRIDGE 1/17/94, MULHOL, 009; values in g"
    >>> event_of(GroundMotion(np.ones(2), 0.1, "m", "", "PEER AT2", text))
    'northridge 1/17/94'
    """
    recorded = "not a recording" not in motion.description.lower()
    if recorded and motion.format.startswith(("PEER", "FEMA")):
        for part in motion.description.split(";"):
            # Event, station or date, component: fewer commas are those of another sentence.
            event, *others = part.split(",")
            if len(others) > 1:
                return event.strip().lower()
    return motion.name


def choose(
    scaled: Array, wanted: Array, events: Sequence[str], count: int, per_event: int
) -> list[int]:
    """Places of the spectra whose mean is nearest to the target, in order."""

    def free(places: Sequence[int]) -> list[int]:
        """What may still be chosen beside these places."""
        taken = Counter(events[place] for place in places)
        every = enumerate(events)
        return [p for p, event in every if p not in places and taken[event] < per_event]

    def grown(first: int) -> list[int]:
        """A choice that begins with one spectrum and takes the best next one each time."""
        places = [first]
        while len(places) < count:
            others = free(places)
            means = (scaled[places].sum(axis=0) + scaled[others]) / (len(places) + 1.0)
            places.append(others[int(np.argmin(misfit(means, wanted)))])
        return places

    def exchanged(places: list[int]) -> tuple[float, list[int]]:
        """The best exchange of one spectrum for another, until none helps; first its misfit."""
        now = float(misfit(scaled[places].mean(axis=0), wanted))
        while True:
            total, best = scaled[places].sum(axis=0), None
            for out in places:
                kept = [place for place in places if place != out]
                if not (others := [place for place in free(kept) if place != out]):
                    continue
                found = misfit((total - scaled[out] + scaled[others]) / len(places), wanted)
                place = int(np.argmin(found))
                # Rounding of the sums must not look like progress, or it would never end.
                if found[place] < now - 1e-12:
                    now, best = float(found[place]), [*kept, others[place]]
            if best is None:
                return float(misfit(scaled[places].mean(axis=0), wanted)), sorted(places)
            places = best

    order = np.argsort(misfit(scaled, wanted), kind="stable")
    return min(exchanged(grown(first)) for first in order[:STARTS].tolist())[1]


def _candidate(
    motion: GroundMotion, damping: float, periods: Array, wanted: Array, request: SelectionRequest
) -> Candidate | None:
    """A motion with its factor; None if the factor to a PGV is out of bounds."""
    acceleration = response_spectrum(motion, periods, damping).pseudo_acceleration
    measures = intensity_measures(motion)
    low, high = request.factors
    if not (acceleration > 0.0).all() or measures.pgv <= 0.0:
        raise RecordError(f"{motion.source}: does not move the ground; leave it out")
    if request.pgv is None:
        best = float(np.exp(np.mean(np.log(wanted / acceleration))))
        factor = min(max(best, low), high)
    elif low <= (factor := request.pgv / measures.pgv) <= high:
        pass
    else:
        return None
    factor = float(f"{factor:.6g}")  # what the list says is what was judged
    return Candidate(
        motion=motion,
        event=event_of(motion),
        pgv=measures.pgv,
        pgd=measures.pgd,
        acceleration=acceleration,
        factor=factor,
        misfit=float(misfit(factor * acceleration, wanted)),
    )


def _require_enough(fitting: Sequence[Candidate], every: int, request: SelectionRequest) -> None:
    counts = Counter(candidate.event for candidate in fitting)
    room = sum(min(count, request.per_event) for count in counts.values())
    if room < request.count:
        raise RecordError(
            f"only {room} of {every} motions may be chosen together, {request.count} are wanted:"
            f" {len(fitting)} keep within the factors {request.factors[0]:g} to"
            f" {request.factors[1]:g}, from {len(counts)} events with at most {request.per_event}"
            " each; give more motions or wider bounds"
        )
