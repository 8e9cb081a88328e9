"""The report rotation: largest rotations of systems beside those of one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKey, VariedKeys
from rpscli.case.study.schema import Axis
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import listed
from rpscli.model.podium import Array
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.report import Found, Report, keyed, without_uplift
from rpscli.sweep.names import labels, with_names
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.grouping import (
    INTENSITY,
    Grouping,
    Histories,
    grouping,
    own_keys,
)
from rpscli.sweep.table import Indices, StoredPoints, groups, leading_keys


class RotationOptions(ReportOptions):
    """Largest rotations of several systems against those of one, record by record."""

    key: VariedKey | None = None
    """varied key in which they differ; the last axis"""
    reference: Any = Field(
        None, description="its value on the horizontal axis; the last one"
    )
    panels: VariedKeys | None = None
    """varied keys, one panel for each value; each intensity by default"""


class Paired(NamedTuple):
    """Points (pairs,) of a system and of the reference that differ
    in one key, all computed.
    """

    value: object
    points: Indices
    references: Indices
    failed: int


class _Compared(NamedTuple):
    """Systems beside the reference: panels with their pairs, and all ratios to alpha."""

    key: str
    reference: object
    found: Grouping
    shown: dict[Histories, list[Paired]]
    ratio: Array  # (points,) largest rotation over alpha, infinite where overturned
    others: int  # systems beside the reference

    @property
    def pairs(self) -> list[Paired]:
        """Those of all panels."""
        return [each for group in self.shown.values() for each in group]

    @property
    def ends(self) -> list[float]:
        """Of both axes, a little above what is drawn."""
        every = [each.references for each in self.pairs], [p.points for p in self.pairs]
        drawn = (self.ratio[np.concatenate(points)] for points in every)
        return [
            1.08 * float(each[np.isfinite(each)].max(initial=0.0)) or 1.0
            for each in drawn
        ]


def rotation(study: StoredPoints, options: RotationOptions) -> Found:
    """Largest rotations over alpha of each system and of the reference (paper, Figure
    7).
    """
    compared = _compared(study, options)
    names, rows = _rows(study, compared)
    heads = f"outcome, rotation_over_alpha, reference {compared.key}, reference_outcome"
    return Found(
        {"": keyed(names, f"{heads}, reference_rotation_over_alpha", rows)},
        _figure(study.table.layout, compared),
    )


def _compared(study: StoredPoints, options: RotationOptions) -> _Compared:
    """Pair the points of each system with those of the reference."""
    table = study.table
    layout = table.layout
    leading = leading_keys(layout)
    key = options.key or leading[-1]
    systems = groups(layout, [key])
    wanted = [group for group in systems if group.values[0] == options.reference]
    reference = (wanted or systems[-1:])[0]
    # Each intensity has a panel, unless the study says otherwise.
    keys = own_keys(layout, leading) if options.panels is None else options.panels
    found = grouping(table, keys, leading)
    shown: dict[Histories, list[Paired]] = {}
    for within in found.groups:
        shown[within] = []
        for system in (each for each in systems if each is not reference):
            kept = np.isin(system.points, within.every)
            mine = system.points[kept]
            theirs = reference.points[kept]
            bad = table.failed[mine] | table.failed[theirs]
            pair = Paired(system.values[0], mine[~bad], theirs[~bad], int(bad.sum()))
            shown[within].append(pair)
    alpha = np.array([properties.alpha for properties in layout.properties])
    of_point = alpha[np.arange(len(table)) // layout.points_of_system]
    ratio = np.where(table.overturned, np.inf, table.columns["max_rotation"] / of_point)
    return _Compared(key, reference.values[0], found, shown, ratio, len(systems) - 1)


def _rows(study: StoredPoints, compared: _Compared) -> tuple[list[str], list[Any]]:
    """One row a pair; a rotation is empty where the structure overturned."""
    table = study.table
    layout = table.layout
    factors = len(layout.scales) > 1 and layout.plan.measure is None
    rows = []
    names = list[str]()
    for each in compared.pairs:
        both = zip(each.points.tolist(), each.references.tolist(), strict=True)
        for mine, theirs in both:
            scale = {INTENSITY: layout[mine].scale} if factors else {}
            named = layout.described(mine) | scale
            names = list(named)
            ours, other = (
                (table.outcomes[n], float(compared.ratio[n])) for n in (mine, theirs)
            )
            rows.append((tuple(named.values()), *ours, compared.reference, *other))
    return names, rows


def _figure(layout: StudyPoints, compared: _Compared) -> Any:
    """The figure: markers of pairs, open ones at the frame where one overturned."""
    ends = compared.ends
    count = compared.others
    key = with_names(layout.study.axes, compared.key)

    def draw(axes: style.Axes, group: Histories) -> None:
        for place, each in enumerate(compared.shown[group]):
            x, y = both = compared.ratio[each.references], compared.ratio[each.points]
            stood = np.isfinite(x) & np.isfinite(y)
            look = panels.look(place, count) | {"ls": "", "ms": 3.2}
            axes.plot(
                x[stood], y[stood], **look, alpha=0.75, label=labels([key], [each.value])
            )
            at_frame = [
                np.minimum(of[~stood], end) for of, end in zip(both, ends, strict=True)
            ]
            (fell,) = axes.plot(
                *at_frame, **look, mfc="none", mew=0.9, clip_on=False, zorder=3
            )
            fell.set_in_layout(False)
        axes.plot([0.0, min(ends)], [0.0, min(ends)], "k--", lw=0.8)

    name = r"$|\theta_{max}|/\alpha$ [-]"
    failed = sum(each.failed for each in compared.pairs)
    return panels.in_panels(
        compared.found.keys,
        compared.found.groups,
        draw,
        x_label=f"{name}, {labels([key], [compared.reference])}",
        y_label=f"{name}, the others",
        limits=lambda axes: axes.set(xlim=(0.0, ends[0]), ylim=(0.0, ends[1])),
        note=panels.noted(
            compared.found,
            "open markers: overturned",
            panels.shaded(count),
            failed=failed,
        ),
    )


def unknown_reference(
    _document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A reference that its key does not take, or no key at all."""
    options = request.options
    report = f"the report {request.kind}"
    assert isinstance(options, RotationOptions), "requests have the options of their kind"
    of_key = [axis for axis in axes if options.key is None or options.key in axis.keys][
        -1:
    ]
    if not of_key:
        yield Fault(request.path, f"{report} needs a varied key: systems to compare")
        return
    place = of_key[0].keys.index(options.key) if options.key else 0
    key = of_key[0].keys[place]
    values = [row[place] for row in of_key[0].rows]
    if len({repr(value) for value in values}) < 2:
        yield Fault(
            request.path,
            f"{report} compares systems, but {key} has one value;"
            " give it another one, or the report another `key`",
        )
    if options.reference is not None and options.reference not in values:
        path: Path = (*request.path, request.kind, "reference")
        text = f"{dotted(path)} = {shown(options.reference)} is not a value of {key}"
        yield Fault(path, f"{text}, which takes {listed(map(shown, values), 'and')}")


REPORT = Report(
    RotationOptions, rotation, check=unknown_reference, requires=without_uplift
)
