"""Largest rotations of systems against those of a reference, record by record (paper, Figure 7)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKey, VariedKeys
from rpscli.case.study.schema import Axis
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import listed
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.labels import keyed, label
from rpscli.report.study.report import Found, Report, without_uplift
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping, own_keys
from rpscli.sweep.table import Group, Indices, StudyResults, groups, leading_keys


class RotationOptions(ReportOptions):
    """Largest rotations of several systems against those of one, record by record."""

    key: VariedKey | None = None
    """varied key in which they differ; the last axis"""
    reference: Any = Field(None, description="its value on the horizontal axis; the last one")
    panels: VariedKeys | None = None
    """varied keys, one panel for each value; each intensity by default"""


class Pairs(NamedTuple):
    """Points (pairs,) of a system and of the reference that differ in one key, all computed."""

    value: object
    points: Indices
    references: Indices
    failed: int


def rotation(study: StudyResults, options: RotationOptions) -> Found:
    """Largest rotations over alpha of each system and of the reference."""
    table, layout = study.table, study.table.layout
    leading = leading_keys(layout)
    key = options.key or leading[-1]
    systems = groups(layout, [key])
    wanted = [group for group in systems if group.values[0] == options.reference]
    reference = wanted[0] if wanted else systems[-1]
    # Each intensity has a panel, unless the study says otherwise.
    keys = own_keys(layout, leading) if options.panels is None else options.panels
    found = grouping(table, keys, leading)

    def paired(system: Group, within: Histories) -> Pairs:
        kept = np.isin(system.points, within.every)
        mine, theirs = system.points[kept], reference.points[kept]
        bad = table.failed[mine] | table.failed[theirs]
        return Pairs(system.values[0], mine[~bad], theirs[~bad], int(bad.sum()))

    others = [system for system in systems if system is not reference]
    shown = {group: [paired(system, group) for system in others] for group in found.groups}
    pairs, count = [each for group in shown.values() for each in group], len(others)
    alpha = np.array([properties.alpha for properties in layout.properties])
    ratio = table.columns["max_rotation"] / alpha[np.arange(len(table)) // layout.points_of_system]
    ratio = np.where(table.overturned, np.inf, ratio)
    every = [[each.references for each in pairs], [each.points for each in pairs]]
    x_top, y_top = (
        1.08 * float(drawn[np.isfinite(drawn)].max(initial=0.0)) or 1.0
        for drawn in (ratio[np.concatenate(points)] for points in every)
    )

    def draw(axes: style.Axes, group: Histories) -> None:
        for place, each in enumerate(shown[group]):
            x, y = ratio[each.references], ratio[each.points]
            stood = np.isfinite(x) & np.isfinite(y)
            look: dict[str, Any] = {"color": panels.colour(place, count), "ls": "", "ms": 3.2}
            look["marker"] = panels.marker(place)
            axes.plot(x[stood], y[stood], **look, alpha=0.75, label=label(key, each.value))
            (fell,) = axes.plot(
                np.minimum(x[~stood], x_top), np.minimum(y[~stood], y_top), **look,
                mfc="none", mew=0.9, clip_on=False, zorder=3,
            )  # fmt: skip
            fell.set_in_layout(False)  # on the frame
        axes.plot([0.0, min(x_top, y_top)], [0.0, min(x_top, y_top)], "k--", lw=0.8)

    # One row a pair; a rotation is empty where the structure overturned.
    factors = len(layout.scales) > 1 and layout.plan.measure is None
    rows, names = [], list[str]()
    for each in pairs:
        for mine, theirs in zip(each.points.tolist(), each.references.tolist(), strict=True):
            named = layout.described(mine) | ({INTENSITY: layout[mine].scale} if factors else {})
            names = list(named)
            ours, other = ((table.outcomes[n], float(ratio[n])) for n in (mine, theirs))
            rows.append((tuple(named.values()), *ours, reference.values[0], *other))
    heads = (
        "outcome", "rotation_over_alpha", f"reference {key}", "reference_outcome",
        "reference_rotation_over_alpha",
    )  # fmt: skip
    remarks = "open markers: overturned", panels.shaded(count)
    words: dict[str, Any] = {
        "x_label": rf"$|\theta_{{max}}|/\alpha$ [-], {label(key, reference.values[0])}",
        "y_label": r"$|\theta_{max}|/\alpha$ [-], the others",
        "limits": lambda axes: axes.set(xlim=(0.0, x_top), ylim=(0.0, y_top)),
        "note": panels.noted(found, *remarks, failed=sum(each.failed for each in pairs)),
    }
    return Found(
        {"": keyed(names, dict.fromkeys(heads, "-"), rows)},
        panels.in_panels(found.keys, found.groups, draw, **words),
    )


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
        return
    place = axis.keys.index(options.key) if options.key else 0
    values = [row[place] for row in axis.rows]
    if len({repr(value) for value in values}) < 2:
        yield Fault(
            request.path,
            f"the report {request.kind} compares systems, but {axis.keys[place]} has one value;"
            " give it another one, or the report another `key`",
        )
    if options.reference is not None and options.reference not in values:
        path: Path = (*request.path, request.kind, "reference")
        text = f"{dotted(path)} = {shown(options.reference)} is not a value of {axis.keys[place]}"
        yield Fault(path, f"{text}, which takes {listed(map(shown, values), 'and')}")


REPORT = Report(RotationOptions, rotation, check=unknown_reference, requires=without_uplift)
