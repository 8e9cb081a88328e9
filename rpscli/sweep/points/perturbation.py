"""Small perturbations: the same for every point, so that points can be compared."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rpscli.case.study.schema import PerturbSection


class Change(NamedTuple):
    """Factors on the record's scale and on the restitution."""

    scale: float
    restitution: float


UNCHANGED = Change(1.0, 1.0)


def changes(section: PerturbSection | None) -> tuple[Change, ...]:
    """The members of an ensemble; the first is the unperturbed one.

    Uniform within the given shares. More members leave the earlier ones as they are.
    """
    if section is None:
        return (UNCHANGED,)
    generator = np.random.default_rng(section.seed)
    drawn = generator.uniform(-1.0, 1.0, (section.members - 1, 2)).tolist()
    others = (Change(1.0 + section.scale * a, 1.0 + section.restitution * b) for a, b in drawn)
    return (UNCHANGED, *others)
