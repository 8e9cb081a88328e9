"""Results of systems over those of others that differ from them in one key alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.analyses.result_quantities import DEMANDS
from rpscli.case.study.schema import Keys
from rpscli.sweep.reports.rotation import RotationOptions, paired
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys

if TYPE_CHECKING:
    ResultNames = tuple[str, ...]
else:
    ResultNames = tuple[Literal[tuple(quantity.name for quantity in DEMANDS)], ...]

FRACTILES = (0.16, 0.50, 0.84)


class ContrastOptions(RotationOptions):
    """How far results change with one key: median over the motions, in a map of other keys."""

    value: Any = Field(None, description="the key's value that is compared; the first other one")
    rows: Keys = Field(description="varied keys down each map")
    columns: Keys = Field(description="varied keys across each map")
    results: ResultNames = Field(
        ("rotation_ratio", "base_shear_ratio"), description="results of which ratios are formed"
    )


class Contrast(NamedTuple):
    """One cell of the map.

    `values` are those of the keys of panels, rows and columns. `ratios` (results, 3) are fractiles
    of the result over that of the reference, record by record, where both structures stood; NaN
    without any. `overturned` and `reference_overturned` are shares of the pairs.
    """

    values: tuple[object, ...]
    pairs: int
    ratios: Array
    overturned: float
    reference_overturned: float


@dataclass(frozen=True)
class ContrastReport:
    """All cells, and how many pairs were left out because a point of them failed."""

    options: ContrastOptions
    key: str
    value: object
    reference: object
    panel_keys: tuple[str, ...]
    cells: tuple[Contrast, ...]
    failed: int


def contrast_report(table: Table, options: ContrastOptions) -> ContrastReport:
    """Pair the points of the two values of the key, and gather them in cells."""
    key = options.key or leading_keys(table.layout)[-1]
    systems = {group.values[0]: group.points for group in groups(table.layout, [key])}
    reference = next(iter(systems)) if options.reference is None else options.reference
    value = options.value
    if value is None:
        value = next(known for known in systems if known != reference)
    everywhere = np.arange(len(table.layout))
    mine, theirs = paired(everywhere, systems[value], systems[reference])
    bad = table.failed[mine] | table.failed[theirs]
    panel_keys = options.panels or ()
    keys = (*panel_keys, *options.rows, *options.columns)
    other = dict(zip(theirs[~bad].tolist(), mine[~bad].tolist(), strict=True))
    cells = tuple(
        _cell(
            table, options, group.values, np.array([other[i] for i in group.points]), group.points
        )
        for group in groups(table.layout, keys, theirs[~bad])
    )
    return ContrastReport(options, key, value, reference, panel_keys, cells, int(bad.sum()))


def _cell(
    table: Table,
    options: ContrastOptions,
    values: tuple[object, ...],
    mine: Indices,
    theirs: Indices,
) -> Contrast:
    stood = ~(table.overturned[mine] | table.overturned[theirs])
    ratios = np.full((len(options.results), len(FRACTILES)), np.nan)
    for place, name in enumerate(options.results):
        ours, reference = (table.columns[name][points[stood]] for points in (mine, theirs))
        ratio = ours[reference > 0.0] / reference[reference > 0.0]
        if len(ratio):
            ratios[place] = np.quantile(ratio, FRACTILES)
    shares = (float(np.mean(table.overturned[points])) for points in (mine, theirs))
    return Contrast(values, len(mine), ratios, *shares)
