"""Which programs made a result."""

from __future__ import annotations

import platform


def program_version() -> str:
    """Version of rps; ``0+unknown`` where it runs from a source tree that is not installed."""
    return _installed("rpscli") or "0+unknown"


def versions() -> dict[str, str | None]:
    """Versions of rps, Python, numpy and numba, without importing any of them."""
    return {
        "rps": program_version(),
        "python": platform.python_version(),
        "numpy": _installed("numpy"),
        "numba": _installed("numba"),
    }


def _installed(package: str) -> str | None:
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None
