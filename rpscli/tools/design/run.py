"""A design from its file to its files: searched for, judged as a study, validated."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from rpscli.case.text.files import opened
from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell.options import CaseRequest, Output, RunChoices
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.commands.study import computed, show_dry_run, study_heading
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.figures.look import Look
from rpscli.report.figures.style import figure_files
from rpscli.report.files import OutputFolder, heading
from rpscli.report.limits import VERDICT, verdict_texts
from rpscli.report.study.collected import Collected
from rpscli.report.study.statistics import (
    note_of_directions,
    of_first_system,
    verdict_columns,
    verdict_document,
    verdict_lines,
)
from rpscli.report.table import Heading, Part, Table, csv_text
from rpscli.studies import Study, StudyResult, collected, error_of
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.store import Store
from rpscli.sweep.table import PointTable as Points
from rpscli.tools.design.keys import parse_design
from rpscli.tools.design.report import (
    answer_document,
    answer_notes,
    answer_tables,
    best_so_far,
    design_columns,
    figures,
    nothing_passes,
)
from rpscli.tools.design.search import Answer, Search


class Design(NamedTuple):
    """A design that was searched for, the studies that it rests on, and its files.

    `run` has all valid designs, of which `found` tells; `judged` has the best or least
    violated one under the records of the search, `validated` the best one under others.
    """

    search: Search
    answer: Answer
    run: StudyResult
    found: Collected
    judged: StudyResult
    validated: StudyResult | None
    folder: OutputFolder

    @property
    def keeps_limits(self) -> bool | None:
        """True if the best design does so in the validation; None without one."""
        if self.validated is None:
            return None
        verdicts = self.validated.judgements
        return bool(verdicts) and not any(verdict.exceeded for verdict in verdicts)

    @property
    def error(self) -> RpsError | None:
        """Points that failed, no design that passes, or a validation that failed."""
        # Designs that exceed limits are what was looked for, not what went wrong.
        if error := error_of(self.run, self.found, limits=False):
            return error
        if self.answer.best is None:
            return LimitExceeded(nothing_passes(self.answer))
        if self.validated is None:
            return None
        if messages := dict.fromkeys(self.validated.table.messages.values()):
            return StudyIncomplete("\n".join(f"validation: {text}" for text in messages))
        lines = verdict_lines(
            self.validated.keys, self.validated.judgements, "validation: "
        )
        return LimitExceeded("\n".join(lines)) if lines else None

    @property
    def document(self) -> dict[str, Any]:
        """The answer in JSON."""
        layout = self.run.layout
        unseen = self.validated
        notes = [*answer_notes(self.answer, self.search.faults)]
        if self.keeps_limits is False:
            notes.append(
                "the best design does not keep its limits under the records of `validate`"
            )
        validation = unseen and [
            verdict_document(unseen.keys, v) for v in unseen.judgements
        ]
        document = {
            **heading("design"),
            "study": study_heading(layout),
            "note": note_of_directions(layout) or None,
            "points": {"total": len(self.run.table), "failed": len(self.found.failures)},
            **answer_document(self.answer, self.judged.judgements),
            "validated": self.keeps_limits,
            "validation": validation or [],
            "warnings": [*notes, *self.found.notes, *self.run.study.warnings],
            "files": [str(self.run.results.store.path), *self.folder.files],
        }
        return concluded(document, self.error)

    @property
    def tables(self) -> Iterator[Part]:
        """The answer for readers, then its validation."""
        layout = self.run.layout
        judgements = self.judged.judgements
        yield Heading(layout.study.title)
        counts = answer_document(self.answer, judgements)["designs"]
        listing = [
            (name.replace("_", " "), str(number)) for name, number in counts.items()
        ]
        yield Table.listing([*listing, ("records scaled to", layout.scaled_to)])
        yield from answer_tables(self.answer, judgements)
        if self.validated is not None:
            unseen = len(self.answer.task.unseen)
            yield Heading(f"validation with {unseen} records that were not used")
            yield Table.of_texts(
                VERDICT, map(verdict_texts, self.validated.judgements), words=4
            )
        yield of_first_system(self.judged.layout)
        yield from filter(None, [note_of_directions(layout)])

    def conclude(self, terminal: Terminal) -> None:
        """Write the files, and give the answer."""
        write(self.folder, terminal)
        document = self.document
        terminal.warn_first(document["warnings"], "with --json")
        terminal.result(document, self.tables)
        leave(self.error)


def designed(request: CaseRequest, choices: RunChoices, out: Output) -> Design | None:
    """Search, judge what is best, and collect the files; None after a dry run."""
    terminal = out.terminal
    task = parse_design(**opened(request.source), overrides=request.overrides)
    search = Search(task)
    rounds = 0
    validated = None
    first = Study(search.layout, request.overrides)
    first.require_results()
    terminal.warn(task.study.notes)  # doubts about systems come with those of all rounds
    if choices.dry_run:
        terminal.note(f"the first of at most {search.most} designs:")
        show_dry_run("design", first, choices, terminal)
        return None
    place = out.place or RESULTS / task.study.name / "design"
    folder = first.output(place, "design", force=out.force)
    records = search.layout.context.records  # read once
    with Store(folder.folder, fresh=choices.fresh) as store:

        def run(layout: StudyPoints) -> StudyResult:
            layout.context.records = records
            return computed(
                "design", Study(layout, request.overrides), store, choices, terminal
            )

        def evaluated(layout: StudyPoints) -> Points:
            nonlocal rounds
            rounds += 1
            designs = len(layout.properties)
            terminal.note(f"round {rounds} of {search.most_rounds}: {designs} designs")
            return run(layout).table

        answer = search.run(evaluated, lambda known: terminal.note(best_so_far(known)))
        best = answer.values[[answer.closest]]
        if task.unseen and answer.best is not None:
            terminal.note("validation of the best design")
            validated = run(lay_out(task.study_of(best, task.unseen)))
        judged = run(lay_out(task.study_of(best)))
        every = run(lay_out(task.study_of(answer.values[answer.valid])))
        found = collected(every, out.look)
        design = Design(search, answer, every, found, judged, validated, folder)
        _add_files(design, out.look)
        store.require()
    return design


def _add_files(design: Design, look: Look) -> None:
    """Tables and figures of the study, the designs, and the validation."""
    folder = design.folder
    answer = design.answer
    validated = design.validated
    folder.add_all(design.found.files.items())
    folder.add("designs.csv", csv_text(design_columns(answer)))
    if validated is not None:
        columns = verdict_columns(validated.keys, validated.judgements)
        folder.add("validation.csv", csv_text(columns))
    title = answer.task.study.title
    folder.add_all(figure_files(figures(answer, title), look).items())
