"""A case that may have faults: what is written, and what of it is sound."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import TypeVar

from pydantic import ValidationError

from rpscli.case.build import Shape, shape_of
from rpscli.case.schema.case_file import (
    AcrossSection,
    BearingSection,
    CaseFile,
    DeviceSection,
    PlanSection,
    PodiumMasses,
    SuperstructureSection,
)
from rpscli.case.schema.check import SchemaCheck
from rpscli.case.schema.fields import Section
from rpscli.case.text.document import MISSING, Document, Fault, Path, dotted

SectionT = TypeVar("SectionT", bound=Section)

SUPERSTRUCTURE: Path = ("superstructure",)
PODIUM: Path = ("podium",)
BEARING: Path = ("podium", "bearing")
IMPACT: Path = ("podium", "impact")
CONTACT: Path = ("podium", "contact")
PLAN: Path = ("podium", "plan")
DEVICES: Path = ("podium", "devices")
LIMITS: Path = ("limits",)


@dataclass(frozen=True, eq=False)
class PartialCase:
    """Sections of a case as far as they can be read.

    A section is None if a key that it cannot be without is missing or faulty; a faulty value is
    None inside its section, though `has` knows that it is written. So rules about presence and
    rules about values can both be examined in a file that has other faults.
    """

    document: Document
    check: SchemaCheck[CaseFile]

    def has(self, path: Path) -> bool:
        """Whether a key is written, or an unknown key was taken for it."""
        return self.document.has(path) or path in self.check.suggested

    def is_mapping(self, path: Path) -> bool:
        """Whether a mapping is written at a path."""
        return isinstance(self.document.at(path), dict)

    def present(self, parent: Path, *names: str) -> list[str]:
        """Those of the keys below a parent that are written, in the order given."""
        return [name for name in names if self.has((*parent, name))]

    def written(self, parent: Path, *names: str) -> list[str]:
        """Those of the keys below a parent that are written under their very names."""
        return [name for name in names if self.document.has((*parent, name))]

    def missing(self, path: Path, meaning: str) -> Iterator[Fault]:
        """A fault if a key is not written."""
        if not self.has(path):
            text = f"{dotted(path)} is missing: {meaning}"
            yield Fault(path, text, at_key=True, needs=(path,))

    def where(self, path: Path) -> str:
        """Place of a key for a message, in brackets."""
        return self.document.where(path)

    def _section(self, model: type[SectionT], path: Path) -> SectionT | None:
        """Of the case as it was read; of a case with faults, what its sound values make."""
        if self.check.read is not None:
            section: SectionT = attrgetter(".".join(map(str, path)))(self.check.read)
            return section
        sound = Document(self.document.name, self.check.sound)
        values = {name: sound.at((*path, name)) for name in model.model_fields}
        try:
            return model.model_validate({k: v for k, v in values.items() if v is not MISSING})
        except ValidationError:
            return None

    @cached_property
    def superstructure(self) -> SuperstructureSection | None:
        """The section `superstructure`."""
        return self._section(SuperstructureSection, SUPERSTRUCTURE)

    @cached_property
    def across(self) -> AcrossSection | None:
        """The section `superstructure.y`."""
        return self._section(AcrossSection, (*SUPERSTRUCTURE, "y"))

    @cached_property
    def masses(self) -> PodiumMasses | None:
        """The masses of the section `podium`."""
        return self._section(PodiumMasses, PODIUM)

    @cached_property
    def plan(self) -> PlanSection | None:
        """The section `podium.plan`."""
        return self._section(PlanSection, PLAN) if self.is_mapping(PLAN) else None

    @cached_property
    def bearing(self) -> BearingSection | None:
        """The section `podium.bearing`."""
        return self._section(BearingSection, BEARING)

    def device(self, index: str | int) -> DeviceSection | None:
        """The device at an index of `podium.devices`, or None if it cannot be read."""
        try:
            return DeviceSection.model_validate(self.document.at((*DEVICES, index)))
        except ValidationError:
            return None

    @cached_property
    def shape(self) -> Shape | None:
        """Shape of the column, or None if it is not described completely."""
        return shape_of(self.bearing) if self.bearing else None

    @cached_property
    def storeys(self) -> int | None:
        """Number of storeys, or None if that cannot be read."""
        return self.superstructure.storeys if self.superstructure else None
