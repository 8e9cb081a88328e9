"""What a finished study leaves behind: points, failures and reports."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.commands.sweep.input import StudyInput
from rpscli.report.files.csv_text import Column, csv_text
from rpscli.report.files.output_folder import OutputFolder

if TYPE_CHECKING:
    from rpscli.sweep.reports.study_results import StudyResults
    from rpscli.sweep.table import Table

BASE = "base.yaml"


@dataclass(frozen=True)
class Failure:
    """A point that failed: its line in `points.csv`, why, and how to compute it alone."""

    point: int
    message: str
    command: str


class Collected(NamedTuple):
    """Points that failed, and what reports have to say about their numbers."""

    failures: list[Failure]
    notes: list[str]


def collect(given: StudyInput, results: StudyResults, folder: OutputFolder) -> Collected:
    """Add all files to the folder.

    Raises
    ------
    CaseError
        If a report cannot be had from this study.
    """
    from rpscli.report.study.registry import REPORTS  # noqa: PLC0415 -- numpy is slow
    from rpscli.sweep.points_csv import points_csv  # noqa: PLC0415

    folder.add("points.csv", "".join(points_csv(results.table)))
    failures = list(_failures(given, results.table, folder))
    if failures:
        folder.add("failed.csv", csv_text(_failure_columns(failures)))
    notes: list[str] = []
    for request in given.study.reports:
        report = REPORTS[request.kind]
        numbers = report.numbers(results, request.options)
        notes += [f"{request.stem}: {note}" for note in report.notes(numbers)]
        title = request.options.title or given.study.title
        for name, content in report.files(numbers, request.stem, title):
            folder.add(name, content)
    return Collected(failures, notes)


def _failures(given: StudyInput, table: Table, folder: OutputFolder) -> Iterator[Failure]:
    from rpscli.sweep.design.described import reproduction  # noqa: PLC0415

    base = given.study.base_file
    if base is None and table.messages:
        # JSON is YAML too.
        folder.add(BASE, json.dumps(given.design.plan.base, indent=2) + "\n")
        base = folder.folder / BASE
    for number, message in table.messages.items():
        line = reproduction(given.design, given.context, given.design[number], base or Path())
        yield Failure(number + 1, message, line)


def _failure_columns(failures: list[Failure]) -> list[Column]:
    from rpscli.report.study.labels import quoted  # noqa: PLC0415

    return [
        Column("point", "-", [failure.point for failure in failures]),
        Column("message", "-", [quoted(failure.message) for failure in failures]),
        Column("command", "-", [quoted(failure.command) for failure in failures]),
    ]


def outcome_counts(table: Table) -> dict[str, Any]:
    """How many points ended in which way, the commonest first."""
    return dict(Counter(table.outcomes.tolist()).most_common())
