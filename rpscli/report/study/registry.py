"""All kinds of report by the names that studies call them, and
what they need of a study.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import FRICTION, Condition
from rpscli.case.text.document import Fault
from rpscli.registry import Registry, all_of_tools
from rpscli.report.study import (
    fragility,
    heights,
    lines,
    risk,
    rotation,
    scatter,
    table,
)
from rpscli.report.study.report import Report
from rpscli.report.table_files import MISSING, has_workbooks
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.systems import needs_of

REPORTS: Registry[Report[Any]] = Registry(
    "reports",
    {
        "overturning": table.OVERTURNING,
        "rotation": rotation.REPORT,
        "demand": scatter.DEMAND,
        "storey_shear": heights.STOREY_SHEAR,
        "floor_spectra": heights.FLOOR_SPECTRA,
        "fragility": fragility.REPORT,
        "risk": risk.REPORT,
        "ida": lines.IDA,
        "overturning_spectrum": scatter.OVERTURNING_SPECTRUM,
        "lines": lines.REPORT,
        "table": table.TABLE,
        "scatter": scatter.SCATTER,
        **all_of_tools("reports"),
    },
    Report,
)


def asked(layout: StudyPoints) -> set[str]:
    """Results of the limits and reports of a study, the main ones
    where it has no reports.
    """
    limits = {limit.name for system in layout.properties for limit in system.limits}
    requests = layout.study.reports
    main = (
        set() if requests else {quantity.name for quantity in LIMITED if quantity.demand}
    )
    return limits.union(
        main, *(REPORTS[each.kind].results(each.options) for each in requests)
    )


def requirement_faults(layout: StudyPoints) -> Iterator[Fault]:
    """Limits on results that systems do not have, and reports that cannot be drawn."""
    own = layout.study.file.limits is not None
    limits = (
        limit
        for system in layout.properties
        for limit in system.limits
        if limit.source != FRICTION
    )
    for name in dict.fromkeys(limit.name for limit in limits):
        if lacking(layout, name, all):
            path = ("limits", name) if own else ("base",)
            yield Fault(path, f"limits.{needs_of(name, 'no')}", at_key=own)
    for request in layout.study.reports:
        report = REPORTS[request.kind]
        if "xlsx" in request.options.formats and not has_workbooks():
            yield Fault(request.path, f"the report {request.kind}: formats: {MISSING}")
        for name in dict.fromkeys(report.results(request.options)):
            if lacking(layout, name):
                yield Fault(request.path, f"the report {request.kind}: {needs_of(name)}")
        for text in report.requires(layout, request.options):
            yield Fault(request.path, f"the report {request.kind}: {text}")


def lacking(
    layout: StudyPoints, name: str, which: Callable[[Iterable[bool]], bool] = any
) -> bool:
    """True if any, or all, systems of a study cannot have a result."""
    return which(name in properties.lacking for properties in layout.properties)


def not_judged(
    layout: StudyPoints, conditions: Iterable[Condition] = ()
) -> Iterator[str]:
    """Limits that some systems are not judged by, since they cannot have the result."""
    limits = (limit for system in layout.properties for limit in system.limits)
    for name in dict.fromkeys(limit.name for limit in (*limits, *conditions)):
        without = sum(name in system.lacking for system in layout.properties)
        if without:
            many = f"{without} of {len(layout.properties)} systems are not judged by it"
            yield f"{needs_of(name)}: {many}, and have no statistics of it"
