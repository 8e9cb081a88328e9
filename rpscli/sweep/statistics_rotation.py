"""Largest rotations of some systems against those of a reference (paper, Figure 7)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rpscli.case.study_reports import RotationOptions
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys


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
    """All panels, and how many pairs were left out because a point of them failed."""

    key: str
    reference: object
    panel_keys: tuple[str, ...]
    panels: tuple[RotationPanel, ...]
    failed: int


def rotation_report(table: Table, options: RotationOptions) -> RotationReport:
    """Pair the points of each system with those of the reference."""
    key = options.key or leading_keys(table.design)[-1]
    systems = groups(table.design, [key])
    wanted = [group for group in systems if group.values[0] == options.reference]
    reference = wanted[0] if wanted else systems[-1]
    others = tuple(group for group in systems if group is not reference)
    ratio = rotation_over_alpha(table)
    panel_keys = options.panels or ()
    panels = []
    failed = 0
    for panel in groups(table.design, panel_keys):
        found = []
        for other in others:
            pairs = _paired(panel.points, other.points, reference.points)
            bad = table.failed[pairs[0]] | table.failed[pairs[1]]
            failed += int(bad.sum())
            mine, theirs = (side[~bad] for side in pairs)
            found.append(Comparison(other.values[0], mine, theirs, ratio[theirs], ratio[mine]))
        panels.append(RotationPanel(panel.values, tuple(found)))
    return RotationReport(key, reference.values[0], panel_keys, tuple(panels), failed)


def rotation_over_alpha(table: Table) -> Array:
    """(points,) max|theta|/alpha; infinite where the structure overturned."""
    design = table.design
    alpha = np.array([facts.alpha for facts in design.facts])
    system = np.arange(len(design)) // design.points_of_system
    ratio = table.columns["max_rotation"] / alpha[system]
    return np.where(table.overturned, np.inf, ratio)


def _paired(within: Indices, mine: Indices, theirs: Indices) -> tuple[Indices, Indices]:
    """Points of both systems in the same place of all other axes, kept to a panel."""
    kept = np.isin(mine, within)
    return mine[kept], theirs[kept]
