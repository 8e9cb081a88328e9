"""The case that `rps init` writes."""

from __future__ import annotations

from importlib import resources


def starter_text() -> str:
    """A commented case that is valid as it stands."""
    return resources.files("rpscli.case").joinpath("starter.yaml").read_text(encoding="utf-8")
