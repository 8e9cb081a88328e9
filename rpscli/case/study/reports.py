"""Which reports a study asks for, and what the study file must know of each kind."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from pydantic import Field

from rpscli.case.schema.check import schema_check
from rpscli.case.schema.fields import Section, Text
from rpscli.case.study.axes import Axis
from rpscli.case.study.schema import Analysis
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import hint, listed


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


OF_THE_STUDY = ("points", "failed", "statistics", "verdicts")
"""Stems of files that every study leaves."""


def requests_of(
    document: Document, kinds: ReportKinds
) -> tuple[tuple[ReportRequest, ...], list[Fault]]:
    """Reports under the key `reports`, and what is wrong with them."""
    written = document.content.get("reports", [])
    if not isinstance(written, list):
        text = f"reports = {shown(written)} must be a list, as in [overturning, fragility]"
        return (), [Fault(("reports",), text)]
    requests: list[ReportRequest] = []
    faults: list[Fault] = []
    for index, item in enumerate(written):
        path: Path = ("reports", index)
        found = list(_faults(document, path, item, kinds))
        faults += found
        if not found:
            kind = item if isinstance(item, str) else next(iter(item))
            given = {} if isinstance(item, str) else item[kind] or {}
            options = kinds[kind].options.model_validate(given)
            taken = {*OF_THE_STUDY, *(request.stem for request in requests)}
            stem = _stem(options.name or kind, taken)
            requests.append(ReportRequest(kind, stem, options, path))
    return tuple(requests), faults


def _faults(document: Document, path: Path, item: object, kinds: ReportKinds) -> Iterator[Fault]:
    if isinstance(item, dict) and len(item) == 1:
        (kind, given), options_path = next(iter(item.items())), (*path, *item)
    elif isinstance(item, str):
        kind, given, options_path = item, None, path
    else:
        text = f"{dotted(path)} = {shown(item)} must be a name, or one `name: {{option: value}}`"
        yield Fault(path, text)
        return
    if kind not in kinds:
        meant = hint(kind, kinds, f"known are {listed(kinds, 'and')}")
        yield Fault(options_path, f"{dotted(path)}: there is no report {shown(kind)}; {meant}")
    elif isinstance(given, dict):
        for fault in schema_check(kinds[kind].options, document.part(*options_path)).faults:
            text = f"{dotted(options_path)}.{fault.text}"
            yield Fault((*options_path, *fault.path), text, fault.at_key)
    elif given is None:
        for fault in schema_check(kinds[kind].options, Document(document.name, {})).faults:
            yield Fault(options_path, f"{dotted(options_path)}.{fault.text}")
    else:
        text = f"{dotted(options_path)} = {shown(given)} must be a mapping of options"
        yield Fault(options_path, text)


def _stem(wanted: str, taken: set[str]) -> str:
    """`lines`, `lines_2`, `lines_3`: every report has files of its own."""
    numbers = (f"{wanted}_{number}" for number in range(2, len(taken) + 3))
    return wanted if wanted not in taken else next(n for n in numbers if n not in taken)
