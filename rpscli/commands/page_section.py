"""Sections that tools add to the page of a case, where `rps report CASE --NAME` asks."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from rpscli.registry import all_of_tools

if TYPE_CHECKING:
    from rpscli.report.page import ReportSection

Command = TypeVar("Command", bound=Callable[..., Any])


class PageSection(NamedTuple):
    """A section, and the help of its flag."""

    help: str
    made: Callable[..., ReportSection]  # of a case, motions, a terminal, a look, a label


PAGE_SECTIONS: dict[str, PageSection] = all_of_tools("page_sections")
"""Those of all tools, by name."""


def section_options(function: Command) -> Command:
    """A flag for each section; names of those that are asked for, as `extra`."""

    @wraps(function)
    def command(**given: Any) -> None:
        extra = tuple(name for name in PAGE_SECTIONS if given.pop(f"with_{name}"))
        function(extra=extra, **given)

    made: Any = command
    for name, section in PAGE_SECTIONS.items():
        flag = click.option(f"--{name}", f"with_{name}", is_flag=True, help=section.help)
        made = flag(made)
    return made  # type: ignore[no-any-return]
