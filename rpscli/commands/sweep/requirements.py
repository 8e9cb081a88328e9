"""What limits and reports need of a study, looked at before anything is computed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from rpscli.analyses.result_quantities import HISTORY, SAMPLED
from rpscli.case.conditions import FRICTION
from rpscli.commands.sweep.input import StudyInput
from rpscli.errors import UsageError

if TYPE_CHECKING:
    from rpscli.case.conditions import Condition
    from rpscli.case.text.faults import Fault


def require_results(given: StudyInput, conditions: Iterable[Condition]) -> None:
    """Refuse limits on results that systems do not have, and reports that cannot be drawn.

    Raises
    ------
    CaseError
        At the place of the limit or the report.
    UsageError
        If `--fail-on` names the result.
    """
    study = given.study
    study.document.refuse([*_limit_faults(given), *_report_faults(given)])
    for condition in conditions:
        if given.design.plan.analysis != "timehistory":
            raise UsageError(f"--fail-on {condition.name} needs analysis: timehistory")
        if lacking(given, condition.name):
            raise UsageError(f"--fail-on: {_needs(condition.name)}")


def lacking(given: StudyInput, name: str) -> bool:
    """Whether some system of a study cannot have a result."""
    return any(name in properties.lacking for properties in given.design.properties)


def _needs(name: str) -> str:
    needs = {quantity.name: quantity.needs for quantity in (*HISTORY, *SAMPLED)}[name]
    if name in {quantity.name for quantity in SAMPLED}:
        alike = f" and {needs} in all systems" if needs else ""
        return f"{name} needs `whole_histories: true` in the study{alike}"
    return f"{name} needs {needs}, which not every system of the study has"


def _limit_faults(given: StudyInput) -> Iterator[Fault]:
    from rpscli.case.text.faults import Fault  # noqa: PLC0415

    own = given.study.file.limits is not None
    systems = given.design.properties
    limits = (limit for system in systems for limit in system.limits if limit.source != FRICTION)
    for name in dict.fromkeys(limit.name for limit in limits):
        if lacking(given, name):
            yield Fault(
                ("limits", name) if own else ("base",), f"limits.{_needs(name)}", at_key=own
            )


def _report_faults(given: StudyInput) -> Iterator[Fault]:
    from rpscli.case.text.faults import Fault  # noqa: PLC0415
    from rpscli.report.study.registry import REPORTS  # noqa: PLC0415 -- numpy is slow

    for request in given.study.reports:
        report = REPORTS[request.kind]
        for name in dict.fromkeys(report.results(request.options)):
            if lacking(given, name):
                yield Fault(request.path, f"the report {request.kind}: {_needs(name)}")
        for text in report.requires(given.design, request.options):
            yield Fault(request.path, f"the report {request.kind}: {text}")
