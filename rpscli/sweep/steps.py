"""Points of a study whose results depend on the length of steps.

Steps keep their error, and yet a motion that decides between two futures by less goes another way
with other steps. No cheap sign tells such points from others, so that points are computed again:
all of a small study, and of a large one as many at even distances, which tell how common it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rpscli.analyses.demand import WORTH_LANES, demands
from rpscli.analyses.kernels.compilation import is_ready
from rpscli.analyses.largest_demands import Demand
from rpscli.physics.state import LANES
from rpscli.sweep.table import Table

MOST = 64
"""Points that are computed again."""

PROMISED = 1e-4
"""Of the largest rotation and base shear: what steps keep where motions converge."""

NAMED = 5


def step_notes(table: Table) -> Iterator[str]:
    """Remarks on points that change with steps of half the length; nothing if none does."""
    layout, known = table.layout, np.flatnonzero(~table.failed)
    some = known[:: max(-(-len(known) // MOST), 1)].tolist()
    requests = [layout.context.history(layout[number]) for number in some]
    lanes = LANES if len(requests) >= WORTH_LANES else 1
    if not all(is_ready(1 if of.motion.y is None else 2, lanes) for of in requests):
        yield (
            "steps: whether points change with steps of half the length was not tried: all of them"
            " were stored before, and the kernel that computes them is not compiled yet"
        )
        return
    finer = [
        replace(of, settings=replace(of.settings, accuracy=2.0 * of.settings.accuracy))
        for of in requests
    ]
    names = [
        f"{number + 1} ({changed})"
        for number, after in zip(some, demands(finer), strict=True)
        if (changed := _changes(table, number, after))
    ]
    if names:
        more = f" and {len(names) - NAMED} more" * (len(names) > NAMED)
        yield (
            f"steps: of {len(some)} points (of {len(known)}) computed again with steps of half the"
            f" length {len(names)} changed: point {', '.join(names[:NAMED])}{more}. There the"
            " motion decides by less than a step keeps: judge by many records"
        )


def _changes(table: Table, number: int, after: Demand) -> str:
    """Changes of a point with shorter steps, in words; empty if there are none."""
    if (outcome := table.outcomes[number]) != after.outcome:
        return f"{outcome} or {after.outcome}".replace("_", " ")
    parts = []
    for name in ("max_rotation", "max_base_shear"):
        old, new = float(table.columns[name][number]), getattr(after, name)
        if abs(new - old) > PROMISED * max(old, new):
            parts.append(f"{name} {abs(new - old) / max(old, new):.2g} of it")
    return ", ".join(parts)
