"""What a point of a study is, small enough to be sent anywhere, and which code computes it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from rpscli.case.study.schema import Analysis, MeasureScale
from rpscli.records.measures import USUAL, Of
from rpscli.records.recordings import Pair
from rpscli.records.source import Source
from rpscli.version import VERSION


class RecordRequest(NamedTuple):
    """A ground motion to be loaded, and where its relative names start.

    What is measured by a `pair` has both components of that. A second component `y` acts together
    with the source, as both of a source do that says so; they are turned by a rotation [deg].
    """

    source: str
    folder: str
    vertical: str | None = None
    dt: float | None = None
    units: str | None = None
    pair: Pair | None = None
    y: str | None = None
    rotation: float = 0.0

    @property
    def name(self) -> str:
        """The source, or both."""
        return self.source if self.y is None else f"{self.source} + {self.y}"

    @property
    def is_pair(self) -> bool:
        """Whether both horizontal components act."""
        return self.y is not None or Source.parse(self.source).both


class Point(NamedTuple):
    """One point.

    `number` is its place in the order of the study, from 0. `values` are those of the varied keys,
    in their order. `scale` is the factor on the record, or the value of the measure to scale it to;
    `period` is then the one of Sa and the like. The changes are factors of the perturbation, 1
    where there is none.
    """

    number: int
    system: int
    values: tuple[Any, ...]
    record: RecordRequest | None
    scale: float
    member: int
    scale_change: float
    restitution_change: float
    period: float | None


@dataclass(frozen=True)
class Plan:
    """Everything besides the points that a process needs to evaluate them."""

    analysis: Analysis
    """What is done at every point."""
    keys: tuple[str, ...]
    """Dotted keys of the values of a point."""
    base: dict[str, Any]
    """The case at the base, as plain values."""
    base_name: str
    base_folder: str
    """Where it comes from, for messages and relative file names."""
    measure: MeasureScale | None
    """What the records are scaled to, if not by factors."""
    whole: bool
    """Whether histories are followed with all their samples."""
    solver: str
    """Version of the solver that all results must come from."""

    @property
    def of(self) -> Of:
        """What measures of pairs are of."""
        return (self.measure and self.measure.of) or USUAL


SOLVING = (
    *("constants.py", "units.py", "registry.py", "physics", "model", "records", "analyses", "case"),
    "sweep/evaluation",
)
"""Files and folders of the package whose sources decide about what is stored under a key."""


@cache
def solver_version() -> str:
    """Version of rps and a digest of the sources that compute."""
    return f"{VERSION}+{digest_of_sources(Path(__file__).parents[2])[:16]}"


def digest_of_sources(package: Path) -> str:
    """SHA-256 of the names and contents of all sources that compute, in sub-folders too."""
    digest = hashlib.sha256()
    for name in SOLVING:
        place = package / name
        for source in [place] if place.is_file() else sorted(place.rglob("*.py")):
            digest.update(f"{source.relative_to(package).as_posix()}\0".encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()
