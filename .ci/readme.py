"""README.md for the package index, where a link cannot lead to the file beside it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

PICTURES = {".png", ".svg", ".gif"}


class Readme(MetadataHookInterface):
    """Links to files of the repository become links to them in the version that is built."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Put the text into the metadata of the package."""
        source = metadata["urls"]["Source"]
        tag = f"v{metadata['version']}"

        def absolute(link: re.Match[str]) -> str:
            kind = "raw" if Path(link[1]).suffix in PICTURES else "blob"
            return f"]({source}/{kind}/{tag}/{link[1]}"

        text = Path(self.root, "README.md").read_text("utf-8")
        text = re.sub(r"\]\((?!https?:|#|mailto:)([^)#\s]+)", absolute, text)
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
