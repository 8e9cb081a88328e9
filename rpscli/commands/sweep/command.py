"""`rps sweep`: all points of a study."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, NoReturn

import click

from rpscli.commands.acceptance import parse_condition
from rpscli.commands.shell.completions import FILE, condition_names
from rpscli.commands.shell.failure import INTERRUPTED, concluded, leave
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    figure_options,
    output_options,
    overrides_option,
    run_options,
    terminal_options,
)
from rpscli.commands.shell.tables import listing, title
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.dry_run import show_dry_run
from rpscli.commands.sweep.input import (
    StudyInput,
    SweepChoices,
    read_study,
    study_folder,
    study_heading,
)
from rpscli.commands.sweep.points import begin, compute
from rpscli.commands.sweep.requirements import require_results
from rpscli.commands.sweep.results import Collected, collect, first_error, outcome_counts
from rpscli.commands.sweep.tables import summary_tables, verdict_table
from rpscli.report.documents import ONE_DIRECTION, failure_document, heading
from rpscli.report.figures.look import Look

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rpscli.case.conditions import Condition
    from rpscli.report.files.output_folder import OutputFolder
    from rpscli.sweep.run.resume import Resume
    from rpscli.sweep.run.runner import Finish
    from rpscli.sweep.store import Store

WARNINGS_SHOWN = 5


@click.command("sweep")
@click.argument("study", metavar="STUDY", type=FILE)
@overrides_option(
    "Put a value over the study's own (--set 'scale=[1, 2]') or over its base case's"
    " (--set podium.bearing.slenderness=0.2)"
)
@run_options
@click.option(
    "--fail-on",
    "fail_on",
    multiple=True,
    metavar="WHAT",
    shell_complete=condition_names,
    help="End with exit code 10 if overturning=0.1 (more than this share of the records of a system"
    " at an intensity), or a result of any record exceeds a value, as rotation_ratio=0.5 (SI"
    " units); repeatable. The limits of study and case count as well.",
)
@click.option("--report-only", is_flag=True, help="Draw the reports again from what is stored.")
@figure_options
@output_options
@terminal_options
def command(
    study: str,
    overrides: tuple[str, ...],
    output: OutputRequest,
    terminal: Terminal,
    fail_on: tuple[str, ...],
    look: Look,
    **choices: Any,
) -> None:
    """Compute all points of STUDY, and draw its reports.

    Every point is stored as it ends: after an interruption the same command goes on. If points
    failed the exit code is 5, and failed.csv has the command that computes each of them alone. It
    is 10 if a limit of the study, of its base case or of --fail-on is exceeded.
    """
    chosen = SweepChoices(**choices)
    chosen.require_sense()
    conditions = [parse_condition(text) for text in fail_on]
    given = read_study(CaseRequest(study, overrides), terminal, look)
    require_results(given, conditions)
    if chosen.dry_run:
        show_dry_run(given, chosen, terminal)
        return
    from rpscli.sweep.store import Store

    folder = study_folder(given, output)
    with Store(folder.folder, fresh=chosen.fresh) as store:
        start = begin(given, store, chosen, terminal)
        try:
            finish = compute(given, start, store, chosen, terminal)
        except KeyboardInterrupt:
            finish = None
        if finish is None or finish.interrupted:
            stop("sweep", given, store, start, terminal)
        _conclude(given, store, start, finish, folder, conditions, terminal)


def stop(
    command: str, given: StudyInput, store: Store, start: Resume, terminal: Terminal
) -> NoReturn:
    """Say how to go on, and leave."""
    known = store.outcomes()
    done = sum(key in known for key in start.keys)
    text = (
        f"interrupted: {done} of {len(start.keys)} points are stored in {store.path}; the same"
        " command goes on from there"
    )
    terminal.note(text)
    document = {
        **heading(),
        "command": command,
        "study": study_heading(given),
        "points": {"total": len(start.keys), "stored": done},
        **failure_document("Interrupted", text, INTERRUPTED),
    }
    terminal.result(document)
    raise click.exceptions.Exit(INTERRUPTED)


def _conclude(
    given: StudyInput,
    store: Store,
    start: Resume,
    finish: Finish,
    folder: OutputFolder,
    conditions: list[Condition],
    terminal: Terminal,
) -> None:
    from rpscli.commands.case_input import write
    from rpscli.sweep.run.threads import available_cores
    from rpscli.sweep.study_results import StudyResults
    from rpscli.sweep.table import tabulate

    table = tabulate(given.layout, store.stored(start.keys))
    results = StudyResults(table, start.keys, store, given.context, available_cores())
    found = collect(given, results, conditions, folder)
    failures, notes = found.failures, found.notes
    error = first_error(found, len(table))
    store.require()
    write(folder, terminal)
    warn(notes, terminal)
    document = {
        **heading(),
        "command": "sweep",
        "study": study_heading(given),
        "note": ONE_DIRECTION if found.summary else None,
        "points": {
            "total": len(table),
            "computed": finish.computed,
            "kept": start.kept,
            "failed": len(failures),
            "unused": start.unused,
        },
        "outcomes": outcome_counts(table),
        **_statistics(found),
        "findings": {
            stem: [{"of": name, "found": sentence} for name, sentence in lines]
            for stem, lines in found.findings.items()
        },
        "failures": [asdict(failure) for failure in failures],
        "notes": list(start.notes),
        "warnings": notes,
        "files": [str(store.path), *folder.files],
    }
    terminal.result(concluded(document, error), _tables(document, found))
    leave(error)


def warn(notes: list[str], terminal: Terminal) -> None:
    """Say the first of the warnings, and how many there are besides."""
    terminal.warn(notes[:WARNINGS_SHOWN])
    if len(notes) > WARNINGS_SHOWN:
        terminal.note(f"... and {len(notes) - WARNINGS_SHOWN} more with --json")


def _statistics(found: Collected) -> dict[str, Any]:
    """Statistics and verdicts in JSON."""
    if found.summary is None:
        return {}
    from rpscli.report.study.statistics import summary_document, verdict_document

    keys = found.summary.keys
    return {
        "pooled": found.summary.pooled,
        "statistics": summary_document(found.summary),
        "verdicts": [verdict_document(keys, verdict) for verdict in found.verdicts],
    }


def _tables(document: dict[str, Any], found: Collected) -> Iterator[RenderableType]:
    yield title(document["study"]["title"])
    outcomes = document["outcomes"].items()
    rows = [("points", str(document["points"]["total"]))]
    yield listing([*rows, *((name, str(count)) for name, count in outcomes)])
    if found.summary is not None:
        yield from summary_tables(found.summary)
        if found.verdicts:
            yield verdict_table(found.summary, found.verdicts)
    for stem, lines in found.findings.items():
        yield title(stem)
        yield listing(lines)
    if found.summary is not None:
        yield ONE_DIRECTION
