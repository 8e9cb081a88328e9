"""A study: what one file asks for, checked, and ready to be laid out as points."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rpscli.case.overrides import apply_overrides
from rpscli.case.schema.check import checked
from rpscli.case.schema.keys import fields_of
from rpscli.case.schema.scale_to import ScaleToSection
from rpscli.case.study import rules
from rpscli.case.study.axes import Axis, axes_of, sources_of, unequal, with_linked
from rpscli.case.study.observed import Observed, read_observed
from rpscli.case.study.reports import (
    ReportRequest,
    format_with,
    kinds_in,
    requests_of,
    written_out,
)
from rpscli.case.study.schema import MeasureScale, StudyFile, StudyParts
from rpscli.case.text.document import Document, is_case, is_design, is_study, shown
from rpscli.case.text.files import read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, stem_of
from rpscli.registry import Registry


@dataclass(frozen=True, eq=False)
class Study:
    """Many points from one case."""

    name: str
    source: str
    folder: Path
    document: Document
    file: StudyFile
    base: Document
    base_file: Path | None
    base_folder: Path
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
        if self.file.scale is not None or self.file.analysis != "timehistory":
            return self.file.scale
        return _scale_of_base(self.base)

    @property
    def title(self) -> str:
        """Heading of reports; the name, if the file has no title."""
        return self.file.title or self.name


def _scale_of_base(base: Document) -> MeasureScale | None:
    """The target of the record of the case at the base, as a study says it."""
    record = base.content.get("record")
    target = record.get("scale_to") if isinstance(record, dict) else None
    if target is None:
        return None
    try:
        section = ScaleToSection.model_validate(target)
    except ValidationError:
        return None  # told with the other faults of the systems
    given = section.model_dump(exclude={"value"}, exclude_unset=True)
    return MeasureScale.model_validate(given | {"values": target["value"]})


def parse_study(
    text: str,
    *,
    name: str,
    kinds: Registry[Any],
    folder: Path | None = None,
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
    of_study, of_base = shared_out(overrides, StudyFile)
    document = apply_overrides(document, of_study, model=StudyFile)
    digest = hashlib.sha256(text.encode()).hexdigest()
    return study_of(document, of_base, kinds=kinds, folder=folder or Path(), digest=digest)


def study_of(
    document: Document,
    base_overrides: Sequence[str],
    *,
    kinds: Registry[Any],
    folder: Path,
    digest: str,
) -> Study:
    """A study from its document, as `parse_study` says."""
    asked = kinds_in(document, kinds)
    whole = written_out(document, asked)
    file = checked(format_with(asked), whole)
    reports = requests_of(whole, file)
    sources, faults, notes = sources_of(document, folder)
    faults += [*unequal(document, file.vary), *rules.unknown_keys(document), *rules.twice(document)]
    faults += [*rules.record_rules(document), *rules.reliability_rules(document)]
    faults += [
        *rules.analysis_rules(file, reports, asked),
        *rules.fixed_faults(document, base_overrides),
    ]
    document.refuse(faults)
    axes = with_linked(axes_of(document, file.vary), file.linked, document)
    observed = read_observed(file.observed, folder, axes, document)
    document.refuse(rules.report_rules(document, file, axes, reports, asked))
    document.refuse(rules.size_faults(file, axes, sources))
    base, base_file = _base(document, folder)
    return Study(
        name=stem_of(Path(document.name.strip("<>"))) or "study",
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


def shared_out(overrides: Sequence[str], model: type[StudyParts]) -> tuple[list[str], list[str]]:
    """Overrides of a study or a design, and those of its base, as `analysis.gravity`."""
    own: list[str] = []
    of_base: list[str] = []
    for override in overrides:
        key = override.partition("=")[0].strip()
        known = key.split(".")[0] in fields_of(model) and not key.startswith("analysis.")
        (own if known else of_base).append(override)
    return own, of_base


def _base(document: Document, folder: Path) -> tuple[Document, Path | None]:
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
