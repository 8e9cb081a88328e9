"""A case: what one file describes, checked, and ready to be analysed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.builder import podium_structure, time_history_settings
from rpscli.case.document import Document
from rpscli.case.draft import Draft
from rpscli.case.faults import Fault
from rpscli.case.files import STDIN, read_text
from rpscli.case.overrides import Overrides, apply_overrides
from rpscli.case.release_rule import release_rule
from rpscli.case.restitution_rule import restitution_rule
from rpscli.case.rules_bearing import bearing_rules, impact_rules
from rpscli.case.rules_masses import masses_rules
from rpscli.case.rules_superstructure import (
    ignored_keys,
    ignored_text,
    limits_rules,
    superstructure_rules,
)
from rpscli.case.schema import CaseFile, LimitsSection, RecordSection
from rpscli.case.schema_faults import schema_check
from rpscli.case.yaml_text import read_yaml
from rpscli.errors import CaseError
from rpscli.model.podium import PodiumStructure

RULES = (superstructure_rules, masses_rules, bearing_rules, impact_rules, limits_rules)


@dataclass(frozen=True, eq=False)
class Case:
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
    warnings
        What the user should know although it is no fault.
    """

    name: str
    source: str
    folder: Path
    file: CaseFile
    warnings: tuple[str, ...] = ()

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
        return time_history_settings(self.file.analysis)

    @cached_property
    def structure(self) -> PodiumStructure:
        """The structure, built when it is first asked for."""
        try:
            return podium_structure(self.file)
        except ValueError as error:
            raise CaseError(f"{self.source}: {error}") from None

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
        return content


def load_case(source: str | Path, overrides: Overrides = ()) -> Case:
    """Read a case from a file, or from the standard input (``-``).

    Raises
    ------
    CaseError
        If the file cannot be read, or is not a valid case: one line for each fault.
    """
    text = read_text(source)
    if str(source) == STDIN:
        return parse_case(text, name="<stdin>", overrides=overrides)
    return parse_case(text, name=str(source), folder=Path(source).parent, overrides=overrides)


def parse_case(
    text: str, *, name: str, folder: Path | None = None, overrides: Overrides = ()
) -> Case:
    """A case from its text.

    Parameters
    ----------
    text
        YAML.
    name
        The source as it is named in messages; the stem of its last part names the case.
    folder
        Where relative file names start; the current folder by default.
    overrides
        See `apply_overrides`.
    """
    return case_from_mapping(read_yaml(text, name), name, folder, overrides)


def case_from_mapping(
    mapping: Mapping[str, Any] | Document,
    name: str,
    folder: Path | None = None,
    overrides: Overrides = (),
    *,
    label: str = "--set",
) -> Case:
    """A case from values in memory, or from a document (or part of one) with its positions.

    Parameters
    ----------
    mapping
        The case. It stays as it is.
    name, folder, overrides
        As in `parse_case`.
    label
        Heads the messages about overrides.
    """
    document = mapping if isinstance(mapping, Document) else Document(name, dict(mapping))
    document = apply_overrides(document, overrides, label=label)
    file, warnings = _checked(document)
    stem = Path(name.strip("<>")).stem or "case"
    return Case(stem, name, folder or Path(), file, warnings)


def _checked(document: Document) -> tuple[CaseFile, tuple[str, ...]]:
    """The validated file and its warnings; all faults are raised together."""
    check = schema_check(CaseFile, document)
    draft = Draft(document, check)
    found = [fault for rule in RULES for fault in rule(draft)]
    faults = [*check.faults, *found]
    document.refuse(fault for fault in faults if not check.meant.intersection(fault.needs))
    file = CaseFile.model_validate(document.content)
    document.refuse(_model_faults(file, document))
    ignored = ignored_keys(draft)
    return file, (ignored_text(ignored),) if ignored else ()


def _model_faults(file: CaseFile, document: Document) -> list[Fault]:
    try:
        return [*restitution_rule(file, document), *release_rule(file)]
    except ValueError as error:
        return [Fault(("podium",), f"podium: {error}", at_key=True)]
