"""The rounds of `rps design`, computed as studies into one store, and the answer in tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from rpscli.analyses.neighbours import OTHER_LOSS
from rpscli.case.conditions import EVENTS, LIMITS, Condition, condition_text
from rpscli.case.overrides import apply_overrides
from rpscli.case.rules.plausibility import RESTITUTION
from rpscli.case.study.study import Study as CheckedStudy
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.study import SweepChoices, compute
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.design import requirement_label
from rpscli.report.study.labels import axis_label, label, symbol
from rpscli.report.study.shown import of_first_system
from rpscli.report.study.statistics import VERDICT, verdict_lines, verdict_texts
from rpscli.report.table import Heading, Part, Table, large, measured, shown
from rpscli.studies import Study
from rpscli.study_run import StudyRun, require_results
from rpscli.sweep.design.answer import NONE, ROBUST, Answer
from rpscli.sweep.design.search import Flags, Search
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.intensities import unit_of
from rpscli.sweep.points.layout import lay_out
from rpscli.sweep.statistics.fractiles import CONFIDENCE, ROUNDING
from rpscli.sweep.store import Store
from rpscli.sweep.table import Array
from rpscli.sweep.table import Table as Points


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
        """All rounds, one after the other; then what is recommended within its tolerances."""
        search, number = self.search, 1
        while len(places := search.next_round()):
            words = f"round {number}: {len(places)} designs"
            search.add(places, *self._round(places, words, first, store))
            number += 1
        while len(places := search.next_checks()):
            around = search.around(places)
            words = f"{len(places)} designs and {len(around) - len(places)} within their tolerances"
            search.add_checks(places, *self._round(around, words, first, store))
        return search.answer()

    def _round(
        self, places: Array, words: str, first: Study, store: Store
    ) -> tuple[Array, Flags, Points | None]:
        """Values of designs, which of them are valid cases, and the points of these."""
        values = self.search.task.values(places)
        valid = self.search.valid_cases(values)
        if not valid.any():
            return values, valid, None
        study = first
        if len(self.search.places):
            study = self._laid_out(self.search.task.study_of(values[valid]), first)
        self.terminal.note(words)
        return values, valid, self._computed(study, store).table

    def confirm(self, answer: Answer, store: Store) -> Iterator[tuple[str, StudyRun]]:
        """Judge the best and the robust design under other motions, if there are any."""
        task, designs = answer.task, {"best": answer.best, "robust": answer.robust}
        for name, place in designs.items():
            if task.confirming and place != NONE:
                study = self._laid_out(task.study_of(answer.values[[place]], task.confirming))
                self.terminal.note(f"confirmation of the {name} design")
                yield name, self._judged(study, store)

    def with_other_loss(self, answer: Answer, store: Store) -> StudyRun | None:
        """The recommended design where impacts take half: only if they take much by their law."""
        checked = self.search.task.study_of(answer.values[[answer.headline]])
        structure = lay_out(checked).system(0).structure
        if structure.impact_law.kind == "value" or structure.restitution >= RESTITUTION.least:
            return None
        base = apply_overrides(checked.base, [f"podium.impact.loss={OTHER_LOSS:g}"])
        self.terminal.note(f"the same design with podium.impact.loss {OTHER_LOSS:g}")
        return self._judged(self._laid_out(replace(checked, base=base)), store)

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
        if (place := answer.robust) != NONE and not answer.sure and answer.resamples:
            share = f"{100.0 * answer.tolerated.share[place]:.0f} %"
            yield (
                f"no design passes in {100.0 * ROBUST:g} % of the resamples of the records; the"
                f" recommended one passes in {share} of them"
            )
        if len(self.search.checked) >= self.search.most:
            yield "search.most ended the search before all of the recommended region was examined"
        for name, run in confirmations.items():
            if not keeps_limits(run):
                yield f"the {WORDS[name]} does not keep its limits under the other motions"

    def _laid_out(self, checked: CheckedStudy, earlier: Study | None = None) -> Study:
        """A study with its points; records are shared with an earlier one."""
        layout = lay_out(checked)
        context = StudyContext(layout.plan)
        if earlier is not None:
            context.records = earlier.context.records
        return Study(layout, context, self.overrides)

    def _judged(self, study: Study, store: Store) -> StudyRun:
        """With its verdicts, which need the store as long as it is open."""
        run = self._computed(study, store)
        _ = run.verdicts
        return run

    def _computed(self, study: Study, store: Store) -> StudyRun:
        """Compute what is not stored; leave if the user interrupts."""
        run = study.opened(store, **self.choices.of_run)
        compute("design", run, self.terminal)
        return run


def unconfirmed(runs: Mapping[str, StudyRun]) -> RpsError | None:
    """Histories of the validation that failed, or limits that the design does not keep in it."""
    texts = (text for run in runs.values() for text in run.table.messages.values())
    lines = list(dict.fromkeys(f"validation: {text}" for text in texts))
    if lines:
        return StudyIncomplete("\n".join(lines))
    name = headline_of(runs)
    if name is None or keeps_limits(runs[name]):
        return None
    of = f"validation of the {WORDS[name]}: "
    return LimitExceeded("\n".join(verdict_lines(runs[name].keys_of_rows, runs[name].verdicts, of)))


def headline_of(runs: Mapping[str, StudyRun]) -> str | None:
    """Name of the design whose validation counts: what is recommended, else the best."""
    return next((name for name in ("robust", "best") if name in runs), None)


def validation_text(conditions: Iterable[Condition], n: int, behind: str = "") -> Iterator[str]:
    """What so many records can tell of limits that a share of them may exceed."""
    if_so = f", if these{behind} were independent" if behind else ""
    from scipy.special import betainc, betaincinv

    for condition in conditions:
        if not condition.admissible:
            continue
        may = math.floor(condition.admissible * n + ROUNDING)
        fails = 1.0 - float(betainc(n - may, may + 1, 1.0 - condition.admissible))
        seen = float(betaincinv(may + 1, n - may, CONFIDENCE))
        yield (
            f"{condition.name}: {may} of {n} may be beyond; a design with exactly"
            f" {100.0 * condition.admissible:g} % beyond fails here in {100.0 * fails:.0f} %, one"
            f" with {100.0 * seen:.0f} % passes in {100.0 * (1.0 - CONFIDENCE):.0f} %{if_so}"
        )


DIGITS = 4
RECORDS_SHOWN = 3
WORDS = {"best": "least that passes", "robust": "recommended design"}
"""What the designs of an answer are called."""


def answer_tables(
    document: dict[str, Any],
    answer: Answer,
    confirmations: Mapping[str, StudyRun],
    softer: StudyRun | None = None,
) -> Iterator[Part]:
    """What is recommended, its requirements, what the records do to it, and how it is validated."""
    counts = document["designs"]
    yield Heading(document["study"]["title"])
    listing = [(name.replace("_", " "), str(count)) for name, count in counts.items()]
    if aim := document["study"]["scaled_to"]:
        listing.append(("records scaled to", aim))
    yield Table.listing(listing)
    yield _values(document)
    yield _requirements(document, answer)
    if document["best"] is not None:
        yield Table.listing([*_region(document, answer), *_records(document, answer)])
    design = answer.task.study_of(answer.values[[answer.headline]])
    yield of_first_system(lay_out(design))
    if softer is not None:
        yield Heading(f"the same design with podium.impact.loss {OTHER_LOSS:g}")
        rows = [
            (*texts, "" if verdict.condition.name in EVENTS else shown(verdict.value, DIGITS))
            for verdict in softer.verdicts
            for texts in [verdict_texts(verdict)]
        ]
        yield Table.of_texts((*VERDICT, "largest"), rows, words=4)
    if len(answer.front):
        yield f"Pareto front of both objectives: {len(answer.front)} designs, in front.csv"
    if confirmations:
        yield Heading(f"validation with {len(answer.task.confirming)} records that were not used")
        rows = [
            (WORDS[design], *verdict_texts(verdict))
            for design, run in confirmations.items()
            for verdict in run.verdicts
        ]
        yield Table.of_texts(("design", *VERDICT), rows, words=5, keys=2)
        conditions = dict.fromkeys(r.condition for r in answer.judged.requirements)
        (run, *_) = confirmations.values()
        behind = next((v.beyond.behind for v in run.verdicts), "")
        yield from validation_text(conditions, len(answer.task.confirming), behind)
    yield from filter(None, [document["note"]])


def _values(document: dict[str, Any]) -> Table:
    """What is recommended beside the least that passes, or the least violated one."""
    intervals = document["records"]["intervals"]
    best = document["best"] or document["closest"]
    shown_designs = [best] if document["robust"] is None else [document["robust"], best]
    rows = []
    for key in best["values"]:
        least = "minimised" if symbol(key) in best["aims"] else ""
        # As it was judged: no digit less.
        values = [f"{design['values'][key]:.10g}" for design in shown_designs]
        rows.append((axis_label(key), least, *values, _interval(intervals[key])))
    for place, (objective, value) in enumerate(_further_objectives(document, best)):
        name = objective["aim"]
        interval = [large(end, objective["unit"])[0] or 0.0 for end in intervals.get(name, ())]
        _, unit = large(value, objective["unit"])
        head = f"{name} [{unit}]" if unit else name
        of_all = [[*_further_objectives(document, design)][place][1] for design in shown_designs]
        numbers = [shown(large(each, objective["unit"])[0], DIGITS) for each in of_all]
        rows.append((head, "minimised", *numbers, _interval(interval)))
    title = "least that passes" if document["best"] else "least violated"
    heads = ["recommended"] * (len(shown_designs) > 1) + [title, "95 % of resamples"]
    return Table.of_texts(("", "", *heads), rows, words=2)


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
    verdicts = answer.verdicts(answer.headline)
    for row, verdict in zip(document["requirements"], verdicts, strict=True):
        _, word, requirement, result = verdict_texts(verdict)
        if verdict.condition.name in LIMITS and verdict.fractile is None:
            result = f"{shown(row['value'], DIGITS)}; {result}"
        met_by = str(row["designs_that_meet_it"])
        if row["binds"]:
            unit = document["least"][0]["unit"]
            met_by += f"; governs, otherwise {measured(row['aim_without_it'], unit)}"
        rows.append((row["requirement"], word, requirement, result, met_by))
    return Table.of_texts((*VERDICT, "designs that meet it"), rows, words=5)


def _name_of(design: dict[str, Any], document: dict[str, Any]) -> str:
    """Values and further objectives of a design."""
    found = [label(key, value) for key, value in design["values"].items()]
    objectives = _further_objectives(document, design)
    found += [f"{each['aim']} {measured(value, each['unit'])}" for each, value in objectives]
    return ", ".join(found)


def _region(document: dict[str, Any], answer: Answer) -> Iterator[tuple[str, str]]:
    """What was examined around the recommended design, and what is better but apart."""
    if (robust := document["robust"]) is None:
        return
    within = "within the tolerances" if robust["within_tolerances"] else "by itself"
    share = f" in {100.0 * robust['passing_share']:.0f} % of the resamples"
    yield "the recommended design passes", within + share * bool(answer.resamples)
    region = answer.regions[0]
    checked = set() if answer.within is None else set(answer.within[0].tolist())
    tolerated = len(checked.intersection(region.tolist()))
    least, most = answer.values[region].min(axis=0), answer.values[region].max(axis=0)
    ends = zip(answer.task.keys, least.tolist(), most.tolist(), strict=True)
    where = ", ".join(f"{symbol(key)} {low:.6g} to {high:.6g}" for key, low, high in ends)
    at = answer.places[region]
    inside = at.shape[1] == 1 and at.min() > 0.0 and at.max() < 1.0
    both = "; smaller and larger ones fail" if inside else ""
    yield "its region", f"{len(region)} designs, {tolerated} of them with tolerances: {where}{both}"
    if islands := document["islands"]:
        names = "; ".join(_name_of(island, document) for island in islands[:RECORDS_SHOWN])
        more = f" and {len(islands) - RECORDS_SHOWN} more" * (len(islands) > RECORDS_SHOWN)
        yield "islands, separated from it by failing designs", names + more


def _records(document: dict[str, Any], answer: Answer) -> Iterator[tuple[str, str]]:
    """How sharp the least that passes is, and how it hangs on the choice of records."""
    records = document["records"]
    if ends := [f"{end:.10g}" for end in document["bracket"] or () if end is not None]:
        unit = unit_of(answer.task.unknowns[0].key).removesuffix("-")
        found = f"{' and '.join(ends)} {unit}".rstrip()
        yield "nearest designs that fail", f"{found}, among those examined"
    if not records["resamples"]:
        return
    share = 100.0 * records["passing_share_of_best"]
    yield "the least that passes does so in", f"{share:.0f} % of {records['resamples']} resamples"
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
