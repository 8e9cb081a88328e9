"""The page of `rps report` about a study, and parts that a design has too."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress

from rpscli.case.case import Case
from rpscli.commands.inputs import RESULTS, CaseInput, CaseMotion, MotionRequest
from rpscli.commands.page_done import PageDone, ends
from rpscli.commands.page_section import PAGE_SECTIONS, SectionRequest, with_brought
from rpscli.commands.shell.options import CaseRequest, Output, RunChoices
from rpscli.commands.study import Swept, counts_of_points, swept
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.report import case_page as parts
from rpscli.report.limits import verdicts_in_short
from rpscli.report.page import Block, Notice, Picture, ReportSection, pictures
from rpscli.report.study.report import SHEET
from rpscli.report.study.statistics import (
    cut,
    note_of_directions,
    of_first_system,
    summary_tables,
    verdict_table,
)
from rpscli.report.table import Table
from rpscli.studies import Study, StudyResult
from rpscli.sweep.evaluation import resolved
from rpscli.sweep.names import labels

FAILURES_SHOWN = 20


def study_page(study: Study, out: Output) -> PageDone:
    """Compute the points that are not stored yet, and put all in order."""
    layout = study.layout
    folder = study.output(out.place or RESULTS / layout.study.name / "sweep")
    # What is in a folder is shown, not added to.
    choices = RunChoices(report_only=out.place is not None)
    done = swept("report", study, folder, choices, out)
    out.terminal.warn(done.notes)
    first = resolved(layout.plan, layout[0].values)
    varied = any(key.startswith("podium.contact") for key in layout.plan.keys)
    contact = ", contact varied" if varied else ends(first)
    which = []
    if (systems := len(layout.properties)) > 1:
        named = labels(layout.plan.keys, layout[0].values)
        which = [f"The first of {systems} systems: {named}."]
    asked = CaseRequest(layout.study.source, study.overrides)
    words = asked.words
    stored = (
        f"Every point is stored in {folder.folder}; points.csv there has them all,"
        " failed.csv the command that computes each failed point alone."
    )
    sections = parts.page_sections(
        first,
        study.title,
        out.look,
        short=_in_short(done.result),
        warnings=_study_warnings(done),
        inputs=study_input(
            study, first, "The case" if systems == 1 else "Its first system"
        ),
        results=[
            *_study_results(done, out),
            *_brought(study, CaseInput(first, asked), out),
        ],
        commands=[["rps", "sweep", *words], ["rps", "report", *words]],
        stored=[stored],
        both=all(layout.pairs),
        which=which,
    )
    subtitle = f"Study of {len(done.result)} points{contact}"
    signed = layout.study.file.document
    return PageDone(
        study.title, subtitle, sections, done.document("report"), done.error, signed
    )


def _study_results(done: Swept, out: Output) -> Iterator[ReportSection]:
    """Figures; ground motions and statistics before them where there are histories."""
    study = done.result.study
    if done.result.summary:
        yield parts.motions_section(*motions_of(study), study.title, out.look)
        statistics = [
            *summary_tables(done.result.summary),
            of_first_system(study.layout),
            *done.found.parts,
        ]
        yield ReportSection("Statistics", [*cut(statistics)])
    yield figures(done.found.files, study)


def _brought(study: Study, first: CaseInput, out: Output) -> Iterator[ReportSection]:
    """Sections that a list of records brings, of the first system; none where records
    have factors of the study's own.
    """
    layout = study.layout
    typed = [
        record for record in layout.study.file.records or () if isinstance(record, str)
    ]
    wanted = with_brought({}, typed) if layout.scales in ((1.0,), (None,)) else {}
    if not wanted:
        return
    motions = []
    for request in filter(None, layout.records):
        with suppress(RecordError):  # told where it is read
            ground = layout.context.records.motion(request)
            motions.append(CaseMotion(MotionRequest(request.source), ground))
    names = [each.ground.horizontal.name for each in motions]
    for name, value in wanted.items():
        section = SectionRequest(first, motions, names, 0, value, out.terminal, out.look)
        yield PAGE_SECTIONS[name].made(section)


def _study_warnings(done: Swept) -> Iterator[str]:
    """Doubts, reports that failed, and the first of the points that did."""
    failures = done.found.failures
    yield from (*done.notes, *map(str, done.found.broken))
    for failure in failures[:FAILURES_SHOWN]:
        yield f"Point {failure.point} failed: {failure.message}"
    if len(failures) > FAILURES_SHOWN:
        yield f"{len(failures)} points failed; these are the first of them"


def _in_short(run: StudyResult) -> Iterator[Block]:
    """Counts of outcomes, and verdicts."""
    counts = counts_of_points(run)
    yield Table.of_texts(tuple(counts), [tuple(map(str, counts.values()))], words=0)
    if aim := run.layout.scaled_to:
        yield f"Records are scaled to {aim}."
    if run.summary is not None:
        yield verdicts_in_short(run.judgements, " of a system at an intensity")
        if run.judgements:
            yield from cut([verdict_table(run.summary, run.judgements)])
        if note := note_of_directions(run.layout):
            yield Notice(note)


def motions_of(study: Study) -> tuple[list[GroundMotion], list[str]]:
    """The records before they are scaled, and why some cannot be read."""
    layout = study.layout
    motions = []
    reasons = []
    own = [
        properties.record for properties in layout.properties if None in layout.records
    ]
    for request in filter(None, dict.fromkeys((*layout.records, *own))):
        try:
            motions.append(layout.context.records.motion(request).horizontal)
        except RecordError as error:
            reasons.append(str(error))
    return motions, reasons


def figures(files: Mapping[str, object], study: Study) -> ReportSection:
    """All of them, with the kind and the title of the report that each is of."""
    drawn = []
    for stem, each in pictures(files.items()).items():
        of, _, sheet = stem.partition(SHEET)
        request = study.reports.get(stem) or study.reports.get(of)
        kind, title = (request.kind, request.options.title) if request else (stem, None)
        caption = f"{kind.replace('_', ' ').capitalize()}{f': {title}' if title else ''}"
        caption += f", sheet {sheet}." * bool(sheet and stem not in study.reports) or "."
        drawn.append(Picture(each, caption))
    return ReportSection("Figures", drawn)


def study_input(study: Study, first: Case, which: str) -> Iterator[Block]:
    """The file as it is written, and a case of it."""
    checked = study.layout.study
    plan = study.layout.plan
    yield parts.listing([
        ("file", checked.source),
        ("SHA-256 of its text", checked.digest),
        ((
            "case at"
            " its"
            " base"
        ), str(checked.base_file) if checked.base_file else "in the study"),
        ("overridden values", ", ".join(study.overrides)),
        ("solver", plan.solver),
    ])  # fmt: skip
    yield "What it says:"
    yield parts.input_table(checked.document.content)
    yield f"{which}, as it is written and in SI units, with all defaults:"
    yield parts.input_table(first.document, first.written)
