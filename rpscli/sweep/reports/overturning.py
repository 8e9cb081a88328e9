"""Share of the points that overturn, as a table of systems (paper, Table 3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from pydantic import Field

from rpscli.case.study.fields import Keys
from rpscli.case.study.reports import ReportOptions
from rpscli.sweep.table import Indices, Table, groups, leading_keys


class OverturningOptions(ReportOptions):
    """Share of the points that overturn, as a table."""

    rows: Keys | None = Field(None, description="varied keys down the table; all but the columns'")
    columns: Keys | None = Field(None, description="varied keys across; those of the last axis")


class Share(NamedTuple):
    """Points of one cell. Failed ones are counted apart and enter no share."""

    overturned: int
    counted: int
    failed: int

    @property
    def fraction(self) -> float | None:
        """Overturned over counted; None without any."""
        return self.overturned / self.counted if self.counted else None


@dataclass(frozen=True)
class OverturningTable:
    """Shares by rows and columns; a cell is None where the study has no points."""

    row_keys: tuple[str, ...]
    column_keys: tuple[str, ...]
    rows: tuple[tuple[object, ...], ...]
    columns: tuple[tuple[object, ...], ...]
    cells: tuple[tuple[Share | None, ...], ...]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(cell.failed for row in self.cells for cell in row if cell)


def overturning_table(table: Table, options: OverturningOptions) -> OverturningTable:
    """Count the overturned points of each system over everything else that varies."""
    leading = leading_keys(table.design)
    columns = options.columns
    if columns is None:
        columns = tuple(key for key in leading[-1:] if key not in (options.rows or ()))
    rows = options.rows
    if rows is None:
        rows = tuple(key for key in leading if not _together(table, key, columns))
    across = groups(table.design, columns)
    lines = []
    for row in groups(table.design, rows):
        cells = {group.values: group.points for group in groups(table.design, columns, row.points)}
        lines.append(tuple(_share(table, cells.get(group.values)) for group in across))
    return OverturningTable(
        row_keys=rows,
        column_keys=columns,
        rows=tuple(group.values for group in groups(table.design, rows)),
        columns=tuple(group.values for group in across),
        cells=tuple(lines),
    )


def _together(table: Table, key: str, keys: tuple[str, ...]) -> bool:
    """Whether a key varies in the same axis as one of others."""
    axes = (axis.keys for axis in table.design.study.axes)
    return any(key in axis and set(axis) & set(keys) for axis in axes)


def _share(table: Table, points: Indices | None) -> Share | None:
    if points is None:
        return None
    failed = int(table.failed[points].sum())
    return Share(int(table.overturned[points].sum()), len(points) - failed, failed)
