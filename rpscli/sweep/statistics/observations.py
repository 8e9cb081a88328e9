"""Points of a study beside observations: which stand beside which, and how well they agree."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from pathlib import PurePath
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.case.study.observed import Observed, comparable
from rpscli.errors import beginning
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import Share, clustered, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY
from rpscli.sweep.table import Array, Indices, groups


class Pairs(NamedTuple):
    """Points (pairs,), what was observed (quantities, pairs), what was left out."""

    points: Indices
    values: Array
    notes: tuple[str, ...]


def observed_pairs(layout: StudyPoints, observed: Observed) -> Pairs:
    """Every point with the observation of its system and of its record by any of its names."""
    records = _record_numbers(layout)
    rows = {
        (records[row.record], row.system): place
        for place, row in enumerate(observed.rows)
        if row.record in records
    }
    points, places = [], []
    for group in groups(layout, observed.keys):
        system = tuple(map(comparable, observed.keys, group.values))
        row_of = np.array([rows.get((n, system), -1) for n in range(len(layout.records))])
        place = row_of[layout.places.record[group.points]]
        points.append(group.points[place >= 0])
        places.append(place[place >= 0])
    found, row = np.concatenate(points), np.concatenate(places)
    order = np.argsort(found, kind="stable")
    found, row = found[order], row[order]
    values = np.array([seen.values for seen in observed.rows]).T[:, row]
    notes = []
    if unused := len(observed.rows) - len(np.unique(row)):
        notes.append(
            f"{unused} of {len(observed.rows)} observations in {observed.name} have no point in"
            " the study: their record, or their system, is not in it"
        )
    if len(found) < len(layout):
        notes.append(f"{len(layout) - len(found)} of {len(layout)} points have no observation")
    return Pairs(found, values, tuple(notes))


def _record_numbers(layout: StudyPoints) -> dict[str, int]:
    """Numbers of the records by every name that one of them alone goes by."""
    sources = [record.source for record in layout.records if record is not None]
    names = [{s, PurePath(s).name, PurePath(s).stem} for s in sources]
    times = Counter(name for known in names for name in known)
    short = {name: n for n, known in enumerate(names) for name in known if times[name] == 1}
    return short | {source: number for number, source in enumerate(sources)}


def unpaired(layout: StudyPoints) -> Iterator[str]:
    """Reasons that keep a study from being compared with its observations."""
    observed = layout.study.observed
    if observed is None:
        yield "the study names no observations; add `observed: FILE.csv`"
    elif None in layout.records:
        yield "the study has no list `records`, by which observations are found; add it"
    elif len(layout.scales) > 1 and INTENSITY not in observed.keys:
        yield (
            f"the study has {len(layout.scales)} scales, and {observed.name} does not say which of"
            " them was observed; add a column `scale`, or keep one scale"
        )
    elif not len(observed_pairs(layout, observed).points):
        yield (
            f"no line of {observed.name} has a record and a system of the study, such as"
            f" {beginning(observed.rows[0].record)}; records go by their sources or the names of"
            " files"
        )


Flags = NDArray[np.bool_]


class Agreement(NamedTuple):
    """Counts of computed and observed outcomes, and the share of those that are the same."""

    both: int
    computed_only: int
    observed_only: int
    neither: int
    agreed: Share

    @property
    def counted(self) -> int:
        """All outcomes."""
        return self.agreed.of

    @property
    def computed(self) -> int:
        """Computed overturnings."""
        return self.both + self.computed_only

    @property
    def observed(self) -> int:
        """Observed overturnings."""
        return self.both + self.observed_only


class Maxima(NamedTuple):
    """Computed over observed maxima of one quantity.

    `median` and `dispersion` (standard deviation of the logarithm) are those of the `counted`
    ratios; `overturned` histories have none, and are infinite in the distance of Kolmogorov and
    Smirnov between both distributions.
    """

    counted: int
    overturned: int
    median: float
    dispersion: float
    distance: float


def agreement(computed: Flags, observed: Flags, cluster: Indices) -> Agreement:
    """Count the four pairs of outcomes, of clusters as `clustered` takes them."""
    cells = (computed & observed, computed & ~observed, ~computed & observed, ~computed & ~observed)
    a, b, c, d = (int(cell.sum()) for cell in cells)
    return Agreement(a, b, c, d, clustered(computed == observed, cluster))


def maxima(computed: Array, observed: Array) -> Maxima:
    """Compare maxima; computed ones are infinite where the structure overturned."""
    from scipy.stats import ks_2samp

    stood = np.isfinite(computed) & (computed > 0.0) & (observed > 0.0)
    logs = np.log(computed[stood] / observed[stood])
    return Maxima(
        counted=len(logs),
        overturned=int(np.isinf(computed).sum()),
        median=math.exp(fractiles(logs, [0.5])[0]),
        dispersion=float(np.std(logs, ddof=1)) if len(logs) > 1 else math.nan,
        distance=float(ks_2samp(computed, observed).statistic) if len(observed) else math.nan,
    )
