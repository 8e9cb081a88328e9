"""Which solver made a result: results of two versions are never mixed."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib import metadata
from pathlib import Path

import rpscli

SOLVING = ("physics", "model", "analyses")
"""Folders of the package whose sources decide about the numbers."""


@cache
def solver_version() -> str:
    """Version of rps and a digest of the sources that compute."""
    try:
        version = metadata.version("rpscli")
    except metadata.PackageNotFoundError:
        version = "0+unknown"
    digest = hashlib.sha256()
    root = Path(rpscli.__file__).parent
    for folder in SOLVING:
        for source in sorted((root / folder).glob("*.py")):
            digest.update(source.read_bytes())
    return f"{version}+{digest.hexdigest()[:16]}"
