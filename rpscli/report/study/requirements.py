"""What limits and reports need of a study, looked at before anything is computed."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.conditions import FRICTION
from rpscli.case.text.document import Fault
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.points.check import needs_of
from rpscli.sweep.points.layout import StudyPoints


def requirement_faults(layout: StudyPoints) -> Iterator[Fault]:
    """Limits on results that systems do not have, and reports that cannot be drawn."""
    yield from _limit_faults(layout)
    yield from _report_faults(layout)


def lacking(layout: StudyPoints, name: str) -> bool:
    """Whether some system of a study cannot have a result."""
    return any(name in properties.lacking for properties in layout.properties)


def _limit_faults(layout: StudyPoints) -> Iterator[Fault]:
    own = layout.study.file.limits is not None
    limits = (
        limit for system in layout.properties for limit in system.limits if limit.source != FRICTION
    )
    for name in dict.fromkeys(limit.name for limit in limits):
        if lacking(layout, name):
            path = ("limits", name) if own else ("base",)
            yield Fault(path, f"limits.{needs_of(name)}", at_key=own)


def _report_faults(layout: StudyPoints) -> Iterator[Fault]:
    for request in layout.study.reports:
        report = REPORTS[request.kind]
        for name in dict.fromkeys(report.results(request.options)):
            if lacking(layout, name):
                yield Fault(request.path, f"the report {request.kind}: {needs_of(name)}")
        for text in report.requires(layout, request.options):
            yield Fault(request.path, f"the report {request.kind}: {text}")
