"""Which peers are here."""

from __future__ import annotations

import importlib.util

from benchmarks.tables import say


def installed(module: str) -> bool:
    """Whether a peer can be imported; says so if not."""
    if importlib.util.find_spec(module) is not None:
        return True
    say(f"{module} is not installed and left out: pip install -e '.[bench]'")
    return False
