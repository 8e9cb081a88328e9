"""Pages of a study and of a design: systems, records, statistics, verdicts, figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from rpscli.case.case import Case
from rpscli.commands.design_run import designed
from rpscli.commands.inputs import RESULTS
from rpscli.commands.report_case import Earlier, PageDone, ends, subject_words
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal, concluded
from rpscli.commands.shell.waiting import passing_time
from rpscli.commands.study import SweepChoices, computed, study_heading
from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.html import case_page
from rpscli.report.html.page import Block, Picture, Section, page_look, pictures
from rpscli.report.limits import verdicts_in_short
from rpscli.report.study.labels import labels
from rpscli.report.study.shown import cut, of_first_system, summary_tables, verdict_table
from rpscli.report.table import Heading, Table
from rpscli.studies import Study, StudyResult, collected, error_of
from rpscli.sweep.context import resolved
from rpscli.sweep.store import Store

FAILURES_SHOWN = 20


def study_page(study: Study, place: Path | None, look: Look, terminal: Terminal) -> PageDone:
    """Compute the points that are not stored yet, and put all in order."""
    look, layout = page_look(look), study.layout
    folder = place or RESULTS / layout.study.name / "sweep"
    # What is in a folder is shown, not added to.
    only = place is not None
    study.output(folder)
    with Store(folder) as store:
        run = computed("report", study, store, SweepChoices(report_only=only), terminal)
        with passing_time("making reports", terminal):
            found = collected(run, look)
    notes = [*study.warnings, *found.notes]
    error = error_of(run, found)
    document = {
        **heading(),
        "study": study_heading(layout),
        "points": {"total": len(run.table), "failed": len(found.failures)},
        "outcomes": run.outcomes,
        "warnings": notes,
    }
    terminal.warn(notes)
    varied = any(key.startswith("podium.contact") for key in layout.plan.keys)
    first = resolved(layout.plan, layout[0].values)
    contact = ", contact varied" if varied else ends(first)
    results = [_figures(found.files, study)]
    if run.summary:
        statistics = [*summary_tables(run.summary), of_first_system(run.layout), *found.parts]
        motions = case_page.motions_section(*motions_of(study), study.title, look)
        results = [motions, Section("Statistics", [*cut(statistics)]), *results]
    which = []
    if (systems := len(layout.properties)) > 1:
        named = labels(layout.plan.keys, layout[0].values)
        which = [f"The first of {systems} systems: {named}."]
    words = subject_words(layout.study.source, study.overrides)
    warnings = [*notes, *(str(error) for error in found.broken)]
    warnings += [f"Point {f.point} failed: {f.message}" for f in found.failures[:FAILURES_SHOWN]]
    if (failed := len(found.failures)) > FAILURES_SHOWN:
        warnings.append(f"{failed} points failed; these are the first of them")
    stored = (
        f"Every point is stored in {folder}; points.csv there has them all, failed.csv the"
        " command that computes each failed point alone."
    )
    sections = case_page.page_sections(
        first,
        study.title,
        look,
        short=_in_short(run),
        warnings=warnings,
        inputs=study_input(study, first, "The case" if systems == 1 else "Its first system"),
        results=results,
        commands=[["rps", "sweep", *words], ["rps", "report", *words]],
        stored=[stored],
        both=all(layout.pairs),
        which=which,
    )
    subtitle = f"Study of {len(run.table)} points{contact}"
    signed = layout.study.file.document
    return PageDone(study.title, subtitle, sections, concluded(document, error), error, signed)


def _in_short(run: StudyResult) -> Iterator[Block]:
    counts = {"points": len(run.table), **run.outcomes}
    yield Table.of_texts(tuple(counts), [tuple(map(str, counts.values()))], words=0)
    if aim := run.layout.scaled_to:
        yield f"Records are scaled to {aim}."
    if run.summary is not None:
        yield verdicts_in_short(run.judgements, " of a system at an intensity")
        if run.judgements:
            yield from cut([verdict_table(run.summary, run.judgements)])


def motions_of(study: Study) -> tuple[list[GroundMotion], list[str]]:
    """The records before they are scaled, and why some cannot be read."""
    layout, motions, reasons = study.layout, [], []
    own = [properties.record for properties in layout.properties if None in layout.records]
    for request in filter(None, dict.fromkeys((*layout.records, *own))):
        try:
            motions.append(layout.context.records.motion(request).horizontal)
        except RecordError as error:
            reasons.append(str(error))
    return motions, reasons


def _figures(files: Mapping[str, object], study: Study) -> Section:
    """All of them, with the kind and the title of the report that each is of."""
    drawn = []
    for stem, each in pictures(files.items()).items():
        request = study.reports.get(stem)
        kind, title = (request.kind, request.options.title) if request else (stem, None)
        caption = f"{kind.replace('_', ' ').capitalize()}{f': {title}' if title else ''}."
        drawn.append(Picture(each, caption))
    return Section("Figures", drawn)


def study_input(study: Study, first: Case, which: str) -> Iterator[Block]:
    """The file as it is written, and a case of it."""
    checked, plan = study.layout.study, study.layout.plan
    yield case_page.listing([
        ("file", checked.source),
        ("SHA-256 of its text", checked.digest),
        ("case at its base", str(checked.base_file) if checked.base_file else "in the study"),
        ("overridden values", ", ".join(study.overrides)),
        ("solver", plan.solver),
    ])  # fmt: skip
    yield "What it says:"
    yield case_page.input_table(checked.document.content)
    yield f"{which}, as it is written and in SI units, with all defaults:"
    yield case_page.input_table(first.document, first.written)


def design_page(
    source: str, overrides: tuple[str, ...], earlier: Earlier | None, look: Look, terminal: Terminal
) -> PageDone:
    """Search, or go on from the points that are stored, and put all in order."""
    request = CaseRequest(source, overrides) if earlier is None else earlier.subject
    folder = None if earlier is None else earlier.folder
    output, look = OutputRequest(folder, force=folder is not None), page_look(look)
    done = designed(request.source, request.overrides, SweepChoices(), output, look, terminal)
    assert done is not None, "it is no dry run"
    document, study = done.document, done.run.study
    terminal.warn(notes := document["warnings"])
    at = done.judged.layout
    case = resolved(at.plan, at[0].values)
    named = {path.name: content for path, content in done.folder.contents.items()}
    short = [
        part for part in done.tables if not (isinstance(part, Heading) and part == study.title)
    ]
    motions = case_page.motions_section(*motions_of(study), study.title, look)
    results = [motions, _figures(named, study)]
    words = subject_words(source, overrides)
    stored = f"Every point is stored in {done.folder.folder}."
    title = "the best design" if document["best"] else "the least violated design"
    sections = case_page.page_sections(
        case,
        study.title,
        look,
        short=short,
        warnings=notes,
        inputs=study_input(study, case, f"The case of {title}"),
        results=results,
        commands=[["rps", "design", *words], ["rps", "report", *words]],
        stored=[stored],
        both=all(study.layout.pairs),
        which=[f"Of {title}."],
    )
    subtitle = f"Design: {len(done.answer.places)} examined{ends(case)}"
    signed = done.search.task.file.document
    return PageDone(study.title, subtitle, sections, document, done.error, signed)
