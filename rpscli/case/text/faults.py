"""Faults of an input file, and how they are named: place, value, rule, remedy."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

Path = tuple[str | int, ...]
"""Where a value stands inside a document: keys, and indices of lists counted from 0."""


def _cut(override: str) -> str:
    """The `--set` that brought a value in, or a name, without most of a long value."""
    return override if len(override) <= 160 else f"{override[:157]}..."


@dataclass(frozen=True)
class Place:
    """Where a key or a value was written.

    Parameters
    ----------
    source
        The file as the user named it, or the ``--set`` that brought the value in.
    line, column
        Counted from 1; 0 where there is no text to point at.
    rank
        Order among sources: 0 is the file, overrides follow in the order given.
    """

    source: str
    line: int = 0
    column: int = 0
    rank: int = 0

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}" if self.line else _cut(self.source)

    @property
    def short(self) -> str:
        """The place as a second one in a message: ``line 14``, or the source."""
        return f"line {self.line}" if self.line else _cut(self.source)


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong.

    Parameters
    ----------
    path
        What it is about; it is reported at this path's place, or its nearest parent's.
    text
        Value, rule and remedy, complete.
    at_key
        Point at the key rather than at the value.
    needs
        Paths any of which would cure the fault. If a misspelled key was meant to be one of
        them, the misspelling is the fault and this one is not reported.
    place
        Where, if the path alone cannot tell (the second of two equal keys).
    """

    path: Path
    text: str
    at_key: bool = False
    needs: tuple[Path, ...] = ()
    place: Place | None = None


def dotted(path: Path) -> str:
    """A path as the user writes it, long keys cut.

    >>> dotted(("superstructure", "storey_mass", 0))
    'superstructure.storey_mass.0'
    """
    return ".".join(part if len(part) <= 60 else f"{part[:57]}..." for part in map(str, path))


def shown(value: object, width: int = 60) -> str:
    """A value as it goes into a message: text in quotes, long ones cut.

    >>> shown("200 t"), shown(0.5), shown(None), shown(True)
    ("'200 t'", '0.5', 'null', 'true')
    """
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if isinstance(value, dict):
        text = "{" + ", ".join(f"{key}: {shown(item)}" for key, item in value.items()) + "}"
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(shown(item) for item in value) + "]"
    else:
        text = repr(value) if isinstance(value, str | int | float) else str(value)
    return text if len(text) <= width else f"{text[: width - 3]}..."


def listed(words: Iterable[str], last: str = "or") -> str:
    """Words as an enumeration.

    >>> listed(["sine", "uniform", "linear"])
    'sine, uniform or linear'
    """
    *head, tail = words
    return f"{', '.join(head)} {last} {tail}" if head else tail
