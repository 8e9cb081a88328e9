"""A report of a study as one object: what may be asked, its numbers, tables and figure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Generic, TypeVar

from rpscli.case.study.reports import Check, ReportOptions
from rpscli.case.study.schema import Analysis
from rpscli.report.figures.look import USUAL, Look, figure_files
from rpscli.report.figures.style import Target, kept_figure
from rpscli.report.table import Column, csv_text
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.study_results import StudyResults

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Options = TypeVar("Options", bound=ReportOptions)
Numbers = TypeVar("Numbers")


@dataclass(frozen=True)
class Report(Generic[Options, Numbers]):
    """One kind of report.

    Parameters
    ----------
    options
        What a study may say about it.
    numbers
        What it computes; it takes from the results what it needs.
    tables
        Columns of each CSV file, by what follows the report's name in the file's.
    figure
        The file of its figure under a title.
    texts
        Further files, by what follows the report's name in the file's.
    drawable
        Whether there is anything to draw.
    notes
        What the user should know about the numbers.
    findings
        Its main numbers in lines, a name and a sentence each, for the terminal.
    check
        Rules that join the options with the rest of the study; seen before anything is computed.
    results
        Names of results that every system must have.
    requires
        What is wrong with the points of a study that it cannot show, in words; seen before anything
        is computed.
    analyses
        Analyses whose results it shows.
    """

    options: type[Options]
    numbers: Callable[[StudyResults, Options], Numbers]
    tables: Mapping[str, Callable[[Numbers], list[Column]]]
    figure: Callable[[Numbers, str], bytes]
    texts: Callable[[Numbers], Mapping[str, str]] = lambda _: {}
    drawable: Callable[[Numbers], bool] = lambda _: True
    notes: Callable[[Numbers], Iterable[str]] = lambda _: ()
    findings: Callable[[Numbers], Iterable[tuple[str, str]]] = lambda _: ()
    check: Check = lambda *_: ()
    results: Callable[[Options], Iterable[str]] = lambda _: ()
    requires: Callable[[StudyPoints, Options], Iterable[str]] = lambda *_: ()
    analyses: tuple[Analysis, ...] = ("timehistory",)

    def drawn(self, numbers: Numbers, title: str, target: Target | Axes | None = None) -> Target:
        """Its figure, which is no file yet; drawn into the target if there is one."""
        return kept_figure(partial(self.figure, numbers, title), target)

    def files(
        self, numbers: Numbers, stem: str, title: str, look: Look = USUAL
    ) -> Iterator[tuple[str, str | bytes]]:
        """Names and contents of its files."""
        for suffix, columns in self.tables.items():
            yield f"{stem}{suffix}.csv", csv_text(columns(numbers))
        for suffix, text in self.texts(numbers).items():
            yield f"{stem}{suffix}", text
        if self.drawable(numbers):
            yield from figure_files({stem: partial(self.figure, numbers, title)}, look).items()


def add_notes(notes: list[str], name: str, found: Iterable[str]) -> None:
    """Notes under the name of their report; what another report has said is not said again.

    >>> notes = ["fragility: the data are separated"]
    >>> add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    >>> notes
    ['fragility: the data are separated', 'risk: the hazard curve is continued']
    """
    told = {note.partition(": ")[2] for note in notes}
    notes += [f"{name}: {note}" for note in found if note not in told]
