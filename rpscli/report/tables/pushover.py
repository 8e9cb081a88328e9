"""CSV tables of the static characteristics."""

from __future__ import annotations

import numpy as np

from rpscli.analyses.pushover import CapacityCurve, StoreyCurve
from rpscli.analyses.result_quantities import STOREY_CURVE
from rpscli.report.table import Column


def storey_curve_columns(curve: StoreyCurve) -> list[Column]:
    """`storey_curve.csv`: one row a point, from the uplift on."""
    return [Column(q.name, q.unit, getattr(curve, q.name)) for q in STOREY_CURVE]


def capacity_columns(curves: tuple[CapacityCurve, ...]) -> list[Column]:
    """`capacity.csv`: the points of one load pattern after those of the other."""
    names = [curve.pattern for curve in curves for _ in curve.sum_of_floor_forces]
    return [
        Column("pattern", "-", names),
        Column("roof_displacement", "m", np.concatenate([c.roof_displacement for c in curves])),
        Column(
            "cap_beam_displacement", "m", np.concatenate([c.cap_beam_displacement for c in curves])
        ),
        Column("sum_of_floor_forces", "N", np.concatenate([c.sum_of_floor_forces for c in curves])),
    ]
