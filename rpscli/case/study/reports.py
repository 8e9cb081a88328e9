"""Reports that a study asks for, and what the study file must know of each kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Annotated, Any, Generic, Literal, TypeVar

from pydantic import AfterValidator, Field, create_model

from rpscli.case.schema.fields import OneOf, Section, Several, Text, refuse
from rpscli.case.schema.keys import inside
from rpscli.case.study.schema import A_LIST, Analysis, AnyKeys, Axis, StudyFile
from rpscli.case.text.document import Document, Fault, Path
from rpscli.registry import Registry

_VARIED = "varied keys"
VariedKeys = Annotated[AnyKeys, _VARIED]
"""Keys under `vary`, or record and scale: one, several, or none
to pool all that differs."""
VariedKey = Annotated[Text, _VARIED]
"""One of them."""


def varied_keys(options: Section, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Varied keys that options name, whatever the options are
    called, and where they stand.
    """
    for name, key_field in type(options).model_fields.items():
        value = getattr(options, name)
        if isinstance(value, Section):
            yield from varied_keys(value, (*path, name))
        elif value is not None and _VARIED in inside(key_field):
            for key in (value,) if isinstance(value, str) else value:
                yield (*path, name), key


def _file_name(text: str) -> str:
    fits = text.isprintable() and text[0] not in ". " and len(text.encode()) <= 100
    if not fits or {*text} & {*'/\\:*?"<>|'}:
        refuse(
            'must be the name of a file: at most 100 bytes, no / \\ : * ? " < > | or line end in it'
            " and no dot or space first"
        )
    return text


FileName = Annotated[Text, AfterValidator(_file_name)]
"""Name of a file in the folder of results, without its ending."""


TableFormats = Annotated[
    tuple[Literal["csv", "tex", "xlsx"], ...],
    Several(Literal["csv", "tex", "xlsx"], spaced=False),
]
"""Formats of tables: one or several."""


class ReportOptions(Section):
    """Options that every report has."""

    name: FileName | None = None
    """stem of its files; the report's kind by default"""
    title: Text | None = None
    """heading of the figure; the study's by default"""
    formats: TableFormats = ("csv",)
    """of its tables: csv, which is always written, tex for LaTeX with booktabs, and xlsx,
    which needs openpyxl"""


@dataclass(frozen=True)
class ReportRequest:
    """One report."""

    kind: str
    stem: str
    options: ReportOptions
    path: Path


Check = Callable[[Document, Sequence[Axis], ReportRequest], Iterable[Fault]]
"""Faults of a request in a study with these axes."""

Options = TypeVar("Options", bound=ReportOptions)


@dataclass(frozen=True)
class ReportKind(Generic[Options]):
    """Options of a kind of report, and what else the study file must know of it.

    `check` holds rules that join the options with the rest of the study; `analyses` are
    those whose results it shows.
    """

    options: type[Options]
    check: Check = field(default=lambda *_: (), kw_only=True)
    analyses: tuple[Analysis, ...] = field(default=("timehistory",), kw_only=True)


ReportKinds = Mapping[str, ReportKind[Any]]
"""The kinds by name."""

GONE = {
    "contrast": (
        "`table: {rows: ..., columns: ..., statistic: median}` has the medians of each"
        " system, and points.csv every history; use these"
    ),
    "directions": (
        "pairs with ?both act together, and points.csv has every angle; remove the report"
    ),
    "efficiency": "the beta of a fragility is the scatter by its measure; use `fragility:"
    " {measure: ...}` for each measure",
    "demand_sample": "points.csv has the demands of every history; remove the report",
}
"""Reports of earlier versions, and what to use in their place."""

OF_THE_STUDY = ("points", "failed", "statistics", "verdicts")
"""Stems of files that every study leaves."""


def format_with(kinds: ReportKinds) -> type[StudyFile]:
    """The format of studies that may ask for reports of these kinds."""
    return _format(tuple((name, kind.options) for name, kind in kinds.items()))


@cache
def _format(kinds: tuple[tuple[str, type[Section]], ...]) -> type[StudyFile]:
    if not kinds:
        return StudyFile
    each: Any = Annotated[
        tuple[Annotated[Any, OneOf("report", dict(kinds), GONE)], ...], A_LIST
    ]
    field = each, Field((), description=StudyFile.model_fields["reports"].description)
    return create_model(
        "StudyFile", __base__=StudyFile, __doc__=StudyFile.__doc__, reports=field
    )


def written_out(document: Document, known: Registry[Any]) -> tuple[Document, ReportKinds]:
    """A study whose reports all have options, if none by name; the
    kinds by which it is read.
    """
    reports = document.content.get("reports")
    if not isinstance(reports, list):
        return document, dict(known)
    named = [
        name for each in reports for name in (each if isinstance(each, dict) else [each])
    ]
    others = [name for name in named if isinstance(name, str) and name not in known]
    # Those of other packages only if it names others; what is named must be usable.
    kinds = known.everything() if others else dict(known)
    kinds |= {name: known[name] for name in others if name in known.names()}

    def whole(item: Any) -> Any:
        item = {item: None} if isinstance(item, str) and item in kinds else item
        if isinstance(item, dict) and [*item.values()] == [None]:
            return {kind: {} for kind in item}
        return item

    content = {**document.content, "reports": [*map(whole, reports)]}
    return replace(document, content=content), kinds


def requests_of(document: Document, file: StudyFile) -> tuple[ReportRequest, ...]:
    """Reports of a study that is written out; each has files of
    its own, as lines, lines_2.
    """
    requests: list[ReportRequest] = []
    taken = {*OF_THE_STUDY}
    for index, options in enumerate(file.reports):
        (kind,) = document.content["reports"][index]
        wanted = options.name or kind
        numbered = (f"{wanted}_{number}" for number in range(2, len(taken) + 3))
        stem = next(name for name in (wanted, *numbered) if name not in taken)
        taken.add(stem)
        requests.append(ReportRequest(kind, stem, options, ("reports", index)))
    return tuple(requests)
