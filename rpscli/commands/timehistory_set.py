"""Several time histories by one command: one table, one verdict, one exit code."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.case.conditions import EVENTS, Condition, case_conditions, with_friction
from rpscli.commands.inputs import RESULTS, case_folder, motion_inputs, write
from rpscli.commands.shell.options import OutputRequest
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.commands.timehistory_run import (
    COMMAND,
    HistoryRequest,
    HistoryResult,
    add_summary,
    compute,
)
from rpscli.errors import AnalysisError, LimitExceeded, RpsError
from rpscli.report.documents import direction_note, heading, json_text
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder
from rpscli.report.study.statistics import (
    VERDICT,
    demand_columns,
    records_columns,
    shown_by_text,
    summary_document,
    verdict_document,
    verdict_lines,
    verdict_texts,
)
from rpscli.report.table import Heading, Part, Table, csv_text, headed, large, shown
from rpscli.report.tables.timehistory import overturned_text, restitution_text
from rpscli.sweep.statistics.fractiles import Spread
from rpscli.sweep.statistics.summary import Records, Summary, summary_of_records
from rpscli.sweep.statistics.verdicts import Verdict, judged_records

if TYPE_CHECKING:
    from rpscli.analyses.result_quantities import ResultQuantity

DIGITS = 4
A_TABLE = 4
"""Quantities side by side in a table that fits a page."""
CODES = (
    "codes take the mean of the maxima of 7 records (EN 1998-1) or 11 pairs (ASCE/SEI 7-16, chapter"
    " 16) and more; the largest of 3 to 6 is for EN 1998-1 alone"
)


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
        case.folder.add("records.csv", csv_text(records_columns(case.labels, scalars)))
        case.folder.add("statistics.csv", csv_text(demand_columns(case.together)))
        case.folder.add("summary.json", json_text({**heading(), **set_document(case)}))
        write(case.folder, terminal)
    error = set_error(computed)
    document = all_document(computed, error)
    terminal.warn_first(document["warnings"], "in the documents")
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
            add_summary(done)
            request.folder.write()
        histories.append(done)
    outcomes = [history.document["outcome"] for history in histories]
    sources = [request.ground.horizontal.source for request in group]
    records = Records.of(outcomes, [history.demands for history in histories], sources)
    judged = group[0].given.case
    limits = with_friction(case_conditions(judged.limits), judged.structure)
    found = judged_records(records, [each.label for each in group], [*limits, *conditions])
    return Computed(histories, summary_of_records(records), found, folder)


def _set_folder(
    group: Sequence[HistoryRequest], output: OutputRequest, *, alone: bool
) -> OutputFolder | None:
    """Where the table of a case goes: each set of records has a place of its own."""
    if len(group) == 1:
        return None
    first = group[0]
    grounds = (request.ground.named for request in group)
    motions = "".join(each[name].digest for each in grounds for name in each if name != "vertical")
    name = f"{len(group)}_records_{hashlib.sha256(motions.encode()).hexdigest()[:6]}"
    place = RESULTS / first.case_label / COMMAND / name
    if output.place is not None:
        place = output.place if alone else output.place / first.case_label
    return case_folder(
        first.given,
        OutputRequest(place, output.force),
        COMMAND,
        record_source=name,
        records=[motion_inputs(request.ground) for request in group],
    )


def set_error(computed: Sequence[Computed]) -> RpsError | None:
    """What ends the command: failed histories, else limits that are exceeded."""
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
        for line in verdict_lines((), case.verdicts, f"{case.first.case_label}: ")
    ]
    return LimitExceeded("\n".join(lines)) if lines else None


def all_document(computed: Sequence[Computed], error: RpsError | None) -> dict[str, Any]:
    """All histories and sets in JSON."""
    histories = [history for case in computed for history in case.histories]
    files = [file for history in histories for file in history.document.get("files", ())]
    files += [file for case in computed if case.folder is not None for file in case.folder.files]
    warnings = [
        f"{history.request.name}: {text}"
        for history in histories
        for text in history.document["warnings"]
    ]
    document = {
        **heading(COMMAND),
        "note": _note(computed) or None,
        "histories": [history.document for history in histories],
        "sets": [set_document(case) for case in computed],
        "warnings": warnings,
        "files": files,
    }
    return concluded(document, error)


def set_document(case: Computed) -> dict[str, Any]:
    """What the records of a case say together."""
    return {
        "case": case.histories[0].document["case"],
        "records": case.labels,
        **summary_document(case.together)[0],
        "verdicts": [verdict_document((), verdict) for verdict in case.verdicts],
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
        found = zip(case.together.quantities, row.spreads, strict=True)
        main = [(quantity, spread) for quantity, spread in found if quantity.demand]
        for first in range(0, len(main), A_TABLE):
            yield _records_table(case, dict(main[first : first + A_TABLE]))
        if len(case.histories) > 1:
            yield f"overturned: {row.overturned}; {CODES}"
        own = case.first.given.case
        yield overturned_text(own.structure, own.analysis)
        yield restitution_text(own.structure)
    if any(case.verdicts for case in computed):
        yield _verdict_table(computed)
    if note := _note(computed):
        yield note


def _note(computed: Sequence[Computed]) -> str:
    grounds = (history.request.ground for case in computed for history in case.histories)
    return direction_note(ground.y is not None for ground in grounds)


def _records_table(case: Computed, quantities: dict[ResultQuantity, Spread]) -> Table:
    rows = []
    for label, history in zip(case.labels, case.histories, strict=True):
        found, outcome = history.document, str(history.document["outcome"])
        word = "overturned" if outcome.startswith("overturned") else outcome.replace("_", " ")
        values = [large(found[q.name], q.unit)[0] for q in quantities]
        rows.append([label, word, *(shown(value, DIGITS) for value in values)])
    if len(case.histories) > 1:
        words = {"mean": "mean of maxima", "median": "median", "high": "84 %", "largest": "largest"}
        for name, label in words.items():
            values = [large(getattr(each, name), q.unit)[0] for q, each in quantities.items()]
            rows.append([label, "", *(shown(value, DIGITS) for value in values)])
    heads = [headed(q.label, q.unit) for q in quantities]
    return Table.of_texts(["record", "", *heads], rows, words=2)


def _verdict_table(computed: Sequence[Computed]) -> Table:
    rows = []
    for case in computed:
        for verdict in case.verdicts:
            *texts, _ = verdict_texts(verdict)
            which = "least" if verdict.condition.from_below else "largest"
            value = shown(verdict.value) if math.isfinite(verdict.value) else "overturned"
            event = verdict.condition.name in EVENTS
            worst = "" if event else f", {which} {value} ({verdict.record})"
            result = f"{verdict.beyond.number} of {verdict.beyond.of} beyond{worst}"
            result += f"; {shown_by_text(verdict)}" if verdict.shown_by else ""
            rows.append([case.first.case_label, *texts, result])
    return Table.of_texts(["case", *VERDICT], rows, words=5, keys=2)
