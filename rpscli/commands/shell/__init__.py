"""Parts that every command shares: groups, options, streams,
tables, errors and exit codes.
"""

from __future__ import annotations

import click

from rpscli.errors import hint


class CommandGroup(click.Group):
    """Commands in the order in which they were given; an unknown one
    is told the nearest name.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in that order."""
        del ctx
        return list(self.commands)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is called, or a refusal."""
        word = args[0] if args else ""
        if word and not word.startswith("-") and self.get_command(ctx, word) is None:
            known = self.list_commands(ctx)
            meant = hint(word, known, f"there are {', '.join(known)}", 0.6)
            ctx.fail(f"no such command: {word}; {meant}")
        return super().resolve_command(ctx, args)
