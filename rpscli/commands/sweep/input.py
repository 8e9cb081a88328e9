"""From what stands on the command line to the points of a study, and to its folder."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rpscli.commands.case_input import RESULTS
from rpscli.commands.shell.options import CaseRequest, OutputRequest
from rpscli.commands.shell.passing_time import watched
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import UsageError
from rpscli.report.figures.look import USUAL, Look

if TYPE_CHECKING:
    from rpscli.case.study.study import Study
    from rpscli.report.files.output_folder import OutputFolder
    from rpscli.sweep.evaluation.context import StudyContext
    from rpscli.sweep.points.layout import StudyPoints


@dataclass(frozen=True)
class SweepChoices:
    """How a study is run."""

    jobs: int | None
    scheduler: str | None
    dry_run: bool
    fresh: bool
    retry_failed: bool
    report_only: bool = False

    def require_sense(self) -> None:
        """Refuse options that contradict each other."""
        if self.report_only and (self.fresh or self.retry_failed or self.scheduler):
            raise UsageError(
                "--report-only computes no points; take --fresh, --retry-failed and --scheduler out"
            )
        if self.scheduler and self.jobs:
            raise UsageError("--jobs counts threads of this machine; --scheduler has its own")


@dataclass(frozen=True, eq=False)
class StudyInput:
    """A study, laid out."""

    layout: StudyPoints
    context: StudyContext
    request: CaseRequest
    look: Look = USUAL

    @property
    def study(self) -> Study:
        """The study."""
        return self.layout.study

    @property
    def doubts(self) -> list[str]:
        """What is unusual about its systems, each kind once."""
        from rpscli.case.rules.plausibility import doubts_of_many

        return doubts_of_many([properties.doubts for properties in self.layout.properties])

    @property
    def file(self) -> Path | None:
        """The study's file; None if it came through the standard input."""
        return None if self.request.source == "-" else Path(self.request.source)


def read_study(request: CaseRequest, terminal: Terminal, look: Look = USUAL) -> StudyInput:
    """Read and check a study and all its systems."""
    from rpscli.case.study.study import parse_study
    from rpscli.case.text.files import read_text
    from rpscli.report.study.registry import REPORTS
    from rpscli.sweep.evaluation.context import StudyContext
    from rpscli.sweep.points.layout import lay_out
    from rpscli.sweep.points.sampling import balance_note

    piped = request.source == "-"
    study = parse_study(
        read_text(request.source),
        name="<stdin>" if piped else request.source,
        kinds=REPORTS,
        folder=None if piped else Path(request.source).parent,
        overrides=request.overrides,
    )
    if (section := study.file.sample) and (note := balance_note(section)):
        terminal.warn([note])
    layout = lay_out(study, partial(watched, "systems examined", terminal))
    return StudyInput(layout, StudyContext(layout.plan), request, look)


def study_folder(given: StudyInput, output: OutputRequest, command: str = "sweep") -> OutputFolder:
    """The folder of a study's results, or a design's."""
    from rpscli.report.study import folder

    place = output.place or RESULTS / given.study.name / command
    overrides = given.request.overrides
    return folder.study_folder(given.layout, place, overrides, command, force=output.force)


def study_heading(given: StudyInput) -> dict[str, str]:
    """The study in a JSON document."""
    study = given.study
    return {"name": study.name, "title": study.title, "source": study.source}
