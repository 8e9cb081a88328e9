"""The section of `rps report CASE --budget`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.commands.page_section import PageSection, SectionRequest

if TYPE_CHECKING:
    from rpscli.report.page import ReportSection


def budget_section(asked: SectionRequest) -> ReportSection:
    """The budget of a case under the worst of its motions first."""
    from rpscli.tools.budget.command import case_budget

    worst = asked.motions[asked.worst]
    first = sorted(asked.motions, key=lambda each: each is not worst)
    budget = case_budget(asked.given, first, asked.terminal)
    return budget.section(asked.look, asked.labels[asked.worst])


SECTION = PageSection(
    "Add the sensitivity of each limited result of a CASE, as in `rps budget`.",
    budget_section,
)
"""Sensitivity of limited results and verdicts."""
