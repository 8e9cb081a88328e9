"""`rps design`: the values of a case that meet its requirements and make an aim least."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.case_input import write
from rpscli.commands.design.rounds import Rounds
from rpscli.commands.design.tables import answer_tables, nothing_passes
from rpscli.commands.shell.completions import FILE
from rpscli.commands.shell.failure import concluded, leave
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    figure_options,
    output_options,
    overrides_option,
    run_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.command import warn
from rpscli.commands.sweep.dry_run import show_dry_run
from rpscli.commands.sweep.input import SweepChoices, study_folder, study_heading
from rpscli.commands.sweep.results import collect, first_error
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.documents import ONE_DIRECTION, heading
from rpscli.report.figures.look import Look
from rpscli.report.files.csv_text import csv_text
from rpscli.report.files.output_folder import OutputFolder

if TYPE_CHECKING:
    from rpscli.commands.design.rounds import Confirmation
    from rpscli.commands.sweep.input import StudyInput
    from rpscli.sweep.design.answer import Answer
    from rpscli.sweep.study_results import StudyResults


@click.command("design")
@click.argument("design", metavar="DESIGN", type=FILE)
@overrides_option("Put a value over the file's own (--set search.most=64) or over its base case's")
@run_options
@figure_options
@output_options
@terminal_options
def command(
    design: str,
    overrides: tuple[str, ...],
    output: OutputRequest,
    terminal: Terminal,
    look: Look,
    **choices: Any,
) -> None:
    """Find the values of DESIGN that meet its limits and make what is `least` least.

    The file has a base case, `find` with ranges, records and `limits` as a study, and `least`. An
    even sample comes first, then designs where the verdict changes. The answer has the best design,
    the region that passes, what binds, and how far the choice of records moves it.

    Every point is stored as it ends: after an interruption the same command goes on. The exit code
    is 10 if no design passes.
    """
    from rpscli.case.design import read_design
    from rpscli.sweep.design.search import Search
    from rpscli.sweep.store import Store

    chosen = SweepChoices(**choices)
    chosen.require_sense()
    search = Search(read_design(design, overrides))
    rounds = Rounds(search, CaseRequest(design, overrides), look, chosen, terminal)
    first = rounds.first()
    if chosen.dry_run:
        terminal.note(f"the first of at most {search.most} designs:")
        show_dry_run(first, chosen, terminal)
        return
    folder = study_folder(first, output, "design")
    with Store(folder.folder, fresh=chosen.fresh) as store:
        answer = rounds.run(first, store)
        confirmations = list(rounds.confirm(answer, store))
        given, results = rounds.everything(answer, first, store)
        _conclude(rounds, given, results, answer, confirmations, folder)


def _conclude(
    rounds: Rounds,
    given: StudyInput,
    results: StudyResults,
    answer: Answer,
    confirmations: list[Confirmation],
    folder: OutputFolder,
) -> None:
    from rpscli.report.design.answer import answer_document, design_columns
    from rpscli.report.design.figures import figures
    from rpscli.report.figures.drawing import figure_files
    from rpscli.report.study.statistics import verdict_columns, verdict_document

    found = collect(given, results, (), folder)
    folder.add("designs.csv", csv_text(design_columns(answer, range(len(answer.places)))))
    if len(answer.front):
        folder.add("front.csv", csv_text(design_columns(answer, answer.front)))
    if confirmations:
        verdicts = [verdict for each in confirmations for verdict in each.verdicts]
        columns = verdict_columns(confirmations[0].keys, verdicts)
        folder.add("confirmation.csv", csv_text(columns))
    for name, content in figure_files(figures(answer, given.study.title), given.look).items():
        folder.add(name, content)
    error = (
        first_error(found._replace(verdicts=[]), len(results.table))
        or _limits(answer)
        or _unconfirmed(confirmations)
    )
    results.store.require()
    write(folder, rounds.terminal)
    notes = [*rounds.notes(answer, confirmations), *found.notes]
    warn(notes, rounds.terminal)
    document = {
        **heading(),
        "command": "design",
        "study": study_heading(given),
        "note": ONE_DIRECTION,
        "points": {"total": len(results.table), "failed": len(found.failures)},
        **answer_document(answer),
        "confirmed": not confirmations[0].exceeded if confirmations else None,
        "confirmation": {
            each.design: [verdict_document(each.keys, verdict) for verdict in each.verdicts]
            for each in confirmations
        },
        "warnings": notes,
        "files": [str(results.store.path), *folder.files],
    }
    tables = answer_tables(document, answer, confirmations)
    rounds.terminal.result(concluded(document, error), tables)
    leave(error)


def _unconfirmed(confirmations: list[Confirmation]) -> RpsError | None:
    """Histories of the confirmation that failed."""
    lines = [f"confirmation: {text}" for each in confirmations for text in each.messages]
    return StudyIncomplete("\n".join(dict.fromkeys(lines))) if lines else None


def _limits(answer: Answer) -> RpsError | None:
    text = nothing_passes(answer)
    return LimitExceeded(text) if text else None
