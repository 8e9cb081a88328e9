"""What a study file says about a report, and what it must know of each kind."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from pydantic import Field

from rpscli.case.schema.fields import Text
from rpscli.case.schema.section import Section
from rpscli.case.study.axes import Axis
from rpscli.case.study.schema import Analysis
from rpscli.case.text.document import Document
from rpscli.case.text.faults import Fault, Path


class ReportOptions(Section):
    """Options that every report has."""

    name: Text | None = Field(None, description="stem of its files; the report's kind by default")
    title: Text | None = Field(None, description="heading of the figure; the study's by default")


@dataclass(frozen=True)
class ReportRequest:
    """One report.

    Parameters
    ----------
    kind
        Its name among the kinds.
    stem
        Name of its files without suffix, one of a kind within a study.
    options
        What the study says about it.
    path
        Where it stands in the study.
    """

    kind: str
    stem: str
    options: ReportOptions
    path: Path


Check = Callable[[Document, Sequence[Axis], ReportRequest], Iterable[Fault]]
"""Faults of a request in a study with these axes."""


class ReportKind(Protocol):
    """What the study file must know of a kind of report."""

    @property
    def options(self) -> type[ReportOptions]:
        """What may be said about it."""

    @property
    def analyses(self) -> Collection[Analysis]:
        """Analyses whose results it shows."""

    @property
    def check(self) -> Check:
        """Rules that join its options with the rest of the study."""


ReportKinds = Mapping[str, ReportKind]
"""The kinds by name."""
