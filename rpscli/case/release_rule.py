"""A structure that is let go from a rotation must not have overturned already."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.builder import bearing
from rpscli.case.faults import Fault
from rpscli.case.rules_bearing import below
from rpscli.case.schema import CaseFile


def release_rule(file: CaseFile) -> Iterator[Fault]:
    """Refuse an initial rotation at or beyond the overturning limit, in a case without faults."""
    rotation = file.analysis.initial_rotation
    limit = file.analysis.overturning_limit * bearing(file.podium.bearing).critical_rotation
    if abs(rotation) >= limit:
        yield Fault(
            ("analysis", "initial_rotation"),
            f"analysis.initial_rotation = {rotation:g} rad must stay below the overturning limit,"
            f" overturning_limit * theta_cr = {limit:.6g} rad; use less than {below(limit)}",
        )
