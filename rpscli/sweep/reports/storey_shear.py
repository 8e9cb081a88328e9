"""Mean and largest storey shears, isolated and on a fixed base (paper, Figure 9)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from pydantic import Field

from rpscli.case.study.fields import Keys
from rpscli.case.study.reports import ReportOptions
from rpscli.errors import CaseError
from rpscli.sweep.statistics.fixed_base import FixedBaseReferences
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys


class StoreyShearOptions(ReportOptions):
    """Mean and largest storey shears against those on a fixed base."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")


@dataclass(frozen=True, eq=False)
class StoreyProfile:
    """Storey shears of a group of systems over V_st, each (n,) from the bottom.

    Overturned and failed points are left out, of the fixed base too. `static_base_shear` is V_st
    [N]; NaN if the systems of the group differ in it.
    """

    values: tuple[object, ...]
    mean: Array
    largest: Array
    fixed_mean: Array
    fixed_largest: Array
    static_base_shear: float
    counted: int
    overturned: int
    failed: int


@dataclass(frozen=True)
class StoreyShearReport:
    """All panels."""

    panel_keys: tuple[str, ...]
    profiles: tuple[StoreyProfile, ...]


def storey_shear_report(
    table: Table, fixed: FixedBaseReferences, options: StoreyShearOptions
) -> StoreyShearReport:
    """Profiles of each system, or of each group of systems.

    Raises
    ------
    CaseError
        If the systems of a panel differ in their number of storeys.
    """
    keys = options.panels if options.panels is not None else leading_keys(table.design)
    profiles = (
        _profile(table, fixed, group.values, group.points) for group in groups(table.design, keys)
    )
    return StoreyShearReport(keys, tuple(profile for profile in profiles if profile))


def _profile(
    table: Table, fixed: FixedBaseReferences, values: tuple[object, ...], points: Indices
) -> StoreyProfile | None:
    design = table.design
    systems = np.unique(points // design.points_of_system)
    storeys = {design.properties[system].storeys for system in systems}
    if len(storeys) > 1:
        raise CaseError(
            f"the report storey_shear: {values} holds buildings of {sorted(storeys)} storeys; let"
            " `panels` name the key in which they differ"
        )
    n = storeys.pop()
    if n == 0:
        return None
    statics = np.array([properties.static_base_shear for properties in design.properties])
    kept = points[~table.failed[points] & ~table.overturned[points]]
    static = statics[kept // design.points_of_system, None]
    shears = table.storey_shears[kept, :n] / static
    reference = _fixed(table, fixed, kept, n) / static
    unique = np.unique(statics[systems])
    return StoreyProfile(
        values=values,
        mean=_over(np.mean, shears),
        largest=_over(np.max, shears),
        fixed_mean=_over(np.mean, reference),
        fixed_largest=_over(np.max, reference),
        static_base_shear=float(unique[0]) if len(unique) == 1 else float("nan"),
        counted=len(kept),
        overturned=int(table.overturned[points].sum()),
        failed=int(table.failed[points].sum()),
    )


def _fixed(table: Table, fixed: FixedBaseReferences, points: Indices, n: int) -> Array:
    """Shears on a fixed base of the same points."""
    rows = np.empty((len(points), n))
    for row, number in enumerate(points.tolist()):
        point = table.design[number]
        assert point.record is not None, "points of histories have a record"
        rows[row] = abs(table.scale[number]) * fixed[point.system, point.record]
    return rows


def _over(statistic: Callable[..., Array], values: Array) -> Array:
    """A statistic over the points; NaN where none is left."""
    if not len(values):
        return np.full(values.shape[1], np.nan)
    return np.asarray(statistic(values, axis=0))
