"""What a finished study leaves behind: points, failures and reports."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.commands.sweep.input import StudyInput
from rpscli.commands.sweep.tables import verdict_lines
from rpscli.errors import LimitExceeded, RpsError, StudyIncomplete
from rpscli.report.files.csv_text import Column, csv_text
from rpscli.report.files.output_folder import OutputFolder

if TYPE_CHECKING:
    from rpscli.case.conditions import Condition
    from rpscli.case.study.reports import ReportRequest
    from rpscli.sweep.statistics.summary import Summary
    from rpscli.sweep.statistics.verdicts import StudyVerdict
    from rpscli.sweep.study_results import StudyResults
    from rpscli.sweep.table import Table

BASE = "base.yaml"
FAILURES_SHOWN = 10


@dataclass(frozen=True)
class Failure:
    """A point that failed: its line in `points.csv`, why, and how to compute it alone."""

    point: int
    message: str
    command: str


class Collected(NamedTuple):
    """What a study found besides its points.

    `summary` is None for analyses without histories; `notes` are what is unusual about the systems,
    and what statistics and reports have to say about their numbers; `broken` are the reports that
    could not be made.
    """

    failures: list[Failure]
    summary: Summary | None
    verdicts: list[StudyVerdict]
    notes: list[str]
    findings: dict[str, list[tuple[str, str]]]
    broken: list[RpsError]


def collect(
    given: StudyInput, results: StudyResults, conditions: Sequence[Condition], folder: OutputFolder
) -> Collected:
    """Add all files to the folder. A report that fails does not take the others with it."""
    from rpscli.sweep.points_csv import points_csv

    folder.add("points.csv", "".join(points_csv(results.table)))
    failures = list(_failures(given, results.table, folder))
    if failures:
        folder.add("failed.csv", csv_text(_failure_columns(failures)))
    found = Collected(failures, None, [], given.doubts, {}, [])
    if given.layout.plan.analysis == "timehistory":
        found = _with_statistics(found, results, conditions, folder)
    for request in given.study.reports:
        try:
            _report(given, results, request, folder, found)
        except RpsError as error:
            found.broken.append(error)
        except Exception as error:  # noqa: BLE001 -- the points and the others must not be lost
            text = f"the report {request.stem}: {type(error).__name__}: {error}"
            found.broken.append(RpsError(f"{text}; this is a fault of rps: please report it"))
    return found


def _with_statistics(
    found: Collected, results: StudyResults, conditions: Sequence[Condition], folder: OutputFolder
) -> Collected:
    from rpscli.report.study.statistics import summary_columns, verdict_columns
    from rpscli.sweep.statistics.scales import scale_notes
    from rpscli.sweep.statistics.summary import summary
    from rpscli.sweep.statistics.verdicts import judged

    made = summary(results.table, results.fixed_base)
    verdicts = judged(results.table, made, conditions)
    folder.add("statistics.csv", csv_text(summary_columns(made)))
    if verdicts:
        folder.add("verdicts.csv", csv_text(verdict_columns(made.keys, verdicts)))
    notes = [f"statistics: {note}" for note in (*made.notes, *scale_notes(results.table))]
    return found._replace(summary=made, verdicts=verdicts, notes=[*found.notes, *notes])


def _report(
    given: StudyInput,
    results: StudyResults,
    request: ReportRequest,
    folder: OutputFolder,
    found: Collected,
) -> None:
    """Add the files of a report, and what it has to say about its numbers."""
    from rpscli.report.study.registry import REPORTS
    from rpscli.report.study.report import add_notes

    report = REPORTS[request.kind]
    numbers = report.numbers(results, request.options)
    title = request.options.title or given.study.title
    for name, content in list(report.files(numbers, request.stem, title, given.look)):
        folder.add(name, content)
    add_notes(found.notes, request.stem, report.notes(numbers))
    if lines := list(report.findings(numbers)):
        found.findings[request.stem] = lines


def _failures(given: StudyInput, table: Table, folder: OutputFolder) -> Iterator[Failure]:
    from rpscli.sweep.points.described import reproduction

    base = given.study.base_file
    if base is None and table.messages:
        # JSON is YAML too.
        folder.add(BASE, json.dumps(given.layout.plan.base, indent=2) + "\n")
        base = folder.folder / BASE
    for number, message in table.messages.items():
        line = reproduction(given.layout, given.context, given.layout[number], base or Path())
        yield Failure(number + 1, message, line)


def _failure_columns(failures: list[Failure]) -> list[Column]:
    from rpscli.report.files.csv_text import quoted

    return [
        Column("point", "-", [failure.point for failure in failures]),
        Column("message", "-", [quoted(failure.message) for failure in failures]),
        Column("command", "-", [quoted(failure.command) for failure in failures]),
    ]


def outcome_counts(table: Table) -> dict[str, Any]:
    """How many points ended in which way, the commonest first."""
    return dict(Counter(table.outcomes.tolist()).most_common())


def first_error(found: Collected, total: int) -> RpsError | None:
    """The gravest of what went wrong, whose exit code counts; its text tells of all."""
    exceeded = verdict_lines(found.summary.keys, found.verdicts) if found.summary else []
    lines = [f"limit exceeded: {line}" for line in exceeded[:FAILURES_SHOWN]]
    if len(exceeded) > FAILURES_SHOWN:
        lines.append(f"... and {len(exceeded) - FAILURES_SHOWN} more, all in verdicts.csv")
    limits = LimitExceeded("\n".join(lines)) if lines else None
    all_errors = [*found.broken, _incomplete(found.failures, total), limits]
    errors = [error for error in all_errors if error is not None]
    if not errors:
        return None
    return type(errors[0])("\n".join(map(str, errors)))


def _incomplete(failures: list[Failure], total: int) -> StudyIncomplete | None:
    if not failures:
        return None
    lines = [f"{len(failures)} of {total} points failed; they enter no statistic"]
    for failure in failures[:FAILURES_SHOWN]:
        lines += [f"point {failure.point}: {failure.message}", f"  {failure.command}"]
    if len(failures) > FAILURES_SHOWN:
        lines.append(f"... and {len(failures) - FAILURES_SHOWN} more, all in failed.csv")
    return StudyIncomplete("\n".join(lines))
