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
from rpscli.case.build import Podium, podium_of, podium_structure, time_history_settings
from rpscli.case.overrides import Overrides, apply_overrides
from rpscli.case.rules.partial_case import CONTACT, PartialCase
from rpscli.case.rules.plausibility import Doubt, doubts_of_storeys, doubts_of_structure
from rpscli.case.rules.podium import (
    bearing_rules,
    contact_rules,
    devices_rules,
    impact_rules,
    overturning_rule,
    release_rule,
    restitution_rule,
)
from rpscli.case.rules.superstructure import (
    column_rules,
    ignored_text,
    limits_rules,
    masses_rules,
    record_rules,
    superstructure_rules,
)
from rpscli.case.schema.case_file import CaseFile, RecordSection
from rpscli.case.schema.check import schema_check
from rpscli.case.schema.limits import LimitsSection
from rpscli.case.text.document import Document, is_design, is_study, text_of_values
from rpscli.case.text.files import STDIN, read_text
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError, require_kind, stem_of
from rpscli.model.podium import PodiumStructure
from rpscli.shown import Shown

RULES = (
    superstructure_rules,
    masses_rules,
    bearing_rules,
    impact_rules,
    contact_rules,
    devices_rules,
    record_rules,
    limits_rules,
    column_rules,
)


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
    podium
        Columns and cap beam, built.
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
    podium: Podium
    doubts_of_text: tuple[Doubt, ...] = ()
    digest: str = ""
    written: Mapping[str, Any] = field(default_factory=dict)

    def facts(self) -> dict[str, Any]:
        """What it is about."""
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

    @property
    def limits(self) -> LimitsSection:
        """Acceptance limits; those that are None are not set."""
        return self.file.limits

    @cached_property
    def analysis(self) -> TimeHistorySettings:
        """Settings of the time history."""
        return time_history_settings(self.file.analysis, self.podium.bearing)

    @cached_property
    def structure(self) -> PodiumStructure:
        """The structure, built when it is first asked for."""
        try:
            return podium_structure(self.podium, self.file)
        except ValueError as error:
            raise CaseError(f"{self.source}: {error}") from None

    @cached_property
    def doubts(self) -> tuple[Doubt, ...]:
        """What is possible, but unusual."""
        return (*self.doubts_of_text, *doubts_of_structure(self.structure))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know although it is no fault."""
        return tuple(map(str, self.doubts))

    @cached_property
    def document(self) -> dict[str, Any]:
        """The case in SI units with all defaults written out; JSON-able, and a case again."""
        content = self.file.model_dump(mode="json", exclude_none=True)
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
    """A case from a file, the standard input (``-``), or values as a file would hold them.

    Parameters
    ----------
    source
        Name of the file, or a mapping, in which numbers and lists may be those of numpy; its
        relative paths start in the working folder.
    overrides
        Texts ``key=value`` over the case's own values.

    Raises
    ------
    CaseError
        If the file cannot be read, or is not a valid case: one line for each fault.
    """
    if isinstance(source, Mapping):
        text = text_of_values(source, "<case>")
        case = case_from_mapping(json.loads(text), "<case>", None, overrides)
        return replace(case, digest=hashlib.sha256(text.encode()).hexdigest())
    require_kind(source, (str, Path), "the case", "give the name of a file, or a mapping")
    text = read_text(source)
    if str(source) == STDIN:
        return parse_case(text, name="<stdin>", overrides=overrides)
    return parse_case(text, name=str(source), folder=Path(source).parent, overrides=overrides)


def parse_case(
    text: str, *, name: str, folder: Path | None = None, overrides: Overrides = ()
) -> Case:
    """A case from its text."""
    document = read_yaml(text, name)
    if is_study(document):
        kind, command = ("design", "design") if is_design(document) else ("study", "sweep")
        raise CaseError(
            f"{name}: this is a {kind}, but a case is needed here; `rps {command} {name}` runs it"
        )
    case = case_from_mapping(document, name, folder, overrides)
    return replace(case, digest=hashlib.sha256(text.encode()).hexdigest())


def case_from_mapping(
    mapping: Mapping[str, Any] | Document,
    name: str,
    folder: Path | None = None,
    overrides: Overrides = (),
    *,
    label: str = "--set",
) -> Case:
    """A case from values in memory, or from a document (or part of one) with its positions."""
    document = mapping if isinstance(mapping, Document) else Document(name, dict(mapping))
    document = apply_overrides(document, overrides, label=label)
    check = schema_check(CaseFile, document)
    partial = PartialCase(document, check)
    faults = [*check.faults, *(fault for rule in RULES for fault in rule(partial))]
    document.refuse(fault for fault in faults if not check.suggested.intersection(fault.needs))
    file = check.read
    assert file is not None, "without faults the file is read"
    stem = stem_of(Path(name.strip("<>"))) or "case"
    podium = _podium(file, partial)
    doubts = (
        *((Doubt(ignored),) if (ignored := ignored_text(partial)) else ()),
        *doubts_of_storeys(file.superstructure, document),
    )
    written = document.content
    return Case(stem, name, folder or Path(), file, podium, doubts, written=written)


def _podium(file: CaseFile, partial: PartialCase) -> Podium:
    """Columns and cap beam, if the model takes them."""
    assert partial.shape is not None, "the rules make sure that the shape is complete"
    document = partial.document
    try:
        podium = podium_of(file, partial.shape)
        faults = [
            *restitution_rule(podium, document),
            *overturning_rule(podium.bearing, file.analysis),
            *release_rule(podium.bearing, file.analysis),
        ]
    except ValueError as error:
        place = document.key_place(("podium",))
        raise CaseError(f"{place}: podium: {error}") from None
    document.refuse(faults)
    if document.has(CONTACT):
        _refuse_contact(podium, file, document)
    return podium


def _refuse_contact(podium: Podium, file: CaseFile, document: Document) -> None:
    """Say what the model does not take of compliant ends, or of a start below phi_u."""
    try:
        structure = podium_structure(podium, file)
        if structure.bed is not None:
            structure.bed.refuse_start(file.analysis.initial_rotation)
    except ValueError as error:
        raise CaseError(f"{document.key_place(CONTACT)}: podium.contact: {error}") from None
