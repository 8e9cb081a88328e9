"""Regions of designs that hold: which designs are neighbours, and between which others fail."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.sweep.table import Array, Indices

MOST_NEAR = 64
"""Other designs among which the neighbours of a design are looked for."""


def neighbours(places: Array) -> tuple[Indices, Indices]:
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


def _around(squares: Array, one: int) -> Indices:
    """The neighbours of a design among the nearest others: whoever is between is nearer still."""
    near = np.argsort(squares[one], kind="stable")
    near = near[near != one][:MOST_NEAR]
    length = squares[one, near]
    between = length[:, None] + squares[np.ix_(near, near)] < length * (1.0 - 1e-12)
    return np.asarray(near[~between.any(axis=0)])


def regions(places: Array, holds: NDArray[np.bool_], even: int) -> list[Indices]:
    """Designs (designs, unknowns) that hold, apart where others lie between; the main one first.

    With one unknown that is the longest of those that reach an end of the range, or of all where
    none does: from its inner end on all others hold. With several it is the one with most of the
    first, `even` sample.

    >>> line = np.linspace(0.0, 1.0, 6)[:, None]
    >>> [part.tolist() for part in regions(line, np.array([0, 1, 1, 1, 0, 1], dtype=bool), 6)]
    [[5], [1, 2, 3]]
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    first, second = neighbours(places)
    kept = holds[first] & holds[second]
    size = len(places)
    graph = coo_array((np.ones(kept.sum()), (first[kept], second[kept])), shape=(size, size))
    _, part = connected_components(graph, directed=False)
    found = [np.flatnonzero(holds & (part == number)) for number in np.unique(part[holds])]

    def worth(members: Indices) -> tuple[bool, float, int]:
        if places.shape[1] > 1:
            return False, float((members < even).sum()), len(members)
        at = places[members, 0]
        return bool(at.min() <= 0.0 or at.max() >= 1.0), float(np.ptp(at)), len(members)

    return sorted(found, key=worth, reverse=True)
