"""The systems of a study in order: the product of its axes, and of the sample at the end."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rpscli.case.study.axes import Values
from rpscli.case.study.study import Study
from rpscli.case.text.document import Place
from rpscli.frozen import Frozen
from rpscli.sweep.points.sampling import Array, sample


@dataclass(frozen=True, eq=False)
class Combinations(Frozen):
    """Values of the varied and sampled keys of each system.

    Parameters
    ----------
    study
        Whose axes they are.
    drawn
        The sample, (size, keys); (1, 0) if nothing is sampled.
    """

    study: Study
    drawn: Array

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes and of the sample."""
        return (*(len(axis.rows) for axis in self.study.axes), len(self.drawn))

    @cached_property
    def keys(self) -> tuple[str, ...]:
        """Varied keys, then sampled ones."""
        varied = tuple(key for axis in self.study.axes for key in axis.keys)
        return varied + self._sampled

    @cached_property
    def _sampled(self) -> tuple[str, ...]:
        section = self.study.file.sample
        return tuple(section.ranges) if section else ()

    def values(self, system: int) -> Values:
        """Values of the keys of a system."""
        rows = self._rows(system)
        varied = (axis.rows[row] for axis, row in zip(self.study.axes, rows, strict=True))
        drawn = self.drawn[system % len(self.drawn)]
        return (*itertools.chain.from_iterable(varied), *drawn.tolist())

    def places(self, system: int) -> tuple[Place, ...]:
        """Where the study wrote the values of a system."""
        rows = self._rows(system)
        varied = (
            axis.place(key, row)
            for axis, row in zip(self.study.axes, rows, strict=True)
            for key in range(len(axis.keys))
        )
        document = self.study.document
        drawn = (document.value_place(("sample", "ranges", key)) for key in self._sampled)
        return (*varied, *drawn)

    def _rows(self, system: int) -> list[int]:
        """Place of a system along each axis; the last one runs fastest."""
        rest = system // len(self.drawn)
        rows = []
        for axis in reversed(self.study.axes):
            rest, row = divmod(rest, len(axis.rows))
            rows.append(row)
        return rows[::-1]


def combinations_of(study: Study) -> Combinations:
    """The systems of a study."""
    section = study.file.sample
    return Combinations(study, sample(section) if section else np.empty((1, 0)))
