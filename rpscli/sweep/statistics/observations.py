"""Which points of a study stand beside which observations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from rpscli.case.study.observed import Observed, comparable
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.grouping import INTENSITY
from rpscli.sweep.table import Array, Indices, groups


class Pairs(NamedTuple):
    """Points with an observation, in the order of the study.

    `points` and `records` (pairs,) are numbers of points and of their records, `values`
    (quantities, pairs) what was observed, NaN where nothing was. `notes` tell what was left out.
    """

    points: Indices
    records: Indices
    values: Array
    notes: tuple[str, ...]


def observed_pairs(layout: StudyPoints, observed: Observed) -> Pairs:
    """Pair every point with the observation of its record and system.

    Parameters
    ----------
    layout
        A study with a list of records.
    observed
        Its observations; a record goes by its source, its file's name, or that without its suffix.
    """
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
        place = row_of[record_of(layout, group.points)]
        points.append(group.points[place >= 0])
        places.append(place[place >= 0])
    found, row = np.concatenate(points), np.concatenate(places)
    order = np.argsort(found, kind="stable")
    found, row = found[order], row[order]
    values = np.array([seen.values for seen in observed.rows]).T[:, row]
    notes = _left_out(layout, observed, found, row)
    return Pairs(found, record_of(layout, found), values, tuple(notes))


def record_of(layout: StudyPoints, points: Indices) -> Indices:
    """(points,) number of the record of each point."""
    of_system = layout.points_of_system
    return points % of_system // (of_system // len(layout.records))


def _record_numbers(layout: StudyPoints) -> dict[str, int]:
    """Numbers of the records by every name that one of them alone goes by."""
    sources = [record.source for record in layout.records if record is not None]
    names = [{s, PurePath(s).name, PurePath(s).stem} for s in sources]
    times = Counter(name for known in names for name in known)
    short = {name: n for n, known in enumerate(names) for name in known if times[name] == 1}
    return short | {source: number for number, source in enumerate(sources)}


def _left_out(
    layout: StudyPoints, observed: Observed, points: Indices, rows: Indices
) -> Iterator[str]:
    unused = len(observed.rows) - len(np.unique(rows))
    if unused:
        yield (
            f"{unused} of {len(observed.rows)} observations in {observed.name} have no point in"
            " the study: their record, or their system, is not in it"
        )
    if len(points) < len(layout):
        yield f"{len(layout) - len(points)} of {len(layout)} points have no observation"


def unpaired(layout: StudyPoints) -> Iterator[str]:
    """What keeps a study from being compared with its observations."""
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
            f" {observed.rows[0].record!r}; records go by their sources or the names of files"
        )
