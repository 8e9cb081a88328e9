"""What `rps sweep`, `rps design` and `rps report` share: a study is read, tried and computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from rpscli.case.conditions import Condition
from rpscli.commands.shell import waiting
from rpscli.commands.shell.options import CaseRequest
from rpscli.commands.shell.terminal import INTERRUPTED, Terminal
from rpscli.errors import Refused, UsageError
from rpscli.report.documents import failure_document, heading
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.studies import Study, StudyResult
    from rpscli.sweep.points import StudyPoints
    from rpscli.sweep.run import Progress, Start
    from rpscli.sweep.store import Store

POINTS_SHOWN = 3
"""At each end of a study."""
GUESSED_POINT_SECONDS = 0.01
"""Where trying would mean compiling first: some 40 s of motion of a few storeys."""


@dataclass(frozen=True)
class SweepChoices:
    """How a study is run."""

    jobs: int | None = None
    scheduler: str | None = None
    dry_run: bool = False
    fresh: bool = False
    retry_failed: bool = False
    report_only: bool = False

    def __post_init__(self) -> None:
        if self.report_only and (self.fresh or self.retry_failed or self.scheduler):
            raise UsageError(
                "--report-only computes no points; remove --fresh, --retry-failed and --scheduler"
            )
        if self.scheduler and self.jobs:
            raise UsageError("--jobs counts threads of this machine; --scheduler has its own")


def read(request: CaseRequest, conditions: Iterable[Condition], terminal: Terminal) -> Study:
    """Read and check a study and all its systems."""
    from rpscli.studies import load_study
    from rpscli.sweep.systems import balance_note

    examined = partial(waiting.watched, "systems examined", terminal)
    study = load_study(request.source, request.overrides, conditions=conditions, watched=examined)
    if (section := study.layout.study.file.sample) and (note := balance_note(section)):
        terminal.warn([note])
    return study


def computed(
    command: str, study: Study, store: Store, choices: SweepChoices, terminal: Terminal
) -> StudyResult:
    """A study whose points are in a store; what goes on is said, and an interruption ends it."""
    from rpscli.studies import StudyInterrupted, run_in

    layout = study.layout

    @contextmanager
    def watch(begin: Start) -> Iterator[Callable[[Progress], None]]:
        for note in begin.notes if command != "design" else ():  # which is many studies
            terminal.note(note)
        pending, total = len(begin.pending), len(begin.keys)
        if choices.report_only and pending:
            raise Refused(
                f"{store.path} lacks {pending} of {total} points; run the study without"
                " --report-only first"
            )
        if pending and begin.kept:
            terminal.note(f"continuing: {begin.kept} of {total} points are stored already")
        if pending and layout.plan.analysis == "timehistory" and not choices.scheduler:
            waiting.announce_compilation(terminal)
        with waiting.progress_report(terminal, begin.kept, begin.kept + pending) as report:
            yield report

    def announce() -> None:
        terminal.note("\nstopping after the points under way; Ctrl-C again stops at once")

    how: dict[str, Any] = {"jobs": choices.jobs, "scheduler": choices.scheduler}
    try:
        result = run_in(store, study, watch, announce, retry_failed=choices.retry_failed, **how)
    except StudyInterrupted as interruption:
        text = str(interruption)
        terminal.note(text)
        document = {
            **heading(command),
            "study": study_heading(layout),
            "points": interruption.points,
            **failure_document("Interrupted", text, INTERRUPTED),
        }
        terminal.result(document)
        raise click.exceptions.Exit(INTERRUPTED) from None
    if count := result.done.computed:
        seconds = result.done.seconds
        rate = count / seconds if seconds else 0.0
        terminal.note(
            f"computed {count} points in {waiting.duration(seconds)}, {rate:.3g} points/s"
        )
    return result


def study_heading(layout: StudyPoints) -> dict[str, str]:
    """The study in a JSON document."""
    study = layout.study
    own = {"name": study.name, "title": study.title, "source": study.source}
    return {**own, "scaled_to": layout.scaled_to}


def show_dry_run(study: Study, choices: SweepChoices, terminal: Terminal) -> None:
    """Count, first and last points, and an estimate of the time."""
    from rpscli.analyses.kernels.compilation import is_ready
    from rpscli.machine import available_cores
    from rpscli.physics.state import LANES
    from rpscli.sweep.run import estimated_seconds

    terminal.warn(study.warnings)  # first: trying points may take long where the case is at fault
    layout, count = study.layout, len(study)
    jobs, histories = choices.jobs or available_cores(), layout.plan.analysis == "timehistory"
    points: dict[int, dict[str, Any]] = {}
    for number in sorted({*range(count)[:POINTS_SHOWN], *range(count)[-POINTS_SHOWN:]}):
        point = layout[number]
        points[number + 1] = layout.described(number)
        if histories and layout.plan.measure is None:  # no measure decides about the factor
            points[number + 1]["scale"] = point.scale * point.scale_change
    listed = [{"point": number, **varied} for number, varied in points.items()]
    ways = 2 if any(record and record.is_pair for record in layout.records) else 1
    if histories and not is_ready(ways, LANES):
        seconds = GUESSED_POINT_SECONDS * count / jobs
        source = "a guess, since the kernel is not compiled yet"
    else:
        with waiting.passing_time("trying some of the points", terminal):
            seconds = estimated_seconds(layout, jobs)
        source = "trying some of the points"
    document: dict[str, Any] = {
        **heading("sweep"),
        "study": study_heading(layout),
        "dry_run": True,
        "analysis": layout.plan.analysis,
        "points": count,
        "systems": len(layout.properties),
        "records": len(layout.records),
        "scales": len(layout.scales),
        "members": len(layout.members),
        "first_points": listed[:POINTS_SHOWN],
        "last_points": listed[-POINTS_SHOWN:],
        "estimate": {"seconds": seconds, "jobs": jobs, "source": source},
        "warnings": study.warnings,
    }
    terminal.result(document, _dry_run_tables(document, points.items()))


def _dry_run_tables(
    document: dict[str, Any], points: Iterable[tuple[int, dict[str, Any]]]
) -> Iterator[Part]:
    from rpscli.report.study.labels import label

    yield Heading(document["study"]["title"])
    names = ("points", "systems", "records", "scales", "members")
    expected = document["estimate"]
    text = f"about {waiting.duration(expected['seconds'])} on {expected['jobs']} cores"
    counts = [(name, str(document[name])) for name in names]
    yield Table.listing([*counts, ("time", f"{text}, by {expected['source']}")])
    yield Table.listing(
        [
            (f"point {number}", ", ".join(label(key, value) for key, value in varied.items()))
            for number, varied in points
        ]
    )
