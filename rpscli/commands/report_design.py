"""The page of a design: what is recommended, what binds, its validation and its figures."""

from __future__ import annotations

from rpscli.commands.design import designed
from rpscli.commands.report_case import Earlier, PageDone, subject_words
from rpscli.commands.report_study import motions_of, study_input
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.study import SweepChoices
from rpscli.report.figures.look import Look
from rpscli.report.html.page import Picture, Section, page_look, pictures
from rpscli.report.html.sections import motions_section, notices, page_sections, repeated
from rpscli.report.table import Heading
from rpscli.sweep.evaluation.context import resolved
from rpscli.sweep.points.layout import lay_out


def design_page(
    source: str,
    overrides: tuple[str, ...],
    earlier: Earlier | None,
    look: Look,
    terminal: Terminal,
) -> PageDone:
    """Search, or go on from the points that are stored, and put all in order."""
    request = CaseRequest(source, overrides) if earlier is None else earlier.subject
    folder = None if earlier is None else earlier.folder
    output, look = OutputRequest(folder, force=folder is not None), page_look(look)
    done = designed(
        request.source, request.overrides, SweepChoices(), output, look, terminal, written=False
    )
    assert done is not None, "it is no dry run"
    answer, study, notes = done.answer, done.study, done.document["warnings"]
    terminal.warn(notes)
    at = lay_out(answer.task.study_of(answer.values[[answer.headline]]))
    case = resolved(at.plan, at[0].values)
    named = {path.name: content for path, content in done.folder.contents.items()}
    drawn = [
        Picture(each, f"{stem.replace('_', ' ').capitalize()}.")
        for stem, each in pictures(named.items())
    ]
    short = [
        part for part in done.tables if not (isinstance(part, Heading) and part == study.title)
    ]
    results = [motions_section(*motions_of(study), study.title, look), Section("Figures", drawn)]
    words = subject_words(source, overrides)
    stored = f"Every point is stored in {done.folder.folder}."
    title = "the recommended design" if done.document["robust"] else "the design shown"
    sections = page_sections(
        case,
        study.title,
        look,
        [*short, *notices(notes)],
        study_input(study, case, f"The case of {title}"),
        results,
        [*repeated(["rps", "design", *words], ["rps", "report", *words]), stored],
        [f"Of {title}."],
    )
    subtitle = f"Design: {len(answer.places)} looked at"
    signed = answer.task.file.document
    return PageDone(study.title, subtitle, sections, done.document, done.error, signed)
