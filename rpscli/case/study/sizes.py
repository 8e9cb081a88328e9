"""How large a study may be: told before its points are laid out."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from rpscli.case.study.axes import Axis
from rpscli.case.study.schema import MeasureScale, StudyFile
from rpscli.case.text.faults import Fault, Path

MOST_SYSTEMS = 200_000
"""Each is checked as a case before anything runs, which takes a millisecond."""

MOST_POINTS = 5_000_000
"""Their results, some thirty numbers each, are in memory when reports are drawn."""

MOST_SOURCES = 100_000
"""Ground motions that the options of one pattern may stand for."""


def size_faults(file: StudyFile, axes: Sequence[Axis], sources: Sequence[str]) -> Iterator[Fault]:
    """A study that is too large, at its largest part.

    Parameters
    ----------
    file
        The study.
    axes
        Its varied keys.
    sources
        Its single record sources.
    """
    systems: dict[Path, int] = {("vary", i): len(axis.rows) for i, axis in enumerate(axes)}
    if file.sample is not None:
        systems["sample", "size"] = file.sample.size
    others: dict[Path, int] = {("records",): max(len(sources), 1)}
    if file.scale is not None:
        values = file.scale.values if isinstance(file.scale, MeasureScale) else file.scale
        others["scale",] = len(values)
    if file.perturb is not None:
        others["perturb", "members"] = file.perturb.members
    for parts, most, name in (
        (systems, MOST_SYSTEMS, "systems"),
        (systems | others, MOST_POINTS, "points"),
    ):
        if (count := math.prod(parts.values())) > most:
            product = " x ".join(str(part) for part in parts.values() if part > 1)
            largest = max(parts, key=lambda path: parts[path])
            yield Fault(
                largest,
                f"the study has {count} {name} ({product}), which must not be more than {most};"
                " use fewer values, or several studies",
            )
            return
