"""The page of a case, with its time history if it has a record."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rpscli.commands.case_input import CaseInput, case_heading
from rpscli.commands.motion import MotionRequest
from rpscli.commands.report.comparison import compared
from rpscli.commands.report.subject import SUMMARY, Earlier
from rpscli.commands.shell.failure import concluded
from rpscli.commands.shell.options import OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation
from rpscli.commands.timehistory_run import HistoryRequest, HistoryResult, compute, history_requests
from rpscli.report.documents import heading
from rpscli.report.figures.drawing import artists
from rpscli.report.figures.look import Look
from rpscli.report.files.versions import versions

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.case.conditions import Condition
    from rpscli.errors import RpsError
    from rpscli.report.html.page import Block, Section

FIGURES = 10
"""Of a history, in two formats each."""

CAPTIONS = {
    "rotation": "Ground acceleration, rotation of the columns with the phases of the motion, and"
    " the events.",
    "displacements": "Displacements to the ground against time.",
    "moment_rotation": "Moment about the contact points against rotation, and what the weight alone"
    " does.",
    "energy": "Where the energy of the ground has gone.",
    "storey_shears": "Largest storey shears on the bearings and on a fixed base.",
    "devices": "Force against displacement of each device between ground and cap beam.",
}


@dataclass(frozen=True)
class PageDone:
    """A page's title and sections, the document that says what was found, and its error."""

    title: str
    subtitle: str
    sections: Sequence[Section]
    document: dict[str, Any]
    error: RpsError | None


def case_page(
    given: CaseInput,
    motion: MotionRequest,
    conditions: Sequence[Condition],
    look: Look,
    earlier: Earlier | None,
    terminal: Terminal,
) -> PageDone:
    """Compute what belongs to a case, and put it in order."""
    case = given.case
    if case.record is None and motion.record is None:
        document = {**heading(), "case": case_heading(given), "warnings": list(case.warnings)}
        sections = _sections(given, motion, None, look, ())
        return PageDone(case.title, "Structure", sections, concluded(document, None), None)
    from rpscli.report.html.pictures import page_look

    # A place for the files, which are not written there.
    (request,) = history_requests([given], [motion], OutputRequest(Path(), force=True))
    with artists(FIGURES) as drawing:
        announce_compilation(terminal, moving=True)
        done, result = compute(request, conditions, page_look(look), drawing, terminal)
    terminal.warn(done.document["warnings"])
    stored = () if earlier is None else _stored(earlier, request, done)
    sections = _sections(given, motion, (request, done, result), look, stored)
    return PageDone(
        case.title, f"Time history under {result.record.name}", sections, done.document, done.error
    )


def _sections(
    given: CaseInput,
    motion: MotionRequest,
    history: tuple[HistoryRequest, HistoryResult, TimeHistoryResult] | None,
    look: Look,
    stored: Sequence[Block],
) -> list[Section]:
    from rpscli.report.html import sections as shared
    from rpscli.report.html.motions import motion_pictures
    from rpscli.report.html.page import Section

    case = given.case
    made = [
        shared.structure_section(case.structure, case.title, look),
        Section("Input", _input(given, history and history[0])),
        shared.derived_section(case.structure, case.document["podium"]),
    ]
    if history is None:
        text = "The case names no ground motion: this page ends with what follows without one."
        made.insert(0, Section("In short", [text, *notices(case.warnings)]))
    else:
        request, done, result = history
        ground = [*_record_tables(result)]
        ground += [motion_pictures(each, look) for each in request.ground.named.values()]
        made.insert(0, Section("In short", list(_in_short(done, result))))
        made += [Section("Ground motion", ground), Section("Response", _response(request, result))]
    repeat: list[Block] = [*_repeat(given, motion), *stored]
    return [*made, shared.hidden_section(), Section("How to repeat it", repeat)]


def _record_tables(result: TimeHistoryResult) -> Iterator[Any]:
    from rpscli.commands.record.info import record_tables
    from rpscli.records.measures import intensity_measures

    return record_tables(result.record, intensity_measures(result.record))


def _in_short(done: HistoryResult, result: TimeHistoryResult) -> Iterator[Block]:
    from rpscli.commands.timehistory_tables import limits_table, outcome_text
    from rpscli.report.html.page import Notice

    yield f"Outcome: {outcome_text(result)}."
    if result.failure:
        yield Notice(result.failure)
    if done.verdicts:
        exceeded = sum(verdict.exceeded for verdict in done.verdicts)
        of = f"of {len(done.verdicts)} limits"
        yield f"{exceeded} {of} exceeded." if exceeded else f"All {len(done.verdicts)} limits met."
        yield limits_table(done.verdicts)
    else:
        yield "No limits were set."
    yield from notices(done.document["warnings"])


def notices(texts: Sequence[str]) -> Iterator[Block]:
    """What must be read before the numbers are used."""
    from rpscli.report.html.page import Notice

    return (Notice(f"Warning: {text}") for text in texts)


def _response(request: HistoryRequest, result: TimeHistoryResult) -> list[Block]:
    from rpscli.commands.timehistory_tables import outcome_table, storeys_table
    from rpscli.report.html.pictures import Picture, pictures

    tables = [outcome_table(result)]
    if result.structure.storeys:
        tables.append(storeys_table(result))
    files = ((path.name, content) for path, content in request.folder.contents.items())
    drawn = [Picture(found, CAPTIONS[stem]) for stem, found in pictures(files)]
    return [*tables, *drawn]


def _input(given: CaseInput, request: HistoryRequest | None) -> list[Block]:
    from rpscli.report.html.sections import input_table, listing

    case = given.case
    motions = {}
    if request is not None:
        ground = request.ground
        for component, each in ground.named.items():
            name = f"{component} record".removeprefix("horizontal ")
            motions[name] = f"{each.source}, scaled by {ground.scale:.9g}"
            motions[f"SHA-256 of the scaled samples, {name}"] = each.digest
    origin = listing(
        ("case", case.source),
        ("SHA-256 of its text", case.digest),
        ("values put over it", ", ".join(given.request.overrides)),
        *motions.items(),
        ("made by", programs()),
    )
    return [origin, "The case in SI units, with all defaults:", input_table(case.document)]


def programs() -> str:
    """What made the numbers, with versions."""
    return ", ".join(f"{name} {version}" for name, version in versions().items() if version)


def _repeat(given: CaseInput, motion: MotionRequest) -> Iterator[Block]:
    from rpscli.report.html.page import Code

    words = [given.request.source]
    for override in given.request.overrides:
        words += ["--set", override]
    options = {
        "--record": motion.record,
        "--vertical": motion.vertical,
        "--scale": None if motion.scale is None else repr(motion.scale),
        "--scale-to": motion.scale_to,
    }
    for option, value in options.items():
        words += [] if value is None else [option, value]
    lines = [shlex.join(["rps", "report", *words])]
    if given.case.record is not None or motion.record is not None:
        lines.insert(0, shlex.join(["rps", "timehistory", *words]))
    yield "From the folder in which this page was made, with the same versions:"
    yield Code("\n".join(lines))


def _stored(earlier: Earlier, request: HistoryRequest, done: HistoryResult) -> list[Block]:
    """Whether case, record and results are those of the stored results."""
    import hashlib

    from rpscli.report.html.page import Notice

    found: list[Block] = []
    file = earlier.file
    known = earlier.run["inputs"]["record"]["horizontal"]["sha256"]
    if request.ground.horizontal.digest != known:
        found.append(Notice("The record is not the one of the stored results any more."))
    if file is not None:
        try:
            now = hashlib.sha256(file.read_bytes()).hexdigest()
        except OSError:
            now = ""
        if now != earlier.run["sha256"]:
            state = "has changed since" if now else "is not there any more"
            found.append(Notice(f"{file} {state}; this page keeps to the case in run.json."))
    if (earlier.folder / SUMMARY).exists():
        found += compared(earlier.folder, done.document)
    return found
