"""The systems of a study in order: the product of its axes, then its sample; perturbations."""

from __future__ import annotations

import itertools
import math
import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.case.study.axes import Values
from rpscli.case.study.schema import PerturbSection, RangeSection, SampleSection
from rpscli.case.study.study import Study
from rpscli.case.text.document import Place
from rpscli.shown import Frozen

Array = NDArray[np.float64]


def sample(section: SampleSection) -> Array:
    """The sample, (size, keys): scrambled Sobol or Latin hypercube, fixed by the seed."""
    unit = unit_cube(section, len(section.ranges))
    columns = [_values(unit[:, i], given) for i, given in enumerate(section.ranges.values())]
    return np.column_stack(columns)


def unit_cube(section: SampleSection, dimensions: int) -> Array:
    """(size, dimensions) of the section's sequence, in the unit cube."""
    from scipy.stats import qmc

    engine = {"sobol": qmc.Sobol, "latin_hypercube": qmc.LatinHypercube}[section.method]
    sequence: Any = engine(dimensions, seed=np.random.default_rng(section.seed))
    with warnings.catch_warnings():
        # Sobol sequences are balanced at powers of two; `balance_note` tells the user.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(sequence.random(section.size), dtype=np.float64)


def balance_note(section: SampleSection) -> str | None:
    """What the user should know about the size of a Sobol sample."""
    size = section.size
    if section.method != "sobol" or size & (size - 1) == 0:
        return None
    better = 1 << (size.bit_length() - 1)
    return f"sample.size = {size} is not a power of 2; Sobol samples are even at {better}"


def _values(unit: Array, given: RangeSection) -> Array:
    """One parameter from its place in the unit interval."""
    if given.low is not None and given.high is not None:
        return given.low + (given.high - given.low) * unit
    assert given.mean is not None, "the study's rules make sure that the moments are given"
    assert given.cov is not None, "the study's rules make sure that the moments are given"
    deviation = given.cov * abs(given.mean)
    if given.distribution == "uniform":
        return given.mean + math.sqrt(3.0) * deviation * (2.0 * unit - 1.0)
    normal = _normal_quantile(unit)
    if given.distribution == "normal":
        return given.mean + deviation * normal
    spread = math.sqrt(math.log1p(given.cov**2))
    median = given.mean / math.sqrt(1.0 + given.cov**2)
    return np.asarray(median * np.exp(spread * normal))


def _normal_quantile(unit: Array) -> Array:
    from scipy.special import ndtri

    # A scrambled sequence may hit zero, whose quantile is minus infinity.
    return np.asarray(ndtri(np.maximum(unit, 1e-16)))


class Change(NamedTuple):
    """Factors on the record's scale and on the restitution; a turn of pairs [deg]."""

    scale: float
    restitution: float
    rotation: float = 0.0


UNCHANGED = Change(1.0, 1.0)


def changes(section: PerturbSection | None) -> tuple[Change, ...]:
    """The members of an ensemble, uniform within the given shares; the first is unperturbed."""
    if section is None:
        return (UNCHANGED,)
    generator = np.random.default_rng(section.seed)
    drawn = generator.uniform(-1.0, 1.0, (section.members - 1, 2)).tolist()
    # A sequence of their own: more members leave the earlier ones.
    turning = np.random.default_rng([section.seed, 1])
    turns = (section.rotation * turning.uniform(-1.0, 1.0, section.members - 1)).tolist()
    others = (
        Change(1.0 + section.scale * a, 1.0 + section.restitution * b, turn)
        for (a, b), turn in zip(drawn, turns, strict=True)
    )
    return (UNCHANGED, *others)


@dataclass(frozen=True, eq=False)
class Combinations(Frozen):
    """Values of the varied and sampled keys of each system."""

    study: Study
    """Whose axes they are."""
    drawn: Array
    """The sample, (size, keys); (1, 0) if nothing is sampled."""

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
