"""One time history: what is asked for, and what it leaves behind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.analyses.result_quantities import LIMITED, NEEDS
from rpscli.case.conditions import EVENTS, LIMITS, Condition, case_conditions, with_friction
from rpscli.commands.inputs import (
    RESULTS,
    CaseInput,
    MotionRequest,
    case_folder,
    case_heading,
    load_motion,
    motion_inputs,
    motion_source,
)
from rpscli.commands.shell.options import OutputRequest
from rpscli.commands.shell.terminal import Terminal, concluded
from rpscli.commands.shell.waiting import patience
from rpscli.errors import AnalysisError, LimitExceeded, RecordError, RpsError, UsageError, all_made
from rpscli.report.documents import direction_note, heading, json_text, timehistory_document
from rpscli.report.figures.look import Look
from rpscli.report.files import OutputFolder

if TYPE_CHECKING:
    from rpscli.analyses.neighbours import Neighbour
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.records.ground_motion import MotionComponents
    from rpscli.sweep.statistics.verdicts import Verdict

COMMAND = "timehistory"


@dataclass(frozen=True, eq=False)
class HistoryRequest:
    """A case, its motion, the folder of the results; spectra of floors where they are asked for."""

    given: CaseInput
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
    """What is known of a history that is over; its demands by name, NaN for what it has not."""

    request: HistoryRequest
    document: dict[str, Any]
    demands: dict[str, float]
    verdicts: list[Verdict]
    error: RpsError | None


def history_requests(
    cases: Sequence[CaseInput], motions: Sequence[MotionRequest], output: OutputRequest
) -> list[HistoryRequest]:
    """Every case under every motion, all read and all folders claimed before any is computed."""
    requests = []
    case_labels = unique([given.case.name for given in cases])
    for given, case_label in zip(cases, case_labels, strict=True):
        grounds = all_made(partial(load_motion, given.case), motions, RecordError)
        labels = unique([_label(ground) for ground in grounds])
        for motion, ground, label in zip(motions, grounds, labels, strict=True):
            place = RESULTS / case_label / COMMAND / label
            if output.place is not None:
                inside = [case_label] * (len(cases) > 1) + [label] * (len(motions) > 1)
                place = output.place.joinpath(*inside)
            folder = case_folder(
                given,
                OutputRequest(place, output.force),
                COMMAND,
                record_source=motion_source(given.case, motion),
                record=motion_inputs(ground),
            )
            requests.append(HistoryRequest(given, case_label, ground, label, folder))
    return requests


def _label(ground: MotionComponents) -> str:
    scaled = "" if ground.scale == 1.0 else f"_x{ground.scale:.4g}"
    return f"{ground.horizontal.name}{scaled}"


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
    from rpscli.analyses.column_forces import no_bound
    from rpscli.analyses.timehistory import time_history
    from rpscli.report.bundles import floor_spectra_files, timehistory_files
    from rpscli.report.study.statistics import verdict_document
    from rpscli.sweep.statistics.summary import Records
    from rpscli.sweep.statistics.verdicts import judged_records

    case, ground = request.given.case, request.ground
    with patience(case, ground.horizontal.duration, terminal):
        result = time_history(case.structure, ground, case.analysis)
    request.folder.add_all(timehistory_files(result, case.title, look))
    if request.floor_spectra:
        request.folder.add_all(floor_spectra_files(result, case.title, look))
    found = {quantity.name: getattr(result, quantity.name) for quantity in LIMITED}
    demands = {name: math.nan if each is None else float(each) for name, each in found.items()}
    document = _document(request, result)
    verdicts: list[Verdict] = []
    error: RpsError | None = AnalysisError(result.failure) if result.failure else None
    if error is None:
        limits = case_conditions(case.limits, overturning=True)
        limits = [*with_friction(limits, case.structure), *conditions]
        for limit in limits:
            needs = LIMITS[limit.name].needs if limit.name in found else ""
            if result.both_components and (why := no_bound(limit.name, result.structure)):
                raise UsageError(f"{limit.source}: {why}")
            partial = needs == "columns" and result.left_out_of_columns
            if needs and (found[limit.name] is None or partial):
                raise UsageError(f"{limit.source}: {limit.name} needs {NEEDS[needs]}")
        records = Records.of([result.outcome], [demands], [result.record.source])
        verdicts = judged_records(records, [request.label], limits)
        over = [f"limit exceeded: {_found(verdict)}" for verdict in verdicts if verdict.exceeded]
        error = LimitExceeded("\n".join(over)) if over else None
    document["verdicts"] = [verdict_document((), verdict) for verdict in verdicts]
    return HistoryResult(request, concluded(document, error), demands, verdicts, error), result


def look_beside(done: HistoryResult, result: TimeHistoryResult) -> list[Neighbour]:
    """Histories beside a single one, which go into its document too."""
    from rpscli.analyses.neighbours import neighbours

    found = neighbours(result)
    done.document["neighbours"] = [each._asdict() for each in found]
    return found


def _found(verdict: Verdict) -> str:
    condition = verdict.condition
    if condition.name in EVENTS:
        return f"{condition.name} ({condition.source})"
    if verdict.overturned:
        return f"{condition.name}: overturned ({condition.source})"
    beyond = "is below" if condition.from_below else "exceeds"
    value = f"{verdict.value:.4g} {beyond} {condition.limit:g}"
    return f"{condition.name} = {value} ({condition.source})"


def add_summary(done: HistoryResult) -> None:
    """`summary.json`, which names all files that were collected before it."""
    folder = done.request.folder
    done.document["files"] = [str(folder.folder / "summary.json"), *folder.files]
    folder.add("summary.json", json_text(done.document))


def _document(request: HistoryRequest, result: TimeHistoryResult) -> dict[str, Any]:
    from rpscli.case.rules.plausibility import doubts_of_directions  # the help needs no pydantic

    given, ground = request.given, request.ground
    document = {
        **heading(COMMAND),
        "note": direction_note([ground.y is not None]) or None,
        "case": case_heading(given),
        **timehistory_document(result),
    }
    document["record"] |= {"scale": ground.scale, "scaled_to": ground.scaled_to or None}
    doubts = doubts_of_directions(given.case.structure, both=ground.y is not None)
    warnings = [*given.case.warnings, *map(str, doubts)]
    document["warnings"] = [*warnings, *document["warnings"], *ground.warnings]
    return document
