"""Motions and factors whose mean spectrum is nearest to a target."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.recordings import clusters, events_among
from rpscli.records.target import Component, TargetSpectrum
from rpscli.tools.selection.candidates import (
    Candidate,
    measured,
    motions_or_pairs,
    spectrum_of,
    under,
    under_own_factors,
)
from rpscli.tools.selection.request import SelectionRequest
from rpscli.tools.selection.requirements import RULES, Requirements, Rule
from rpscli.tools.selection.search import Goal, Pool, best_choice

Array = NDArray[np.float64]

PERIODS = 60  # periods of comparison, spread evenly over the logarithm
FINER = 4  # times as many periods in the end, for the common factor and the verdicts

TWO = "has a sigma_ln, which takes two motions at least"


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
    sources = motions_or_pairs([*motions], request.of)
    every = [
        measured(sources[number], target.damping, periods, request.of)
        for number in watched(range(len(sources)))
    ]
    wanted = goal.wanted[1:]
    fits = [under_own_factors(one, target, periods, wanted, request) for one in every]
    best, whole = _best_set(every, fits, goal, target, request)

    # Codes ask for all periods: the common factor and the verdicts are from a finer grid.
    periods, goal = _goal(target, request, asked, FINER * PERIODS)
    chosen, common = _under_common_factor(best, periods, goal, target, request)
    found = Selection(target, request.of, periods, chosen, len(every), fits.count([]))
    found = replace(found, common=common, requirements=asked, whole=whole)
    return replace(found, rules=_verdicts(found, request))


def as_it_is(
    motions: Iterable[tuple[tuple[GroundMotion, ...], float]],
    target: TargetSpectrum,
    request: SelectionRequest,
) -> Selection:
    """A set under factors that are fixed already, beside a target and the rules of its
    code.
    """
    asked = None if target.deviation else RULES.get(request.rules or target.rules)
    periods, _ = _goal(target, request, asked, FINER * PERIODS)
    if request.count < 2 and target.deviation is not None:
        raise RecordError(f"{target.source}: {TWO}")
    chosen = [
        replace(measured(of, target.damping, periods, request.of), factor=factor)
        for of, factor in motions
    ]
    found = Selection(target, request.of, periods, tuple(chosen), len(chosen), 0)
    found = replace(found, requirements=asked, whole=True)
    return replace(found, rules=_verdicts(found, request))


def _best_set(
    every: list[Candidate],
    fits: list[list[Candidate]],
    goal: Goal,
    target: TargetSpectrum,
    request: SelectionRequest,
) -> tuple[list[Candidate], bool]:
    """The candidates that are chosen, in order; and true if all sets were looked at."""
    pool = _pool(every, fits, goal)
    _require_enough(pool, len(every), target, request)
    places, whole = best_choice(pool, goal, request.count, request.per_event)
    fitting = [one for scaled in fits for one in scaled]
    return [fitting[place] for place in places], whole


def _pool(every: list[Candidate], fits: list[list[Candidate]], goal: Goal) -> Pool:
    """Candidates under the factors that they may have, beside those without factors."""
    fitting = [one for scaled in fits for one in scaled]
    # Motions that were made as arrays have no source to go by.
    named = [one.motions[0].source for one in every]
    named = [f"array {i}" if name == "array" else name for i, name in enumerate(named)]
    recordings = np.repeat(clusters(named), [len(scaled) for scaled in fits])
    of_each = [one.motions[0].recording for one in fitting]
    events = np.array(events_among(of_each, recordings.tolist()), np.int64)
    return Pool(
        np.array([one.scaled for one in fitting]).reshape(-1, len(goal.wanted)),
        np.array([one.factor for one in fitting]),
        recordings,
        events,
    )


def _require_enough(
    pool: Pool, every: int, target: TargetSpectrum, request: SelectionRequest
) -> None:
    """Refuse a pool of which fewer may be chosen together than are wanted."""
    known = set(zip(pool.recordings.tolist(), pool.events.tolist(), strict=True))
    counts = Counter(event for _, event in known)
    room = sum(min(count, request.per_event) for count in counts.values())
    if request.count < 2 and target.deviation is not None:
        raise RecordError(f"{target.source}: {TWO}")
    if room < request.count:
        noun = "motions" if request.of == "component" else "pairs"
        raise RecordError(
            f"only {room} of {every} {noun} may be chosen together, {request.count} are"
            f" wanted: {len(known)} recordings keep within the factors"
            f" {request.factors[0]:g} to {request.factors[1]:g}, from {len(counts)}"
            f" events with at most {request.per_event} each, and of one recording one"
            " component is taken; give more motions or wider bounds"
        )


def _under_common_factor(
    best: list[Candidate],
    periods: Array,
    goal: Goal,
    target: TargetSpectrum,
    request: SelectionRequest,
) -> tuple[tuple[Candidate, ...], float]:
    """The set with its spectra at periods (n,) [s], under one factor more, and that."""
    spectra = [
        spectrum_of(one.motions, target.damping, periods, request.of) for one in best
    ]
    finer = [
        replace(one, acceleration=s[1:]) for one, s in zip(best, spectra, strict=True)
    ]
    features = goal.features(np.array([one.scaled for one in finer]))
    _, common = goal.of_set(features, np.array([one.factor for one in finer]))
    return tuple(under(common, one, request) for one in finer), common


def _verdicts(selection: Selection, request: SelectionRequest) -> tuple[Rule, ...]:
    """Every requirement of the code; none without one."""
    asked = selection.requirements
    if asked is None:
        return ()
    target = selection.target
    wanted = target.ground_acceleration or np.nan
    pga = float(np.mean([one.scaled[0] for one in selection.chosen]) / wanted)
    return asked.judged(
        len(selection.chosen), request.of, target.level, pga, selection.least_ratio,
        request.periods, request.structure,
    )  # fmt: skip


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
