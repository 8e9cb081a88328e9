"""`rps design`: the values of a case that meet its requirements and minimise an objective."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from rpscli.commands.case_input import RESULTS, write
from rpscli.commands.design_tables import answer_tables, nothing_passes
from rpscli.commands.shell.completions import FILE
from rpscli.commands.shell.failure import concluded, leave
from rpscli.commands.shell.options import (
    OutputRequest,
    figure_options,
    output_options,
    overrides_option,
    run_options,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.study import SweepChoices, compute, show_dry_run, study_heading, warn
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.documents import ONE_DIRECTION, heading
from rpscli.report.figures.look import Look
from rpscli.report.table import csv_text

if TYPE_CHECKING:
    from rpscli.case.study.study import Study as CheckedStudy
    from rpscli.studies import Study
    from rpscli.study_run import StudyRun
    from rpscli.sweep.design.answer import Answer
    from rpscli.sweep.design.search import Search
    from rpscli.sweep.store import Store


@click.command("design")
@click.argument("design", metavar="DESIGN", type=FILE)
@overrides_option("Override a value of the file (--set search.most=64) or of its base case")
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
    """Find the values of DESIGN that meet its limits and minimise its objective.

    The file has a base case, `variables`, records and `limits` as a study, and `minimise`. An
    even sample comes first, then designs where the verdict changes. The answer has the best design,
    the region that passes, what binds, and how far the choice of records moves it.

    Every point is stored as it ends: after an interruption the same command goes on. The exit code
    is 10 if no design passes.
    """
    from rpscli.case.design import read_design
    from rpscli.report.design.answer import answer_document, design_columns
    from rpscli.report.design.figures import figures
    from rpscli.report.figures.drawing import figure_files
    from rpscli.report.study.statistics import verdict_columns, verdict_document
    from rpscli.sweep.design.search import Search
    from rpscli.sweep.store import Store

    chosen = SweepChoices(**choices)
    search = Search(read_design(design, overrides))
    rounds = Rounds(search, overrides, chosen, terminal)
    first = rounds.first()
    if chosen.dry_run:
        terminal.note(f"the first of at most {search.most} designs:")
        show_dry_run(first, chosen, terminal)
        return
    place = output.place or RESULTS / first.layout.study.name / "design"
    folder = first.folder(place, "design", force=output.force)
    with Store(place, fresh=chosen.fresh) as store:
        answer = rounds.run(first, store)
        confirmations = list(rounds.confirm(answer, store))
        study, run = rounds.everything(answer, first, store)
        found = run.collect(place, look)
        folder.add_all(found.files.items())
        folder.add("designs.csv", csv_text(design_columns(answer, range(len(answer.places)))))
        if len(answer.front):
            folder.add("front.csv", csv_text(design_columns(answer, answer.front)))
        if confirmations:
            verdicts = [verdict for each in confirmations for verdict in each.run.verdicts]
            columns = verdict_columns(confirmations[0].keys, verdicts)
            folder.add("confirmation.csv", csv_text(columns))
        drawn = figures(answer, run.layout.study.title)
        folder.add_all(figure_files(drawn, look).items())
        # Designs that exceed limits are what was looked for, not what went wrong.
        error = run.error(found, limits=False) or _limits(answer) or _unconfirmed(confirmations)
        store.require()
        write(folder, terminal)
    notes = [*rounds.notes(answer, confirmations), *study.warnings, *found.notes]
    warn(notes, terminal)
    document = {
        **heading(),
        "command": "design",
        "study": study_heading(run.layout),
        "note": ONE_DIRECTION,
        "points": {"total": len(run.table), "failed": len(found.failures)},
        **answer_document(answer),
        "confirmed": not confirmations[0].exceeded if confirmations else None,
        "confirmation": {
            each.design: [verdict_document(each.keys, verdict) for verdict in each.run.verdicts]
            for each in confirmations
        },
        "warnings": notes,
        "files": [str(store.path), *folder.files],
    }
    confirmation = {each.design: each.run.verdicts for each in confirmations}
    tables = answer_tables(document, answer, confirmation)
    terminal.result(concluded(document, error), tables)
    leave(error)


class Confirmation(NamedTuple):
    """A design under motions that the search did not see."""

    design: str
    run: StudyRun

    @property
    def keys(self) -> tuple[str, ...]:
        """That tell apart what verdicts are on."""
        return self.run.summary.keys if self.run.summary else ()

    @property
    def exceeded(self) -> bool:
        """Whether a limit is, or there is no history by which to judge."""
        verdicts = self.run.verdicts
        return not verdicts or any(verdict.exceeded for verdict in verdicts)


class Rounds:
    """The rounds of a search, computed as studies into one store."""

    def __init__(
        self, search: Search, overrides: tuple[str, ...], choices: SweepChoices, terminal: Terminal
    ) -> None:
        self.search, self.overrides = search, overrides
        self.choices, self.terminal = choices, terminal

    def first(self) -> Study:
        """The first round, laid out; with it the file is checked to its end."""
        from rpscli.study_run import require_results

        search = self.search
        places = search.next_round()
        values = search.task.values(places)
        valid = search.valid_cases(values)
        # If none is, the first one tells why, at its place in the file.
        first = self._laid_out(search.task.study_of(values[valid] if valid.any() else values[:1]))
        search.require(first.layout)
        require_results(first.layout, ())
        return first

    def run(self, first: Study, store: Store) -> Answer:
        """All rounds, one after the other."""
        search, study, number = self.search, first, 1
        while len(places := search.next_round()):
            values = search.task.values(places)
            valid = search.valid_cases(values)
            table = None
            if valid.any():
                if number > 1:
                    study = self._laid_out(search.task.study_of(values[valid]), first)
                self.terminal.note(f"round {number}: {len(places)} designs")
                table = self._computed(study, store).table
            search.add(places, values, valid, table)
            number += 1
        return search.answer()

    def confirm(self, answer: Answer, store: Store) -> Iterator[Confirmation]:
        """Judge the best and the robust design under other motions, if there are any."""
        from rpscli.sweep.design.answer import NONE

        task, designs = answer.task, {"best": answer.best, "robust": answer.robust}
        for name, place in designs.items():
            if task.confirming and place != NONE:
                study = self._laid_out(task.study_of(answer.values[[place]], task.confirming))
                self.terminal.note(f"confirmation of the {name} design")
                yield Confirmation(name, self._computed(study, store))

    def everything(self, answer: Answer, first: Study, store: Store) -> tuple[Study, StudyRun]:
        """All valid designs as one study, whose points are in the store."""
        study = self._laid_out(answer.task.study_of(answer.values[answer.valid]), first)
        return study, self._computed(study, store)

    def notes(self, answer: Answer, confirmations: list[Confirmation]) -> Iterator[str]:
        """What the user should know about the answer."""
        from rpscli.sweep.design.answer import NONE

        if invalid := int((~answer.valid).sum()):
            reason = next(iter(self.search.faults))
            yield f"{invalid} designs are no valid cases and count as failing: {reason}"
        if not answer.resamples and answer.task.file.search.resamples:
            yield "one record only: how far the choice of records moves the answer is not known"
        if answer.best != NONE and (ends := list(answer.at_bounds)):
            words = " and ".join(f"the {end} {key}" for key, end in ends)
            yield f"the best design has {words} of the range; a wider one may have a better design"
        for each in confirmations:
            if each.exceeded:
                yield f"the {each.design} design does not keep its limits under the other motions"

    def _laid_out(self, checked: CheckedStudy, earlier: Study | None = None) -> Study:
        """A study with its points; records are shared with an earlier one."""
        from rpscli.studies import Study
        from rpscli.sweep.evaluation.context import StudyContext
        from rpscli.sweep.points.layout import lay_out

        layout = lay_out(checked)
        context = StudyContext(layout.plan)
        if earlier is not None:
            context.records = earlier.context.records
        return Study(layout, context, self.overrides)

    def _computed(self, study: Study, store: Store) -> StudyRun:
        """Compute what is not stored; leave if the user interrupts."""
        run = study.opened(store, **self.choices.of_run)
        compute("design", run, self.terminal)
        return run


def _unconfirmed(confirmations: list[Confirmation]) -> RpsError | None:
    """Histories of the confirmation that failed."""
    texts = (text for each in confirmations for text in each.run.table.messages.values())
    lines = list(dict.fromkeys(f"confirmation: {text}" for text in texts))
    return StudyIncomplete("\n".join(lines)) if lines else None


def _limits(answer: Answer) -> RpsError | None:
    text = nothing_passes(answer)
    return LimitExceeded(text) if text else None
