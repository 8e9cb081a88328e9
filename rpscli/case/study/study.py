"""A study: what one file asks for, checked, and ready to be laid out as points."""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path as Folder
from typing import Any

from pydantic import ValidationError

from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.check import checked
from rpscli.case.schema.keys import field_at, fields_of, is_whole, unit, unknown_key
from rpscli.case.schema.scale_to import ScaleToSection
from rpscli.case.study.reports import (
    ReportKinds,
    ReportRequest,
    format_with,
    requests_of,
    varied_keys,
    written_out,
)
from rpscli.case.study.schema import (
    LABELS,
    PLUS,
    Axis,
    MeasureScale,
    RecordPattern,
    StudyFile,
    StudyParts,
    Values,
)
from rpscli.case.study.tool_key import TOOL_KEYS
from rpscli.case.text.document import Document, Fault, Path, dotted, format_of, shown
from rpscli.case.text.file_kinds import FILE_KINDS
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import (
    CaseError,
    RecordError,
    RpsError,
    is_number,
    listed,
    stem_of,
    visible,
)
from rpscli.records.loading import expanded, repeated
from rpscli.registry import Registry
from rpscli.units import in_si

OF_HISTORIES = ("records", "scale", "perturb", *TOOL_KEYS, "hazard")
"""Keys of a study that only time histories have."""

OF_POINTS = ("record", "scale")
"""Axes of the product that are no case keys; reports may name them."""

MOST_SOURCES = 100_000
"""Ground motions that the options of one pattern may stand for."""

MOST_SYSTEMS = 200_000
"""Each is checked as a case before anything runs, which takes a millisecond."""

MOST_POINTS = 5_000_000
MOST_COUNTED = 10**18
"""Their results, some thirty numbers each, are in memory when reports are drawn."""

DIGITS = 6
"""Of what is linked to other values: finer cannot be built, and files stay readable."""


@dataclass(frozen=True, eq=False)
class StudyInput:
    """Many points from one case."""

    name: str
    source: str
    folder: Folder
    document: Document
    file: StudyFile
    base: Document
    base_file: Folder | None
    base_overrides: tuple[str, ...]
    axes: tuple[Axis, ...]
    sources: tuple[str, ...]
    of_tools: Mapping[str, Any]  # what they read of their keys
    reports: tuple[ReportRequest, ...]
    digest: str
    notes: tuple[str, ...] = ()

    @property
    def base_folder(self) -> Folder:
        """Where relative file names inside the base start."""
        return self.base_file.parent if self.base_file else self.folder

    @property
    def scale(self) -> MeasureScale | tuple[float, ...] | None:
        """Factors or targets of the records, else the target of the case at the base."""
        target = self.base.at(("record", "scale_to"))
        if self.file.scale is None and self.file.analysis == "timehistory":
            with suppress(ValidationError):  # told with the other faults of the systems
                section = ScaleToSection.model_validate(target)
                given = section.model_dump(exclude={"value"}, exclude_unset=True)
                return MeasureScale.model_validate(given | {"values": target["value"]})
        return self.file.scale

    @property
    def title(self) -> str:
        """Heading of reports; the name, if the file has no title."""
        return self.file.title or self.name


def parse_study(
    text: str,
    *,
    name: str,
    kinds: Registry[Any],
    folder: Folder | None = None,
    overrides: Sequence[str] = (),
) -> StudyInput:
    """A study from its text."""
    document = read_yaml(text, name)
    if (kind := format_of(document)) == "case":
        raise CaseError(
            f"{name}: this is a case, but a study is needed here; `rps timehistory"
            f" {name}` computes it, `rps init --study` writes a study"
        )
    if kind in FILE_KINDS:
        raise CaseError(
            f"{name}: this is a {kind}, but a study is needed here; use `rps {kind}"
            f" {name}`"
        )
    document, of_base = overridden(document, overrides, StudyFile)
    digest = hashlib.sha256(text.encode()).hexdigest()
    return study_of(
        document, of_base, kinds=kinds, folder=folder or Folder(), digest=digest
    )


def overridden(
    document: Document, overrides: Sequence[str], model: type[StudyParts]
) -> tuple[Document, list[str]]:
    """A study or a design with its own overrides; those of its
    base, as `analysis.gravity`.
    """
    own: list[str] = []
    of_base: list[str] = []
    for override in overrides:
        key = override.partition("=")[0].strip()
        known = key.split(".")[0] in fields_of(model) and not key.startswith("analysis.")
        (own if known else of_base).append(override)
    return apply_overrides(document, own, model=model), of_base


def study_of(
    document: Document,
    base_overrides: Sequence[str],
    *,
    kinds: Registry[Any] | None = None,
    folder: Folder,
    digest: str,
) -> StudyInput:
    """A study from its document, as `parse_study` says; one of a
    design asks for no reports.
    """
    whole, asked = (document, {}) if kinds is None else written_out(document, kinds)
    document.refuse(_misplaced(document))
    file = checked(format_with(asked), whole)
    reports = requests_of(whole, file)
    document.refuse(_label_faults(file))
    sources, faults, notes = sources_of(document, folder)
    faults += [*_unequal(document, file), *key_faults(document, base_overrides, folder)]
    document.refuse([*faults, *_analysis_faults(document, file, reports, asked)])
    axes = _with_linked(_axes(document, file), file.linked, document)
    of_tools = {
        name: key.read(getattr(file, name, None), folder, axes, document)
        for name, key in TOOL_KEYS.items()
    }
    document.refuse(_report_faults(document, file, axes, reports, asked))
    document.refuse(_size_faults(file, axes, sources))
    base, base_file = _base(document, folder)
    return StudyInput(
        name=stem_of(Folder(document.name.strip("<>"))) or "study",
        source=document.name,
        folder=folder,
        document=document,
        file=file,
        base=apply_overrides(base, base_overrides),
        base_file=base_file,
        base_overrides=tuple(base_overrides),
        axes=axes,
        sources=sources,
        of_tools=of_tools,
        reports=reports,
        digest=digest,
        notes=tuple(notes),
    )


def _base(document: Document, folder: Folder) -> tuple[Document, Folder | None]:
    """The case at the base, and its file."""
    written = document.content["base"]
    if isinstance(written, dict):
        return document.part("base"), None
    path = folder / written
    here = f"{document.value_place(('base',))}: base = {shown(written)}"
    try:
        text = read_text(path)
    except CaseError as error:
        raise CaseError(f"{here}: {error}") from None
    base = read_yaml(text, str(path))
    if (kind := format_of(base)) in ("study", "design"):
        raise CaseError(
            f"{here} is a study, and a base is a case; name the case that it varies"
        )
    if "rps" not in base.content and kind != "case":
        raise CaseError(f"{here} has neither `rps` nor `superstructure`; name a case")
    return base, path


def _unequal(document: Document, file: StudyFile) -> Iterator[Fault]:
    """Keys of one axis that have not equally many values."""
    for index, columns in enumerate(file.vary):
        first = next(iter(columns))
        for key in (key for key in columns if len(columns[key]) != len(columns[first])):
            text = (
                f"{key} has {len(columns[key])} values, but"
                f" {first}{document.where(('vary', index, first))} has"
                f" {len(columns[first])}: the keys of one axis go together; give equally"
                " many, or begin another axis with `-`"
            )
            yield Fault(("vary", index, key), text, at_key=True)


BESIDE_VARY = ("linked", "records", "scale", "limits", "reports", "base")
"""Keys of studies that stand beside `vary`, not in one of its axes."""


def _misplaced(document: Document) -> Iterator[Fault]:
    """Keys of the study that stand in an axis."""
    axes = document.at(("vary",))
    for index, columns in enumerate(axes if isinstance(axes, list) else ()):
        for key in BESIDE_VARY if isinstance(columns, dict) else ():
            if key in columns:
                text = f"{key} stands beside vary, not in one of its axes: write it there"
                yield Fault(("vary", index, key), text, at_key=True)


def _label_faults(file: StudyFile) -> Iterator[Fault]:
    """Names of rows that are no texts, that are there twice, or without a row."""
    for index, columns in enumerate(file.vary):
        labels = columns.get(LABELS, ())
        path: Path = ("vary", index, LABELS)
        if labels and len(columns) == 1:
            text = "labels name the values of the keys beside them; give the axis a key"
            yield Fault(path, text, at_key=True)
        for row, label in enumerate(labels):
            if not isinstance(label, str) or visible(label.strip()) != label or not label:
                text = (
                    f"labels[{row}] = {shown(label)} must be a name, a text in one line"
                )
                yield Fault((*path, row), text)
            elif label in labels[:row]:
                text = f"labels[{row}] = {label} names another value already"
                yield Fault((*path, row), f"{text}; give each value a name of its own")


def _axes(document: Document, file: StudyFile) -> tuple[Axis, ...]:
    """Axes of a study whose columns are equally long."""
    axes = []
    for index, written in enumerate(file.vary):
        places = []
        columns = dict(written)
        for key, of in columns.items():
            if key == LABELS:
                continue
            path: Path = ("vary", index, key)
            ranged = isinstance(document.at(path), dict)
            inside = [path] if ranged else [(*path, row) for row in range(len(of))]
            places.append(tuple(map(document.value_place, inside)))
        labels = tuple(columns.pop(LABELS, ()))
        rows = tuple(zip(*columns.values(), strict=True))
        axes.append(Axis(tuple(columns), rows, tuple(places), labels=labels))
    return tuple(axes)


def linked_value(
    key: str, terms: Mapping[str, float], values: Sequence[float]
) -> float | int:
    """A linear sum of the values of its keys, as a case takes it."""
    factors = (factor for name, factor in terms.items() if name != PLUS)
    products = (factor * value for factor, value in zip(factors, values, strict=True))
    total = sum(products, terms.get(PLUS, 0.0))
    return round(total) if is_whole(key) else float(f"{total:.{DIGITS}g}")


def _with_linked(
    axes: tuple[Axis, ...], linked: Mapping[str, Mapping[str, float]], document: Document
) -> tuple[Axis, ...]:
    """The axes with keys that are linear sums of others of theirs."""
    for key, terms in linked.items():
        path = ("linked", key)
        names = [name for name in terms if name != PLUS]
        axis = next((each for each in axes if names and {*names} <= {*each.keys}), None)
        if axis is None:
            text = (
                f"linked.{key} needs {listed(names or ['a key'], 'and')}, which no axis"
                " of vary"
            )
            raise document.refusal(
                [Fault(path, f"{text} has; sums are of keys of one axis")]
            )
        columns = [(axis.keys.index(name), unit(name)) for name in names]
        rows: list[list[Any]] = [
            [in_si(row[at], si) for at, si in columns] for row in axis.rows
        ]
        if not all(map(is_number, itertools.chain(*rows))):
            text = f"linked.{key} is a sum of numbers; {names} are not"
            raise document.refusal([Fault(path, text)])
        sums = (linked_value(key, terms, row) for row in rows)
        values: tuple[Values, ...] = tuple(
            (*old, new) for old, new in zip(axis.rows, sums, strict=True)
        )
        longer = replace(
            axis,
            keys=(*axis.keys, key),
            rows=values,
            places=(*axis.places, (document.value_place(path),)),
        )
        axes = tuple(longer if each is axis else each for each in axes)
    return axes


def sources_of(
    document: Document, folder: Folder, *owner: str
) -> tuple[tuple[str, ...], list[Fault], list[str]]:
    """Single sources of a list `records`, in order, each once;
    what is wrong, and notes.
    """
    place: Path = (*owner, "records")
    records = document.at(place)
    sources: list[str] = []
    faults: list[Fault] = []
    notes: list[str] = []
    for index, item in enumerate(records if isinstance(records, list) else ()):
        try:
            single = isinstance(item, str) and item.strip()
            patterns = [item] if single else _product(item, (*place, index))
            found, told = expanded(patterns, folder=folder)
            sources += found
            notes += told
        except ValidationError:
            continue  # told key by key
        except (RecordError, ValueError) as error:
            faults.append(Fault((*place, index), str(error)))
    notes = [f"records: {text}" for text in dict.fromkeys([*notes, *repeated(sources)])]
    return tuple(dict.fromkeys(sources)), faults, notes


def _product(item: object, path: Path) -> list[str]:
    """Sources of a mapping: every option may have several values,
    the first varies slowest.
    """
    pattern = RecordPattern.model_validate(item)
    source = pattern.source
    extra = pattern.model_extra or {}
    options = [
        [f"{key}={_text(value)}" for value in values] for key, values in extra.items()
    ]
    if (count := math.prod(map(len, options))) > MOST_SOURCES:
        raise ValueError(
            f"{dotted(path)} stands for {count} ground motions, which must not be more"
            f" than {MOST_SOURCES}; use fewer values of its options"
        )
    mark = (
        "&"
        if "?" in source and not source.endswith("?")
        else "?" * (not source.endswith("?"))
    )
    return [
        f"{source}{mark if chosen else ''}{'&'.join(chosen)}"
        for chosen in itertools.product(*options)
    ]


def _text(value: object) -> str:
    """A value as an option is written: whole numbers without a fraction."""
    whole = isinstance(value, float) and value.is_integer() and abs(value) < 1e15
    return f"{value:.0f}" if whole else str(value)


def varying(document: Document) -> list[tuple[str, Path]]:
    """Every key that varies or is sampled, in studies and
    designs, and where it stands.
    """
    vary = document.content.get("vary")
    axes: list[Path] = [
        ("vary", i) for i in range(len(vary) if isinstance(vary, list) else 0)
    ]
    owners = (*axes, ("sample", "ranges"), ("variables",), ("linked",))
    written = ((owner, document.at(owner)) for owner in owners)
    return [
        (key, (*owner, key))
        for owner, of in written
        if isinstance(of, dict)
        for key in of
        if not (owner[0] == "vary" and key == LABELS)
    ]


def key_faults(
    document: Document, overrides: Sequence[str], folder: Folder
) -> Iterator[Fault]:
    """Keys that cannot vary: unknown ones, said twice, fixed by an
    override or by the study.
    """
    with suppress(RpsError, ValidationError):  # told with the systems
        # Constants of laws of other packages are keys once a case has named the law.
        CaseFile.model_validate(_base(document, folder)[0].content)
    seen: dict[str, Path] = {}
    for key, path in varying(document):
        if key in seen:
            axis = " in another axis" if path[0] == seen[key][0] == "vary" else ""
            text = (
                f"{key} varies already{axis}{document.where(seen[key])}; remove one of"
                " them"
            )
            yield Fault(path, text, at_key=True)
        seen[key] = path
    fixed = {text: text.partition("=")[0].strip() for text in overrides}
    for key, path in seen.items():
        inside: Path = tuple(part for part in key.split(".") if not part.isdecimal())
        if not inside or field_at(CaseFile, inside) is None:
            yield Fault(
                path, unknown_key(CaseFile, inside or (key,))[0].text, at_key=True
            )
        if others := sorted(other for other in seen if other.startswith(f"{key}.")):
            text = (
                f"{key} varies as a whole; {listed(others, 'and')} inside it must not"
                " vary too"
            )
            yield Fault(path, text, at_key=True)
        for text, name in fixed.items():
            if f"{key}.".startswith(f"{name}.") or name.startswith(f"{key}."):
                message = f"{key} varies in the study; --set {text} cannot fix it"
                yield Fault(path, message, at_key=True)
        # The record is said once: by the study's list, or by the case and its varied
        # keys.
        for owner, of in (("records", key.split(".")[0]), ("scale", key)):
            if of in {"record", f"record.{owner}"} and document.has((owner,)):
                where = document.where((owner,))
                message = f"{key} must not vary beside {owner}{where}; remove one of them"
                yield Fault(path, message, at_key=True)


def _analysis_faults(
    document: Document,
    file: StudyFile,
    requests: tuple[ReportRequest, ...],
    kinds: ReportKinds,
) -> Iterator[Fault]:
    """A rate without a hazard; keys and reports without a meaning with
    a modal or pushover one.
    """
    for key in ("annual_rate", "probability_in_50_years"):
        if document.has(("limits", key)) and not document.has(("hazard",)):
            text = (
                f"limits.{key} needs a hazard curve; add `hazard: {{file: FILE, measure:"
                " PGV}`"
            )
            yield Fault(("limits", key), text, at_key=True)
    if file.analysis == "timehistory":
        return
    for key in OF_HISTORIES:
        if key in file.model_fields_set:
            text = f"{key} has no meaning with analysis: {file.analysis}; remove it"
            yield Fault((key,), text, at_key=True)
    suitable = listed(
        name for name, kind in kinds.items() if file.analysis in kind.analyses
    )
    for request in requests:
        if file.analysis not in (needed := kinds[request.kind].analyses):
            text = f"the report {request.kind} needs analysis: {listed(needed)}"
            yield Fault(request.path, f"{text}; {suitable} suits {file.analysis}")


def _report_faults(
    document: Document,
    file: StudyFile,
    axes: Sequence[Axis],
    requests: tuple[ReportRequest, ...],
    kinds: ReportKinds,
) -> Iterator[Fault]:
    """Keys that reports name must vary; each kind has rules of its own."""
    known = [*(key for axis in axes for key in axis.keys), *OF_POINTS]
    for request in requests:
        faults = [
            Fault(
                path := (*request.path, request.kind, *option),
                f"{dotted(path)} = {key} does not vary in this study; use"
                f" {listed(known)}",
            )
            for option, key in varied_keys(request.options)
            if key not in known
        ]
        kind = kinds[request.kind]
        if not faults and file.analysis in kind.analyses:
            faults.extend(kind.check(document, axes, request))
        yield from faults


def _size_faults(
    file: StudyFile, axes: Sequence[Axis], sources: Sequence[str]
) -> Iterator[Fault]:
    """A study that is too large, at its largest part."""
    parts: dict[Path, int] = {("vary", i): len(axis.rows) for i, axis in enumerate(axes)}
    if file.sample is not None:
        parts["sample", "size"] = file.sample.size
    most = MOST_SYSTEMS
    name = "systems"
    if math.prod(parts.values()) <= most:
        most = MOST_POINTS
        name = "points"
        parts["records",] = max(len(sources), 1)
        if file.scale is not None:
            values = (
                file.scale.values if isinstance(file.scale, MeasureScale) else file.scale
            )
            parts["scale",] = len(values)
        if file.perturb is not None:
            parts["perturb", "members"] = file.perturb.members
    if (count := math.prod(parts.values())) > most:
        found, *each = (  # numbers without end are cut
            str(part) if part < MOST_COUNTED else f"over {MOST_COUNTED}"
            for part in (count, *parts.values()) if part > 1
        )  # fmt: skip
        yield Fault(
            max(parts, key=lambda path: parts[path]),
            f"the study has {found} {name} ({' x '.join(each)}), which must not be more"
            f" than {most}; use fewer values, or several studies",
        )
