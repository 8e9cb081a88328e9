"""The rounds of a search, computed as studies into one store."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from rpscli.commands.shell.options import CaseRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.command import stop
from rpscli.commands.sweep.input import StudyInput, SweepChoices
from rpscli.commands.sweep.points import compute
from rpscli.commands.sweep.requirements import require_results
from rpscli.report.figures.look import Look

if TYPE_CHECKING:
    from rpscli.case.study.study import Study
    from rpscli.sweep.design.answer import Answer
    from rpscli.sweep.design.search import Search
    from rpscli.sweep.statistics.verdicts import StudyVerdict
    from rpscli.sweep.store import Store
    from rpscli.sweep.study_results import StudyResults
    from rpscli.sweep.table import Table


class Confirmation(NamedTuple):
    """A design under motions that the search did not see."""

    design: str
    keys: tuple[str, ...]
    verdicts: list[StudyVerdict]
    records: int
    messages: tuple[str, ...]

    @property
    def exceeded(self) -> bool:
        """Whether a limit is, or there is no history by which to judge."""
        return not self.verdicts or any(verdict.exceeded for verdict in self.verdicts)


@dataclass(eq=False)
class Rounds:
    """A search that computes."""

    search: Search
    request: CaseRequest
    look: Look
    choices: SweepChoices
    terminal: Terminal

    def first(self) -> StudyInput:
        """The first round, laid out; with it the file is checked to its end."""
        search = self.search
        places = search.next_round()
        values = search.task.values(places)
        valid = search.valid_cases(values)
        # If none is, the first one tells why, at its place in the file.
        given = self._laid_out(search.task.study_of(values[valid] if valid.any() else values[:1]))
        search.require(given.layout)
        require_results(given, ())
        return given

    def run(self, first: StudyInput, store: Store) -> Answer:
        """All rounds, one after the other."""
        search, given, number = self.search, first, 1
        while len(places := search.next_round()):
            values = search.task.values(places)
            valid = search.valid_cases(values)
            table = None
            if valid.any():
                if number > 1:
                    given = self._laid_out(search.task.study_of(values[valid]), first)
                self.terminal.note(f"round {number}: {len(places)} designs")
                table = self._computed(given, store)[1]
            search.add(places, values, valid, table)
            number += 1
        return search.answer()

    def confirm(self, answer: Answer, store: Store) -> Iterator[Confirmation]:
        """Judge the best and the robust design under other motions, if there are any."""
        from rpscli.sweep.design.answer import NONE
        from rpscli.sweep.statistics.summary import summary
        from rpscli.sweep.statistics.verdicts import judged

        task, designs = answer.task, {"best": answer.best, "robust": answer.robust}
        for name, place in designs.items():
            if task.confirming and place != NONE:
                given = self._laid_out(task.study_of(answer.values[[place]], task.confirming))
                self.terminal.note(f"confirmation of the {name} design")
                results, table = self._computed(given, store)
                made = summary(table, results.fixed_base)
                yield Confirmation(
                    name,
                    made.keys,
                    judged(table, made),
                    len(task.confirming),
                    tuple(table.messages.values()),
                )

    def everything(
        self, answer: Answer, first: StudyInput, store: Store
    ) -> tuple[StudyInput, StudyResults]:
        """All valid designs as one study, whose points are in the store."""
        given = self._laid_out(answer.task.study_of(answer.values[answer.valid]), first)
        return given, self._computed(given, store)[0]

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

    def _laid_out(self, study: Study, earlier: StudyInput | None = None) -> StudyInput:
        """A study with its points; records are shared with an earlier one."""
        from rpscli.sweep.evaluation.context import StudyContext
        from rpscli.sweep.points.layout import lay_out

        design = lay_out(study)
        context = StudyContext(design.plan)
        if earlier is not None:
            context.records = earlier.context.records
        return StudyInput(design, context, self.request, self.look)

    def _computed(self, given: StudyInput, store: Store) -> tuple[StudyResults, Table]:
        """Compute what is not stored; leave if the user interrupts."""
        from rpscli.sweep.run.keys import all_keys
        from rpscli.sweep.run.resume import remember, resume
        from rpscli.sweep.run.threads import available_cores
        from rpscli.sweep.study_results import StudyResults
        from rpscli.sweep.table import tabulate

        keys = all_keys(given.layout, given.context)
        start = resume(given.layout, keys, store, retry_failed=self.choices.retry_failed)
        remember(given.layout, store)
        try:
            finish = compute(given, start, store, self.choices, self.terminal)
        except KeyboardInterrupt:
            finish = None
        if finish is None or finish.interrupted:
            stop("design", given, store, start, self.terminal)
        table = tabulate(given.layout, store.stored(keys))
        jobs = self.choices.jobs or available_cores()
        return StudyResults(table, keys, store, given.context, jobs), table
