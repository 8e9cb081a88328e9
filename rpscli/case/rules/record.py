"""What the keys of `record` must be together."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.case.rules.partial_case import PartialCase
from rpscli.case.text.document import MISSING
from rpscli.case.text.faults import Fault, Path

SCALE: Path = ("record", "scale")
SCALE_TO: Path = ("record", "scale_to")


def record_rules(case: PartialCase) -> Iterator[Fault]:
    """A record has a factor, or a measure that fixes the factor."""
    written = case.document.at(SCALE)
    if case.document.has(SCALE_TO) and written is not MISSING and written != 1.0:
        text = f"record.scale_to and record.scale{case.where(SCALE)} both fix the factor"
        yield Fault(SCALE_TO, f"{text}; keep one of them", at_key=True)
