"""Design files: how they are known."""

from __future__ import annotations

from rpscli.case.text.file_kinds import FileKind

DESIGN = FileKind(frozenset({"variables", "find"}), "rpscli.tools.design.keys:DesignFile")
