"""Kinds of files that tools add to cases and studies, known by keys of their own."""

from __future__ import annotations

from typing import Any, NamedTuple

from rpscli.registry import all_of_tools, loaded


class FileKind(NamedTuple):
    """A kind of file that has a case at its base: `rps NAME FILE` runs it."""

    marks: frozenset[str]  # keys, of which every file of the kind has one
    format: str  # target of its pydantic model, slow to import

    @property
    def model(self) -> Any:
        """The pydantic model, imported now."""
        return loaded(self.format)


FILE_KINDS: dict[str, FileKind] = all_of_tools("files")
"""Those of all tools, by name."""
