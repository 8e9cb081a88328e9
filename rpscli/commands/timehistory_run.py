"""Time histories of a command: what is asked for, computed, judged, written and shown."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Any, NamedTuple

from rpscli.analyses.column_forces import OF_COLUMNS, no_bound
from rpscli.analyses.result_quantities import LIMITED, NEEDS, ResultQuantity
from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.timehistory import Neighbour, neighbours, time_history
from rpscli.case.conditions import LIMITS, Condition, case_conditions
from rpscli.case.plausibility import doubts_of_directions
from rpscli.commands import inputs
from rpscli.commands.shell.options import OutputRequest
from rpscli.commands.shell.terminal import Terminal, concluded, leave, patience
from rpscli.errors import AnalysisError, LimitExceeded, RecordError, RpsError, UsageError, all_made
from rpscli.records.ground_motion import MotionComponents
from rpscli.report.bundles import floor_spectra_files, timehistory_files
from rpscli.report.documents import direction_note, heading, json_text, timehistory_document
from rpscli.report.figures.animation import history_film
from rpscli.report.figures.film import FilmRequest
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder
from rpscli.report.limits import VERDICT, excess_text, verdict_texts, worst_text
from rpscli.report.study import statistics
from rpscli.report.table import Heading, Part, Table, csv_text, headed, large, shown, standing
from rpscli.report.tables.timehistory import (
    neighbours_texts,
    overturned_text,
    passes_text,
    restitution_text,
    timehistory_tables,
)
from rpscli.sweep.statistics.fractiles import Spread
from rpscli.sweep.statistics.summary import Records, Summary, summary_of_records
from rpscli.sweep.statistics.verdicts import Verdict, judged_records

COMMAND = "timehistory"

DIGITS = 4
OF_ONE_COLUMN = ("max_column_force", "column_moment")
A_TABLE = 4
"""Quantities side by side in a table that fits a page."""
CODES = (
    "codes take the mean of the maxima of 7 records (EN 1998-1) or 11 pairs (ASCE/SEI 7-16, chapter"
    " 16) and more; the largest of 3 to 6 is for EN 1998-1 alone"
)


@dataclass(frozen=True, eq=False)
class HistoryRequest:
    """A case, its motion, the folder of the results; spectra of floors where they are asked for."""

    given: inputs.CaseInput
    case_label: str
    ground: MotionComponents
    label: str
    folder: OutputFolder
    floor_spectra: bool = False

    @property
    def name(self) -> str:
        """Of the case and the record."""
        return f"{self.case_label}, {self.label}"


class HistoryResult(NamedTuple):
    """A history that is over: document, demands by name, NaN for what it has not, verdicts."""

    request: HistoryRequest
    document: dict[str, Any]
    demands: dict[str, float]
    verdicts: list[Verdict]
    error: RpsError | None


def history_requests(
    cases: Sequence[inputs.CaseInput],
    motions: Sequence[inputs.MotionRequest],
    output: OutputRequest,
    *,
    floor_spectra: bool = False,
) -> list[HistoryRequest]:
    """Every case under every motion, all read and all folders claimed before any is computed."""
    requests = []
    case_labels = unique([given.case.name for given in cases])
    for given, case_label in zip(cases, case_labels, strict=True):
        grounds = all_made(partial(inputs.load_motion, given.case), motions, RecordError)
        scaled = ["" if each.scale == 1.0 else f"_x{each.scale:.4g}" for each in grounds]
        names = [each.horizontal.name for each in grounds]
        labels = unique([f"{name}{by}" for name, by in zip(names, scaled, strict=True)])
        for motion, ground, label in zip(motions, grounds, labels, strict=True):
            place = inputs.RESULTS / case_label / COMMAND / label
            if output.place is not None:
                inside = [case_label] * (len(cases) > 1) + [label] * (len(motions) > 1)
                place = output.place.joinpath(*inside)
            folder = inputs.case_folder(
                given,
                OutputRequest(place, output.force),
                COMMAND,
                record_source=inputs.motion_source(given.case, motion),
                record=inputs.motion_inputs(ground),
            )
            requests.append(HistoryRequest(given, case_label, ground, label, folder, floor_spectra))
    return requests


def unique(names: Sequence[str]) -> list[str]:
    """The names, numbered where one comes again in small letters or capitals."""
    taken: dict[str, str] = {}
    for name in names:
        tried = (name, *(f"{name}_{number}" for number in range(2, len(names) + 2)))
        free = next(each for each in tried if each.casefold() not in taken)
        taken[free.casefold()] = free
    return [*taken.values()]


def compute(
    request: HistoryRequest, conditions: Sequence[Condition], look: Look, terminal: Terminal
) -> tuple[HistoryResult, TimeHistoryResult]:
    """Run a history, judge it, and collect its files; the caller writes them."""
    case, ground = request.given.case, request.ground
    limits = [*case_conditions(case.limits, case.structure), *conditions]
    for limit in limits if ground.y is not None else ():
        if why := no_bound(limit.name, case.structure):  # known before minutes are spent
            raise UsageError(f"{limit.source}: {why}")
    with patience(case, ground.horizontal.duration, terminal):
        result = time_history(case.structure, ground, case.analysis)
    request.folder.add_all(timehistory_files(result, case.title, look))
    if request.floor_spectra:
        request.folder.add_all(floor_spectra_files(result, case.title, look))
    values = {quantity.name: getattr(result, quantity.name) for quantity in LIMITED}
    demands = {name: math.nan if each is None else float(each) for name, each in values.items()}
    verdicts: list[Verdict] = []
    error: RpsError | None = AnalysisError(result.failure) if result.failure else None
    if error is None:
        for limit in limits:
            _refuse_unknown(limit, result)
        records = Records.of([result.outcome], [demands], [result.record.source])
        verdicts = judged_records(records, [request.label], limits)
        over = [
            f"limit exceeded: {excess_text(verdict)}" for verdict in verdicts if verdict.exceeded
        ]
        error = LimitExceeded("\n".join(over)) if over else None
    document = _document(request, result)
    document["verdicts"] = [statistics.verdict_document((), verdict) for verdict in verdicts]
    return HistoryResult(request, concluded(document, error), demands, verdicts, error), result


def _refuse_unknown(limit: Condition, result: TimeHistoryResult) -> None:
    """Refuse a limit on what a history does not know: raises UsageError."""
    needs = LIMITS[limit.name].needs if limit.name in LIMITS else ""
    incomplete = limit.name in OF_COLUMNS and result.left_out_of_columns
    if needs and (getattr(result, limit.name) is None or incomplete):
        raise UsageError(f"{limit.source}: {limit.name} needs {NEEDS[needs]}")


def _document(request: HistoryRequest, result: TimeHistoryResult) -> dict[str, Any]:
    given, ground = request.given, request.ground
    document = {
        **heading(COMMAND),
        "note": direction_note([ground.y is not None], result.structure.planar_only) or None,
        "case": inputs.case_heading(given),
        **timehistory_document(result),
    }
    document["record"] |= {"scale": ground.scale, "scaled_to": ground.scaled_to or None}
    doubts = doubts_of_directions(given.case.structure, both=ground.y is not None)
    warnings = [*given.case.warnings, *map(str, doubts)]
    document["warnings"] = [*warnings, *document["warnings"], *ground.warnings]
    return document


def look_beside(done: HistoryResult, result: TimeHistoryResult) -> list[Neighbour]:
    """Histories beside a single one, which go into its document too."""
    beside = neighbours(result)
    done.document["neighbours"] = [each._asdict() for each in beside]
    return beside


def _add_summary(done: HistoryResult) -> OutputFolder:
    """The folder with `summary.json`, which names all files that were collected before it."""
    folder = done.request.folder
    done.document["files"] = [str(folder.folder / "summary.json"), *folder.files]
    folder.add("summary.json", json_text(done.document))
    return folder


def run_one(
    request: HistoryRequest,
    conditions: Sequence[Condition],
    look: Look,
    film: FilmRequest | None,
    terminal: Terminal,
) -> None:
    """Compute a single history, look beside it, and write and show all of it."""
    title = request.given.case.title
    done, result = compute(request, conditions, look, terminal)
    beside = look_beside(done, result)
    if film is not None:
        draw = partial(history_film, result, title, film)
        inputs.add_film(request.folder, film, look, draw, terminal)
    inputs.write(_add_summary(done), terminal)
    done.document["warnings"] += request.folder.undrawn
    terminal.warn(done.document["warnings"])
    tables = timehistory_tables(result, done.verdicts, title, request.ground.scaled_to)
    texts = [*neighbours_texts(result, beside), passes_text(result), done.document["note"]]
    terminal.result(done.document, [*tables, *filter(None, texts)])
    leave(done.error)


class Computed(NamedTuple):
    """The histories of one case, what they say together, and the folder for it."""

    histories: list[HistoryResult]
    together: Summary
    verdicts: list[Verdict]
    folder: OutputFolder | None

    @property
    def first(self) -> HistoryRequest:
        """The first of them, whose case is that of all."""
        return self.histories[0].request

    @property
    def labels(self) -> list[str]:
        """Names of the records."""
        return [history.request.label for history in self.histories]


def run_all(
    requests: Sequence[HistoryRequest],
    conditions: Sequence[Condition],
    look: Look,
    output: OutputRequest,
    terminal: Terminal,
) -> None:
    """Compute all histories, and write each as soon as it is over."""
    cases = [list(group) for _, group in groupby(requests, lambda request: request.case_label)]
    folders = [_set_folder(group, output, alone=len(cases) == 1) for group in cases]
    computed = [
        computed_set(group, conditions, look, terminal, folder)
        for group, folder in zip(cases, folders, strict=True)
    ]
    for case in computed:
        if case.folder is None:
            terminal.note(f"written to {case.first.folder.folder}")
            continue
        scalars = [history.document for history in case.histories]
        case.folder.add("records.csv", csv_text(statistics.records_columns(case.labels, scalars)))
        case.folder.add("statistics.csv", csv_text(statistics.demand_columns(case.together)))
        case.folder.add("summary.json", json_text({**heading(), **set_document(case)}))
        inputs.write(case.folder, terminal)
    error = set_error(computed)
    document = all_document(computed, error)
    terminal.warn(document["warnings"])
    terminal.result(document, set_tables(computed))
    leave(error)


def computed_set(
    group: Sequence[HistoryRequest],
    conditions: Sequence[Condition],
    look: Look,
    terminal: Terminal,
    folder: OutputFolder | None,
    *,
    written: bool = True,
) -> Computed:
    """Compute the histories of one case, each written as soon as it is over, and judge them."""
    histories = []
    for request in group:
        done, _ = compute(request, conditions, look, terminal)
        if written:
            _add_summary(done).write()
            terminal.warn(request.folder.undrawn)
        histories.append(done)
    outcomes = [history.document["outcome"] for history in histories]
    sources = [request.ground.horizontal.source for request in group]
    records = Records.of(outcomes, [history.demands for history in histories], sources)
    judged = group[0].given.case
    limits = case_conditions(judged.limits, judged.structure, len(group))
    verdicts = judged_records(records, [each.label for each in group], [*limits, *conditions])
    return Computed(histories, summary_of_records(records), verdicts, folder)


def _set_folder(
    group: Sequence[HistoryRequest], output: OutputRequest, *, alone: bool
) -> OutputFolder | None:
    """Folder for the table of a case: each set of records has one of its own."""
    if len(group) == 1:
        return None
    first = group[0]
    grounds = (request.ground.named for request in group)
    motions = "".join(each[name].digest for each in grounds for name in each if name != "vertical")
    name = f"{len(group)}_records_{hashlib.sha256(motions.encode()).hexdigest()[:6]}"
    place = inputs.RESULTS / first.case_label / COMMAND / name
    if output.place is not None:
        place = output.place if alone else output.place / first.case_label
    return inputs.case_folder(
        first.given,
        OutputRequest(place, output.force),
        COMMAND,
        record_source=name,
        records=[inputs.motion_inputs(request.ground) for request in group],
    )


def set_error(computed: Sequence[Computed]) -> RpsError | None:
    """The error that ends the command: failed histories, else limits that are exceeded."""
    lines = [
        f"{history.request.name}: {history.error}"
        for case in computed
        for history in case.histories
        if isinstance(history.error, AnalysisError)
    ]
    if lines:
        return AnalysisError("\n".join(lines))
    lines = [
        line
        for case in computed
        for line in statistics.verdict_lines((), case.verdicts, f"{case.first.case_label}: ")
    ]
    return LimitExceeded("\n".join(lines)) if lines else None


def all_document(computed: Sequence[Computed], error: RpsError | None) -> dict[str, Any]:
    """All histories and sets in JSON."""
    histories = [history for case in computed for history in case.histories]
    files = [file for history in histories for file in history.document.get("files", ())]
    files += [file for case in computed if case.folder is not None for file in case.folder.files]
    document = {
        **heading(COMMAND),
        "note": _note(computed) or None,
        "histories": [history.document for history in histories],
        "sets": [set_document(case) for case in computed],
        "warnings": list(_warnings(histories)),
        "files": files,
    }
    return concluded(document, error)


def _warnings(histories: Sequence[HistoryResult]) -> Iterator[str]:
    """Each kind of warning once, with its number of histories and the numbers of the first."""
    kinds: dict[str, list[tuple[str, str]]] = {}
    for history in histories:
        for text in history.document["warnings"]:
            kind = re.sub(r"[-+\d.]+", "", text)
            kinds.setdefault(kind, []).append((history.request.name, text))
    for given in kinds.values():
        name, text = given[0]
        others = f"{len(given)} of {len(histories)} histories, such as " * (len(given) > 1)
        yield f"{others}{name}: {text}"


def set_document(case: Computed) -> dict[str, Any]:
    """Statistics and verdicts of the records of a case."""
    return {
        "case": case.histories[0].document["case"],
        "records": case.labels,
        **statistics.summary_document(case.together)[0],
        "verdicts": [statistics.verdict_document((), verdict) for verdict in case.verdicts],
    }


def set_tables(computed: Sequence[Computed]) -> Iterator[Part]:
    """Every record, mean and largest, and the verdicts."""
    for case in computed:
        yield Heading(case.first.given.case.title)
        if aims := dict.fromkeys(
            filter(None, (each.request.ground.scaled_to for each in case.histories))
        ):
            yield f"records scaled to {' or '.join(aims)}"
        (row,) = case.together.rows
        spreads = zip(case.together.quantities, row.spreads, strict=True)
        own = case.first.given.case
        # Forces of single columns are known where their number is.
        further = ("max_damper_force", *OF_ONE_COLUMN * (own.structure.columns > 1))
        main = [pair for pair in spreads if pair[0].demand or pair[0].name in further]
        for first in range(0, len(main), A_TABLE):
            yield _records_table(case, dict(main[first : first + A_TABLE]))
        if len(case.histories) > 1:
            undefined = ", so the mean of maxima is not defined" * bool(row.overturned.number)
            yield f"overturned: {row.overturned}{undefined}; {CODES}"
        yield overturned_text(own.structure, own.analysis)
        yield restitution_text(own.structure)
    rows = [
        [case.first.case_label, *verdict_texts(verdict)[:-1], worst_text(verdict)]
        for case in computed
        for verdict in case.verdicts
    ]
    if rows:
        yield Table.of_texts(["case", *VERDICT], rows, words=5, keys=2)
    if note := _note(computed):
        yield note


def _note(computed: Sequence[Computed]) -> str:
    grounds = (history.request.ground for case in computed for history in case.histories)
    planar = computed[0].first.given.case.structure.planar_only
    return direction_note((ground.y is not None for ground in grounds), planar)


def _records_table(case: Computed, quantities: dict[ResultQuantity, Spread]) -> Table:
    rows = []
    for label, history in zip(case.labels, case.histories, strict=True):
        document, outcome = history.document, str(history.document["outcome"])
        word = "overturned" if outcome.startswith("overturned") else outcome.replace("_", " ")
        values = [large(document[q.name], q.unit)[0] for q in quantities]
        rows.append([label, word, *(shown(value, DIGITS) for value in values)])
    if len(case.histories) > 1:
        words = {"mean": "mean of maxima", "median": "median", "high": "84 %", "largest": "largest"}
        if case.together.rows[0].overturned.number:
            words |= {"low_stands": "least that stands", "high_stands": "largest that stands"}
        for name, label in words.items():
            values = [large(getattr(each, name), q.unit)[0] for q, each in quantities.items()]
            rows.append([label, "", *(standing(value, DIGITS) for value in values)])
    heads = [headed(q.label, q.unit) for q in quantities]
    return Table.of_texts(["record", "", *heads], rows, words=2)
