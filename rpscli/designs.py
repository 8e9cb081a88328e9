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
    validation_text,
)
from rpscli.report.figures.look import Look, figure_files
from rpscli.report.study.statistics import (
    VERDICT,
    verdict_columns,
    verdict_document,
    verdict_lines,
    verdict_texts,
)
from rpscli.report.table import Heading, Part, Table, csv_text
from rpscli.studies import Study
from rpscli.study_run import Collected, StudyRun
from rpscli.sweep.design import Answer, Search
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.points.layout import StudyPoints, lay_out
from rpscli.sweep.store import Store


@dataclass(frozen=True)
class Design:
    """A design that was searched for, and the studies that it rests on, in one store.

    `run` has all valid designs, `judged` the best or least violated one under the records of the
    search, `validated` the best one under those that the search did not see.
    """

    search: Search
    answer: Answer
    run: StudyRun
    judged: StudyRun
    validated: StudyRun | None
    overrides: tuple[str, ...]

    @property
    def study(self) -> Study:
        """All valid designs as a study."""
        return Study(self.run.layout, self.run.context, self.overrides)

    @property
    def confirmed(self) -> bool | None:
        """Whether the best design keeps its limits in the validation; None without one."""
        if self.validated is None:
            return None
        verdicts = self.validated.verdicts
        return bool(verdicts) and not any(verdict.exceeded for verdict in verdicts)

    def files(self, found: Collected, look: Look) -> Iterator[tuple[str, str | bytes]]:
        """Those of the study `found` of all designs, and those of the search."""
        yield from found.files.items()
        yield "designs.csv", csv_text(design_columns(self.answer))
        if self.validated is not None:
            columns = verdict_columns(self.validated.keys_of_rows, self.validated.verdicts)
            yield "validation.csv", csv_text(columns)
        yield from figure_files(figures(self.answer, self.study.title), look).items()

    def error(self, found: Collected) -> RpsError | None:
        """Points that failed, no design that passes, or a validation that failed."""
        # Designs that exceed limits are what was looked for, not what went wrong.
        if error := self.run.error(found, limits=False):
            return error
        if self.answer.best is None:
            return LimitExceeded(nothing_passes(self.answer))
        if self.validated is None:
            return None
        if messages := dict.fromkeys(self.validated.table.messages.values()):
            return StudyIncomplete("\n".join(f"validation: {text}" for text in messages))
        lines = verdict_lines(self.validated.keys_of_rows, self.validated.verdicts, "validation: ")
        return LimitExceeded("\n".join(lines)) if lines else None

    def notes(self, found: Collected) -> list[str]:
        """What the user should know about the answer."""
        notes = [*answer_notes(self.answer, self.search.faults), *self.study.warnings]
        if self.confirmed is False:
            notes.append("the best design does not keep its limits under the records of `validate`")
        return [*notes, *found.notes]

    def document(self) -> dict[str, Any]:
        """The answer in JSON."""
        found = answer_document(self.answer, self.judged.verdicts)
        found |= {"validated": self.confirmed, "validation": []}
        if (run := self.validated) is not None:
            found["validation"] = [verdict_document(run.keys_of_rows, v) for v in run.verdicts]
        return found

    def tables(self) -> Iterator[Part]:
        """The answer, then its validation."""
        yield from answer_tables(self.answer, self.judged.verdicts)
        if self.validated is not None:
            unseen = len(self.answer.task.unseen)
            yield Heading(f"validation with {unseen} records that were not used")
            yield Table.of_texts(VERDICT, map(verdict_texts, self.validated.verdicts), words=4)
            yield from validation_text(self.validated.verdicts, unseen)


def find_design(
    search: Search,
    overrides: tuple[str, ...],
    store: Store,
    compute: Callable[[str, StudyRun], object],
    **choices: Any,
) -> Design:
    """Search, with all histories in a store, and judge what is best.

    `compute` computes what a run lacks, and may say so in the words that it gets; `choices` are
    those of a `StudyRun`.
    """
    task, counts = search.task, []
    context = StudyContext(search.layout.plan, search.layout.examined)

    def computed(words: str, layout: StudyPoints) -> StudyRun:
        of_these = StudyContext(layout.plan, layout.examined)
        of_these.records = context.records  # read once
        run = StudyRun(layout, of_these, store, **choices)
        compute(words, run)
        _ = run.verdicts  # which need the store as long as it is open
        return run

    def evaluated(layout: StudyPoints) -> Any:
        counts.append(len(layout.combinations))
        return computed(f"round {len(counts)}: {counts[-1]} designs", layout).table

    answer = search.run(evaluated)
    best, validated = answer.values[[answer.closest]], None
    if task.unseen and answer.best is not None:
        unseen = lay_out(task.study_of(best, task.unseen))
        validated = computed("validation of the best design", unseen)
    judged = computed("", lay_out(task.study_of(best)))
    run = computed("", lay_out(task.study_of(answer.values[answer.valid])))
    return Design(search, answer, run, judged, validated, overrides)
