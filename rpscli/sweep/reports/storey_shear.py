"""Mean and largest storey shears, isolated and on a fixed base (paper, Figure 9)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic import Field

from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import Keys
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.statistics.fixed_base import FixedBaseReferences
from rpscli.sweep.statistics.grouping import apart, pooled, pooling_note, shown_keys
from rpscli.sweep.table import Array, Indices, Table, groups, leading_keys


class StoreyShearOptions(ReportOptions):
    """Mean and largest storey shears against those on a fixed base."""

    panels: Keys | None = Field(None, description="varied keys, one panel for each value")
    unit: Literal["V_st", "kN"] = Field(
        "V_st", description="of the figure: the base shear at uplift, or kN to compare systems"
    )


@dataclass(frozen=True, eq=False)
class StoreyProfile:
    """Storey shears of a group of systems over V_st, each (n,) from the bottom.

    Means and largest values are those of survivors: overturned and failed points are left out, of
    the fixed base too. `static_base_shear` is V_st
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
    unit: str
    pooled: tuple[str, ...]
    pooling: tuple[str, ...]

    @property
    def overturned(self) -> int:
        """Points left out of all panels because the structure overturned."""
        return sum(profile.overturned for profile in self.profiles)

    @property
    def notes(self) -> list[str]:
        """What is pooled, and what is left out."""
        notes = list(self.pooling)
        if self.overturned:
            of = self.overturned + sum(profile.counted for profile in self.profiles)
            notes.append(
                f"means and largest shears are those of survivors: {self.overturned} of {of}"
                " histories overturned and are left out, on the fixed base too"
            )
        return notes


def storey_shear_report(
    table: Table, fixed: FixedBaseReferences, options: StoreyShearOptions
) -> StoreyShearReport:
    """Profiles of each system at each intensity, or of the groups that the study names."""
    layout = table.layout
    keys = panel_keys(layout, options)
    profiles = (
        _profile(table, fixed, group.values, group.points) for group in groups(layout, keys)
    )
    return StoreyShearReport(
        panel_keys=shown_keys(layout, keys),
        profiles=tuple(profile for profile in profiles if profile),
        unit=options.unit,
        pooled=pooled(layout, keys),
        pooling=tuple(pooling_note(layout, keys)),
    )


def panel_keys(layout: StudyPoints, options: StoreyShearOptions) -> tuple[str, ...]:
    """What tells panels apart."""
    return apart(layout, leading_keys(layout)) if options.panels is None else options.panels


def unlike_buildings(layout: StudyPoints, options: StoreyShearOptions) -> Iterator[str]:
    """Panels whose systems differ in what their common profile would need."""
    keys = panel_keys(layout, options)
    for group in groups(layout, keys):
        systems = [layout.properties[i] for i in np.unique(group.points // layout.points_of_system)]
        named = ", ".join(f"{key} = {value}" for key, value in zip(keys, group.values, strict=True))
        of = f"the panel of {named}" if named else "its one panel"
        storeys = sorted({system.storeys for system in systems})
        if len(storeys) > 1:
            yield (
                f"{of} holds buildings of {storeys} storeys; let `panels` name the key in which"
                " they differ"
            )
        elif options.unit == "kN" and len({system.static_base_shear for system in systems}) > 1:
            yield f"{of} holds systems of different V_st, so that `unit` must be V_st"


def _profile(
    table: Table, fixed: FixedBaseReferences, values: tuple[object, ...], points: Indices
) -> StoreyProfile | None:
    layout = table.layout
    systems = np.unique(points // layout.points_of_system)
    n = layout.properties[systems[0]].storeys
    if n == 0:
        return None
    statics = np.array([properties.static_base_shear for properties in layout.properties])
    kept = points[~table.failed[points] & ~table.overturned[points]]
    static = statics[kept // layout.points_of_system, None]
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
        point = table.layout[number]
        assert point.record is not None, "points of histories have a record"
        rows[row] = abs(table.scale[number]) * fixed[point.system, point.record]
    return rows


def _over(statistic: Callable[..., Array], values: Array) -> Array:
    """A statistic over the points; NaN where none is left."""
    if not len(values):
        return np.full(values.shape[1], np.nan)
    return np.asarray(statistic(values, axis=0))
