"""How a slab on rows of columns turns about the vertical: what seeds it, what resists
it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from rpscli.errors import require_fields, told

Podium = Any
"""`PodiumStructure`, which imports this."""

FOLLOWED = frozenset({"viscous", "friction"})
"""Kinds of devices that a slab that turns may have."""

LARGEST_SCATTER = 0.2
"""Of the slenderness, as a standard deviation: beyond it columns are of several kinds."""

DRAWN_WITHIN = 3.0
"""Standard deviations; what is drawn beyond them is drawn again."""

LEAST_SEAT = 2e-4
"""Sinking of seats below which loads depend on micrometres [m]."""


@dataclass(frozen=True)
class Twist:
    """A slab whose columns each follow their own head (Theory, section 17).

    Parameters
    ----------
    scatter
        Standard deviation of the slenderness of columns, over the mean: drawn normally.
    seed
        Of the drawing.
    factors
        On the slenderness, one a column, row by row from the first in y; in place of
        `scatter`.
    pivot_friction
        Lever by which friction resists the pivoting of ends, times the weight [m].
    seats
        Sinking of the slab at a column under its weight at rest [m]; None: it warps
        freely.
    period_ratio
        First period in x over that of the storeys in twist, both uncoupled.
    eccentricity
        Of the centre of stiffness of every storey from that of mass, over the plan's
        lengths in x and y.

    Raises
    ------
    ValueError
        For values outside the model.

    Examples
    --------
    >>> Twist(scatter=0.02, seed=1).factors_of(4).round(3).tolist()
    [1.007, 1.016, 1.007, 0.974]
    """

    scatter: float = 0.0
    seed: int = 1
    factors: tuple[float, ...] = ()
    pivot_friction: float = 0.0
    seats: float | None = None
    period_ratio: float = 1.2
    eccentricity: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        """Refuse values outside the model."""
        require_fields(self)
        rules = {
            "scatter": (
                0.0 <= self.scatter <= LARGEST_SCATTER,
                f"from 0 to {LARGEST_SCATTER:g}",
            ),
            "factors": (
                all(0.5 <= factor <= 2.0 for factor in self.factors),
                "between 0.5 and 2",
            ),
            "pivot_friction": (0.0 <= self.pivot_friction < math.inf, ">= 0"),
            "seats": (
                self.seats is None or LEAST_SEAT <= self.seats < math.inf,
                f"at least {1e3 * LEAST_SEAT:g} mm, or free",
            ),
            "period_ratio": (0.2 <= self.period_ratio <= 5.0, "between 0.2 and 5"),
            "eccentricity": (
                all(abs(part) <= 0.5 for part in self.eccentricity),
                "within half of the plan's lengths",
            ),
        }
        for name, (holds, rule) in rules.items():
            if not holds:
                raise ValueError(f"{name} = {told(getattr(self, name))} must be {rule}")
        if self.factors and self.scatter:
            raise ValueError("give factors or a scatter, not both; remove one of them")

    def factors_of(self, columns: int) -> np.ndarray:
        """(N,) factors on the slenderness of each column.

        Raises ValueError where `factors` are not so many.
        """
        if self.factors:
            if len(self.factors) != columns:
                raise ValueError(
                    f"factors are {len(self.factors)}, and the plan has {columns}"
                    " columns: give one a column, row by row"
                )
            return np.array(self.factors)
        draw = np.random.default_rng(self.seed)
        drawn = draw.standard_normal(columns)
        while (beyond := np.abs(drawn) > DRAWN_WITHIN).any():
            drawn[beyond] = draw.standard_normal(int(beyond.sum()))
        return np.asarray(1.0 + self.scatter * drawn)

    def refuse(self, structure: Podium) -> None:
        """Refuse a structure whose slab is not followed as it turns: raises ValueError."""
        if found := [*refusals(structure)]:
            raise ValueError(f"twist {'; and '.join(found)}")
        unequal = self.scatter > 0.0 or any(factor != 1.0 for factor in self.factors)
        if unequal and structure.bearing.is_spherical:
            name = "factors" if self.factors else "scatter"
            raise ValueError(
                f"{name} would change nothing: it multiplies the slenderness of the flat"
                " part, and these ends have none; leave it out"
            )
        self.factors_of(len(structure.rows) * len(structure.rows_y))


def refusals(structure: Podium) -> Iterator[str]:  # noqa: C901 -- a reason a line
    """Reasons why a slab cannot be followed as it turns; none if it can."""
    above = structure.superstructure
    law = structure.impact_law.kind
    if not (structure.rows and structure.rows_y):
        yield "needs places of columns: give podium.plan with rows and y.rows"
    count = len(structure.rows) * len(structure.rows_y)
    if structure.columns not in (1, count):
        yield f"podium.columns = {structure.columns} must be the {count} places of the plan"
    if structure.cap_beam_mass == 0.0:
        yield "needs a cap beam, which turns"
    if structure.contact.kind != "rigid":
        yield "is not followed on compliant ends (podium.contact); use kind: rigid"
    if above is not None and law != "flexible":
        yield f"has no form for the impact law {law} under a building; use flexible"
    if structure.yields:
        yield "is not followed with superstructure.yield; leave it out"
    if above is not None and above.vertical_period is not None:
        yield "is not followed with superstructure.vertical_period; leave it out"
    for device in structure.devices:
        if device.kind not in FOLLOWED:
            yield f"is not followed with a {device.kind}; leave it out"
        elif getattr(device, "exponent", 1.0) != 1.0:
            yield "is followed with viscous dampers of exponent 1 alone"
