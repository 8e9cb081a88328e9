"""The shape of a column, whichever way the case describes it."""

from __future__ import annotations

import math
from typing import NamedTuple

from rpscli.case.schema import BearingSection, DimensionsSection


class Shape(NamedTuple):
    """Ratios of a column; `wedge_slenderness` equals `slenderness` where flat ends leave it out."""

    semi_diagonal: float
    slenderness: float
    wedge_slenderness: float
    curvature_ratio: float


def critical_curvature_ratio(slenderness: float, wedge_slenderness: float) -> float:
    """What the word `critical` stands for: rho_cr = (1 - tan(alpha)/tan(alpha'))/2.

    First order, as in the paper's Eq. 1 (Theory, section 9).

    >>> critical_curvature_ratio(0.15, 0.30)
    0.25
    """
    return 0.5 * (1.0 - slenderness / wedge_slenderness)


def shape_of(bearing: BearingSection) -> Shape | None:
    """The shape, or None if the description is not complete."""
    if bearing.dimensions is not None:
        return _shape_of_dimensions(bearing.dimensions)
    R, flat, wedge = bearing.semi_diagonal, bearing.slenderness, bearing.wedge_slenderness
    rho = bearing.curvature_ratio
    if R is None or flat is None or rho is None or (wedge is None and rho != 0.0):
        return None
    if wedge is None:
        wedge = flat
    if isinstance(rho, str):
        rho = critical_curvature_ratio(flat, wedge)
    return Shape(R, flat, wedge, rho)


def _shape_of_dimensions(sizes: DimensionsSection) -> Shape | None:
    if sizes.wedge_width is None and sizes.radius != 0.0:
        return None
    wedge = sizes.width if sizes.wedge_width is None else sizes.wedge_width
    h = sizes.height
    return Shape(0.5 * math.hypot(h, sizes.width), sizes.width / h, wedge / h, sizes.radius / h)
