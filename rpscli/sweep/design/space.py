"""Where a search looks: an even sample of the unit cube, then where the verdict changes."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from rpscli.case.study.schema import SampleSection
from rpscli.sweep.points.sampling import unit_cube

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MOST_CORNERS = 4
"""Unknowns up to which all corners of the cube are in the first sample."""

MOST_NEAR = 64
"""Other designs among which the neighbours of a design are looked for."""


def usual_count(unknowns: int) -> int:
    """Designs of the first sample, if the file does not say: 32, 64, 128 and so on, to 512."""
    return int(min(512, 2 ** (unknowns + 4)))


def first_places(unknowns: int, count: int, seed: int) -> Array:
    """(designs, unknowns) of the first sample.

    One unknown: equal steps from end to end. Several: a scrambled Sobol sequence after the corners,
    which are counted besides.
    """
    if unknowns == 1:
        return np.linspace(0.0, 1.0, count)[:, None]
    corners = list(itertools.product((0.0, 1.0), repeat=unknowns)) * (unknowns <= MOST_CORNERS)
    section = SampleSection.model_construct(size=count, seed=seed, ranges={})
    return np.array([*corners, *unit_cube(section, unknowns).tolist()])


def neighbours(places: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of designs between which no other lies: the ball over their distance is empty.

    This is the graph of Gabriel and Sokal; on a line it joins each design with the next.

    >>> [pair.tolist() for pair in neighbours(np.array([[0.0], [1.0], [0.4]]))]
    [[0, 1], [2, 2]]
    """
    from scipy.spatial.distance import cdist

    squares = np.asarray(cdist(places, places, "sqeuclidean"))
    pairs = {
        (min(one, other), max(one, other))
        for one in range(len(places))
        for other in _around(squares, one).tolist()
    }
    first, second = np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2).T
    return first, second


def _around(squares: Array, one: int) -> NDArray[np.int64]:
    """The neighbours of a design among the nearest others: whoever is between is nearer still."""
    near = np.argsort(squares[one], kind="stable")
    near = near[near != one][:MOST_NEAR]
    length = squares[one, near]
    between = length[:, None] + squares[np.ix_(near, near)] < length * (1.0 - 1e-12)
    return np.asarray(near[~between.any(axis=0)])


def next_places(
    places: Array, passes: Flags, aims: Array, best: int, resolution: float, count: int
) -> Array:
    """(new, unknowns) designs that tell most about where the verdict changes, at most `count`.

    They halve the distance between neighbours. Every second one goes where the verdict changes,
    long distances and those first in which it changes in many resamples as well; the others go to
    the neighbours of the best design, and between designs one of which passes and the other would
    be better.

    Parameters
    ----------
    places
        (designs, unknowns) of those that are known.
    passes
        (resamples, designs) verdicts; the first row is that of all records.
    aims
        (designs,) what is to be least, infinite where there is none.
    best
        Place of the best design, or of the one that fails least.
    resolution
        Distance below which neighbours are not parted.
    """
    first, second = neighbours(places)
    length = np.linalg.norm(places[first] - places[second], axis=1)
    change = (passes[:, first] != passes[:, second]).mean(axis=0)
    change = 0.5 * (change + (passes[0, first] != passes[0, second]))
    touches = (first == best) | (second == best)
    better = passes[0].any() & (np.minimum(aims[first], aims[second]) < aims[best])
    middle = 0.5 * (places[first] + places[second])
    parted = length > resolution
    everywhere = _ordered(middle, length * change * parted)
    chance = passes.mean(axis=0)
    promising = np.maximum(better * np.maximum(chance[first], chance[second]), 0.5 * touches)
    close = _ordered(middle, length * promising * parted)
    ends = np.repeat(places[best][None], 2 * places.shape[1], axis=0)
    for unknown in range(places.shape[1]):  # the best design, taken to the ends of its ranges
        ends[2 * unknown : 2 * unknown + 2, unknown] = 0.0, 1.0
    chosen: list[Array] = []
    for pair in itertools.zip_longest(everywhere, [*ends, *close]):
        for place in pair:
            if place is not None and len(chosen) < count:
                known = np.array([*places, *chosen])
                if np.linalg.norm(known - place, axis=1).min() > 0.49 * resolution:
                    chosen.append(place)
    return np.array(chosen).reshape(-1, places.shape[1])


def _ordered(places: Array, worth: Array) -> list[Array]:
    """Places of some worth, the worthiest first."""
    order = np.argsort(-worth, kind="stable")
    return [places[place] for place in order if worth[place] > 0.0]
