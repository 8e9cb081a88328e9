"""`rps timehistory`: response of a case to a ground motion."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.analyses.result_quantities import LIMITED
from rpscli.commands.acceptance import (
    Verdict,
    case_conditions,
    exceeded,
    friction_conditions,
    judge,
    parse_condition,
)
from rpscli.commands.case_input import CaseInput, case_folder, case_heading, read_case, write
from rpscli.commands.motion import MotionRequest, load_motion, motion_inputs
from rpscli.commands.shell.compilation import announce_compilation
from rpscli.commands.shell.failure import concluded, leave
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    case_options,
    figure_options,
    output_options,
    terminal_options,
)
from rpscli.commands.shell.patience import patience
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.timehistory_tables import timehistory_tables
from rpscli.errors import AnalysisError, RpsError, UsageError
from rpscli.report.documents import heading, timehistory_document
from rpscli.report.figures.drawing import artists
from rpscli.report.figures.look import Look
from rpscli.report.files.json_text import json_text

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.records.ground_motion import MotionComponents


@click.command("timehistory")
@case_options
@click.option(
    "--record", metavar="SRC", help="Ground motion in place of the case's own: file, set, pulse."
)
@click.option("--vertical", metavar="SRC", help="Vertical component, with the same time step.")
@click.option("--scale", type=float, metavar="FACTOR", help="Factor on the acceleration.")
@click.option(
    "--fail-on",
    "fail_on",
    multiple=True,
    metavar="WHAT",
    help="End with exit code 10 on overturning, on uplift, or if a result exceeds a value, such as"
    f" {', '.join(f'{result.name}={result.limit}' for result in LIMITED)} (SI units); repeatable.",
)
@click.option(
    "--animate", type=click.Path(path_type=Path), metavar="FILE.gif", help="Also draw it moving."
)
@figure_options
@output_options
@terminal_options
def command(
    request: CaseRequest,
    output: OutputRequest,
    terminal: Terminal,
    fail_on: tuple[str, ...],
    animate: Path | None,
    look: Look,
    **motion: Any,
) -> None:
    """Response of CASE to its record, or to that of --record.

    Overturning is a result, not an error: see --fail-on. The limits of the case count as well.
    """
    conditions = [parse_condition(text) for text in fail_on]
    if animate is not None and animate.suffix.lower() != ".gif":
        raise UsageError(f"--animate {animate}: must end with .gif, the only format there is")
    given = read_case(request, terminal)
    ground = load_motion(given.case, MotionRequest(**motion))
    folder = case_folder(given, output, "timehistory", record=motion_inputs(ground))
    with artists(5 * len(look.endings)) as drawing:
        announce_compilation(terminal, moving=True)
        from rpscli.analyses.timehistory import time_history  # noqa: PLC0415 -- numba is slow
        from rpscli.report.bundles import timehistory_files  # noqa: PLC0415

        with patience(given.case, ground.horizontal.duration, terminal):
            result = time_history(
                given.case.structure,
                ground.horizontal,
                given.case.analysis,
                vertical=ground.vertical,
            )
        for name, content in timehistory_files(result, given.case.title, look, drawing):
            folder.add(name, content)
    if result.failure:
        verdicts: list[Verdict] = []
        error: RpsError | None = AnalysisError(result.failure)
    else:
        slides = friction_conditions(given.case.structure)
        verdicts = judge(result, [*case_conditions(given.case.limits), *slides, *conditions])
        error = exceeded(verdicts)
    if animate is not None:
        from rpscli.report.figures.animation import animation_gif  # noqa: PLC0415

        terminal.note("drawing the animation")
        folder.add_at(animate, animation_gif(result, given.case.title))
    document = concluded(_document(given, ground, result, verdicts), error)
    document["files"] = [str(folder.folder / "summary.json"), *folder.files]
    folder.add("summary.json", json_text(document))
    write(folder, terminal)
    terminal.warn(document["warnings"])
    terminal.result(document, timehistory_tables(result, verdicts, given.case.title))
    leave(error)


def _document(
    given: CaseInput, ground: MotionComponents, result: TimeHistoryResult, verdicts: list[Verdict]
) -> dict[str, Any]:
    document = {
        **heading(),
        "command": "timehistory",
        "case": case_heading(given),
        **timehistory_document(result),
        "verdicts": [asdict(verdict) for verdict in verdicts],
    }
    document["record"] |= {"scale": ground.scale}
    of_motion = (*(ground.vertical.warnings if ground.vertical else ()), *ground.scale_warnings)
    document["warnings"] = [*given.case.warnings, *document["warnings"], *of_motion]
    return document
