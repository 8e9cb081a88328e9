"""Which code made a stored number: results of two versions are never mixed."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib import metadata
from pathlib import Path

SOLVING = ("constants.py", "physics", "model", "records", "analyses", "case", "sweep/evaluation")
"""Files and folders of the package whose sources decide about what is stored under a key."""


@cache
def solver_version() -> str:
    """Version of rps and a digest of the sources that compute."""
    try:
        version = metadata.version("rpscli")
    except metadata.PackageNotFoundError:
        version = "0+unknown"
    return f"{version}+{digest_of_sources(Path(__file__).parents[2])[:16]}"


def digest_of_sources(package: Path) -> str:
    """SHA-256 of the names and contents of all sources that compute, in sub-folders too."""
    digest = hashlib.sha256()
    for name in SOLVING:
        place = package / name
        for source in [place] if place.is_file() else sorted(place.rglob("*.py")):
            digest.update(f"{source.relative_to(package).as_posix()}\0".encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()
