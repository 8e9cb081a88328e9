"""Which reports a study asks for, and what the study file must know of each kind."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, get_args

from rpscli.case.schema.check import schema_check
from rpscli.case.schema.fields import Section, Text
from rpscli.case.study.axes import Axis
from rpscli.case.study.schema import Analysis, AnyKeys
from rpscli.case.text.document import Document, Fault, Path, dotted, shown
from rpscli.errors import hint, listed

_VARIED = "varied keys"
VariedKeys = Annotated[AnyKeys, _VARIED]
"""Keys under `vary`, or record and scale: one, several, or none to pool all that differs."""
VariedKey = Annotated[Text, _VARIED]
"""One of them."""


def varied_keys(options: Section, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Varied keys that options name, whatever the options are called, and where they stand."""
    for name, field in type(options).model_fields.items():
        value = getattr(options, name)
        if isinstance(value, Section):
            yield from varied_keys(value, (*path, name))
        elif value is not None and (_VARIED in field.metadata or _is_varied(field.annotation)):
            for key in (value,) if isinstance(value, str) else value:
                yield (*path, name), key


def _is_varied(annotation: Any) -> bool:
    parts = get_args(annotation)
    return _VARIED in getattr(annotation, "__metadata__", ()) or any(map(_is_varied, parts))


class ReportOptions(Section):
    """Options that every report has."""

    name: Text | None = None
    """stem of its files; the report's kind by default"""
    title: Text | None = None
    """heading of the figure; the study's by default"""


@dataclass(frozen=True)
class ReportRequest:
    """One report."""

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
    requests: list[ReportRequest] = []
    faults: list[Fault] = []
    for index, item in enumerate(written if isinstance(written, list) else ()):
        path: Path = ("reports", index)
        if isinstance(item, str):
            kind, given = item, None
        elif isinstance(item, dict) and len(item) == 1:
            ((kind, given),) = item.items()
            path = (*path, kind)
        else:
            continue  # told with the other keys
        if kind not in kinds:
            suggestion = hint(kind, kinds, f"known are {listed(kinds, 'and')}")
            text = f"reports.{index}: there is no report {shown(kind)}; {suggestion}"
            faults.append(Fault(path, text))
            continue
        if given is not None and not isinstance(given, dict):
            text = f"{dotted(path)} = {shown(given)} must be a mapping of options"
            faults.append(Fault(path, text))
            continue
        part = document.part(*path) if given else Document(document.name, {})
        check = schema_check(kinds[kind].options, part)
        faults += (
            Fault((*path, *fault.path), f"{dotted(path)}.{fault.text}", fault.at_key)
            for fault in check.faults
        )
        if check.read is not None:
            taken = {*OF_THE_STUDY, *(request.stem for request in requests)}
            stem = _stem(check.read.name or kind, taken)
            requests.append(ReportRequest(kind, stem, check.read, ("reports", index)))
    return tuple(requests), faults


def _stem(wanted: str, taken: set[str]) -> str:
    """`lines`, `lines_2`, `lines_3`: every report has files of its own."""
    numbers = (f"{wanted}_{number}" for number in range(2, len(taken) + 3))
    return wanted if wanted not in taken else next(n for n in numbers if n not in taken)
