"""Motions, or pairs of them, and factors whose spectra fit a target."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records import measures
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.recordings import clusters, event_of, pairs
from rpscli.records.requirements import RULES, Component, Periods, Requirements, Rule
from rpscli.records.search import Goal, Pool, best_choice
from rpscli.records.source import Source
from rpscli.records.spectrum import response_spectrum
from rpscli.records.target import TargetSpectrum

Array = NDArray[np.float64]

PERIODS = 60  # periods of comparison, spread evenly over the logarithm
FINER = 4  # times as many periods in the end, for the common factor and the verdicts
LEVELS = np.linspace(-1.5, 1.5, 7)
"""Levels that motions which must scatter may be scaled to, in standard deviations."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One motion that may be chosen, or a pair under one factor, with its event if that is known.

    `acceleration` (n,) [m/s2] is its unscaled spectrum, `pga`, `pgv` and `pgd` its unscaled peaks,
    `factor` what brings it nearest to the target, `misfit` how far it is from it then. A `clamped`
    factor is at one of its bounds.
    """

    motions: tuple[GroundMotion, ...]
    event: str
    pga: float
    pgv: float
    pgd: float
    acceleration: Array
    factor: float = 1.0
    misfit: float = 0.0
    clamped: bool = False

    @property
    def name(self) -> str:
        """Of the motion, or of the pair by its first component, without the side in a set."""
        name = self.motions[0].name
        return name if len(self.motions) == 1 else name.removesuffix("_a")

    @property
    def source(self) -> Source:
        """Of the motion, or of both components together."""
        first, *others = (Source.parse(motion.source) for motion in self.motions)
        return first.together(others[0]).plus(both=None) if others and not first.both else first

    @property
    def scaled(self) -> Array:
        """(1 + n,) PGA and spectrum under the factor [m/s2]."""
        return self.factor * np.array([self.pga, *self.acceleration])


@dataclass(frozen=True, eq=False)
class Selection:
    """The choice, in the order of the candidates, beside its target.

    `periods`, `wanted` and `mean` are (n,) [s, m/s2, m/s2], the mean that of the scaled spectra, a
    geometric one, with the `deviation` (n,) of ln Sa, where the target has a deviation. `common` is
    the factor on all motions after their own. `misfit` is the root mean square over the periods of
    ln(mean/wanted). `candidates` counts the motions or pairs that were looked at, `refused` those
    that would need a factor out of bounds to have the PGV, or the conditioning ordinate; `whole` is
    true if all sets were looked at.
    """

    target: TargetSpectrum
    of: Component
    periods: Array
    wanted: Array
    chosen: tuple[Candidate, ...]
    mean: Array
    misfit: float
    candidates: int
    refused: int
    common: float = 1.0
    deviation: Array | None = None
    requirements: Requirements | None = None
    rules: tuple[Rule, ...] = ()
    whole: bool = False

    @property
    def least_ratio(self) -> float:
        """Least mean over target within the range of periods."""
        return float(np.min(self.mean / self.wanted))

    @property
    def clamped(self) -> int:
        """Number of factors at a bound."""
        return sum(one.clamped for one in self.chosen)

    @property
    def mean_pgv(self) -> float:
        """Mean PGV of the scaled motions [m/s]."""
        return float(np.mean([abs(c.factor) * c.pgv for c in self.chosen]))

    @property
    def mean_pgd(self) -> float:
        """Mean PGD of the scaled motions [m]."""
        return float(np.mean([abs(c.factor) * c.pgd for c in self.chosen]))

    @property
    def errors(self) -> tuple[float, float] | None:
        """Largest errors of mean and standard deviation of ln Sa, where the target has both."""
        if self.target.deviation is None or self.deviation is None:
            return None
        scatter = np.abs(self.deviation - self.target.deviation(self.periods))
        return float(np.abs(np.log(self.mean / self.wanted)).max()), float(scatter.max())


@dataclass(frozen=True)
class SelectionRequest:
    """What is asked for: `count` motions, or pairs, whose spectra are compared in `periods` [s].

    `factors` bound those on a motion, `per_event` the motions from one earthquake. A `pgv` [m/s] is
    that of every motion, in place of the factor that fits it best. `rules` name what a code asks
    of the set, enforced and judged, None what the target's asks; its range of periods is about
    those of the `structure`.
    """

    count: int
    periods: tuple[float, float]
    factors: tuple[float, float] = (0.25, 4.0)
    per_event: int = 2
    pgv: float | None = None
    of: Component = "component"
    rules: str | None = None
    structure: Periods | None = None

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
    motions: Iterable[GroundMotion],
    target: TargetSpectrum,
    request: SelectionRequest,
    watched: Callable[[range], Iterable[int]] = iter,
) -> Selection:
    """The motions and factors whose mean spectrum is nearest to the target.

    Each motion alone gets the factor that makes the mean over the periods of ln(spectrum/target)
    zero, which is the best one in least squares, or the bound next to it; then all of them one
    common factor, which brings the mean spectrum nearest to the target and, if it must, up to what
    the code asks for. With a PGV each motion is brought to that, and there is no common factor.
    A target with a standard deviation is met in the mean and in the deviation of ln Sa, as by
    J. W. Baker and C. Lee, J. Earthq. Eng. 22, 2018, without their simulated spectra: each motion
    is scaled to the target at the period at which that does not scatter; without such a period, to
    one of several levels of it.

    Of one recording one component, or the pair, is chosen at most. `watched` goes through the
    numbers of candidates while their spectra are computed, and may show how far that is.
    """
    asked = None if target.deviation else RULES.get(request.rules or target.rules)
    periods, goal = _goal(target, request, asked, PERIODS)
    sources = _sources([*motions], request.of)
    numbers = watched(range(len(sources)))
    every = [_measured(sources[n], target.damping, periods, request.of) for n in numbers]
    fits = [_scaled(one, target, periods, goal.wanted[1:], request) for one in every]
    fitting = [one for scaled in fits for one in scaled]
    # Motions that were made as arrays have no source to go by.
    named = [one.motions[0].source for one in every]
    named = [f"array {i}" if name == "array" else name for i, name in enumerate(named)]
    recordings = np.repeat(clusters(named), [len(scaled) for scaled in fits])
    # A recording that does not name its earthquake is of one of its own.
    events = [one.event or f"{at}" for one, at in zip(fitting, recordings, strict=True)]
    pool = Pool(
        np.array([one.scaled for one in fitting]).reshape(-1, len(goal.wanted)),
        np.array([one.factor for one in fitting]),
        recordings,
        np.unique(events, return_inverse=True)[1],
    )
    _require_enough(pool, len(every), target, request)
    places, whole = best_choice(pool, goal, request.count, request.per_event)
    # Codes ask for all periods: the common factor and the verdicts are from a finer grid.
    periods, goal = _goal(target, request, asked, FINER * PERIODS)
    best = [fitting[place] for place in places]
    spectra = [_spectrum(one.motions, target.damping, periods, request.of) for one in best]
    finer = [replace(one, acceleration=s[1:]) for one, s in zip(best, spectra, strict=True)]
    features = goal.features(np.array([one.scaled for one in finer]))
    _, common = goal.of_set(features, np.array([one.factor for one in finer]))
    chosen = tuple(_under(common, one, goal.wanted[1:], request) for one in finer)
    scaled = np.array([one.scaled for one in chosen])
    mean = scaled.mean(axis=0) if goal.deviation is None else np.exp(np.log(scaled).mean(axis=0))
    ratio = mean / goal.wanted
    return Selection(
        target=target,
        of=request.of,
        periods=periods,
        wanted=goal.wanted[1:],
        chosen=chosen,
        mean=mean[1:],
        misfit=float(misfit(mean[1:], goal.wanted[1:])),
        candidates=len(every),
        refused=sum(not scaled for scaled in fits),
        common=common,
        deviation=None if goal.deviation is None else np.log(scaled[:, 1:]).std(axis=0, ddof=1),
        requirements=asked,
        rules=() if asked is None else asked.judged(
            len(chosen), request.of, target.level, float(ratio[0]), float(ratio[1:].min()),
            request.periods, request.structure,
        ),
        whole=whole,
    )  # fmt: skip


def _goal(
    target: TargetSpectrum, request: SelectionRequest, asked: Requirements | None, count: int
) -> tuple[Array, Goal]:
    """Periods (n,) [s], and what the set is to have there and of its PGA."""
    low, high = request.periods
    periods = np.geomspace(low, high, count)
    if target.pinned is not None:
        if not low <= target.pinned <= high:
            raise RecordError(
                f"{target.source}: does not scatter at {target.pinned:g} s, which must be within"
                f" --periods {low:g} {high:g}"
            )
        periods = np.union1d(periods, target.pinned)
    pga = target.ground_acceleration
    return periods, Goal(
        np.array([pga or np.nan, *target.acceleration(periods)]),
        None if target.deviation is None else target.deviation(periods),
        0.0 if asked is None else asked.least,
        asked is not None and asked.mean_pga and pga is not None,
        request.factors,
        fixed=request.pgv is not None,
    )


def misfit(spectra: Array, wanted: Array) -> Array:
    """Root mean square of ln(spectrum/target) over the last axis."""
    return np.asarray(np.sqrt(np.mean(np.log(spectra / wanted) ** 2, axis=-1)))


def _sources(motions: list[GroundMotion], of: Component) -> list[tuple[GroundMotion, ...]]:
    """Motions by themselves, or the pairs that they belong to."""
    sources = [motion.source for motion in motions]
    found = pairs(sources, "rotd50" if of == "srss" else of)
    if of == "component":
        return [(motion,) for motion in motions]
    both = {pair: source for pair, source in zip(found, sources, strict=True) if pair is not None}
    return [
        (replace(load_record(x), source=given if Source.parse(given).both else x), load_record(y))
        for (x, y), given in both.items()
    ]


def _spectrum(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Array:
    """(1 + n,) PGA and spectrum of a motion or a pair [m/s2]."""
    at = np.array([0.0, *periods])
    if len(motions) == 1:
        return response_spectrum(motions[0], at, damping).pseudo_acceleration
    x, y = motions
    return measures.of_directions(measures.spectra_over_directions(x, y, at, damping), of)


def _measured(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Candidate:
    """A motion or a pair with its spectrum and its peaks."""
    first, spectrum = motions[0], _spectrum(motions, damping, periods, of)
    pgv, pgd = (
        measures.measured(first, measure)
        if len(motions) == 1
        else float(measures.of_directions(measures.over_directions(first, motions[1], measure), of))
        for measure in ("PGV", "PGD")
    )
    if not spectrum.all() or pgv <= 0.0:
        raise RecordError(f"{first.source}: is zero throughout; leave it out")
    event = event_of(first.recording) or ""
    return Candidate(motions, event, float(spectrum[0]), pgv, pgd, spectrum[1:])


def _scaled(
    one: Candidate, target: TargetSpectrum, periods: Array, wanted: Array, request: SelectionRequest
) -> list[Candidate]:
    """A motion under the factors that it may have; none if those are out of bounds."""
    low, high = request.factors
    offset = np.log(wanted / one.acceleration)
    if request.pgv is not None:
        factors = [request.pgv / one.pgv]
    elif target.pinned is not None:
        factors = [float(np.exp(offset[np.searchsorted(periods, target.pinned)]))]
    elif target.deviation is not None:
        factors = np.exp((offset + LEVELS[:, None] * target.deviation(periods)).mean(axis=1))
    else:
        best = float(np.exp(offset.mean()))
        held = replace(one, clamped=not low <= best <= high)
        return [_under(min(max(best, low), high), held, wanted, request)]
    return [_under(float(f), one, wanted, request) for f in factors if low <= f <= high]


def _under(factor: float, one: Candidate, wanted: Array, request: SelectionRequest) -> Candidate:
    """A motion under a factor more, as the list writes it."""
    low, high = request.factors
    factor = float(f"{factor * one.factor:.6g}")
    clamped = one.clamped or not low * (1.0 + 1e-5) < factor < high * (1.0 - 1e-5)
    found = float(misfit(factor * one.acceleration, wanted))
    return replace(one, factor=factor, misfit=found, clamped=clamped)


def _require_enough(
    pool: Pool, every: int, target: TargetSpectrum, request: SelectionRequest
) -> None:
    known = set(zip(pool.recordings.tolist(), pool.events.tolist(), strict=True))
    counts = Counter(event for _, event in known)
    room = sum(min(count, request.per_event) for count in counts.values())
    if request.count < 2 and target.deviation is not None:
        raise RecordError(f"{target.source}: has a sigma_ln, which takes two motions at least")
    if room < request.count:
        noun = "motions" if request.of == "component" else "pairs"
        raise RecordError(
            f"only {room} of {every} {noun} may be chosen together, {request.count} are wanted:"
            f" {len(known)} recordings keep within the factors {request.factors[0]:g} to"
            f" {request.factors[1]:g}, from {len(counts)} events with at most {request.per_event}"
            " each, and of one recording one component is taken; give more motions or wider bounds"
        )
