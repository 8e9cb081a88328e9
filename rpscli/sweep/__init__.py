"""Studies: many histories, resumable.

What users need of them is in `rpscli.studies`, and by these names here too.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_PUBLIC = ("Study", "StudyResult", "load_study")


def __getattr__(name: str) -> Any:
    """A public name, imported when it is wanted: it stands above this layer."""
    if name in _PUBLIC:
        return getattr(import_module("rpscli.studies"), name)
    raise AttributeError(f"module 'rpscli.sweep' has no attribute {name!r}")
