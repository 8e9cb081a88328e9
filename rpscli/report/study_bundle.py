"""Which files a study leaves behind."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from rpscli.case.study_reports import LinesOptions
from rpscli.case.study_requests import ReportRequest
from rpscli.report.csv_text import Column, csv_text
from rpscli.report.study_demand import demand_columns, demand_figure
from rpscli.report.study_fragility import curve_columns, fragility_columns, fragility_figure
from rpscli.report.study_ida import ida_columns, ida_figure
from rpscli.report.study_lines import lines_columns, lines_figure
from rpscli.report.study_overturning import overturning_columns, overturning_figure
from rpscli.report.study_rotation import rotation_columns, rotation_figure
from rpscli.report.study_spectrum import spectrum_columns, spectrum_figure
from rpscli.report.study_storeys import storey_shear_columns, storey_shear_figure
from rpscli.sweep.table import Table

Files = Iterator[tuple[str, str | bytes]]
"""Names and contents."""

DRAWN: dict[str, tuple[Callable[..., list[Column]], Callable[..., bytes]]] = {
    "overturning": (overturning_columns, overturning_figure),
    "demand": (demand_columns, demand_figure),
    "storey_shear": (storey_shear_columns, storey_shear_figure),
    "fragility": (fragility_columns, fragility_figure),
    "ida": (ida_columns, ida_figure),
    "overturning_spectrum": (spectrum_columns, spectrum_figure),
}
"""Columns and figure of the reports that need nothing but their numbers."""


def report_files(request: ReportRequest, numbers: Any, table: Table, title: str) -> Files:
    """CSV and PNG of one report."""
    title = request.options.title or title
    columns: list[Column]
    if isinstance(request.options, LinesOptions):
        columns, figure = lines_columns(numbers), lines_figure(numbers, request.options, title)
    elif request.kind == "rotation":
        columns, figure = rotation_columns(numbers, table), rotation_figure(numbers, title)
    else:
        to_columns, to_figure = DRAWN[request.kind]
        columns, figure = to_columns(numbers), to_figure(numbers, title)
    yield f"{request.stem}.csv", csv_text(columns)
    if request.kind == "fragility":
        yield f"{request.stem}_curves.csv", csv_text(curve_columns(numbers))
    yield f"{request.stem}.png", figure
