"""What limits and reports need of a study, looked at before anything is computed."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.conditions import FRICTION
from rpscli.case.text.faults import Fault
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.design.check import needs_of
from rpscli.sweep.design.layout import Design


def requirement_faults(design: Design) -> Iterator[Fault]:
    """Limits on results that systems do not have, and reports that cannot be drawn."""
    yield from _limit_faults(design)
    yield from _report_faults(design)


def lacking(design: Design, name: str) -> bool:
    """Whether some system of a study cannot have a result."""
    return any(name in properties.lacking for properties in design.properties)


def _limit_faults(design: Design) -> Iterator[Fault]:
    own = design.study.file.limits is not None
    limits = (
        limit for system in design.properties for limit in system.limits if limit.source != FRICTION
    )
    for name in dict.fromkeys(limit.name for limit in limits):
        if lacking(design, name):
            path = ("limits", name) if own else ("base",)
            yield Fault(path, f"limits.{needs_of(name)}", at_key=own)


def _report_faults(design: Design) -> Iterator[Fault]:
    for request in design.study.reports:
        report = REPORTS[request.kind]
        for name in dict.fromkeys(report.results(request.options)):
            if lacking(design, name):
                yield Fault(request.path, f"the report {request.kind}: {needs_of(name)}")
        for text in report.requires(design, request.options):
            yield Fault(request.path, f"the report {request.kind}: {text}")
