"""From the request for a report to its numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rpscli.case.study_requests import ReportRequest
from rpscli.sweep.batch import Bench
from rpscli.sweep.intensities import intensity
from rpscli.sweep.statistics_demand import demand_report
from rpscli.sweep.statistics_fragility import fragility_report
from rpscli.sweep.statistics_ida import ida_report
from rpscli.sweep.statistics_lines import lines_report
from rpscli.sweep.statistics_overturning import overturning_table
from rpscli.sweep.statistics_rotation import rotation_report
from rpscli.sweep.statistics_spectrum import spectrum_report
from rpscli.sweep.statistics_storeys import storey_shear_report
from rpscli.sweep.store import Store
from rpscli.sweep.table import Table
from rpscli.sweep.yardsticks import yardsticks


@dataclass(frozen=True, eq=False)
class Results:
    """A computed study, and what it takes to look closer at it."""

    table: Table
    keys: list[bytes]
    store: Store
    bench: Bench
    jobs: int


def computed(request: ReportRequest, results: Results) -> Any:
    """The numbers of a report: one of the `...Report` dataclasses, or an `OverturningTable`.

    Raises
    ------
    CaseError
        If the report cannot be had from this study.
    """
    return _MAKERS[request.kind](results, request.options)


def _storey_shear(results: Results, options: Any) -> Any:
    fixed = yardsticks(results.table.design, results.bench, results.store, results.jobs)
    return storey_shear_report(results.table, fixed, options)


def _fragility(results: Results, options: Any) -> Any:
    return fragility_report(
        results.table, intensity(results.table, results.bench, options), options
    )


def _lines(results: Results, options: Any) -> Any:
    return lines_report(results.table, results.store.stored(results.keys), options)


_MAKERS: dict[str, Callable[[Results, Any], Any]] = {
    "overturning": lambda results, options: overturning_table(results.table, options),
    "rotation": lambda results, options: rotation_report(results.table, options),
    "demand": lambda results, options: demand_report(results.table, options),
    "storey_shear": _storey_shear,
    "fragility": _fragility,
    "ida": lambda results, options: ida_report(results.table, options),
    "overturning_spectrum": lambda results, options: spectrum_report(
        results.table, results.bench, options
    ),
    "lines": _lines,
}
