"""Files of a study that was run, by name, and what its reports say."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.case.conditions import Condition
from rpscli.errors import RpsError
from rpscli.report.figures.look import Look
from rpscli.report.files import Content
from rpscli.report.study.registry import REPORTS, not_judged
from rpscli.report.study.report import add_notes
from rpscli.report.study.statistics import summary_columns, verdict_columns
from rpscli.report.table import Heading, Part, columns_of, csv_text
from rpscli.sweep.points import StudyPoints, reproduction
from rpscli.sweep.statistics.summary import Summary, scale_notes, step_notes
from rpscli.sweep.statistics.verdicts import Verdict, rate_notes
from rpscli.sweep.table import PointTable, StoredPoints

if TYPE_CHECKING:
    from rpscli.case.study.reports import ReportRequest

BASE = "base.yaml"


class Failure(NamedTuple):
    """A point that failed: its line in `points.csv`, why, and how to compute it alone."""

    point: int
    message: str
    command: str


@dataclass
class Collected:
    """The files of a study by name, and what its reports say.

    `notes` warn of the numbers, `parts` and `documents` are tables of reports for readers
    and for JSON, `broken` are the reports that could not be made.
    """

    files: dict[str, str | Content] = field(default_factory=dict)
    failures: list[Failure] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    documents: dict[str, Any] = field(default_factory=dict)
    broken: list[RpsError] = field(default_factory=list)

    def add_failures(
        self, layout: StudyPoints, messages: Mapping[int, str], folder: Path
    ) -> None:
        """Failed points with commands, for which a base without a file gets one in a
        folder.
        """
        base = layout.study.base_file
        if base is None and messages:
            # JSON is YAML too.
            self.files[BASE] = json.dumps(layout.plan.base, indent=2) + "\n"
            base = folder / BASE
        for number, message in messages.items():
            command = reproduction(layout, layout[number], base or Path())
            self.failures.append(Failure(number + 1, message, command))
        if self.failures:
            heads = ", ".join(Failure._fields)
            self.files["failed.csv"] = csv_text(columns_of(heads, self.failures))

    def add_statistics(
        self,
        table: PointTable,
        summary: Summary,
        judgements: Sequence[Verdict],
        conditions: Iterable[Condition],
    ) -> None:
        """Statistics and verdicts, and notes on what of the points they leave out."""
        layout = table.layout
        self.files["statistics.csv"] = csv_text(summary_columns(summary))
        if judgements:
            columns = verdict_columns(summary.keys, judgements)
            self.files["verdicts.csv"] = csv_text(columns)
        unjudged = not_judged(layout, conditions)
        notes = [*summary.notes, *scale_notes(table), *unjudged, *rate_notes(layout)]
        self.notes += [f"statistics: {note}" for note in notes]
        self.notes += step_notes(table)

    def add_report(
        self,
        stem: str,
        request: ReportRequest,
        results: StoredPoints,
        title: str,
        look: Look,
    ) -> None:
        """A report under the names of its files; its fault, if it cannot be made."""
        try:
            made = REPORTS[request.kind].make(results, request.options)
            asked = request.options
            files = made.files(stem, asked.title or title, look, asked.formats)
            self.files |= dict(files)
            add_notes(self.notes, stem, made.notes)
            if document := made.document():
                self.documents[stem] = document
                self.parts += [Heading(stem), *made.parts()]
        except RpsError as error:
            self.broken.append(error)
        except Exception as error:  # noqa: BLE001 -- the others must not be lost
            text = f"the report {stem}: {type(error).__name__}: {error}"
            own = request.kind in REPORTS
            whose = "rps: please report it" if own else "the package that adds it"
            self.broken.append(RpsError(f"{text}; this is a fault of {whose}"))
