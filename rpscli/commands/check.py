"""`rps check`: what follows from a case, before any analysis."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import click

from rpscli.case.conditions import conditions_of
from rpscli.commands.case_input import CaseInput, case_folder, case_heading, read_case, write
from rpscli.commands.check_device_tables import device_tables
from rpscli.commands.check_tables import check_tables
from rpscli.commands.motion import MotionRequest, load_motion
from rpscli.commands.shell.failure import concluded, leave
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    case_options,
    figure_options,
    output_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import RecordError, UsageError
from rpscli.report.documents import heading
from rpscli.report.figures.look import USUAL, Look

if TYPE_CHECKING:
    from rpscli.case.case import Case


@click.command("check")
@case_options
@click.option(
    "--draw",
    is_flag=True,
    help="Also draw the bearing with its dimensions: at rest, where rolling ends, at the critical"
    " rotation, and the restoring force; the figure bearing.",
)
@figure_options
@output_options
@terminal_options
def command(
    request: CaseRequest, output: OutputRequest, terminal: Terminal, look: Look, *, draw: bool
) -> None:
    """What follows from CASE: geometry, masses, statics, periods.

    Nothing is analysed, and nothing is written without --draw. A case with mistakes ends with exit
    code 3 and a line for each of them; so does a record that cannot be read.
    """
    if not draw and (output != OutputRequest(None, force=False) or look != USUAL):
        raise UsageError("only --draw writes something; options of files and figures go with it")
    given = read_case(request, terminal)
    from rpscli.model.statics import device_consequences
    from rpscli.report.tables.derived import derived_quantities

    structure = given.case.structure
    derived = derived_quantities(structure) | device_consequences(structure)
    record, error = _record(given.case)
    document = {
        **heading(),
        "command": "check",
        "case": case_heading(given),
        **derived,
        "record": record,
        "limits": given.case.limits.model_dump(exclude_none=True),
        "warnings": [*given.case.warnings, *(record or {}).get("warnings", ())],
    }
    if draw:
        document["files"] = _drawn(given, output, look, terminal)
    terminal.warn((record or {}).get("warnings", ()))
    limits = conditions_of(given.case.limits, "limits of the case")
    tables = chain(check_tables(document, limits), device_tables(structure))
    terminal.result(concluded(document, error), tables)
    leave(error)


def _drawn(given: CaseInput, output: OutputRequest, look: Look, terminal: Terminal) -> list[str]:
    """Draw the bearing; the files that there are of it."""
    from rpscli.report.bundles import bearing_files

    folder = case_folder(given, output, "check")
    for name, content in bearing_files(given.case.structure, given.case.title, look):
        folder.add(name, content)
    write(folder, terminal)
    return folder.files


def _record(case: Case) -> tuple[dict[str, Any] | None, RecordError | None]:
    """The case's own record, or why it cannot be read; nothing if the case names none."""
    if case.record is None:
        return None, None
    try:
        motion = load_motion(case, MotionRequest())
    except RecordError as error:
        return None, error
    found = motion.horizontal
    return {
        "name": found.name,
        "source": found.source,
        "format": found.format,
        "description": found.description,
        "npts": found.npts,
        "dt": found.dt,
        "duration": found.duration,
        "pga": found.pga,
        "scale": motion.scale,
        "warnings": [*found.warnings, *motion.scale_warnings],
    }, None
