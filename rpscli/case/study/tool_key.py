"""Keys of studies that belong to tools."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rpscli.registry import all_of_tools

if TYPE_CHECKING:
    from rpscli.case.text.document import Document

Read = Callable[[Any, Path, Sequence[Any], "Document"], Any]
"""What a key's value says, from the value, the folder of the study, its axes and its
document, which refuses what is wrong."""


class ToolKey(NamedTuple):
    """A key that a tool adds to studies of histories."""

    kind: Any  # annotation; None stands for a key that is left out
    meaning: str
    read: Read


TOOL_KEYS: dict[str, ToolKey] = all_of_tools("keys")
"""Those of all tools, by name."""
