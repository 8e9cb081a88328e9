"""Sections that tools add to the page of a case, where `rps report CASE --NAME` asks, or
where the records of the case bring them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from rpscli.registry import all_of_tools

if TYPE_CHECKING:
    from rpscli.commands.inputs import CaseInput, CaseMotion
    from rpscli.commands.shell.terminal import Terminal
    from rpscli.report.figures.look import Look
    from rpscli.report.page import ReportSection

Command = TypeVar("Command", bound=Callable[..., Any])


class SectionRequest(NamedTuple):
    """A section that is asked for, of a case under motions."""

    given: CaseInput
    motions: Sequence[CaseMotion]
    labels: Sequence[str]  # names of the motions on the page
    worst: int  # place of the motion that turns the columns most
    value: str  # of the option; empty for a flag
    terminal: Terminal
    look: Look


class PageSection(NamedTuple):
    """A section, and the help of its option."""

    help: str
    made: Callable[[SectionRequest], ReportSection]
    metavar: str | None = None  # of the option's value; None for a flag
    brought: Callable[[Sequence[str]], str] = lambda _: ""
    """The value that records, as they were typed, bring; empty without one."""


PAGE_SECTIONS: dict[str, PageSection] = all_of_tools("page_sections")
"""Those of all tools, by name."""


def section_options(function: Command) -> Command:
    """An option for each section; values of those that are asked for by name, as
    `extra`.
    """

    @wraps(function)
    def command(**given: Any) -> None:
        values = {name: given.pop(f"with_{name}") for name in PAGE_SECTIONS}
        extra = {
            name: "" if value is True else value
            for name, value in values.items()
            if value
        }
        function(extra=extra, **given)

    made: Any = command
    for name, section in PAGE_SECTIONS.items():
        kind: dict[str, Any] = {"is_flag": True}
        if section.metavar is not None:
            kind = {"metavar": section.metavar}
        made = click.option(f"--{name}", f"with_{name}", help=section.help, **kind)(made)
    return made  # type: ignore[no-any-return]


def with_brought(extra: Mapping[str, str], records: Sequence[str]) -> dict[str, str]:
    """Values of the sections that are asked for, and of those that records bring."""
    brought = {name: section.brought(records) for name, section in PAGE_SECTIONS.items()}
    return {name: value for name, value in brought.items() if value} | dict(extra)


def section_words(extra: Mapping[str, str]) -> list[str]:
    """The sections on a command line."""
    return [
        word
        for name, value in extra.items()
        for word in ((f"--{name}", value) if value else (f"--{name}",))
    ]
