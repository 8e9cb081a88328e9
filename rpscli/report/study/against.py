"""Systems against a reference that differs in one key alone, record by record.

`rotation` draws every pair (paper, Figure 7); `contrast` maps the ratios of results.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.analyses.result_quantities import DEMANDS
from rpscli.case.study.axes import Axis
from rpscli.case.study.reports import ReportOptions, ReportRequest, VariedKey, VariedKeys
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import listed
from rpscli.report.figures import style
from rpscli.report.study.labels import Values, axis_label, keyed, label, labels, plain
from rpscli.report.study.panels import colour, in_panels, marker, noted
from rpscli.report.study.report import DemandName, Found, Report, without_uplift
from rpscli.report.study.statistics import share_columns
from rpscli.report.table import Column
from rpscli.sweep.points.layout import described
from rpscli.sweep.statistics.fractiles import Share, fractiles
from rpscli.sweep.statistics.grouping import INTENSITY, Histories, grouping, own_keys
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Array, Group, Indices, Table, groups, leading_keys

FRACTILES = {"16 %": 0.16, "median": 0.50, "84 %": 0.84}
SCALES = (2.0, 5.0, 10.0, 20.0, 30.0)
"""Changes at which the colours may end [%]."""
FEW_COLUMNS, LONG_NAME, MOST_LETTERS = 4, 10, 14
"""Columns of a map, whose names have room side by side; letters that have none, and the most."""


class RotationOptions(ReportOptions):
    """Largest rotations of several systems against those of one, record by record."""

    key: VariedKey | None = None
    """varied key in which they differ; the last axis"""
    reference: Any = Field(None, description="its value on the horizontal axis; the last one")
    panels: VariedKeys | None = None
    """varied keys, one panel for each value; each intensity by default"""


class ContrastOptions(RotationOptions):
    """How far results change with one key: median over the motions, in a map of other keys."""

    reference: Any = Field(None, description="the key's value that is compared with; the first one")
    value: Any = Field(None, description="the key's value that is compared; the first other one")
    rows: VariedKeys = Field(description="varied keys down each map")
    columns: VariedKeys = Field(description="varied keys across each map")
    results: tuple[DemandName, ...] = ("rotation_ratio", "base_shear_ratio")
    """results of which ratios are formed"""


class Pairs(NamedTuple):
    """Points (pairs,) in the same place of all axes but one, of which both were computed."""

    value: object
    points: Indices
    references: Indices
    failed: int


def pairs_of(table: Table, system: Group, reference: Group, within: Indices) -> Pairs:
    """Points of a system among some points, each with that of the reference."""
    kept = np.isin(system.points, within)
    mine, theirs = system.points[kept], reference.points[kept]
    bad = table.failed[mine] | table.failed[theirs]
    return Pairs(system.values[0], mine[~bad], theirs[~bad], int(bad.sum()))


def rotation(study: StudyResults, options: RotationOptions) -> Found:
    """Largest rotations over alpha of each system and of the reference."""
    table, layout = study.table, study.table.layout
    leading = leading_keys(layout)
    key = options.key or leading[-1]
    systems = groups(layout, [key])
    wanted = [group for group in systems if group.values[0] == options.reference]
    reference = wanted[0] if wanted else systems[-1]
    # Each intensity has a panel, unless the study says else.
    keys = own_keys(layout, leading) if options.panels is None else options.panels
    found = grouping(table, keys, leading)
    panels = {
        group: [
            pairs_of(table, system, reference, group.every)
            for system in systems
            if system is not reference
        ]
        for group in found.groups
    }
    pairs = [each for group in panels.values() for each in group]
    alpha = np.array([properties.alpha for properties in layout.properties])
    ratio = table.columns["max_rotation"] / alpha[np.arange(len(table)) // layout.points_of_system]
    ratio = np.where(table.overturned, np.inf, ratio)
    x_top, y_top = (
        1.08 * float(ratio[points[np.isfinite(ratio[points])]].max(initial=0.0)) or 1.0
        for points in (
            np.concatenate([each.references for each in pairs]),
            np.concatenate([each.points for each in pairs]),
        )
    )
    against = label(key, reference.values[0])

    def draw(axes: style.Axes, group: Histories) -> None:
        for place, each in enumerate(panels[group]):
            x, y = ratio[each.references], ratio[each.points]
            stood = np.isfinite(x) & np.isfinite(y)
            look: dict[str, Any] = {
                "color": colour(place), "marker": marker(place), "ls": "", "ms": 3.2
            }  # fmt: skip
            axes.plot(x[stood], y[stood], **look, alpha=0.75, label=label(key, each.value))
            axes.plot(
                np.minimum(x[~stood], x_top), np.minimum(y[~stood], y_top), **look,
                mfc="none", mew=0.9, clip_on=False, zorder=3,
            )  # fmt: skip
        axes.plot([0.0, min(x_top, y_top)], [0.0, min(x_top, y_top)], "k--", lw=0.8)

    return Found(
        {"": _pair_columns(table, ratio, pairs, key, reference.values[0])},
        in_panels(
            found.keys,
            found.groups,
            draw,
            x_label=rf"$|\theta_{{max}}|/\alpha$ [-], {against}",
            y_label=r"$|\theta_{max}|/\alpha$ [-], the others",
            limits=lambda axes: axes.set(xlim=(0.0, x_top), ylim=(0.0, y_top)),
            note=noted(
                found, "open markers: overturned", failed=sum(each.failed for each in pairs)
            ),
        ),
    )


def _pair_columns(
    table: Table, ratio: Array, pairs: Sequence[Pairs], key: str, reference: object
) -> list[Column]:
    """One row a pair; a rotation is empty where the structure overturned."""
    layout = table.layout
    factors = len(layout.scales) > 1 and layout.plan.measure is None
    rows = []
    names: tuple[str, ...] = ()
    for each in pairs:
        for mine, theirs in zip(each.points.tolist(), each.references.tolist(), strict=True):
            named = described(layout, mine) | ({INTENSITY: layout[mine].scale} if factors else {})
            names = tuple(named)
            ours, other = ((table.outcomes[n], float(ratio[n])) for n in (mine, theirs))
            rows.append((tuple(named.values()), *ours, reference, *other))
    heads = (
        "outcome", "rotation_over_alpha", f"reference {key}", "reference_outcome",
        "reference_rotation_over_alpha",
    )  # fmt: skip
    return keyed(names, dict.fromkeys(heads, "-"), rows)


def contrast(study: StudyResults, options: ContrastOptions) -> Found:
    """Ratios of results record by record, where both stood, and shares of what overturned."""
    table, layout = study.table, study.table.layout
    key = options.key or leading_keys(layout)[-1]
    systems = groups(layout, [key])
    values = [system.values[0] for system in systems]
    reference = systems[0 if options.reference is None else values.index(options.reference)]
    system = next(
        each
        for each in systems
        if (each is not reference if options.value is None else each.values[0] == options.value)
    )
    inner = (*options.rows, *options.columns)
    panels = options.panels
    if panels is None:
        panels = own_keys(layout, (*leading_keys(layout), *inner))
    found = grouping(table, (*panels, *inner), (key,), reference.points)
    cells = [
        _cell(options, group, pairs_of(table, reference, system, group.every))
        for group in found.groups
    ]
    columns = keyed(
        found.keys, {"pairs": "-", "failed": "-"},
        [(cell.values, cell.pairs, cell.failed) for cell in cells],
    )  # fmt: skip
    for place, name in enumerate(options.results):
        for row, fractile in enumerate(FRACTILES):
            ratios = [float(cell.ratios[place, row]) for cell in cells]
            columns.append(Column(f"ratio of {name}; {fractile}", "-", ratios))
        behind = [cell.behind[place] for cell in cells]
        columns.append(Column(f"ratio of {name}; pairs", "-", behind))
    for place, name in enumerate(("overturned", "reference_overturned")):
        columns += share_columns(name, [cell.overturned[place] for cell in cells])
    about = f"{plain(system.values[0])} over {plain(reference.values[0])}, median over the motions"
    counts = sorted({cell.pairs for cell in cells})
    counted = f"{' to '.join(map(str, dict.fromkeys((counts[0], counts[-1]))))} pairs in each cell"
    note = noted(found, failed=sum(cell.failed for cell in cells))
    return Found(
        {"": columns},
        lambda title: _maps(options, found.keys, cells, [title, about, counted, note]),
        [*found.notes, *_left_out_of_ratios(cells)],
    )


class Contrast(NamedTuple):
    """One cell of the map: pairs that were computed, and how many were not.

    `ratios` (results, 3) are fractiles of the result over that of the reference, of the `behind`
    (results,) pairs of which both stood; NaN without any. `overturned` are the shares of both.
    """

    values: tuple[object, ...]
    pairs: int
    failed: int
    ratios: Array
    behind: list[int]
    overturned: tuple[Share, Share]


def _cell(options: ContrastOptions, group: Histories, pairs: Pairs) -> Contrast:
    """Of points of the reference, each with that of the system that is compared."""
    table, theirs, ours = group.table, pairs.points, pairs.references
    stood = ~(table.overturned[ours] | table.overturned[theirs])
    ratios, behind = [], []
    for name in options.results:
        ours_, theirs_ = (table.columns[name][side[stood]] for side in (ours, theirs))
        ratio = ours_[theirs_ > 0.0] / theirs_[theirs_ > 0.0]
        ratios.append(fractiles(ratio, list(FRACTILES.values())))
        behind.append(int((~np.isnan(ratio)).sum()))
    both = Histories(table, (), ours).overturned, Histories(table, (), theirs).overturned
    return Contrast(group.values, len(ours), pairs.failed, np.array(ratios), behind, both)


def _left_out_of_ratios(cells: Sequence[Contrast]) -> Iterator[str]:
    """Pairs without a ratio: a history overturned, or that of the reference has nothing."""
    pairs = sum(cell.pairs for cell in cells)
    without = pairs - sum(min(cell.behind, default=cell.pairs) for cell in cells)
    if without:
        yield (
            "ratios are those of pairs in which both stood and the reference is not 0:"
            f" {without} of {pairs} pairs have none; the shares that overturned are of all pairs"
        )


def _maps(
    options: ContrastOptions, keys: Sequence[str], cells: Sequence[Contrast], words: Sequence[str]
) -> bytes:
    """One map a result and group of systems; the last row of maps is overturning."""
    down = len(keys) - len(options.columns)
    ahead = down - len(options.rows)
    panels, rows, columns = (
        list(dict.fromkeys(cell.values[part] for cell in cells))
        for part in (slice(ahead), slice(ahead, down), slice(down, None))
    )
    named = {quantity.name: quantity.label for quantity in DEMANDS}
    names = [*(named[name] for name in options.results), "overturned, of 100"]
    changes = np.full((len(names), len(panels), len(rows), len(columns)), np.nan)
    for cell in cells:
        at = cell.values
        place = panels.index(at[:ahead]), rows.index(at[ahead:down]), columns.index(at[down:])
        overturned, reference = (share.fraction or 0.0 for share in cell.overturned)
        fallen = overturned - reference if cell.pairs else np.nan
        changes[:, *place] = 100.0 * np.append(cell.ratios[:, 1] - 1.0, fallen)
    largest = np.nanmax(np.abs(changes), initial=0.0)
    strongest = next((end for end in SCALES if end >= largest), SCALES[-1])
    ends: Literal["both", "neither"] = "both" if largest > strongest else "neither"

    def draw(figure: style.Figure) -> None:
        style.heading(figure, *words)
        grid = figure.subplots(len(names), len(panels), squeeze=False, sharex=True, sharey=True)
        for (line, place), axes in np.ndenumerate(grid):
            image = axes.imshow(
                changes[line, place], cmap="RdBu_r", vmin=-strongest, vmax=strongest, aspect="auto"
            )
            axes.grid(visible=False)
            axes.tick_params(length=0)
            if line == 0:
                axes.set_title(labels(keys[:ahead], panels[place]))
            if place == 0:
                axes.set_ylabel(f"{names[line]}\n{', '.join(map(axis_label, keys[ahead:down]))}")
        small = style.small()
        ticks = list(map(_ticked, columns))
        longest = max(map(len, ticks))
        turned = 90 if len(columns) > FEW_COLUMNS or longest > LONG_NAME else 0
        for axes in grid[:, 0]:
            axes.set_yticks(range(len(rows)), list(map(_ticked, rows)), fontsize=small)
        for axes in grid[-1]:
            axes.set_xticks(range(len(columns)), ticks, fontsize=small, rotation=turned)
            axes.set_xlabel(", ".join(map(axis_label, keys[down:])))
        figure.colorbar(image, ax=grid, label="change [%]", shrink=0.6, extend=ends)

    return style.picture(draw, 1.0 + len(names) * max(1.4, 0.12 * len(rows)))


def _ticked(values: Values) -> str:
    """Values beside a map; of long names, such as those of records, the end, where they differ."""
    text = ", ".join(plain(value) for value in values)
    return text if len(text) <= MOST_LETTERS else f"…{text[-MOST_LETTERS:]}"


def unknown_reference(
    _document: Document, axes: Sequence[Axis], request: ReportRequest
) -> Iterator[Fault]:
    """A reference or a value that its key does not take, or no key at all."""
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
    for option in ("reference", "value"):
        if (given := getattr(options, option, None)) is not None and given not in values:
            path: Path = (*request.path, request.kind, option)
            text = f"{dotted(path)} = {shown(given)} is not a value of {axis.keys[place]}"
            yield Fault(path, f"{text}, which takes {listed(map(shown, values), 'and')}")


ROTATION = Report(RotationOptions, rotation, check=unknown_reference, requires=without_uplift)
CONTRAST = Report(
    ContrastOptions, contrast, check=unknown_reference, results=lambda options: options.results
)
