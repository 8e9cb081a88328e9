"""`rps schema`: the formats for editors and other programs."""

from __future__ import annotations

import sys
from typing import Any

import click

from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal, emit
from rpscli.report.files.json_text import json_text


@click.command("schema")
@click.option("--study", is_flag=True, help="Of a study file, with the options of all reports.")
@terminal_options
def command(*, study: bool, terminal: Terminal) -> None:
    """Print the JSON schema of a case file, with or without --json.

    Editors that know YAML check and complete a case by it: `rps init --editor`.
    """
    del terminal
    emit(json_text(schema_of(study=study)), sys.stdout)


def schema_of(*, study: bool) -> dict[str, Any]:
    """The schema of cases, or of studies."""
    # pydantic is slow.
    if not study:
        from rpscli.case.schema.json_schema import case_json_schema  # noqa: PLC0415

        return case_json_schema()
    from rpscli.case.study.json_schema import study_json_schema  # noqa: PLC0415
    from rpscli.report.study.registry import REPORTS  # noqa: PLC0415

    return study_json_schema(REPORTS)
