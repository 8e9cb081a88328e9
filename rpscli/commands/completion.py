"""`rps completion`: what a shell needs to complete words after `rps`."""

from __future__ import annotations

import sys

import click
from click.shell_completion import BashComplete, FishComplete, ShellComplete, ZshComplete

from rpscli.commands.shell.terminal import emit

SHELLS: dict[str, type[ShellComplete]] = {
    "bash": BashComplete,
    "zsh": ZshComplete,
    "fish": FishComplete,
}


@click.command("completion")
@click.argument("shell", type=click.Choice(tuple(SHELLS)))
def command(shell: str) -> None:
    """Print the lines by which SHELL completes commands, options, files, keys and names.

    For bash put `eval "$(rps completion bash)"` into ~/.bashrc, for zsh the same with zsh into
    ~/.zshrc; for fish, `rps completion fish > ~/.config/fish/completions/rps.fish`.
    """
    complete = SHELLS[shell](click.Command("rps"), {}, "rps", "_RPS_COMPLETE")
    # Not `source()`, which for bash first asks the version of a bash that need not be here.
    emit(complete.source_template % complete.source_vars() + "\n", sys.stdout)
