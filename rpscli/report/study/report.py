"""A report of a study: what may be asked, and what it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Annotated, Generic, Literal, TypeVar

from rpscli.analyses.result_quantities import DEMANDS
from rpscli.case.schema.fields import Quantity
from rpscli.case.study.reports import Check, ReportOptions
from rpscli.case.study.schema import Analysis
from rpscli.report.figures.look import USUAL, Look, figure_files
from rpscli.report.figures.style import Target, kept_figure
from rpscli.report.table import Column, csv_text
from rpscli.sweep.points.layout import StudyPoints
from rpscli.sweep.study_results import StudyResults

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    DemandName = str
else:
    DemandName = Literal[tuple(quantity.name for quantity in DEMANDS)]

Statistic = Annotated[
    float | Literal["mean", "median", "largest"],
    Quantity(symbol="a fractile", above=0, below=1, words=("mean", "median", "largest")),
]
"""What stands for several histories."""

Options = TypeVar("Options", bound=ReportOptions)
Tables = Mapping[str, list[Column]]
"""Columns of each CSV file, by what follows the report's name in the file's."""


@dataclass(frozen=True)
class Found:
    """What a report found.

    `figure` makes the file of its figure under a title; None where nothing can be drawn. `notes`
    are what the user should know about the numbers, `findings` the main ones in lines for the
    terminal, `texts` further files, by what follows the report's name in the file's.
    """

    tables: Tables
    figure: Callable[[str], bytes] | None
    notes: Sequence[str] = ()
    findings: Sequence[tuple[str, str]] = ()
    texts: Mapping[str, str] = field(default_factory=dict)

    def drawn(self, title: str, target: Target | Axes | None = None) -> Target:
        """Its figure, which is no file yet; drawn into the target if there is one."""
        assert self.figure is not None, "asked before"
        return kept_figure(partial(self.figure, title), target)

    def files(self, stem: str, title: str, look: Look = USUAL) -> Iterator[tuple[str, str | bytes]]:
        """Names and contents of its files."""
        for suffix, columns in self.tables.items():
            yield f"{stem}{suffix}.csv", csv_text(columns)
        for suffix, text in self.texts.items():
            yield f"{stem}{suffix}", text
        if self.figure is not None:
            yield from figure_files({stem: partial(self.figure, title)}, look).items()


@dataclass(frozen=True)
class Report(Generic[Options]):
    """One kind of report: what a study may say about it, and how it is made.

    `check` holds rules that join the options with the rest of the study, `results` names results
    that every system must have, and `requires` tells what is wrong with the points of a study that
    it cannot show; all are seen before anything is computed.
    """

    options: type[Options]
    make: Callable[[StudyResults, Options], Found]
    check: Check = lambda *_: ()
    results: Callable[[Options], Iterable[str]] = lambda _: ()
    requires: Callable[[StudyPoints, Options], Iterable[str]] = lambda *_: ()
    analyses: tuple[Analysis, ...] = ("timehistory",)


def add_notes(notes: list[str], name: str, found: Iterable[str]) -> None:
    """Notes under the name of their report; what another report has said is not said again.

    >>> notes = ["fragility: the data are separated"]
    >>> add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    >>> notes
    ['fragility: the data are separated', 'risk: the hazard curve is continued']
    """
    told = {note.partition(": ")[2] for note in notes}
    notes += [f"{name}: {note}" for note in found if note not in told]
