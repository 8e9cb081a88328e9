"""`rps design`: the values of a case that meet its requirements and minimise an objective."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.commands.study import SweepChoices, computed, show_dry_run, study_heading
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.designs import Design
    from rpscli.studies import Study, StudyResult
    from rpscli.sweep.store import Store


@click.command("design")
@click.argument("design", metavar="DESIGN", type=options.FILE)
@options.overrides_option("Override a value of the file (--set search.most=64) or of its base case")
@options.run_options
@options.result_options
def command(
    design: str,
    overrides: tuple[str, ...],
    output: options.OutputRequest,
    terminal: Terminal,
    look: Look,
    **choices: Any,
) -> None:
    """Find the values of DESIGN that meet its limits and minimise its objective.

    The file has a base case, `variables`, records and `limits` as a study, and `minimise`. The
    search starts from an even sample and continues where the verdict changes. The answer is the
    best design that passes in 90 % of the resamples of the records, if any does, and is validated
    on records that the search did not see.

    Every point is stored at once: after an interruption the same command continues. The exit
    code is 10 if no design passes, or if the best one fails the limits in its validation.
    """
    done = designed(design, overrides, SweepChoices(**choices), output, look, terminal)
    if done is None:
        return
    write(done.folder, terminal)
    document = document_of(done)
    terminal.warn_first(document["warnings"], "with --json")
    terminal.result(document, tables_of(done))
    leave(done.error)


def designed(
    design: str,
    overrides: tuple[str, ...],
    chosen: SweepChoices,
    output: options.OutputRequest,
    look: Look,
    terminal: Terminal,
) -> Design | None:
    """Search, and collect the files; None after a dry run."""
    from rpscli.case.design import parse_design
    from rpscli.case.text.files import opened
    from rpscli.designs import find_design
    from rpscli.studies import Study
    from rpscli.sweep.design import Search

    search = Search(parse_design(**opened(design), overrides=overrides))
    first = Study(search.layout, overrides)
    first.require_results()
    terminal.warn(first.warnings)
    if chosen.dry_run:
        terminal.note(f"the first of at most {search.most} designs:")
        show_dry_run(first, chosen, terminal)
        return None
    place = output.place or RESULTS / first.layout.study.name / "design"
    folder = first.output(place, "design", force=output.force)

    def told(words: str, study: Study, store: Store) -> StudyResult:
        if words:
            terminal.note(words)
        return computed("design", study, store, chosen, terminal)

    return find_design(search, folder, look, told, overrides=overrides, fresh=chosen.fresh)


def document_of(done: Design) -> dict[str, Any]:
    """The answer in JSON."""
    from rpscli.report.study.shown import note_of_directions

    layout = done.run.layout
    document = {
        **heading("design"),
        "study": study_heading(layout),
        "note": note_of_directions(layout) or None,
        "points": {"total": len(done.run.table), "failed": len(done.found.failures)},
        **done.document,
        "warnings": [*done.notes, *done.run.study.warnings],
        "files": [str(done.run.results.store.path), *done.folder.files],
    }
    return concluded(document, done.error)


def tables_of(done: Design) -> Iterator[Part]:
    """The answer for readers."""
    from rpscli.report.study.shown import note_of_directions, of_first_system

    layout, document = done.run.layout, done.document
    yield Heading(layout.study.title)
    counts = [(name.replace("_", " "), str(n)) for name, n in document["designs"].items()]
    yield Table.listing([*counts, ("records scaled to", layout.scaled_to)])
    yield from done.tables
    yield of_first_system(done.judged.layout)
    yield from filter(None, [note_of_directions(layout)])
