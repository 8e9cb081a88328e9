"""A study: what one file asks for, checked, and ready to be laid out as points."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path as Folder
from typing import Any

from pydantic import ValidationError

from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.check import checked
from rpscli.case.schema.keys import field_at, fields_of, unknown_key
from rpscli.case.schema.scale_to import ScaleToSection
from rpscli.case.study.axes import Axis, axes_of, sources_of, unequal, with_linked
from rpscli.case.study.observed import Observed, read_observed
from rpscli.case.study.reports import (
    ReportKinds,
    ReportRequest,
    format_with,
    requests_of,
    varied_keys,
    written_out,
)
from rpscli.case.study.schema import MeasureScale, StudyFile, StudyParts
from rpscli.case.text.document import (
    Document,
    Fault,
    Path,
    dotted,
    is_case,
    is_design,
    is_study,
    shown,
)
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, RpsError, listed, stem_of
from rpscli.registry import Registry

OF_HISTORIES = ("records", "scale", "perturb", "observed", "hazard")
"""Keys of a study that only time histories have."""

OF_POINTS = ("record", "scale")
"""Axes of the product that are no case keys; reports may name them."""

MOST_SYSTEMS = 200_000
"""Each is checked as a case before anything runs, which takes a millisecond."""

MOST_POINTS = 5_000_000
"""Their results, some thirty numbers each, are in memory when reports are drawn."""


@dataclass(frozen=True, eq=False)
class Study:
    """Many points from one case."""

    name: str
    source: str
    folder: Folder
    document: Document
    file: StudyFile
    base: Document
    base_file: Folder | None
    base_folder: Folder
    base_overrides: tuple[str, ...]
    axes: tuple[Axis, ...]
    sources: tuple[str, ...]
    observed: Observed | None
    reports: tuple[ReportRequest, ...]
    digest: str
    notes: tuple[str, ...] = ()

    @property
    def scale(self) -> MeasureScale | tuple[float, ...] | None:
        """Factors or targets of the records, else the target of the case at the base."""
        record = self.base.content.get("record")
        target = record.get("scale_to") if isinstance(record, dict) else None
        of_study = self.file.scale is not None or self.file.analysis != "timehistory"
        if of_study or target is None:
            return self.file.scale
        try:
            section = ScaleToSection.model_validate(target)
        except ValidationError:
            return None  # told with the other faults of the systems
        given = section.model_dump(exclude={"value"}, exclude_unset=True)
        return MeasureScale.model_validate(given | {"values": target["value"]})

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
) -> Study:
    """A study from its text."""
    document = read_yaml(text, name)
    if is_case(document):
        raise CaseError(
            f"{name}: this is a case, but a study is needed here; `rps timehistory {name}` computes"
            " it, `rps init --study` writes a study"
        )
    if is_design(document):
        raise CaseError(
            f"{name}: this is a design, but a study is needed here; use `rps design {name}`"
        )
    document, of_base = overridden(document, overrides, StudyFile)
    digest = hashlib.sha256(text.encode()).hexdigest()
    return study_of(document, of_base, kinds=kinds, folder=folder or Folder(), digest=digest)


def overridden(
    document: Document, overrides: Sequence[str], model: type[StudyParts]
) -> tuple[Document, list[str]]:
    """A study or a design with its own overrides; those of its base, as `analysis.gravity`."""
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
    kinds: Registry[Any],
    folder: Folder,
    digest: str,
) -> Study:
    """A study from its document, as `parse_study` says."""
    whole, asked = written_out(document, kinds)
    file = checked(format_with(asked), whole)
    reports = requests_of(whole, file)
    sources, faults, notes = sources_of(document, folder)
    faults += [*unequal(document, file.vary), *key_faults(document, base_overrides, folder)]
    document.refuse([*faults, *_analysis_faults(document, file, reports, asked)])
    axes = with_linked(axes_of(document, file.vary), file.linked, document)
    observed = read_observed(file.observed, folder, axes, document)
    document.refuse(_report_faults(document, file, axes, reports, asked))
    document.refuse(_size_faults(file, axes, sources))
    base, base_file = _base(document, folder)
    return Study(
        name=stem_of(Folder(document.name.strip("<>"))) or "study",
        source=document.name,
        folder=folder,
        document=document,
        file=file,
        base=apply_overrides(base, base_overrides),
        base_file=base_file,
        base_folder=base_file.parent if base_file else folder,
        base_overrides=tuple(base_overrides),
        axes=axes,
        sources=sources,
        observed=observed,
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
    if is_study(base):
        raise CaseError(f"{here} is a study, and a base is a case; name the case that it varies")
    if "rps" not in base.content and not is_case(base):
        raise CaseError(f"{here} has neither `rps` nor `superstructure`; name a case")
    return base, path


def varying(document: Document) -> list[tuple[str, Path]]:
    """Every key that varies or is sampled, in studies and designs, and where it stands."""
    vary = document.content.get("vary")
    axes: list[Path] = [("vary", i) for i in range(len(vary) if isinstance(vary, list) else 0)]
    owners = (*axes, ("sample", "ranges"), ("variables",), ("linked",))
    written = ((owner, document.at(owner)) for owner in owners)
    return [(key, (*owner, key)) for owner, of in written if isinstance(of, dict) for key in of]


def key_faults(document: Document, overrides: Sequence[str], folder: Folder) -> Iterator[Fault]:
    """Keys that cannot vary: unknown ones, said twice, fixed by an override or by the study."""
    with suppress(RpsError, ValidationError):  # told with the systems
        # Constants of laws of other packages are keys once a case has named the law.
        CaseFile.model_validate(_base(document, folder)[0].content)
    seen: dict[str, Path] = {}
    for key, path in varying(document):
        if key in seen:
            axis = " in another axis" if path[0] == seen[key][0] == "vary" else ""
            text = f"{key} varies already{axis}{document.where(seen[key])}; remove one of them"
            yield Fault(path, text, at_key=True)
        seen[key] = path
    fixed = {text: text.partition("=")[0].strip() for text in overrides}
    for key, path in seen.items():
        inside: Path = tuple(part for part in key.split(".") if not part.isdecimal())
        if not inside or field_at(CaseFile, inside) is None:
            yield Fault(path, unknown_key(CaseFile, inside or (key,))[0].text, at_key=True)
        if others := sorted(other for other in seen if other.startswith(f"{key}.")):
            text = f"{key} varies as a whole; {listed(others, 'and')} inside it must not vary too"
            yield Fault(path, text, at_key=True)
        for text, name in fixed.items():
            if f"{key}.".startswith(f"{name}.") or name.startswith(f"{key}."):
                message = f"{key} varies in the study; --set {text} cannot fix it"
                yield Fault(path, message, at_key=True)
        # The record is said once: by the study's list, or by the case and its varied keys.
        for owner, of in (("records", key.split(".")[0]), ("scale", key)):
            if of in {"record", f"record.{owner}"} and document.has((owner,)):
                where = document.where((owner,))
                message = f"{key} must not vary beside {owner}{where}; remove one of them"
                yield Fault(path, message, at_key=True)


def _analysis_faults(
    document: Document, file: StudyFile, requests: tuple[ReportRequest, ...], kinds: ReportKinds
) -> Iterator[Fault]:
    """A rate without a hazard; keys and reports without a meaning with a modal or pushover one."""
    for key in ("annual_rate", "probability_in_50_years"):
        if document.has(("limits", key)) and not document.has(("hazard",)):
            text = f"limits.{key} needs a hazard curve; add `hazard: {{file: FILE, measure: PGV}}`"
            yield Fault(("limits", key), text, at_key=True)
    if file.analysis == "timehistory":
        return
    for key in OF_HISTORIES:
        if key in file.model_fields_set:
            text = f"{key} has no meaning with analysis: {file.analysis}; remove it"
            yield Fault((key,), text, at_key=True)
    suitable = listed(name for name, kind in kinds.items() if file.analysis in kind.analyses)
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
                f"{dotted(path)} = {key} does not vary in this study; use {listed(known)}",
            )
            for option, key in varied_keys(request.options)
            if key not in known
        ]
        kind = kinds[request.kind]
        if not faults and file.analysis in kind.analyses:
            faults.extend(kind.check(document, axes, request))
        yield from faults


def _size_faults(file: StudyFile, axes: Sequence[Axis], sources: Sequence[str]) -> Iterator[Fault]:
    """A study that is too large, at its largest part."""
    systems: dict[Path, int] = {("vary", i): len(axis.rows) for i, axis in enumerate(axes)}
    if file.sample is not None:
        systems["sample", "size"] = file.sample.size
    others: dict[Path, int] = {("records",): max(len(sources), 1)}
    if file.scale is not None:
        values = file.scale.values if isinstance(file.scale, MeasureScale) else file.scale
        others["scale",] = len(values)
    if file.perturb is not None:
        others["perturb", "members"] = file.perturb.members
    for parts, most, name in (
        (systems, MOST_SYSTEMS, "systems"),
        (systems | others, MOST_POINTS, "points"),
    ):
        if (count := math.prod(parts.values())) > most:
            product = " x ".join(str(part) for part in parts.values() if part > 1)
            largest = max(parts, key=lambda path: parts[path])
            yield Fault(
                largest,
                f"the study has {count} {name} ({product}), which must not be more than {most};"
                " use fewer values, or several studies",
            )
            return
