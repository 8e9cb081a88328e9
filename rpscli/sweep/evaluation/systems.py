"""Systems of a study: the base case with one set of values in place, ready to be analysed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.case import Case, case_from_mapping
from rpscli.model.podium import PodiumStructure
from rpscli.sweep.evaluation.points import Plan, Point, RecordRequest
from rpscli.sweep.evaluation.record_cache import Recent

SYSTEMS_KEPT = 512
"""Systems held in memory with their modes of vibration; the longest unused one goes first."""

DECIDING = ("superstructure", "podium", "analysis")
"""Sections of a resolved case on which results depend besides the record."""


@dataclass(frozen=True, eq=False)
class System:
    """One structure of a study and the settings of its analysis."""

    structure: PodiumStructure
    settings: TimeHistorySettings
    digest: bytes

    def perturbed(self, restitution_change: float) -> PodiumStructure:
        """The structure with its restitution times a factor; the building is shared."""
        if restitution_change == 1.0:
            return self.structure
        law = self.structure.impact_law
        changed = replace(law, factor=law.factor * restitution_change)
        return replace(self.structure, impact_law=changed)


def system_of(case: Case) -> System:
    """The system that a case describes."""
    return System(case.structure, case.analysis, digest_of(case.document))


def digest_of(document: Mapping[str, Any]) -> bytes:
    """Digest of everything in a resolved case that decides about results."""
    deciding = {name: document.get(name) for name in DECIDING}
    return hashlib.sha256(json.dumps(deciding, sort_keys=True).encode()).digest()


def record_request(case: Case) -> RecordRequest | None:
    """The case's own record."""
    if (record := case.record) is None:
        return None
    folder = str(case.folder)
    return RecordRequest(record.source, folder, record.vertical, record.dt, record.units)


def resolved(plan: Plan, values: Sequence[Any]) -> Case:
    """The case with values at the varied keys."""
    given = dict(zip(plan.keys, values, strict=True))
    return case_from_mapping(plan.base, plan.base_name, Path(plan.base_folder), given, label="vary")


class Systems:
    """The systems of a plan, resolved when they are first needed and kept for a while."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._recent: Recent[int, System] = Recent(SYSTEMS_KEPT)

    def __getitem__(self, point: Point) -> System:
        """The system of a point."""
        return self._recent.value(
            point.system, lambda: system_of(resolved(self._plan, point.values))
        )
