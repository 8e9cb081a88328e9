"""The page of `rps report` about a design."""

from __future__ import annotations

from dataclasses import replace

from rpscli.commands.page_done import PageDone, ends
from rpscli.commands.page_of_study import figures, motions_of, study_input
from rpscli.commands.report_page import Earlier
from rpscli.commands.shell.options import CaseRequest, Output, RunChoices
from rpscli.report import case_page as parts
from rpscli.report.table import Heading
from rpscli.sweep.evaluation import resolved
from rpscli.tools.design.run import designed


def design_page(asked: CaseRequest, earlier: Earlier | None, out: Output) -> PageDone:
    """Search, or go on from the points that are stored, and put all in order."""
    request = asked if earlier is None else earlier.subject
    done = designed(request, RunChoices(), replace(out, force=earlier is not None))
    assert done is not None, "it is no dry run"
    document = done.document
    study = done.run.study
    at = done.judged.layout
    out.terminal.warn(notes := document["warnings"])
    case = resolved(at.plan, at[0].values)
    named = {path.name: content for path, content in done.folder.contents.items()}
    motions = parts.motions_section(*motions_of(study), study.title, out.look)
    title = "the best design" if document["best"] else "the least violated design"
    sections = parts.page_sections(
        case,
        study.title,
        out.look,
        short=[part for part in done.tables if part != Heading(study.title)],
        warnings=notes,
        inputs=study_input(study, case, f"The case of {title}"),
        results=[motions, figures(named, study)],
        commands=[["rps", command, *asked.words] for command in ("design", "report")],
        stored=[f"Every point is stored in {done.folder.folder}."],
        both=all(study.layout.pairs),
        which=[f"Of {title}."],
    )
    subtitle = f"Design: {len(done.answer.places)} examined{ends(case)}"
    signed = done.search.task.file.document
    return PageDone(study.title, subtitle, sections, document, done.error, signed)
