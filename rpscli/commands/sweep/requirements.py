"""What limits and reports need of a study, looked at before anything is computed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rpscli.commands.sweep.input import StudyInput
from rpscli.errors import UsageError

if TYPE_CHECKING:
    from rpscli.case.conditions import Condition


def require_results(given: StudyInput, conditions: Iterable[Condition]) -> None:
    """Refuse limits on results that systems do not have, and reports that cannot be drawn.

    Raises
    ------
    CaseError
        At the place of the limit or the report.
    UsageError
        If `--fail-on` names the result.
    """
    from rpscli.report.study.requirements import (
        lacking,
        requirement_faults,
    )
    from rpscli.sweep.points.check import needs_of

    layout = given.layout
    layout.study.document.refuse(requirement_faults(layout))
    for condition in conditions:
        if layout.plan.analysis != "timehistory":
            raise UsageError(f"--fail-on {condition.name} needs analysis: timehistory")
        if lacking(layout, condition.name):
            raise UsageError(f"--fail-on: {needs_of(condition.name)}")
