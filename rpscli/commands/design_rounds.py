"""The rounds of `rps design`, computed as studies into one store, and the answer in tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from rpscli.case.conditions import condition_text
from rpscli.case.study.study import Study as CheckedStudy
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.study import SweepChoices, compute
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.design import requirement_label
from rpscli.report.documents import ONE_DIRECTION
from rpscli.report.study.labels import label, symbol
from rpscli.report.study.statistics import VERDICT, verdict_texts
from rpscli.report.table import Heading, Part, Table, large, measured, shown
from rpscli.studies import Study
from rpscli.study_run import StudyRun, require_results
from rpscli.sweep.design.answer import NONE, ROBUST, Answer
from rpscli.sweep.design.search import Search
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.points.layout import lay_out
from rpscli.sweep.store import Store


def keeps_limits(run: StudyRun) -> bool:
    """Whether there are histories by which to judge, and none exceeds a limit."""
    return bool(run.verdicts) and not any(verdict.exceeded for verdict in run.verdicts)


@dataclass(frozen=True)
class Rounds:
    """The rounds of a search, computed as studies into one store."""

    search: Search
    overrides: tuple[str, ...]
    choices: SweepChoices
    terminal: Terminal

    def first(self) -> Study:
        """The first round, laid out; with it the file is checked to its end."""
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

    def confirm(self, answer: Answer, store: Store) -> Iterator[tuple[str, StudyRun]]:
        """Judge the best and the robust design under other motions, if there are any."""
        task, designs = answer.task, {"best": answer.best, "robust": answer.robust}
        for name, place in designs.items():
            if task.confirming and place != NONE:
                study = self._laid_out(task.study_of(answer.values[[place]], task.confirming))
                self.terminal.note(f"confirmation of the {name} design")
                yield name, self._computed(study, store)

    def everything(self, answer: Answer, first: Study, store: Store) -> tuple[Study, StudyRun]:
        """All valid designs as one study, whose points are in the store."""
        study = self._laid_out(answer.task.study_of(answer.values[answer.valid]), first)
        return study, self._computed(study, store)

    def notes(self, answer: Answer, confirmations: Mapping[str, StudyRun]) -> Iterator[str]:
        """What the user should know about the answer."""
        if invalid := int((~answer.valid).sum()):
            reason = next(iter(self.search.faults))
            yield f"{invalid} designs are not valid cases and count as failing: {reason}"
        if not answer.resamples and answer.task.file.search.resamples:
            yield "one record only: how far the choice of records moves the answer is not known"
        if answer.best != NONE and (ends := list(answer.at_bounds)):
            words = " and ".join(f"the {end} {key}" for key, end in ends)
            yield f"the best design has {words} of the range; a wider one may have a better design"
        for name, run in confirmations.items():
            if not keeps_limits(run):
                yield f"the {name} design does not keep its limits under the other motions"

    def _laid_out(self, checked: CheckedStudy, earlier: Study | None = None) -> Study:
        """A study with its points; records are shared with an earlier one."""
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


def unconfirmed(runs: Iterable[StudyRun]) -> RpsError | None:
    """Histories of the confirmation that failed."""
    texts = (text for run in runs for text in run.table.messages.values())
    lines = list(dict.fromkeys(f"confirmation: {text}" for text in texts))
    return StudyIncomplete("\n".join(lines)) if lines else None


DIGITS = 4
RECORDS_SHOWN = 3


def answer_tables(
    document: dict[str, Any], answer: Answer, confirmations: Mapping[str, StudyRun]
) -> Iterator[Part]:
    """Best design, requirements, what the records do to it, and what confirms which design."""
    counts = document["designs"]
    best = document["best"]
    yield Heading(document["study"]["title"])
    yield Table.listing([(name.replace("_", " "), str(count)) for name, count in counts.items()])
    yield _values(document, best or document["closest"], "best" if best else "least violated")
    yield _requirements(document, answer)
    if best is not None:
        yield Table.listing(list(_records(document)))
    if len(answer.front):
        yield f"Pareto front of both objectives: {len(answer.front)} designs, in front.csv"
    if confirmations:
        yield Heading(f"confirmation with {len(answer.task.confirming)} records that were not used")
        rows = [
            (design, *verdict_texts(verdict))
            for design, run in confirmations.items()
            for verdict in run.verdicts
        ]
        yield Table.of_texts(("design", *VERDICT), rows, words=5, keys=2)
    yield ONE_DIRECTION


def _values(document: dict[str, Any], design: dict[str, Any], title: str) -> Table:
    intervals = document["records"]["intervals"]
    ends = {item["key"]: item["end"] for item in document["at_bounds"]}
    rows = []
    for key, value in design["values"].items():
        unit = unit_of(key)
        name = symbol(key) if unit == "-" else f"{symbol(key)} [{unit}]"
        least = "minimised" if symbol(key) in design["aims"] else ""
        end = f"{ends[key]} of its range" if key in ends else least
        rows.append((name, end, shown(value, DIGITS), _interval(intervals[key])))
    for objective, value in _further_objectives(document, design):
        name = objective["aim"]
        interval = [large(end, objective["unit"])[0] or 0.0 for end in intervals.get(name, ())]
        number, unit = large(value, objective["unit"])
        head = f"{name} [{unit}]" if unit else name
        rows.append((head, "minimised", shown(number, DIGITS), _interval(interval)))
    return Table.of_texts(("", "", title, "95 % of resamples"), rows, words=2)


def _further_objectives(
    document: dict[str, Any], design: dict[str, Any]
) -> Iterator[tuple[dict[str, str], float]]:
    """What is to be least and is not itself one of the values of a design."""
    names = {symbol(key) for key in design["values"]}
    for objective, value in zip(document["least"], design["aims"].values(), strict=True):
        if objective["aim"] not in names:
            yield objective, value


def _interval(interval: Iterable[float]) -> str:
    known = [end for end in interval if end == end]  # noqa: PLR0124 -- not NaN
    return " to ".join(shown(end, 3) for end in known) or "-"


def _requirements(document: dict[str, Any], answer: Answer) -> Table:
    rows = []
    for row, requirement in zip(document["requirements"], answer.judged.requirements, strict=True):
        if row["binds"]:
            unit = document["least"][0]["unit"]
            remark = f"binds; without it {measured(row['aim_without_it'], unit)}"
        else:
            remark = "" if row["met"] else "NOT MET"
        result, met_by = shown(row["value"], DIGITS), f"{row['designs_that_meet_it']} designs"
        rows.append(
            (row["requirement"], condition_text(requirement.condition), remark, result, met_by)
        )
    heads = ("limit", "requirement", "", "result", "met by")
    return Table.of_texts(heads, rows, words=3)


def _records(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """How sharp the answer is, and how it hangs on the choice of records."""
    records = document["records"]
    for end, word in zip(document["bracket"] or (), ("smaller", "larger"), strict=False):
        if end is not None:
            (key,) = document["best"]["values"]
            unit = unit_of(key).removesuffix("-")
            yield f"the next {word} value that fails", f"{shown(end, 6)} {unit}".rstrip()
    if not records["resamples"]:
        return
    share = 100.0 * records["passing_share_of_best"]
    yield "the best design passes in", f"{share:.0f} % of {records['resamples']} resamples"
    if (robust := document["robust"]) is not None:
        found = [
            label(key, float(shown(value, DIGITS)) if isinstance(value, float) else value)
            for key, value in robust["values"].items()
        ]
        objectives = _further_objectives(document, robust)
        found += [
            f"{objective['aim']} {measured(value, objective['unit'])}"
            for objective, value in objectives
        ]
        yield f"the best in {100.0 * ROBUST:g} % of them", ", ".join(found)
    if records["without_answer"]:
        yield "nothing passes in", f"{records['without_answer']} of them"
    objective, unit = document["least"][0].values()
    least = document["best"]["aims"][objective]
    changes = [
        (abs(value - least), item["record"], value)
        for item in records["without_one"]
        if item["best"] is not None and (value := item["best"]["aims"][objective]) != least
    ]
    for _, record, value in sorted(changes, reverse=True)[:RECORDS_SHOWN]:
        yield f"without {record}", f"{objective} {measured(value, unit)}"


def nothing_passes(answer: Answer) -> LimitExceeded | None:
    """Which requirement stands in the way least, if no design passes; else nothing."""
    if answer.best != NONE:
        return None
    judged, place = answer.judged, answer.closest
    rows = [row for row in range(len(judged.requirements)) if not judged.met[row, 0, place]]
    lines = [f"no design of {len(answer.places)} meets all requirements"]
    for row in sorted(rows, key=lambda row: float(judged.excess[row, place])):
        requirement = judged.requirements[row]
        value = shown(float(judged.values[row, 0, place]), DIGITS)
        lines.append(
            f"{requirement_label(requirement)}: {condition_text(requirement.condition)}; {value} in"
            f" the least violated design, {100.0 * judged.excess[row, place]:.3g} % of the"
            f" records too many; {int(judged.met[row, 0].sum())} designs meet it"
        )
    return LimitExceeded("\n".join(lines))
