"""Time histories of a command: what is asked for, computed, judged, written and shown."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any, NamedTuple

from rpscli.analyses.neighbours import (
    Neighbour,
    nearest,
    neighbours,
    with_half_the_step,
)
from rpscli.analyses.result_quantities import LIMITED
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import time_history
from rpscli.case.conditions import (
    Condition,
    case_conditions,
    lacking_results,
    unknown_of_pairs,
)
from rpscli.case.plausibility import doubts_of_motion
from rpscli.commands import inputs
from rpscli.commands.records_table import Records, records_parts
from rpscli.commands.shell.options import Output
from rpscli.commands.shell.terminal import concluded, leave, patience
from rpscli.errors import (
    AnalysisError,
    CaseError,
    LimitExceeded,
    RecordError,
    RpsError,
    UsageError,
    listed,
)
from rpscli.records.ground_motion import MotionComponents
from rpscli.report.bundles import floor_spectra_files, timehistory_files
from rpscli.report.figures.look import FilmRequest
from rpscli.report.files import OutputFolder, heading, json_text
from rpscli.report.limits import (
    VERDICT,
    doubt_texts,
    excess_text,
    verdict_texts,
    worst_text,
)
from rpscli.report.neighbours import neighbours_texts, step_text
from rpscli.report.study import statistics
from rpscli.report.table import (
    Heading,
    Part,
    Table,
    csv_text,
    told_once,
)
from rpscli.report.timehistory import (
    direction_note,
    note_of_direction,
    overturned_text,
    passes_text,
    restitution_text,
    timehistory_document,
    timehistory_tables,
    without_passes,
)
from rpscli.report.twist import OF_WHICH_SLAB
from rpscli.sweep.statistics.beside import beside_verdicts
from rpscli.sweep.statistics.summary import (
    Records as Histories,
)
from rpscli.sweep.statistics.summary import (
    Summary,
    summary_of_records,
)
from rpscli.sweep.statistics.verdicts import Verdict, judged_records

COMMAND = "timehistory"

OF_ONE_COLUMN = ("max_column_force", "column_moment")
CODES = (
    "codes take the mean of the maxima of 7 records (EN 1998-1) or 11 pairs (ASCE/SEI"
    " 7-16, chapter 16) and more; with 3 to 6 records EN 1998-1 takes the largest"
)


@dataclass(eq=False)
class History:
    """A case under a motion, the folder of its results, and what it
    says once it is computed.

    `demands` are by name, NaN for what it has not; `beside` are histories beside it,
    `finer` the one with half the step; spectra of floors are made where asked for.
    """

    given: inputs.CaseInput
    case_label: str
    motion: inputs.CaseMotion
    label: str
    folder: OutputFolder
    floor_spectra: bool = False
    document: dict[str, Any] = field(default_factory=dict)
    demands: dict[str, float] = field(default_factory=dict)
    verdicts: list[Verdict] = field(default_factory=list)
    beside: list[Neighbour] = field(default_factory=list)
    finer: Neighbour | None = None
    error: RpsError | None = None

    @property
    def ground(self) -> MotionComponents:
        """The motion itself."""
        return self.motion.ground

    @property
    def changed(self) -> list[Neighbour]:
        """All histories that are looked at beside it."""
        return [*self.beside, *filter(None, [self.finer])]

    @property
    def name(self) -> str:
        """Of the case and the record."""
        return f"{self.case_label}, {self.label}"


def histories_of(
    cases: Sequence[inputs.CaseInput],
    motions: Sequence[inputs.MotionRequest],
    out: Output,
    *,
    floor_spectra: bool = False,
) -> list[History]:
    """Every case under every motion, all read and all folders
    claimed before any is computed.
    """
    histories = []
    case_labels = unique([given.case.name for given in cases])
    for given, case_label in zip(cases, case_labels, strict=True):
        read = inputs.load_motions(given.case, motions, RecordError)
        labels = unique([
            ground.horizontal.name + ("" if ground.scale == 1.0 else f"_x{ground.scale:.4g}")
            for _, ground in read
        ])  # fmt: skip
        for motion, label in zip(read, labels, strict=True):
            place = inputs.RESULTS / case_label / COMMAND / label
            if out.place is not None:
                inside = [case_label] * (len(cases) > 1) + [label] * (len(motions) > 1)
                place = out.place.joinpath(*inside)
            own = replace(out, place=place)
            folder = inputs.case_folder(given, own, COMMAND, motion=motion)
            histories.append(
                History(given, case_label, motion, label, folder, floor_spectra)
            )
    return histories


def unique(names: Sequence[str]) -> list[str]:
    """The names, numbered where one comes again in small letters or capitals."""
    taken: dict[str, str] = {}
    for name in names:
        tried = (name, *(f"{name}_{number}" for number in range(2, len(names) + 2)))
        free = next(each for each in tried if each.casefold() not in taken)
        taken[free.casefold()] = free
    return [*taken.values()]


def compute(
    history: History,
    conditions: Sequence[Condition],
    out: Output,
    *,
    alone: bool = True,
) -> TimeHistoryResult:
    """Run a history, judge it, look beside it, and collect its files, which the caller
    writes; beside one of several only if there are limits, and only at the nearest.
    """
    case = history.given.case
    ground = history.ground
    folder = history.folder
    limits = [*case_conditions(case.limits, case.structure), *conditions]
    refuse_unknown(history, conditions)  # known before minutes are spent
    with patience(case, ground, out.terminal):
        result = time_history(case.structure, ground, case.analysis)
    folder.add_all(timehistory_files(result, case.title, out.look))
    if history.floor_spectra:
        folder.add_all(floor_spectra_files(result, case.title, out.look))
    history.demands = limited(result)
    if alone or limits:
        # What needs samples takes long, which many records would multiply.
        names = [each.name for each in limits] if alone else []
        history.beside = neighbours(result, names) if alone else nearest(result)
        history.finer = with_half_the_step(result, names)
    if result.failure:
        history.error = AnalysisError(result.failure)
    else:
        label = [history.label]
        sources = [result.record.source]
        records = Histories.of([result.outcome], [history.demands], sources)
        judged = judged_records(records, label, limits)
        history.verdicts = beside_verdicts(
            judged, [history.changed], label, sources, limits
        )
        over = [
            f"limit exceeded: {excess_text(v)}" for v in history.verdicts if v.exceeded
        ]
        history.error = LimitExceeded("\n".join(over)) if over else None
    document = _document(history, result)
    history.document = concluded(document, history.error)
    return result


def limited(result: TimeHistoryResult) -> dict[str, float]:
    """Results that may have limits by name, NaN for what a history has not."""
    values = {quantity.name: getattr(result, quantity.name) for quantity in LIMITED}
    return {
        name: math.nan if each is None else float(each) for name, each in values.items()
    }


def refuse_unknown(history: History, conditions: Sequence[Condition]) -> None:
    """Refuse limits on what a history does not know.

    Raises
    ------
    CaseError
        For those of the case.
    UsageError
        For `conditions`, which come with the command.
    """
    case = history.given.case
    structure = case.structure
    unknown = []
    if history.ground.y is not None:
        own = case_conditions(case.limits, structure)
        if lines := unknown_of_pairs(own, structure):
            raise CaseError("\n".join(lines))
        unknown = unknown_of_pairs(conditions, structure)
    if lines := [*lacking_results(conditions, structure), *unknown]:
        raise UsageError("\n".join(lines))


def _document(history: History, result: TimeHistoryResult) -> dict[str, Any]:
    case = history.given.case
    ground = history.ground
    document = {
        **heading(COMMAND),
        "note": note_of_direction(result) or None,
        "case": inputs.case_heading(history.given),
        **timehistory_document(result),
        "verdicts": [
            statistics.verdict_document((), verdict) for verdict in history.verdicts
        ],
    }
    if history.beside:
        document["neighbours"] = [each._asdict() for each in history.beside]
        document["half_step"] = history.finer and history.finer._asdict()
    document["record"] |= {"scale": ground.scale, "scaled_to": ground.scaled_to or None}
    doubts = map(str, doubts_of_motion(case.structure, ground))
    document["warnings"] = [
        *case.warnings,
        *doubts,
        *document["warnings"],
        *ground.warnings,
    ]
    return document


def beside_texts(history: History, result: TimeHistoryResult) -> list[str]:
    """What the histories beside a single one tell of it."""
    limits = {each.condition.name: each.condition.limit for each in history.verdicts}
    told = step_text(result, history.finer, limits)
    return [*neighbours_texts(result, history.beside), *filter(None, [told])]


def _add_summary(history: History) -> OutputFolder:
    """The folder with `summary.json`, which names all files that
    were collected before it.
    """
    folder = history.folder
    history.document["files"] = [str(folder.folder / "summary.json"), *folder.files]
    folder.add("summary.json", json_text(history.document))
    return folder


def run_one(
    history: History,
    conditions: Sequence[Condition],
    film: FilmRequest | None,
    out: Output,
) -> None:
    """Compute a single history, and write and show all of it."""
    title = history.given.case.title
    terminal = out.terminal
    result = compute(history, conditions, out)
    document = history.document
    if film is not None:
        draw = inputs.film_of("history")(result, title, film, out.look)
        inputs.add_film(history.folder, film, draw, out)
    inputs.write(_add_summary(history), terminal)
    document["warnings"] += history.folder.undrawn
    terminal.warn(document["warnings"])
    tables = timehistory_tables(result, history.verdicts, title, history.ground.scaled_to)
    texts = [*beside_texts(history, result), passes_text(result), document["note"]]
    terminal.result(document, [*tables, *filter(None, texts)])
    leave(history.error)


class Computed(NamedTuple):
    """The histories of one case, what they say together, and the folder for it."""

    histories: list[History]
    together: Summary
    verdicts: list[Verdict]
    folder: OutputFolder | None

    @property
    def first(self) -> History:
        """The first of them, whose case is that of all."""
        return self.histories[0]

    @property
    def labels(self) -> list[str]:
        """Names of the records."""
        return [history.label for history in self.histories]


def run_all(
    histories: Sequence[History], conditions: Sequence[Condition], out: Output
) -> None:
    """Compute all histories, and write each as soon as it is over."""
    cases = [
        list(group) for _, group in groupby(histories, lambda history: history.case_label)
    ]
    folders = [_set_folder(group, out, alone=len(cases) == 1) for group in cases]
    computed = [
        computed_set(group, conditions, out, folder)
        for group, folder in zip(cases, folders, strict=True)
    ]
    for case in computed:
        if case.folder is None:
            out.terminal.note(f"written to {case.first.folder.folder}")
            continue
        scalars = [history.document for history in case.histories]
        case.folder.add(
            "records.csv", csv_text(statistics.records_columns(case.labels, scalars))
        )
        case.folder.add(
            "statistics.csv", csv_text(statistics.demand_columns(case.together))
        )
        case.folder.add("summary.json", json_text({**heading(), **set_document(case)}))
        inputs.write(case.folder, out.terminal)
    error = set_error(computed)
    document = all_document(computed, error)
    out.terminal.warn(document["warnings"])
    out.terminal.result(document, set_tables(computed))
    leave(error)


def computed_set(
    group: list[History],
    conditions: Sequence[Condition],
    out: Output,
    folder: OutputFolder | None,
    *,
    written: bool = True,
) -> Computed:
    """Compute the histories of one case, each written as soon as it
    is over, and judge them.
    """
    for history in group:
        compute(history, conditions, out, alone=len(group) == 1)
        if written:
            _add_summary(history).write()
            out.terminal.warn(history.folder.undrawn)
    outcomes = [history.document["outcome"] for history in group]
    sources = [history.ground.horizontal.source for history in group]
    records = Histories.of(outcomes, [history.demands for history in group], sources)
    case = group[0].given.case
    limits = [*case_conditions(case.limits, case.structure, len(group)), *conditions]
    labels = [each.label for each in group]
    verdicts = judged_records(records, labels, limits)
    if "failed" not in outcomes:
        changed = [each.changed for each in group]
        verdicts = beside_verdicts(verdicts, changed, labels, sources, limits)
    return Computed(group, summary_of_records(records), verdicts, folder)


def _set_folder(
    group: Sequence[History], out: Output, *, alone: bool
) -> OutputFolder | None:
    """Folder for the table of a case: each set of records has one of its own."""
    if len(group) == 1:
        return None
    first = group[0]
    grounds = (history.ground.named for history in group)
    motions = "".join(
        each[name].digest for each in grounds for name in each if name != "vertical"
    )
    name = f"{len(group)}_records_{hashlib.sha256(motions.encode()).hexdigest()[:6]}"
    place = inputs.RESULTS / first.case_label / COMMAND / name
    if out.place is not None:
        place = out.place if alone else out.place / first.case_label
    return inputs.case_folder(
        first.given,
        replace(out, place=place),
        COMMAND,
        record_source=name,
        records=[inputs.motion_inputs(history.ground) for history in group],
    )


def set_error(computed: Sequence[Computed]) -> RpsError | None:
    """The error that ends the command: failed histories, else
    limits that are exceeded.
    """
    lines = [
        f"{history.name}: {history.error}"
        for case in computed
        for history in case.histories
        if isinstance(history.error, AnalysisError)
    ]
    if lines:
        return AnalysisError("\n".join(lines))
    lines = [
        line
        for case in computed
        for line in statistics.verdict_lines(
            (), case.verdicts, f"{case.first.case_label}: "
        )
    ]
    return LimitExceeded("\n".join(lines)) if lines else None


def all_document(computed: Sequence[Computed], error: RpsError | None) -> dict[str, Any]:
    """All histories and sets in JSON."""
    histories = [history for case in computed for history in case.histories]
    files = [file for history in histories for file in history.document.get("files", ())]
    files += [
        file for case in computed if case.folder is not None for file in case.folder.files
    ]
    document = {
        **heading(COMMAND),
        "note": _note(computed) or None,
        "histories": [history.document for history in histories],
        "sets": [set_document(case) for case in computed],
        "warnings": list(_warnings(histories)),
        "files": files,
    }
    return concluded(document, error)


def _warnings(histories: Sequence[History]) -> Iterator[str]:
    named = (
        (each.name, text) for each in histories for text in each.document["warnings"]
    )
    return told_once(named, len(histories), "histories")


def set_document(case: Computed) -> dict[str, Any]:
    """Statistics and verdicts of the records of a case."""
    return {
        "case": case.first.document["case"],
        "records": case.labels,
        **statistics.summary_document(case.together)[0],
        "verdicts": [
            statistics.verdict_document((), verdict) for verdict in case.verdicts
        ],
    }


def set_tables(computed: Sequence[Computed]) -> Iterator[Part]:
    """Every record, mean and largest, and the verdicts."""
    for case in computed:
        yield Heading(case.first.given.case.title)
        records = _records(case)
        aims = dict.fromkeys(
            filter(None, (each.ground.scaled_to for each in case.histories))
        )
        told = [f"records scaled to {' or '.join(aims)}"] if aims else []
        if records.several and len(words := {*records.words}) == 1:
            told.append(f"outcome of all: {words.pop()}")
        if told:
            yield "; ".join(told)
        (row,) = case.together.rows
        own = case.first.given.case
        yield from records_parts(records)
        if len(case.histories) > 1:
            undefined = ", so the mean of maxima is not defined" * bool(
                row.overturned.number
            )
            yield f"overturned: {row.overturned}{undefined}; {CODES}"
        documents = (each.document["column_forces_leave_out"] for each in case.histories)
        left_out = [*dict.fromkeys(part for of in documents for part in of)]
        if left_out and own.structure.columns > 1:
            yield f"forces and moments of columns are without {listed(left_out, 'and')}"
        both = any(each.ground.y is not None for each in case.histories)
        for text in without_passes(own.structure, both):
            yield f"friction demands are {text}"
        if own.structure.twist is not None:
            yield OF_WHICH_SLAB
        yield overturned_text(own.structure, own.analysis)
        yield restitution_text(own.structure)
    yield from _verdict_parts(computed)
    if note := _note(computed):
        yield note


def _verdict_parts(computed: Sequence[Computed]) -> Iterator[Part]:
    """The verdicts on all cases, and those that are in doubt."""
    rows = [
        [case.first.case_label, *verdict_texts(verdict)[:-1], worst_text(verdict)]
        for case in computed
        for verdict in case.verdicts
    ]
    if rows:
        yield Table.of_texts(["case", *VERDICT], rows, words=5, keys=2)
    for case in computed:
        of = f"{case.first.case_label}: " * (len(computed) > 1)
        yield from doubt_texts(case.verdicts, of, several=True)


def _records(case: Computed) -> Records:
    """The histories of a case for their table; forces of single columns are known where
    their number is.
    """
    columns = case.first.given.case.structure.columns
    return Records(
        case.labels,
        [history.document for history in case.histories],
        case.together,
        asked=[verdict.condition.name for verdict in case.verdicts],
        further=OF_ONE_COLUMN if columns > 1 else (),
    )


def _note(computed: Sequence[Computed]) -> str:
    grounds = (history.ground for case in computed for history in case.histories)
    planar = computed[0].first.given.case.structure.planar_only
    return direction_note((ground.y is not None for ground in grounds), planar)
