"""`rps schema`: the formats for editors and other programs."""

from __future__ import annotations

import sys
from typing import Any

import click

from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal, emit
from rpscli.errors import UsageError
from rpscli.report.files.json_text import json_text


@click.command("schema")
@click.option("--study", is_flag=True, help="Of a study file, with the options of all reports.")
@click.option("--design", is_flag=True, help="Of a design file.")
@terminal_options
def command(*, study: bool, design: bool, terminal: Terminal) -> None:
    """Print the JSON schema of a case file, with or without --json.

    Editors that know YAML check and complete a case by it: `rps init --editor`.
    """
    del terminal
    if study and design:
        raise UsageError("--study and --design are two formats; take one of them")
    emit(json_text(schema_of(study=study, design=design)), sys.stdout)


def schema_of(*, study: bool, design: bool = False) -> dict[str, Any]:
    """The schema of cases, of studies or of designs."""
    # pydantic is slow.
    if not (study or design):
        from rpscli.case.json_schema import case_json_schema

        return case_json_schema()
    from rpscli.case.design import DesignFile
    from rpscli.case.json_schema import study_json_schema
    from rpscli.report.study.registry import REPORTS

    return study_json_schema({}, DesignFile) if design else study_json_schema(REPORTS)
