"""The rows of conformance.json, each a number beside what an authority expects, and which
of them an installation computes again.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rpscli.analyses.known_systems import NUMBERS
from rpscli.analyses.verification import Key

DATA = Path(__file__).parents[1] / "conformance.json"


@dataclass(frozen=True)
class Row:
    """What is expected of a quantity, by which authority, and what the tests found.

    Of a curve, which has a `count` of numbers, it is the one that uses most of its tolerance.
    """

    capability: str
    quantity: str
    expected: float
    computed: float
    tolerance: float
    share: float
    count: int
    authority: str
    source: str
    test: str


@dataclass(frozen=True)
class Recomputed:
    """A row and its number by this installation; NaN where it is missing."""

    row: Row
    computed: float

    @property
    def share(self) -> float:
        """Of the tolerance."""
        return abs(self.computed - self.row.expected) / self.row.tolerance

    @property
    def holds(self) -> bool:
        """True within the tolerance; what is not a number never is."""
        return self.share <= 1.0

    @property
    def verdict(self) -> str:
        """In a word."""
        return "agrees" if self.holds else "DIFFERS"

    def document(self) -> dict[str, object]:
        """The row with the number of this installation."""
        here = {"computed": self.computed, "share": self.share, "holds": self.holds}
        return asdict(self.row) | here


def known_rows() -> list[Row]:
    """Rows that have numbers; those of the authority "none" say that there is none."""
    document = json.loads(DATA.read_text(encoding="utf-8"))
    cells = [dict(zip(document["columns"], row, strict=True)) for row in document["rows"]]
    return [Row(**each) for each in cells if each["authority"] != "none"]


def named(key: Key) -> str:
    """The row of an answer to a certified problem."""
    return ": ".join(key)


def own_numbers(certified: Mapping[Key, Sequence[float]]) -> Iterator[tuple[str, float]]:
    """Names and numbers of all rows that need no test: answers given, and known
    systems.
    """
    yield from ((named(key), values[-1]) for key, values in certified.items() if values)
    for numbers in NUMBERS:
        yield from numbers()


def recomputed(certified: Mapping[Key, Sequence[float]]) -> list[Recomputed]:
    """The rows that this installation computes again, in the order of the file."""
    own = dict(own_numbers(certified))
    return [
        Recomputed(row, own[row.quantity]) for row in known_rows() if row.quantity in own
    ]
