"""A design from its file to its files: searched for, judged as a study, validated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.design import (
    answer_document,
    answer_notes,
    answer_tables,
    design_columns,
    figures,
    nothing_passes,
)
from rpscli.report.figures.look import Look, figure_files
from rpscli.report.files import OutputFolder
from rpscli.report.limits import VERDICT, verdict_texts
from rpscli.report.study.statistics import verdict_columns, verdict_document, verdict_lines
from rpscli.report.table import Heading, Part, Table, csv_text
from rpscli.studies import Collected, Study, StudyResult, collected, error_of
from rpscli.sweep.design import Answer, Search
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.store import Store


@dataclass(frozen=True)
class Design:
    """A design that was searched for, the studies that it rests on, and its files.

    `run` has all valid designs, of which `found` tells; `judged` has the best or least violated one
    under the records of the search, `validated` the best one under others.
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
        lines = verdict_lines(self.validated.keys, self.validated.judgements, "validation: ")
        return LimitExceeded("\n".join(lines)) if lines else None

    @property
    def notes(self) -> Iterator[str]:
        """Remarks on the answer."""
        yield from answer_notes(self.answer, self.search.faults)
        if self.keeps_limits is False:
            yield "the best design does not keep its limits under the records of `validate`"
        yield from self.found.notes

    @property
    def document(self) -> dict[str, Any]:
        """The answer in JSON."""
        found = answer_document(self.answer, self.judged.judgements)
        found |= {"validated": self.keeps_limits, "validation": []}
        if (run := self.validated) is not None:
            found["validation"] = [verdict_document(run.keys, v) for v in run.judgements]
        return found

    @property
    def tables(self) -> Iterator[Part]:
        """The answer, then its validation."""
        yield from answer_tables(self.answer, self.judged.judgements)
        if self.validated is not None:
            unseen = len(self.answer.task.unseen)
            yield Heading(f"validation with {unseen} records that were not used")
            yield Table.of_texts(VERDICT, map(verdict_texts, self.validated.judgements), words=4)


def find_design(
    search: Search,
    folder: OutputFolder,
    look: Look,
    compute: Callable[[str, Study, Store], StudyResult],
    *,
    overrides: tuple[str, ...] = (),
    fresh: bool = False,
) -> Design:
    """Search, judge what is best, and collect all files, with the points in a store of the folder.

    `compute` computes what the store lacks of a study, and may say so in the words that it gets.
    """
    task, rounds, validated = search.task, 0, None
    records = search.layout.context.records  # read once

    with Store(folder.folder, fresh=fresh) as store:

        def computed(words: str, layout: StudyPoints) -> StudyResult:
            layout.context.records = records
            return compute(words, Study(layout, overrides), store)

        def evaluated(layout: StudyPoints) -> Any:
            nonlocal rounds
            rounds += 1
            return computed(f"round {rounds}: {len(layout.properties)} designs", layout).table

        answer = search.run(evaluated)
        best = answer.values[[answer.closest]]
        if task.unseen and answer.best is not None:
            unseen = lay_out(task.study_of(best, task.unseen))
            validated = computed("validation of the best design", unseen)
        judged = computed("", lay_out(task.study_of(best)))
        run = computed("", lay_out(task.study_of(answer.values[answer.valid])))
        found = collected(run, look)
        folder.add_all(found.files.items())
        folder.add("designs.csv", csv_text(design_columns(answer)))
        if validated is not None:
            columns = verdict_columns(validated.keys, validated.judgements)
            folder.add("validation.csv", csv_text(columns))
        title = task.study.title
        folder.add_all(figure_files(figures(answer, title), look).items())
        store.require()
    return Design(search, answer, run, found, judged, validated, folder)
