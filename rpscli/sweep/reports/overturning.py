"""Share of the points that overturn, as a table of systems (paper, Table 3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from pydantic import Field

from rpscli.case.study.reports import ReportOptions
from rpscli.case.study.schema import Keys
from rpscli.sweep.statistics.fractiles import Share, share
from rpscli.sweep.statistics.grouping import INTENSITY, apart, pooled, pooling_note, shown_keys
from rpscli.sweep.table import Indices, Table, groups, leading_keys


class OverturningOptions(ReportOptions):
    """Share of the points that overturn, as a table."""

    rows: Keys | None = Field(None, description="varied keys down the table; all but the columns'")
    columns: Keys | None = Field(None, description="varied keys across; those of the last axis")


class Cell(NamedTuple):
    """Points of one cell. Failed ones are counted apart and enter no share."""

    overturned: Share
    failed: int


@dataclass(frozen=True)
class OverturningTable:
    """Shares by rows and columns; a cell is None where the study has no points.

    `pooled` says what differs within a cell besides the record, `notes` warn of it.
    """

    row_keys: tuple[str, ...]
    column_keys: tuple[str, ...]
    rows: tuple[tuple[object, ...], ...]
    columns: tuple[tuple[object, ...], ...]
    cells: tuple[tuple[Cell | None, ...], ...]
    pooled: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def failed(self) -> int:
        """Points left out."""
        return sum(cell.failed for row in self.cells for cell in row if cell)


def overturning_table(table: Table, options: OverturningOptions) -> OverturningTable:
    """Count the overturned points of each system, at each intensity unless the study says else."""
    leading = leading_keys(table.layout)
    columns = options.columns
    if columns is None:
        columns = tuple(key for key in leading[-1:] if key not in (options.rows or ()))
    rows = options.rows
    if rows is None:
        rows = tuple(key for key in leading if not _together(table, key, columns))
        if INTENSITY not in columns:
            rows = apart(table.layout, rows)
    across = groups(table.layout, columns)
    lines = []
    for row in groups(table.layout, rows):
        # by their text: a value may be a list, of devices or of masses
        cells = {
            repr(group.values): group.points for group in groups(table.layout, columns, row.points)
        }
        lines.append(tuple(_cell(table, cells.get(repr(group.values))) for group in across))
    return OverturningTable(
        row_keys=shown_keys(table.layout, rows),
        column_keys=shown_keys(table.layout, columns),
        rows=tuple(group.values for group in groups(table.layout, rows)),
        columns=tuple(group.values for group in across),
        cells=tuple(lines),
        pooled=pooled(table.layout, (*rows, *columns)),
        notes=tuple(pooling_note(table.layout, (*rows, *columns))),
    )


def _together(table: Table, key: str, keys: tuple[str, ...]) -> bool:
    """Whether a key varies in the same axis as one of others."""
    axes = (axis.keys for axis in table.layout.study.axes)
    return any(key in axis and set(axis) & set(keys) for axis in axes)


def _cell(table: Table, points: Indices | None) -> Cell | None:
    if points is None:
        return None
    failed = int(table.failed[points].sum())
    return Cell(share(int(table.overturned[points].sum()), len(points) - failed), failed)
