"""A command group whose members are imported when they are used."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from itertools import groupby
from typing import Any, NamedTuple

import click

from rpscli.errors import hint


class Member(NamedTuple):
    """A subcommand: module, line in the group's help, name in the module, section of the help."""

    module: str
    summary: str
    command: str = "command"
    section: str = "Commands"


class LazyGroup(click.Group):
    """A group that knows its members by name; listing them imports none of them."""

    def __init__(self, *args: Any, members: Mapping[str, Member], **options: Any) -> None:
        super().__init__(*args, **options)
        self.members = members

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in the order in which they were given."""
        del ctx
        return list(self.members)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The member of a name, imported now."""
        del ctx
        if cmd_name not in self.members:
            return None
        member = self.members[cmd_name]
        command: click.Command = getattr(import_module(member.module), member.command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The member that is called; an unknown one gets the nearest name in its message."""
        if args and args[0] not in self.members and not args[0].startswith("-"):
            there_are = f"there are {', '.join(self.members)}"
            meant = hint(args[0], self.members, there_are, 0.6)
            ctx.fail(f"no such command: {args[0]}; {meant}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of members in the help."""
        del ctx
        for section, members in groupby(self.members.items(), lambda item: item[1].section):
            with formatter.section(section):
                formatter.write_dl([(name, member.summary) for name, member in members])
