"""`rps design`: the values of a case that meet its requirements and minimise an objective."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell.options import (
    FILE,
    OutputRequest,
    overrides_option,
    result_options,
    run_options,
)
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.commands.study import SweepChoices, show_dry_run, study_heading
from rpscli.report.documents import direction_note, heading
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder
from rpscli.report.table import Part, csv_text

if TYPE_CHECKING:
    from rpscli.errors import RpsError
    from rpscli.studies import Study
    from rpscli.sweep.design.answer import Answer


@click.command("design")
@click.argument("design", metavar="DESIGN", type=FILE)
@overrides_option("Override a value of the file (--set search.most=64) or of its base case")
@run_options
@result_options
def command(
    design: str,
    overrides: tuple[str, ...],
    output: OutputRequest,
    terminal: Terminal,
    look: Look,
    **choices: Any,
) -> None:
    """Find the values of DESIGN that meet its limits and minimise its objective.

    The file has a base case, `variables`, records and `limits` as a study, and `minimise`. The
    search starts from an even sample and continues where the verdict changes. The recommended
    design is the best one of a region in which all designs examined pass, within their tolerances.
    The answer also has the least design that passes, what governs, and the effect of the records.

    Every point is stored at once: after an interruption the same command continues. The exit
    code is 10 if no design passes, or if the recommended one fails the limits in its validation.
    """
    done = designed(design, overrides, SweepChoices(**choices), output, look, terminal)
    if done is None:
        return
    terminal.warn_first(done.document["warnings"], "with --json")
    terminal.result(done.document, done.tables)
    leave(done.error)


class Designed(NamedTuple):
    """A design that was searched for: its answer, all its designs as a study, what to show."""

    answer: Answer
    study: Study
    folder: OutputFolder
    document: dict[str, Any]
    tables: Sequence[Part]
    error: RpsError | None


def designed(
    design: str,
    overrides: tuple[str, ...],
    chosen: SweepChoices,
    output: OutputRequest,
    look: Look,
    terminal: Terminal,
    *,
    written: bool = True,
) -> Designed | None:
    """Search, and write the results unless only the points are kept; None after a dry run."""
    from rpscli.case.design import read_design
    from rpscli.commands.design_rounds import (
        Rounds,
        answer_tables,
        headline_of,
        keeps_limits,
        nothing_passes,
        unconfirmed,
    )
    from rpscli.report.design import answer_document, design_columns, figures
    from rpscli.report.figures.look import figure_files
    from rpscli.report.study.folder import study_folder
    from rpscli.report.study.statistics import verdict_columns, verdict_document
    from rpscli.sweep.design.search import Search
    from rpscli.sweep.store import Store

    search = Search(read_design(design, overrides))
    rounds = Rounds(search, overrides, chosen, terminal)
    first = rounds.first()
    if chosen.dry_run:
        terminal.note(f"the first of at most {search.most} designs:")
        show_dry_run(first, chosen, terminal)
        return None
    place = output.place or RESULTS / first.layout.study.name / "design"
    folder = study_folder(first.layout, place, overrides, "design", force=output.force)
    with Store(place, fresh=chosen.fresh) as store:
        answer = rounds.run(first, store)
        confirmations = dict(rounds.confirm(answer, store))
        softer = rounds.with_other_loss(answer, store)
        study, run = rounds.everything(answer, first, store)
        found = run.collect(place, look)
        folder.add_all(found.files.items())
        folder.add("designs.csv", csv_text(design_columns(answer, range(len(answer.places)))))
        if len(answer.front):
            folder.add("front.csv", csv_text(design_columns(answer, answer.front)))
        if confirmations:
            verdicts = [verdict for each in confirmations.values() for verdict in each.verdicts]
            columns = verdict_columns(confirmations["best"].keys_of_rows, verdicts)
            folder.add("confirmation.csv", csv_text(columns))
        drawn = figures(answer, run.layout.study.title)
        folder.add_all(figure_files(drawn, look).items())
        # Designs that exceed limits are what was looked for, not what went wrong.
        error = run.error(found, limits=False) or nothing_passes(answer)
        error = error or unconfirmed(confirmations)
        store.require()
        if written:
            write(folder, terminal)
    notes = [*rounds.notes(answer, confirmations), *study.warnings, *found.notes]
    judged = headline_of(confirmations)
    document = {
        **heading("design"),
        "study": study_heading(run.layout),
        "note": direction_note(run.layout.pairs) or None,
        "points": {"total": len(run.table), "failed": len(found.failures)},
        **answer_document(answer),
        "confirmed": keeps_limits(confirmations[judged]) if judged else None,
        "confirmation": {
            name: [verdict_document(each.keys_of_rows, verdict) for verdict in each.verdicts]
            for name, each in confirmations.items()
        },
        "other_loss": softer
        and [verdict_document(softer.keys_of_rows, verdict) for verdict in softer.verdicts],
        "warnings": notes,
        "files": [str(store.path), *folder.files],
    }
    tables = [*answer_tables(document, answer, confirmations, softer)]
    return Designed(answer, study, folder, concluded(document, error), tables, error)
