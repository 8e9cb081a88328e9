"""`rps schema`: the case format for editors and other programs."""

from __future__ import annotations

import sys

import click

from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal, emit
from rpscli.report.files.json_text import json_text


@click.command("schema")
@terminal_options
def command(terminal: Terminal) -> None:
    """Print the JSON schema of a case file, with or without --json.

    Editors that know YAML check and complete a case by it.
    """
    del terminal
    from rpscli.case.schema.json_schema import case_json_schema  # noqa: PLC0415

    emit(json_text(case_json_schema()), sys.stdout)
