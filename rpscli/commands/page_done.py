"""A page of `rps report` that is computed, and what each of them says."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from rpscli.case.case import Case
from rpscli.case.schema.case_file import DocumentSection
from rpscli.errors import RpsError
from rpscli.report.page import ReportSection


class PageDone(NamedTuple):
    """A page's title and sections, what was found for JSON, its
    error, and who answers for it.
    """

    title: str
    subtitle: str
    sections: Sequence[ReportSection]
    document: dict[str, Any]
    error: RpsError | None
    signed: DocumentSection


def ends(case: Case) -> str:
    """The kind of compliant ends, to follow in a heading."""
    kind = case.structure.contact.kind
    return "" if kind == "rigid" else f", {kind} contact"
