"""Every command by name: ours, and where those of tools and of packages are found."""

from __future__ import annotations

from copy import copy
from functools import cache
from typing import Any

import click

from rpscli.registry import Registry, of_tools

SECTIONS = {
    "Commands": {
        "init": "write a commented case or study to start from",
        "check": "derived quantities of a case, and mistakes in it",
        "modal": "modes in full contact, rolling and rocking",
        "pushover": "restoring force and capacity curves",
        "timehistory": "response to a ground motion",
        "sweep": "compute the points of a study and draw its reports",
        "report": "one page for a checking engineer, from all of these",
        "record": "read, draw, select, convert, make ground motions",
        "explain": "what a key, a result, a report or a word means",
    },
    "Other commands": {
        "schema": "JSON schemas of cases, studies and designs",
        "completion": "complete commands, files and keys in your shell",
        "verify": "compare this installation with known numbers",
        "doctor": "what is installed, what is missing",
    },
}
"""Lines of the help: our own commands. Those of tools and of other packages follow."""
OURS = {name: summary for lines in SECTIONS.values() for name, summary in lines.items()}
HOMES = {"schema": "init", "completion": "init"}
"""Modules of `rpscli.commands` that hold a command besides their own."""


KIND = "commands"
"""Of what tools and other packages add here."""


@cache
def others() -> Registry[click.Command]:
    """Commands of other packages."""
    return Registry(KIND, {}, click.Command, {*OURS, *of_tools(KIND)})


def of_package(name: str) -> click.Command:
    """The command of another package, which is told by name what goes wrong in it."""
    command = copy(others()[name])
    invoke = command.invoke

    def blamed(ctx: click.Context) -> Any:
        passing: BaseException
        with others().blaming(name, aside=False):
            try:
                return invoke(ctx)
            except (click.ClickException, click.exceptions.Exit, click.Abort) as error:
                passing = error  # how click ends commands
        raise passing

    command.invoke = blamed  # type: ignore[method-assign]
    return command
