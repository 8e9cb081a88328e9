"""Arrays that nobody changes by accident: read-only where they are made, and in every copy."""

from __future__ import annotations

from typing import Any, TypeVar, cast

import numpy as np

Value = TypeVar("Value")


def frozen(value: Value) -> Value:
    """The same value, its arrays read-only, those inside tuples and mappings too.

    >>> frozen(np.zeros(2)).flags.writeable
    False
    """
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, np.void):  # a record, as writable as the array that it is an entry of
        return cast("Value", frozen(np.array(value))[()])
    elif isinstance(value, tuple):
        for part in value:
            frozen(part)
    elif isinstance(value, dict):
        value.update({name: frozen(part) for name, part in value.items()})
    return value


class Frozen:
    """Base of dataclasses whose arrays are read-only, also after `copy` and `pickle`."""

    def __post_init__(self) -> None:
        frozen(vars(self))

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Copies of arrays are writable; what was cached beside the fields is copied as well.
        vars(self).update(frozen(state))
