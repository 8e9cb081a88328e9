"""Which peers are here."""

from __future__ import annotations

import importlib

from benchmarks.tables import say


def installed(module: str) -> bool:
    """Whether a peer can be imported; says so at once if not, with the first cause.

    OpenSeesPy answers a missing system library by a RuntimeError that does not name it.
    """
    try:
        importlib.import_module(module)
    except (ImportError, OSError, RuntimeError) as error:
        cause: BaseException = error
        while cause.__context__ is not None:
            cause = cause.__context__
        say(f"{module} is left out: {cause} (pip install -e '.[bench]' brings all)")
        return False
    return True
