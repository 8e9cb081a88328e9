"""Engines: who computes the batches of a study."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol

from rpscli.sweep.evaluation.points import Point
from rpscli.sweep.evaluation.results import PointResults

Computed = tuple[list[Point], PointResults]
"""A batch of points with its results."""


class Engine(Protocol):
    """Computes batches somewhere, several at a time."""

    @property
    def jobs(self) -> int:
        """How many batches are computed at a time."""

    def outcomes(self, batches: Iterable[list[Point]]) -> Iterator[Computed]:
        """The batches with their results, as they come.

        A batch is taken from the iterable only when somebody is there to compute it. When the
        iterable ends, the batches under way are waited for; every batch comes back once.
        """
