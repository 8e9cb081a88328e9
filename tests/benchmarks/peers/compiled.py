"""numba as the peers use it: contraction and reassociation allowed, nothing kept on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """Compile at the first call."""
    result: Any = numba.njit(function, fastmath={"contract", "reassoc"})
    return cast("Function", result)
