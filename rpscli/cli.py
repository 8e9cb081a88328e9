"""The command line: `rps COMMAND ...`."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

import click

from rpscli.commands.registry import HOMES, KIND, OURS, SECTIONS, of_package, others
from rpscli.commands.shell import CommandGroup
from rpscli.registry import loaded, of_tools, shared_output, summary_of, tools
from rpscli.version import VERSION


def _lowered(sentence: str) -> str:
    return f"{sentence[:1].lower()}{sentence[1:].rstrip('.')}"


class RootGroup(CommandGroup):
    """The program itself: it imports a command when that is used,
    and ends with an exit code.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in the order of the help."""
        del ctx
        return [*OURS, *of_tools(KIND), *others().names()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of a name, imported now."""
        del ctx
        if cmd_name in OURS:
            home = HOMES.get(cmd_name)
            module = import_module(f"rpscli.commands.{home or cmd_name}")
            ours: click.Command = getattr(module, cmd_name if home else "command")
            return ours
        if (target := of_tools(KIND).get(cmd_name)) is not None:
            of_tool: click.Command = loaded(target)
            return of_tool
        return of_package(cmd_name) if cmd_name in others().names() else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The list of commands in the help."""
        del ctx
        of = {
            name: _lowered(summary_of(tool))
            for tool in tools()
            for name in tool.OFFERS.get(KIND, {})
        }
        theirs = {
            name: command.get_short_help_str() for name, command in others().theirs()
        }
        ends = {"Tools": of, "Commands of other packages": theirs}
        for section, lines in (SECTIONS | ends).items():
            if lines:
                with formatter.section(section):
                    formatter.write_dl([*lines.items()])

    def main(
        self, args: Sequence[str] | None = None, *rest: Any, **options: Any
    ) -> NoReturn:
        """Run, report what went wrong, and leave."""
        words = list(sys.argv[1:] if args is None else args)
        options["standalone_mode"] = False
        if "COMP_WORDS" not in os.environ:  # nobody asks what may come next
            options.setdefault("complete_var", "_RPS_COMPLETE_WITHOUT_WORDS")
        try:
            with shared_output():
                code = super().main(words, *rest, **options)
        except SystemExit as end:
            # Click leaves with 1 if nobody reads its help to the end, as in `rps --help |
            # head -1`.
            if end.code == 1 and {"--help", "-h", "--version"}.intersection(words):
                sys.exit(0)
            raise
        except BaseException as error:  # noqa: BLE001 -- the last stop of every error
            # Imported now, when it is needed.
            from rpscli.commands.shell.terminal import report

            code = report(error, as_json="--json" in words)
        sys.exit(code or 0)


@click.command(
    cls=RootGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=(
        "Exit codes: 0 done, 1 internal error or nothing could be written, 2 usage, 3"
        " case or record invalid, 4 analysis failed, 5 study with failed points, 6"
        " verification mismatch, 7 refused to overwrite, 10 a limit was exceeded, 130"
        " interrupted."
    ),
)
@click.version_option(VERSION, message="rps %(version)s", help="Show the version.")
def program() -> None:
    """Rocking podium structures: buildings on kinematic bearings under earthquakes.

    A case is a YAML file; `rps init` writes one to start from. Results go to the standard
    output and to a folder, everything else to the standard error.
    """
