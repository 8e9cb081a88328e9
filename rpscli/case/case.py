"""A case: what one file describes, checked, and ready to be analysed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.build import time_history_settings
from rpscli.case.overrides import Overrides, apply_overrides
from rpscli.case.plausibility import Doubt, doubts_of_structure, doubts_of_text
from rpscli.case.schema.case_file import CaseFile, RecordSection
from rpscli.case.schema.check import checked
from rpscli.case.schema.fields import Section
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.structure import limits_without_result, structure_of
from rpscli.case.text.document import Document, format_of, text_of_values
from rpscli.case.text.files import opened
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, RecordError, require_kind, stem_of
from rpscli.model.podium import PodiumStructure
from rpscli.records.loading import single_source
from rpscli.records.measures import Of
from rpscli.records.recordings import ONE_FACTOR, Pair, pairs
from rpscli.records.source import Source
from rpscli.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Case(Shown):
    """One structure with its record, settings and limits.

    Parameters
    ----------
    name
        Stem of the file's name; names folders of results.
    source
        The file as the user named it.
    folder
        Where relative file names inside the case start.
    file
        The validated file.
    structure
        What it describes, built.
    doubts_of_text
        What is unusual in the values as they are written, and keys without effect.
    digest
        SHA-256 of the text; empty for a case made in memory.
    written
        The values as they were written, with the units of the user.
    """

    name: str
    source: str
    folder: Path
    file: CaseFile
    structure: PodiumStructure
    doubts_of_text: tuple[Doubt, ...] = ()
    digest: str = ""
    written: Mapping[str, Any] = field(default_factory=dict)

    def facts(self) -> dict[str, Any]:
        """Title, source, record and structure."""
        return {
            "title": self.title,
            "source": self.source,
            "record": self.record.source if self.record else None,
            "structure": self.structure,
        }

    @property
    def title(self) -> str:
        """Heading of reports; the name, if the file has no title."""
        return self.file.title or self.name

    @property
    def record(self) -> RecordSection | None:
        """The ground motion's source and scale, if the file names one."""
        return self.file.record

    @cached_property
    def record_source(self) -> Source:
        """The source of the record, or of its first component, taken apart."""
        return single_source(self.record.source if self.record else "", self.folder)

    def record_pair(self, of: Of | None) -> Pair | None:
        """Both components that a measure of the record is of; None
        if it is of a single one.
        """
        if self.record is None or self.record.y is None:
            return pairs([self.record_source], of, self.folder)[0]
        if of == "component":
            raise RecordError(f"{self.record_source}: {ONE_FACTOR}")
        return self.record_source, self.record.y

    @property
    def limits(self) -> LimitsSection:
        """Acceptance limits; those that are None are not set."""
        return self.file.limits

    @cached_property
    def analysis(self) -> TimeHistorySettings:
        """Settings of the time history."""
        return time_history_settings(self.file.analysis, self.structure.bearing)

    @cached_property
    def doubts(self) -> tuple[Doubt, ...]:
        """Possible, but unusual properties."""
        return (*self.doubts_of_text, *doubts_of_structure(self.structure))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Doubts in words: no faults, but something the user should know."""
        return tuple(map(str, self.doubts))

    @cached_property
    def document(self) -> dict[str, Any]:
        """The case in SI units with all defaults written out;
        JSON-able, and a case again.
        """
        Section.build()
        content = self.file.model_dump(
            mode="json", exclude_none=True, by_alias=True, serialize_as_any=True
        )
        building = content["superstructure"]
        if building["storeys"] == 0:
            content["superstructure"] = {"storeys": 0}
        elif "period" in building:
            building.setdefault("profile", "sine")
        if "column_mass" in content["podium"]:
            content["podium"].setdefault("columns", 1)
        if not content["podium"]["devices"]:
            del content["podium"]["devices"]
        if not content["document"]:
            del content["document"]
        return content


def load_case(source: str | Path | Mapping[str, Any], overrides: Overrides = ()) -> Case:
    """A case from a file, the standard input (``-``), or values
    as a file would hold them.

    Parameters
    ----------
    source
        Name of the file, or a mapping, in which numbers and lists may be those of numpy;
        its relative paths start in the working folder.
    overrides
        Texts ``key=value`` over the case's own values.

    Raises
    ------
    CaseError
        If the file cannot be read, or is not a valid case: one line for each fault of a
        key, or, if there are none, for each between keys.
    """
    if isinstance(source, Mapping):
        text = text_of_values(source, "<case>")
        values = json.loads(text)
        case = case_from_mapping(values, "<case>", None, overrides, alone=True)
        return replace(case, digest=hashlib.sha256(text.encode()).hexdigest())
    require_kind(source, (str, Path), "the case", "give the name of a file, or a mapping")
    return parse_case(**opened(source), overrides=overrides)


def parse_case(
    text: str, *, name: str, folder: Path | None = None, overrides: Overrides = ()
) -> Case:
    """A case from its text."""
    document = read_yaml(text, name)
    if (kind := format_of(document)) in ("study", "design"):
        command = "sweep" if kind == "study" else kind
        raise CaseError(
            f"{name}: this is a {kind}, but a case is needed here; `rps {command} {name}`"
            " runs it"
        )
    case = case_from_mapping(document, name, folder, overrides, alone=True)
    return replace(case, digest=hashlib.sha256(text.encode()).hexdigest())


def case_from_mapping(
    mapping: Mapping[str, Any] | Document,
    name: str,
    folder: Path | None = None,
    overrides: Overrides = (),
    *,
    label: str = "--set",
    alone: bool = False,
) -> Case:
    """A case from values in memory, or from a document (or part of
    one) with its positions.

    One that stands `alone` has no limit on a result that it lacks; a system of a study
    is not judged by such.
    """
    document = mapping if isinstance(mapping, Document) else Document(name, dict(mapping))
    document = apply_overrides(document, overrides, label=label)
    file = checked(CaseFile, document)
    structure = structure_of(file, document)
    if alone:
        document.refuse(limits_without_result(file.limits, structure))
    return Case(
        stem_of(Path(name.strip("<>"))) or "case",
        name,
        folder or Path(),
        file,
        structure,
        tuple(doubts_of_text(file.superstructure)),
        written=document.content,
    )
