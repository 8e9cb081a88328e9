"""`rps init`: a case to start from."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal, emit
from rpscli.errors import Refused
from rpscli.report.documents import heading
from rpscli.report.files.whole_files import write_whole


@click.command("init")
@click.argument("file", default="case.yaml", type=click.Path(path_type=Path))
@click.option("--force", is_flag=True, help="Overwrite FILE if it exists.")
@terminal_options
def command(file: Path, *, force: bool, terminal: Terminal) -> None:
    """Write a commented case to FILE (case.yaml by default; - is the standard output)."""
    from rpscli.case.text.files import starter_text  # noqa: PLC0415

    text = starter_text()
    if str(file) == "-":
        emit(text, sys.stdout)
        return
    if file.exists() and not force:
        raise Refused(f"{file} exists; name another file, or overwrite it with --force")
    write_whole({file: text.encode()})
    terminal.note(f"written to {file}; next: rps check {file}")
    if terminal.as_json:
        terminal.result({**heading(), "command": "init", "files": [str(file)]})
