"""A study and its store: what `rps sweep`, `rps design`, `rps report` and Python do with one."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.case.conditions import Condition
from rpscli.errors import LimitExceeded, Refused, RpsError, StudyIncomplete, UsageError
from rpscli.machine import available_cores
from rpscli.report.figures.look import Look
from rpscli.report.study.registry import REPORTS, lacking, not_judged, requirement_faults
from rpscli.report.study.report import add_notes
from rpscli.report.study.statistics import (
    summary_columns,
    summary_document,
    verdict_columns,
    verdict_document,
    verdict_lines,
)
from rpscli.report.table import Heading, Part, columns_of, csv_text
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.points.check import needs_of
from rpscli.sweep.points.layout import StudyPoints, reproduction
from rpscli.sweep.points_csv import points_csv
from rpscli.sweep.run.engines import Cluster, Threads
from rpscli.sweep.run.resume import all_keys, remember, resume
from rpscli.sweep.run.runner import Finish, Progress, run
from rpscli.sweep.statistics.summary import Summary, scale_notes, summary
from rpscli.sweep.statistics.verdicts import Verdict, judged, rate_notes
from rpscli.sweep.steps import step_notes
from rpscli.sweep.store import Store
from rpscli.sweep.study_results import StudyResults
from rpscli.sweep.table import Table, tabulate

if TYPE_CHECKING:
    from rpscli.case.study.reports import ReportRequest

BASE = "base.yaml"
FAILURES_SHOWN = 10


class StudyInterrupted(KeyboardInterrupt):
    """Somebody stopped a study; what is stored stays."""

    def __init__(self, stored: int, total: int, path: Path) -> None:
        super().__init__(
            f"interrupted: {stored} of {total} points are stored in {path}; the same command"
            " continues from there"
        )
        self.points = {"total": total, "stored": stored}


class Failure(NamedTuple):
    """A point that failed: its line in `points.csv`, why, and how to compute it alone."""

    point: int
    message: str
    command: str


@dataclass
class Collected:
    """The files of a study by name, and what its reports say.

    `notes` warn of the numbers, `findings` are lines for the terminal, `parts` and `documents`
    tables of reports for readers and for JSON, `broken` are the reports that could not be made.
    """

    files: dict[str, str | bytes] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    findings: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    parts: list[Part] = field(default_factory=list)
    documents: dict[str, Any] = field(default_factory=dict)
    broken: list[RpsError] = field(default_factory=list)


def require_results(layout: StudyPoints, conditions: Iterable[Condition]) -> None:
    """Refuse limits on results that systems do not have, and reports that cannot be drawn."""
    layout.study.document.refuse(requirement_faults(layout))
    _ = [*rate_notes(layout)]  # which refuses a hazard that the intensities do not go with
    for condition in conditions:
        if layout.plan.analysis != "timehistory":
            raise UsageError(f"--fail-on {condition.name} needs analysis: timehistory")
        if lacking(layout, condition.name, all):
            raise UsageError(f"--fail-on: {needs_of(condition.name, 'no')}")


class StudyRun:
    """A study that is computed into an open store, judged and reported on.

    `start` says what is stored already; `results` are there when `compute` is over. Without `jobs`
    all cores are used; `conditions` count besides the limits of study and case.
    """

    results: StudyResults

    def __init__(
        self,
        layout: StudyPoints,
        context: StudyContext,
        store: Store,
        *,
        jobs: int | None = None,
        scheduler: str | None = None,
        retry_failed: bool = False,
        conditions: Iterable[Condition] = (),
    ) -> None:
        self.layout, self.context, self.store = layout, context, store
        self.jobs, self.scheduler = jobs or available_cores(), scheduler
        self.conditions = tuple(conditions)
        self.keys = all_keys(layout, context)
        self.start = resume(layout, self.keys, store, retry_failed=retry_failed)

    def compute(
        self,
        report: Callable[[Progress], None] = lambda _: None,
        announce: Callable[[], None] = lambda: None,
    ) -> Finish:
        """Compute and store what is missing; a first Ctrl-C lets points end: `StudyInterrupted`."""
        remember(self.layout, self.store)
        finish = Finish(0, 0, 0.0, interrupted=False)
        if self.start.pending:
            try:
                finish = run(self.layout, self.start, self.store, self._engine(), report, announce)
            except KeyboardInterrupt:
                raise self._interrupted() from None
            if finish.interrupted:
                raise self._interrupted()
        table = tabulate(self.layout, self.store.stored(self.keys))
        self.results = StudyResults(table, self.keys, self.store, self.context, self.jobs)
        return finish

    def _engine(self) -> Cluster | Threads:
        if self.scheduler:
            return Cluster(self.scheduler, self.layout.plan)
        return Threads(self.context, self.jobs)

    def _interrupted(self) -> StudyInterrupted:
        known = self.store.outcomes()
        stored = sum(key in known for key in self.keys)
        return StudyInterrupted(stored, len(self.keys), self.store.path)

    @contextmanager
    def reopened(self) -> Iterator[StudyResults]:
        """The results with the store open no longer than it is read: others may go on in it."""
        if not self.store.path.is_file():
            raise Refused(f"{self.store.path}: no longer exists; run the study again")
        with Store(self.store.path.parent) as store:
            self.results = replace(self.results, store=store)
            yield self.results

    @property
    def table(self) -> Table:
        """Results of all points."""
        return self.results.table

    @property
    def outcomes(self) -> dict[str, int]:
        """How many points ended in which way, the commonest first."""
        return dict(Counter(self.table.outcomes.tolist()).most_common())

    @cached_property
    def summary(self) -> Summary | None:
        """Statistics of each system at each intensity; None of analyses without histories."""
        if self.layout.plan.analysis != "timehistory":
            return None
        return summary(self.table, self.results.fixed_base)

    @property
    def keys_of_rows(self) -> tuple[str, ...]:
        """That tell apart the rows of statistics and verdicts."""
        return self.summary.keys if self.summary else ()

    @cached_property
    def verdicts(self) -> list[Verdict]:
        """On every limit of each system at each intensity."""
        return judged(self.table, self.summary, self.conditions) if self.summary else []

    def collect(self, place: Path, look: Look) -> Collected:
        """All files for a folder. A report that fails does not take the others with it."""
        found = Collected({"points.csv": "".join(points_csv(self.table))})
        found.failures += self._failures(place, found)
        if found.failures:
            found.files["failed.csv"] = csv_text(
                columns_of(dict.fromkeys(Failure._fields, "-"), found.failures)
            )
        if self.summary is not None:
            found.files["statistics.csv"] = csv_text(summary_columns(self.summary))
            if self.verdicts:
                columns = verdict_columns(self.summary.keys, self.verdicts)
                found.files["verdicts.csv"] = csv_text(columns)
            unjudged = not_judged(self.layout, self.conditions)
            notes = [*self.summary.notes, *scale_notes(self.table), *unjudged]
            notes += rate_notes(self.layout)
            found.notes += [f"statistics: {note}" for note in notes]
            found.notes += step_notes(self.table, self.context)
        for request in self.layout.study.reports:
            try:
                self._report(request, look, found)
            except RpsError as error:
                found.broken.append(error)
            except Exception as error:  # noqa: BLE001 -- the points and the others must not be lost
                text = f"the report {request.stem}: {type(error).__name__}: {error}"
                own = request.kind in REPORTS
                whose = "rps: please report it" if own else "the package that adds it"
                found.broken.append(RpsError(f"{text}; this is a fault of {whose}"))
        return found

    def _report(self, request: ReportRequest, look: Look, found: Collected) -> None:
        made = REPORTS[request.kind].make(self.results, request.options)
        title = request.options.title or self.layout.study.title
        found.files |= dict(made.files(request.stem, title, look))
        add_notes(found.notes, request.stem, made.notes)
        if lines := list(made.findings):
            found.findings[request.stem] = lines
        if document := made.document():
            found.documents[request.stem] = document
            found.parts += [Heading(request.stem), *made.parts()]

    def _failures(self, place: Path, found: Collected) -> Iterator[Failure]:
        base = self.layout.study.base_file
        if base is None and self.table.messages:
            # JSON is YAML too.
            found.files[BASE] = json.dumps(self.layout.plan.base, indent=2) + "\n"
            base = place / BASE
        for number, message in self.table.messages.items():
            point = self.layout[number]
            command = reproduction(self.layout, self.context, point, base or Path())
            yield Failure(number + 1, message, command)

    def error(self, found: Collected, *, limits: bool = True) -> RpsError | None:
        """The gravest of what went wrong, whose exit code counts; its text tells of all."""
        errors: list[RpsError] = [*found.broken]
        if failures := found.failures:
            lines = [f"{len(failures)} of {len(self.table)} points failed; they enter no statistic"]
            for failure in failures[:FAILURES_SHOWN]:
                lines += [f"point {failure.point}: {failure.message}", f"  {failure.command}"]
            lines += _and_more(failures, "failed.csv")
            errors.append(StudyIncomplete("\n".join(lines)))
        if limits and (lines := verdict_lines(self.keys_of_rows, self.verdicts)):
            told = [*lines[:FAILURES_SHOWN], *_and_more(lines, "verdicts.csv")]
            errors.append(LimitExceeded("\n".join(told)))
        return type(errors[0])("\n".join(map(str, errors))) if errors else None

    def documents(self) -> dict[str, Any]:
        """Statistics and verdicts in JSON; nothing of analyses without histories."""
        if self.summary is None:
            return {}
        return {
            "pooled": self.summary.pooled,
            "statistics": summary_document(self.summary),
            "verdicts": [verdict_document(self.summary.keys, each) for each in self.verdicts],
        }


def _and_more(items: list[Any], file: str) -> list[str]:
    more = len(items) - FAILURES_SHOWN
    return [f"... and {more} more, all in {file}"] if more > 0 else []
