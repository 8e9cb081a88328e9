"""The key `observed` of studies."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rpscli.case.schema.fields import Text
from rpscli.case.study.tool_key import ToolKey

if TYPE_CHECKING:
    from rpscli.case.text.document import Document
    from rpscli.tools.comparison.observed import Observed


def observations(
    name: str | None, folder: Path, axes: Sequence[Any], document: Document
) -> Observed | None:
    """The observations that a study names."""
    from rpscli.tools.comparison.observed import read_observed

    return read_observed(name, folder, axes, document)


OBSERVED = ToolKey(
    Text | None,
    "CSV file of what was observed under records; for the report comparison",
    observations,
)
