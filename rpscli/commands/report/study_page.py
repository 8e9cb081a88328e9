"""The page of a study: its systems, records, statistics, verdicts and reports."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rpscli.commands.report.blocks import blocks_of
from rpscli.commands.report.case_page import PageDone, notices, programs
from rpscli.commands.report.subject import Earlier
from rpscli.commands.shell.failure import concluded
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.input import (
    StudyInput,
    SweepChoices,
    read_study,
    study_folder,
    study_heading,
)
from rpscli.commands.sweep.points import begin, compute
from rpscli.commands.sweep.requirements import require_results
from rpscli.commands.sweep.results import Collected, collect, first_error, outcome_counts
from rpscli.commands.sweep.tables import summary_tables, verdict_table
from rpscli.errors import RecordError, UsageError
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.html import sections as shared
from rpscli.report.html.motions import motions_section
from rpscli.report.html.page import Block, Code, Section, Table
from rpscli.report.html.pictures import Picture, page_look, pictures
from rpscli.report.study.labels import label
from rpscli.sweep.evaluation.systems import resolved

if TYPE_CHECKING:
    from rpscli.case.case import Case
    from rpscli.case.conditions import Condition
    from rpscli.records.ground_motion import GroundMotion
    from rpscli.report.files.output_folder import OutputFolder
    from rpscli.sweep.study_results import StudyResults

CHOICES = SweepChoices(
    jobs=None, scheduler=None, dry_run=False, fresh=False, retry_failed=False, report_only=False
)
FAILURES_SHOWN = 20


def read_subject(
    request: CaseRequest, earlier: Earlier | None, look: Look, terminal: Terminal
) -> StudyInput:
    """The study, or that of a folder of its results."""
    if earlier is not None:
        if earlier.file is None or not earlier.file.exists():
            raise UsageError(
                f"{earlier.folder}: its study {earlier.file or ''} is not there; give the study"
            )
        request = CaseRequest(str(earlier.file), tuple(earlier.run["inputs"]["overrides"]))
    return read_study(request, terminal, page_look(look))


def study_page(
    given: StudyInput, place: Path | None, conditions: Sequence[Condition], terminal: Terminal
) -> PageDone:
    """Compute the points that are not stored yet, and put all in order.

    Raises
    ------
    KeyboardInterrupt
        If it was stopped between two points.
    """
    from rpscli.sweep.run.threads import available_cores
    from rpscli.sweep.store import Store
    from rpscli.sweep.study_results import StudyResults
    from rpscli.sweep.table import tabulate

    require_results(given, list(conditions))
    folder = study_folder(given, OutputRequest(place, force=False))
    with Store(folder.folder) as store:
        # What is in a folder is shown, not added to.
        start = begin(given, store, replace(CHOICES, report_only=place is not None), terminal)
        finish = compute(given, start, store, CHOICES, terminal)
        if finish.interrupted:
            terminal.note(f"points are stored in {store.path}; the same command goes on from there")
            raise KeyboardInterrupt
        table = tabulate(given.layout, store.stored(start.keys))
        results = StudyResults(table, start.keys, store, given.context, available_cores())
        found = collect(given, results, list(conditions), folder)
        error = first_error(found, len(table))
        document = {
            **heading(),
            "study": study_heading(given),
            "points": {"total": len(table), "failed": len(found.failures)},
            "outcomes": outcome_counts(table),
            "warnings": found.notes,
        }
        terminal.warn(found.notes)
        return PageDone(
            given.study.title,
            f"Study of {len(table)} points",
            _sections(given, results, found, folder),
            concluded(document, error),
            error,
        )


def _sections(
    given: StudyInput, results: StudyResults, found: Collected, folder: OutputFolder
) -> list[Section]:
    first, look = _first_system(given), given.look
    files = ((path.name, content) for path, content in folder.contents.items())
    drawn: list[Block] = [Picture(each, _caption(given, stem)) for stem, each in pictures(files)]
    statistics = [] if found.summary is None else list(blocks_of(summary_tables(found.summary)))
    motions, unreadable = _motions(given)
    ground = Section("Ground motions", [])
    if given.layout.plan.analysis == "timehistory":
        ground = motions_section(motions, unreadable, given.study.title, look)
    return [
        Section("In short", list(_in_short(given, results, found))),
        _of_first(shared.structure_section(first.structure, given.study.title, look), given),
        Section("Input", list(_input(given, first))),
        _of_first(shared.derived_section(first.structure, first.document["podium"]), given),
        ground,
        Section("Statistics", statistics),
        Section("Figures", drawn),
        shared.hidden_section(),
        Section("How to repeat it", list(_repeat(given, folder))),
    ]


def _first_system(given: StudyInput) -> Case:
    return resolved(given.layout.plan, given.layout[0].values)


def _of_first(section: Section, given: StudyInput) -> Section:
    """A section about one system says which."""
    systems = len(given.layout.combinations)
    if systems == 1:
        return section
    layout = given.layout
    values = zip(layout.plan.keys, layout[0].values, strict=True)
    which = ", ".join(label(key, value) for key, value in values)
    text = f"The first of {systems} systems: {which}."
    return replace(section, blocks=[text, *section.blocks])


def _in_short(given: StudyInput, results: StudyResults, found: Collected) -> Iterator[Block]:
    outcomes = outcome_counts(results.table)
    yield Table(
        ("points", *outcomes),
        [(str(len(results.table)), *(str(count) for count in outcomes.values()))],
        words=0,
    )
    if found.summary is not None and found.verdicts:
        exceeded = sum(verdict.exceeded for verdict in found.verdicts)
        verdicts = f"{len(found.verdicts)} limits of a system at an intensity"
        yield f"{exceeded} of {verdicts} exceeded." if exceeded else f"All {verdicts} are met."
        yield from blocks_of([verdict_table(found.summary, found.verdicts)])
    elif given.layout.plan.analysis == "timehistory":
        yield "No limits were set."
    texts = [*found.notes, *(str(error) for error in found.broken)]
    texts += [f"Point {f.point} failed: {f.message}" for f in found.failures[:FAILURES_SHOWN]]
    if len(found.failures) > FAILURES_SHOWN:
        texts.append(f"{len(found.failures)} points failed; these are the first of them")
    yield from notices(texts)


def _motions(given: StudyInput) -> tuple[list[GroundMotion], list[str]]:
    """The records before they are scaled, and why some cannot be read."""
    layout, motions, reasons = given.layout, [], []
    own = [properties.record for properties in layout.properties]
    requests = [record for record in (*layout.records, *own) if record is not None]
    if None not in layout.records:
        requests = [record for record in layout.records if record is not None]
    for request in dict.fromkeys(requests):
        try:
            motions.append(given.context.records.motion(request).horizontal)
        except RecordError as error:
            reasons.append(str(error))
    return motions, reasons


def _caption(given: StudyInput, stem: str) -> str:
    kinds = {request.stem: request for request in given.study.reports}
    request = kinds.get(stem)
    if request is None:
        return stem
    title = request.options.title
    return f"{request.kind.replace('_', ' ').capitalize()}{f': {title}' if title else ''}."


def _input(given: StudyInput, first: Case) -> Iterator[Block]:
    study = given.study
    yield shared.listing(
        ("study", study.source),
        ("SHA-256 of its text", study.digest),
        ("case at its base", str(study.base_file) if study.base_file else "in the study"),
        ("values put over it", ", ".join(given.request.overrides)),
        ("solver", given.layout.plan.solver),
        ("made by", programs()),
    )
    yield "The study as it is written:"
    yield shared.input_table(study.document.content)
    systems = len(given.layout.combinations)
    which = "The case" if systems == 1 else "Its first system"
    yield f"{which} in SI units, with all defaults:"
    yield shared.input_table(first.document)


def _repeat(given: StudyInput, folder: OutputFolder) -> Iterator[Block]:
    words = [given.request.source]
    for override in given.request.overrides:
        words += ["--set", override]
    yield "From the folder in which this page was made, with the same versions:"
    yield Code(f"{shlex.join(['rps', 'sweep', *words])}\n{shlex.join(['rps', 'report', *words])}")
    yield (
        f"Every point is stored in {folder.folder}; points.csv there has them all, failed.csv the"
        " command that computes each failed point alone."
    )
