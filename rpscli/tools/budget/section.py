"""The section of `rps report CASE --budget`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rpscli.commands.page_section import PageSection

if TYPE_CHECKING:
    from rpscli.commands import inputs
    from rpscli.commands.shell.terminal import Terminal
    from rpscli.report.figures.look import Look
    from rpscli.report.page import ReportSection


def budget_section(
    given: inputs.CaseInput,
    motions: Sequence[inputs.CaseMotion],
    terminal: Terminal,
    look: Look,
    label: str,
) -> ReportSection:
    """The budget of a case under the first of its motions, called `label`."""
    from rpscli.tools.budget.command import case_budget

    return case_budget(given, motions, terminal).section(look, label)


SECTION = PageSection(
    "Add the sensitivity of each limited result of a CASE, as in `rps budget`.",
    budget_section,
)
