"""Motions, or pairs of them, and factors whose spectra fit a target; the
search for the best set.

The best set is that of all, or sought by exchange.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError, UsageError, hint
from rpscli.records import measures
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.recordings import clusters, event_of, pairs
from rpscli.records.source import Source
from rpscli.records.target import (
    RULES,
    Component,
    Periods,
    Requirements,
    Rule,
    TargetSpectrum,
)
from rpscli.units import bare_or_si

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

PERIODS = 60  # periods of comparison, spread evenly over the logarithm
FINER = 4  # times as many periods in the end, for the common factor and the verdicts
LEVELS = np.linspace(-1.5, 1.5, 7)
"""Levels that motions which must scatter may be scaled to, in standard deviations."""

_RANGES = {
    "magnitude": "",
    "distance": "m",
    "vs30": "m/s",
    "usable_period": "s",
    "d5_75": "s",
    "d5_95": "s",
}
"""Quantities that have a range, with SI units; significant durations
are those of the motion."""


class Filter(NamedTuple):
    """A range that one quantity must lie in, ends included [SI]."""

    text: str
    name: str
    low: float
    high: float

    def keeps(self, motion: GroundMotion) -> bool | None:
        """True if a motion may be a candidate; None if the
        quantity is not known of it.
        """
        durations = self.name.startswith("d5")
        of = measures.intensity_measures(motion) if durations else motion.recording
        value = getattr(of, self.name)
        return None if value is None else self.low <= value <= self.high


def kept(
    motions: Sequence[GroundMotion], filters: Iterable[Filter]
) -> tuple[list[GroundMotion], dict[str, dict[str, int]]]:
    """Motions that pass every filter, and how many each keeps
    out, or knows nothing of.
    """
    passing = list(motions)
    left_out = {}
    for each in filters:
        verdicts = [each.keeps(motion) for motion in passing]
        left_out[each.text] = {
            "outside": verdicts.count(False),
            "not_known": verdicts.count(None),
        }
        passing = list(itertools.compress(passing, verdicts))
    return passing, left_out


def parse_filter(text: str) -> Filter:
    """A range as ``--where`` gives it, in SI or with units; an end may be left out.

    Such are `magnitude=6.5..7.5` and `pulse=no`.
    """
    name, _, wanted = (part.strip() for part in text.partition("="))
    fault = ""
    ends = [0.0, 0.0]
    low, dots, high = wanted.partition("..")
    if name == "pulse":
        ends = [1.0 if wanted == "yes" else 0.0] * 2
        fault = "" if wanted in ("yes", "no") else "write pulse=yes or pulse=no"
    elif name not in _RANGES:
        known = f"known are {', '.join(_RANGES)}, pulse"
        fault = f"{name!r} is not known; {hint(name, _RANGES, known)}"
    elif not dots:
        fault = f"write {name}=LOW..HIGH; an end may be left out"
    else:
        try:
            texts = low.strip() or "-inf", high.strip() or "inf"
            ends = [bare_or_si(end, _RANGES[name]) for end in texts]
            fault = (
                "" if ends[0] <= ends[1] else "must not fall; write the lower end first"
            )
        except ValueError as error:
            fault = f"an end of the range {error}"
    if fault:
        raise UsageError(f"--where {text}: {fault}")
    return Filter(text, name, *ends)


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


@dataclass(frozen=True, eq=False)
class Selection:
    """The choice, in the order of the candidates, beside its
    target at `periods` (n,) [s].

    `common` is the factor on all motions after their own. `candidates` counts the
    motions or pairs that were looked at, `refused` those that would need a factor
    out of bounds to have the PGV, or the conditioning ordinate; `whole` is true if
    all sets were looked at.
    """

    target: TargetSpectrum
    of: Component
    periods: Array
    chosen: tuple[Candidate, ...]
    candidates: int
    refused: int
    common: float = 1.0
    requirements: Requirements | None = None
    rules: tuple[Rule, ...] = ()
    whole: bool = False

    @cached_property
    def wanted(self) -> Array:
        """(n,) of the target [m/s2]."""
        return self.target.acceleration(self.periods)

    @cached_property
    def mean(self) -> Array:
        """(n,) of the scaled spectra [m/s2], a geometric one where
        the target has a deviation.
        """
        spectra = np.array([one.scaled[1:] for one in self.chosen])
        if self.target.deviation is None:
            return np.asarray(spectra.mean(axis=0))
        return np.asarray(np.exp(np.log(spectra).mean(axis=0)))

    @property
    def deviation(self) -> Array | None:
        """(n,) of ln Sa of the scaled spectra, where the target has one."""
        if self.target.deviation is None:
            return None
        return np.asarray(
            np.log([one.scaled[1:] for one in self.chosen]).std(axis=0, ddof=1)
        )

    @property
    def misfit(self) -> float:
        """Root mean square over the periods of ln(mean/target)."""
        return float(misfit(self.mean, self.wanted))

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
        """Largest errors of mean and standard deviation of ln Sa,
        where the target has both.
        """
        if self.target.deviation is None or (scatter := self.deviation) is None:
            return None
        off = (
            np.log(self.mean / self.wanted),
            scatter - self.target.deviation(self.periods),
        )
        return float(np.abs(off[0]).max()), float(np.abs(off[1]).max())


@dataclass(frozen=True)
class SelectionRequest:
    """What is asked for: `count` motions, or pairs, whose spectra are
    compared in `periods` [s].

    `factors` bound those on a motion, `per_event` the motions from one earthquake. A
    `pgv` [m/s] is that of every motion, in place of the factor that fits it best. `rules`
    name what a code asks of the set, enforced and judged, None what the target's asks;
    its range of periods is about those of the `structure`.
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
        (short, long) = self.periods
        (low, high) = self.factors
        if not 0.0 < short < long < np.inf:
            raise RecordError(f"--periods {short:g} {long:g}: must be > 0 and grow")
        if not 0.0 < low <= high < np.inf:
            raise RecordError(f"--factors {low:g} {high:g}: must be > 0 and not fall")
        if self.count < 1 or self.per_event < 1:
            raise RecordError(
                "the numbers of motions and of motions per event must be >= 1"
            )
        if self.pgv is not None and not 0.0 < self.pgv < np.inf:
            raise RecordError(f"--pgv {self.pgv:g}: must be > 0, in m/s")


def select(
    motions: Iterable[GroundMotion],
    target: TargetSpectrum,
    request: SelectionRequest,
    watched: Callable[[range], Iterable[int]] = iter,
) -> Selection:
    """The motions and factors whose mean spectrum is nearest to the target.

    Each motion alone gets the factor that makes the mean over the periods of
    ln(spectrum/target) zero, which is the best one in least squares, or the bound next
    to it; then all of them one common factor, which brings the mean spectrum nearest to
    the target and, if it must, up to what the code asks for. With a PGV each motion is
    brought to that, and there is no common factor. A target with a standard deviation
    is met in the mean and in the deviation of ln Sa, as by J. W. Baker and C. Lee, J.
    Earthq. Eng. 22, 2018, without their simulated spectra: each motion is scaled to the
    target at the period at which that does not scatter; without such a period, to one
    of several levels of it.

    Of one recording one component, or the pair, is chosen at most. `watched`
    goes through the numbers of candidates while their spectra are computed, and
    may show how far that is.
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
    spectra = [
        _spectrum(one.motions, target.damping, periods, request.of) for one in best
    ]
    finer = [
        replace(one, acceleration=s[1:]) for one, s in zip(best, spectra, strict=True)
    ]
    features = goal.features(np.array([one.scaled for one in finer]))
    _, common = goal.of_set(features, np.array([one.factor for one in finer]))
    chosen = tuple(_under(common, one, request) for one in finer)
    refused = sum(not scaled for scaled in fits)
    found = Selection(
        target,
        request.of,
        periods,
        chosen,
        len(every),
        refused,
        common,
        asked,
        whole=whole,
    )
    if asked is None:
        return found
    pga = float(np.mean([one.scaled[0] for one in chosen]) / goal.wanted[0])
    judged = asked.judged(
        len(chosen), request.of, target.level, pga, found.least_ratio, request.periods,
        request.structure,
    )  # fmt: skip
    return replace(found, rules=judged)


def _goal(
    target: TargetSpectrum,
    request: SelectionRequest,
    asked: Requirements | None,
    count: int,
) -> tuple[Array, Goal]:
    """Periods (n,) [s], and what the set is to have there and of its PGA."""
    low, high = request.periods
    periods = np.geomspace(low, high, count)
    if target.pinned is not None:
        if not low <= target.pinned <= high:
            raise RecordError(
                f"{target.source}: does not scatter at {target.pinned:g} s, which must be"
                f" within --periods {low:g} {high:g}"
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


def _sources(
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


def _spectrum(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Array:
    """(1 + n,) PGA and spectrum of a motion or a pair [m/s2]."""
    at = np.array([0.0, *periods])
    if len(motions) == 1:
        return measures.response_spectrum(motions[0], at, damping).pseudo_acceleration
    x, y = motions
    return measures.of_directions(measures.spectra_over_directions(x, y, at, damping), of)


def _measured(
    motions: tuple[GroundMotion, ...], damping: float, periods: Array, of: Component
) -> Candidate:
    """A motion or a pair with its spectrum and its peaks."""
    first = motions[0]
    spectrum = _spectrum(motions, damping, periods, of)
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


def _scaled(
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
        return [_under(min(max(best, low), high), held, request)]
    return [_under(float(f), one, request) for f in factors if low <= f <= high]


def _under(factor: float, one: Candidate, request: SelectionRequest) -> Candidate:
    """A motion under a factor more, as the list writes it."""
    low, high = request.factors
    factor = float(f"{factor * one.factor:.6g}")
    clamped = one.clamped or not low * (1.0 + 1e-5) < factor < high * (1.0 - 1e-5)
    return replace(one, factor=factor, clamped=clamped)


def _require_enough(
    pool: Pool, every: int, target: TargetSpectrum, request: SelectionRequest
) -> None:
    known = set(zip(pool.recordings.tolist(), pool.events.tolist(), strict=True))
    counts = Counter(event for _, event in known)
    room = sum(min(count, request.per_event) for count in counts.values())
    if request.count < 2 and target.deviation is not None:
        raise RecordError(
            f"{target.source}: has a sigma_ln, which takes two motions at least"
        )
    if room < request.count:
        noun = "motions" if request.of == "component" else "pairs"
        raise RecordError(
            f"only {room} of {every} {noun} may be chosen together, {request.count} are"
            f" wanted: {len(known)} recordings keep within the factors"
            f" {request.factors[0]:g} to {request.factors[1]:g}, from {len(counts)}"
            f" events with at most {request.per_event} each, and of one recording one"
            " component is taken; give more motions or wider bounds"
        )


WHOLE = 2_000_000  # most sets that are searched exhaustively
ROUNDS = 50  # searches, of which the best one counts
STARTS = 5  # first choices of a search at random, each improved by exchange
# times that the best of them is left by three motions at random, and improved again
KICKS = 50
ROUNDING = 2e-5  # by which a least value is passed: factors are written with six digits
SHORT = (
    10.0  # weight of what is missing to a requirement [1/ln]: more than any fit can win
)


class Pool(NamedTuple):
    """Candidates: `spectra` (m, 1 + n) under `factors` (m,), the PGA before the periods.

    Of one of the `recordings` (m,) one is chosen at most; `events`
    (m,) number the earthquakes.
    """

    spectra: Array
    factors: Array
    recordings: Numbers
    events: Numbers


@dataclass(frozen=True, eq=False)
class Goal:
    """The aim of the mean of a set, or of the mean and the deviation of ln Sa.

    `wanted` is (1 + n,), `deviation` (n,). Of the mean over `wanted` at least `least` is
    required at all periods, and 1 of the `pga`. One common factor may bring the set
    there, within the `bounds` of every single factor, unless they are `fixed`.
    """

    wanted: Array
    deviation: Array | None = None
    least: float = 0.0
    pga: bool = False
    bounds: tuple[float, float] = (0.0, math.inf)
    fixed: bool = False

    def features(self, spectra: Array) -> Array:
        """(m, features) of scaled spectra; the sum of those of a set decides on it."""
        if self.deviation is None:
            return spectra
        logarithms = np.log(spectra[:, 1:])
        return np.hstack([logarithms, logarithms**2])

    def judged(
        self, total: Array, size: int, least: Array, most: Array
    ) -> tuple[Array, Array]:
        """Cost and logarithm of the common factor, (...), of sets
        with sums (..., features).
        """
        if self.deviation is not None:
            first, second = np.split(total / size, 2, axis=-1)
            scatter = np.sqrt(
                np.maximum(second - first**2, 0.0) * size / max(size - 1, 1)
            )
            errors = (first - np.log(self.wanted[1:])) ** 2 + (
                scatter - self.deviation
            ) ** 2
            return np.sqrt(errors.mean(axis=-1)), np.zeros(errors.shape[:-1])
        ratio = np.log(total / size / self.wanted)
        shape = ratio[..., 1:]
        offset = shape.mean(axis=-1)
        needed = np.full(offset.shape, -np.inf)
        if self.least > 0.0:
            needed = math.log(self.least) + ROUNDING - shape.min(axis=-1)
        if self.pga:
            needed = np.maximum(needed, ROUNDING - ratio[..., 0])
        common = np.zeros(offset.shape)
        if not self.fixed:
            low, high = (math.log(bound) if bound else -math.inf for bound in self.bounds)
            common = np.clip(
                np.maximum(-offset, needed), low - np.log(least), high - np.log(most)
            )
        missing = np.maximum(needed - common, 0.0)
        cost = np.sqrt(shape.var(axis=-1) + (offset + common) ** 2) + SHORT * missing
        return cost, common

    def of_set(self, features: Array, factors: Array) -> tuple[float, float]:
        """Cost and common factor of one set, with features (size,
        ...) under factors (size,).
        """
        total = features.sum(axis=0)
        cost, common = self.judged(total, len(factors), factors.min(), factors.max())
        return float(cost), math.exp(float(common))


def best_choice(
    pool: Pool, goal: Goal, count: int, per_event: int
) -> tuple[list[int], bool]:
    """Places of the best set, in order, and whether all sets were looked at.

    Of more sets than `WHOLE` it is the best that is found, the same for the same motions.
    """
    search = _Search(pool, goal, count, per_event)
    if math.comb(len(pool.factors), count) <= WHOLE:
        return search.best_of_all(), True
    found = []
    random = np.random.default_rng(1)
    for _ in range(ROUNDS):
        best = min(search.exchanged(search.filled([], random)) for _ in range(STARTS))
        for _ in range(KICKS):
            kept = random.permutation(best[1])[min(3, count - 1) :].tolist()
            best = min(best, search.exchanged(search.filled(kept, random)))
        found.append(best)
    return min(found)[1], False


class _Search:
    """Sets of a pool, and moves among them."""

    def __init__(self, pool: Pool, goal: Goal, count: int, per_event: int) -> None:
        self.pool = pool
        self.goal = goal
        self.count = count
        self.per_event = per_event
        self.features = goal.features(pool.spectra)

    def free(self, sets: Numbers) -> NDArray[np.bool_]:
        """(..., m) what may still be chosen beside sets (..., size)."""
        _, _, recordings, events = self.pool
        taken = (recordings[sets][..., None] == recordings).any(axis=-2)
        kin = (events[sets][..., None] == events).sum(axis=-2)
        return np.asarray(~taken & (kin < self.per_event))

    def best_of_all(self) -> list[int]:
        """Places of the best of all sets that keep the rules
        about recordings and events.
        """
        _, every, recordings, events = self.pool
        choices = itertools.combinations(range(len(every)), self.count)
        best = (math.inf, list[int]())
        while block := [*itertools.islice(choices, 20_000)]:
            sets = np.array(block)
            for numbers, most in ((recordings, 1), (events, self.per_event)):
                same = numbers[sets][:, :, None] == numbers[sets][:, None, :]
                sets = sets[same.sum(axis=2).max(axis=1) <= most]
            factors = every[sets]
            total = np.zeros((len(sets), self.features.shape[1]))
            for place in range(self.count):
                total += self.features[sets[:, place]]
            cost, _ = self.goal.judged(
                total, self.count, factors.min(axis=1), factors.max(axis=1)
            )
            if len(sets):
                least = int(np.argmin(cost))
                best = min(best, (float(cost[least]), sets[least].tolist()))
        return best[1]

    def filled(self, places: list[int], random: np.random.Generator) -> list[int]:
        """These places and others at random; fewer than wanted
        where none is free any more.
        """
        while len(places) < self.count:
            free = np.flatnonzero(self.free(np.array(places, dtype=np.int64)))
            if not free.size:
                break
            places = [*places, int(random.choice(free))]
        return places

    def exchanged(self, places: list[int]) -> tuple[float, list[int]]:
        """The cost and the places after the best exchanges, until none helps."""
        every = self.pool.factors
        size = len(places)
        now = self.goal.of_set(self.features[places], every[places])[0]
        while size > 1:
            rest = np.array([np.delete(places, out) for out in range(size)])
            total = self.features[rest].sum(axis=1)[:, None] + self.features
            least = np.minimum(every[rest].min(axis=1, keepdims=True), every)
            most = np.maximum(every[rest].max(axis=1, keepdims=True), every)
            # (size, m) with another one in place of each; infinite where it is not free.
            cost, _ = self.goal.judged(total, size, least, most)
            cost = np.where(self.free(rest), cost, math.inf)
            out, other = np.unravel_index(int(np.argmin(cost)), cost.shape)
            # Rounding of the sums must not look like progress, or it would never end.
            if cost[out, other] >= now - 1e-12:
                break
            now = float(cost[out, other])
            places = [*rest[out].tolist(), int(other)]
        places = sorted(places)
        return self.goal.of_set(self.features[places], every[places])[0], places
