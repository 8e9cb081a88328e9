"""Objects whose arrays stay as they are, and how they show themselves:
in a line, in a notebook.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from html import escape
from numbers import Real
from typing import Any, TypeVar, cast

import numpy as np

Value = TypeVar("Value")


def frozen(value: Value) -> Value:
    """The value with its arrays read-only, those inside tuples and mappings too.

    >>> frozen(np.zeros(2)).flags.writeable
    False
    """
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(
        value, np.void
    ):  # a record, as writable as the array that it is an entry of
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
        # Copies of arrays are writable; what was cached beside the fields is copied as
        # well.
        vars(self).update(frozen(state))


IN_A_LINE = 6  # facts that stand in a line; a notebook has them all
LONGEST_LIST = 4
LONGEST_TEXT = 60


class Shown(Frozen):
    """Base of dataclasses that hold too many numbers to be printed whole."""

    def facts(self) -> Mapping[str, Any]:
        """Properties that tell it from others, the most important
        first; fields by default.
        """
        return {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]

    def __repr__(self) -> str:
        facts = list(self.facts().items())
        inside = [f"{name}={fact_text(value)}" for name, value in facts[:IN_A_LINE]]
        return f"{type(self).__name__}({', '.join([*inside, *['...'] * (len(facts) > IN_A_LINE)])})"

    def _repr_html_(self) -> str:
        """A table for notebooks."""
        cells = [
            (escape(str(name)), escape(fact_text(of)))
            for name, of in self.facts().items()
        ]
        rows = "".join(f"<tr><th>{name}</th><td>{of}</td></tr>" for name, of in cells)
        return f"<table><caption>{type(self).__name__}</caption>{rows}</table>"


def data_frame(columns: Mapping[str, Any]) -> Any:
    """Columns as a table of pandas; of numbers that are not there NaN, not None."""
    try:
        import pandas as pd  # not everybody has it
    except ImportError:
        raise ImportError("to_dataframe needs pandas: pip install pandas") from None
    return pd.DataFrame({name: _numbers(values) for name, values in columns.items()})


def _numbers(values: Any) -> Any:
    """Values as they are; numbers beside None as an array with NaN."""
    if getattr(values, "dtype", None) != np.dtype(object):
        return values
    given = [value for value in values if value is not None]
    numbers = (isinstance(each, Real) and not isinstance(each, bool) for each in given)
    if len(given) == len(values) or not given or not all(numbers):
        return values
    return [math.nan if value is None else float(value) for value in values]


def fact_text(value: Any) -> str:
    """A value in a few letters.

    >>> fact_text(0.36127), fact_text(None), fact_text([1.0, 2.0]), fact_text([1] * 50)
    ('0.3613', '-', '[1, 2]', '50 values')
    """
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, str):
        return value if len(value) <= LONGEST_TEXT else f"{value[: LONGEST_TEXT - 3]}..."
    if (shape := getattr(value, "shape", ())) or isinstance(value, list | tuple):
        sizes = shape or (len(value),)
        if len(sizes) == 1 and sizes[0] <= LONGEST_LIST:
            return f"[{', '.join(map(fact_text, value))}]"
        return f"{' x '.join(map(str, sizes))} values"
    return "-" if value is None else str(value)


def with_unit(value: object, unit: str) -> str:
    """A value and its unit.

    >>> with_unit(0.10643, "rad"), with_unit(7, "-"), with_unit(None, "m")
    ('0.1064 rad', '7', '-')
    """
    text = fact_text(value)
    return text if value is None or unit in {"", "-"} else f"{text} {unit}"
