"""Largest rotations of some systems against those of a reference (paper, Figure 7)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.schema.fields import Text
from rpscli.case.study.axes import Axis
from rpscli.case.study.reports import ReportOptions, ReportRequest
from rpscli.case.study.schema import Keys
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import listed
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys


class RotationOptions(ReportOptions):
    """Largest rotations of several systems against those of one, record by record."""

    key: Text | None = Field(None, description="varied key in which they differ; the last axis")
    reference: Any = Field(None, description="its value on the horizontal axis; the last one")
    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


class Comparison(NamedTuple):
    """One system against the reference, point by point; arrays (points,) of max|theta|/alpha.

    Infinite where a structure overturned.
    """

    value: object
    points: Indices
    reference_points: Indices
    reference: Array
    rotation: Array


@dataclass(frozen=True)
class RotationPanel:
    """Comparisons within one group of systems."""

    values: tuple[object, ...]
    comparisons: tuple[Comparison, ...]


@dataclass(frozen=True)
class RotationReport:
    """All panels, how many pairs were left out because a point of them failed, and all points."""

    key: str
    reference: object
    panel_keys: tuple[str, ...]
    panels: tuple[RotationPanel, ...]
    failed: int
    table: Table


def rotation_report(table: Table, options: RotationOptions) -> RotationReport:
    """Pair the points of each system with those of the reference."""
    key = options.key or leading_keys(table.layout)[-1]
    systems = groups(table.layout, [key])
    wanted = [group for group in systems if group.values[0] == options.reference]
    reference = wanted[0] if wanted else systems[-1]
    others = tuple(group for group in systems if group is not reference)
    ratio = rotation_over_alpha(table)
    panel_keys = options.panels or ()
    panels = []
    failed = 0
    for panel in groups(table.layout, panel_keys):
        found = []
        for other in others:
            pairs = paired(panel.points, other.points, reference.points)
            bad = table.failed[pairs[0]] | table.failed[pairs[1]]
            failed += int(bad.sum())
            mine, theirs = (side[~bad] for side in pairs)
            found.append(Comparison(other.values[0], mine, theirs, ratio[theirs], ratio[mine]))
        panels.append(RotationPanel(panel.values, tuple(found)))
    return RotationReport(key, reference.values[0], panel_keys, tuple(panels), failed, table)


def rotation_over_alpha(table: Table) -> Array:
    """(points,) max|theta|/alpha; infinite where the structure overturned."""
    layout = table.layout
    alpha = np.array([properties.alpha for properties in layout.properties])
    system = np.arange(len(layout)) // layout.points_of_system
    ratio = table.columns["max_rotation"] / alpha[system]
    return np.where(table.overturned, np.inf, ratio)


def paired(within: Indices, mine: Indices, theirs: Indices) -> tuple[Indices, Indices]:
    """Points of both systems in the same place of all other axes, kept to a panel."""
    kept = np.isin(mine, within)
    return mine[kept], theirs[kept]


def unknown_reference(
    _document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A reference that its key does not take, or no key at all."""
    options = request.options
    assert isinstance(options, RotationOptions), "requests have the options of their kind"
    axis = axes[-1] if axes else None
    if options.key is not None:
        axis = next((axis for axis in axes if options.key in axis.keys), None)
    if axis is None:
        yield Fault(
            request.path, f"the report {request.kind} needs a varied key: systems to compare"
        )
    elif options.reference is not None:
        place = axis.keys.index(options.key) if options.key else 0
        values = [row[place] for row in axis.rows]
        if options.reference not in values:
            path: Path = (*request.path, request.kind, "reference")
            text = f"{dotted(path)} = {shown(options.reference)} is no value of {axis.keys[place]}"
            yield Fault(path, f"{text}, which takes {listed(map(shown, values), 'and')}")
