"""A slab that turns: its columns as a table, files, and words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.twist import TwistResult
from rpscli.report.table import Column, Table, shown

DEPENDS = (
    "the turn depends on podium.twist.pivot_friction, scatter and"
    " superstructure.torsion.eccentricity, whose sizes, signs and places are not known: run"
    " both signs and five seeds"
)
DEPENDS_WITHOUT_SCATTER = (
    "the turn depends on podium.twist.pivot_friction and"
    " superstructure.torsion.eccentricity, whose sizes and signs are not known: run both"
    " signs"
)
"""Of ends without a flat part, whose slenderness does not scatter."""

OF_WHICH_SLAB = (
    "the podium is followed twice, as its slab turns and as if it did not, and both are"
    " chaotic: max_rotation, rotation_ratio and max_corner_displacement are the larger of"
    " both; all other demands, cap beam displacement and forces of columns among them, are"
    " those without a turn"
)

MOST_COLUMNS = 16
"""Columns up to which each has a row in a terminal; of more, those that move most."""


def twist_parts(result: TimeHistoryResult) -> Iterator[Table | str]:
    """The slab's turn, a row each column, and what all of it depends on."""
    twist = result.twist
    if twist is None:
        return
    factor = twist.corner_factor
    told = "" if factor is None else f": {shown(factor)} times as far"
    centre = shown(1e3 * twist.max_centre_displacement)
    farthest = shown(1e3 * twist.max_corner_displacement)
    # Its history ends by itself, often later than that without a turn.
    end = shown(float(twist.time[-1]))
    yield (
        f"the slab turns by {shown(1e3 * twist.max_twist)} mrad at most, by"
        f" {shown(1e3 * twist.residual_twist)} mrad where its own history ends, at {end}"
        f" s; its column that moves most moves {farthest} mm, its centre {centre} mm{told}"
    )
    yield columns_table(twist)
    count = len(twist.run.columns)
    if count > MOST_COLUMNS:
        yield (
            f"{MOST_COLUMNS} of {count} columns, those that move most; all are in"
            " columns.csv and the JSON document"
        )
    if twist.structure.twist and twist.structure.twist.seats is not None:
        yield (
            "N is the weight on a column and what its seat takes of the warped slab,"
            " without the overturning moment of the building"
        )
    yield OF_WHICH_SLAB
    yield depends(twist)


def depends(twist: TwistResult) -> str:
    """What the turn depends on that is not known."""
    spherical = twist.structure.bearing.is_spherical
    return DEPENDS_WITHOUT_SCATTER if spherical else DEPENDS


def columns_table(twist: TwistResult) -> Table:
    """Columns by their places, those that move most first where there are many."""
    order = np.argsort(-twist.run.columns["max_u"], kind="stable")
    if len(order) <= MOST_COLUMNS:
        order = np.arange(len(order))
    order = order[:MOST_COLUMNS]
    columns = twist.run.columns[order]
    numbers = {
        "x m": columns["x"],
        "y m": columns["y"],
        "slenderness times": twist.run.factors[order],
        "u mm": 1e3 * columns["max_u"],
        "rotation ratio": columns["max_tilt"] / twist.run.critical[order],
    }
    of = twist.structure
    if of.twist and of.twist.seats is not None:
        numbers["least N kN"] = 1e-3 * columns["least_load"]
        numbers["largest N kN"] = 1e-3 * columns["most_load"]
    if of.bearing.is_spherical:
        del numbers["slenderness times"]
    else:
        numbers["passes"] = columns["passes"]
    cells = [[f"{i + 1}" for i in order.tolist()]]
    cells += [[*map(shown, each.tolist())] for each in numbers.values()]
    return Table.of_texts(("column", *numbers), [*zip(*cells, strict=True)], words=0)


def twist_document(twist: TwistResult | None) -> dict[str, Any] | None:
    """Energies, columns and what was taken, SI units; None where the slab does not
    turn.
    """
    if twist is None:
        return None
    columns = {name: values.tolist() for name, _, values in twist.by_column()}
    return {
        "outcome": twist.outcome,
        "max_centre_displacement": twist.max_centre_displacement,
        "worst_column": twist.worst_column,
        "energy": twist.energies,
        "columns": columns,
        "depends": depends(twist),
    }


def twist_columns(twist: TwistResult) -> list[Column]:
    """`columns.csv`: one row a column."""
    return [Column(*of) for of in twist.by_column()]


def way_columns(twist: TwistResult) -> list[Column]:
    """`twist.csv`: the slab's ways at the samples."""
    u_x, u_y, psi = twist.ways.T
    named = (("time", "s", twist.time), ("u_x", "m", u_x), ("u_y", "m", u_y))
    return [Column(*of) for of in (*named, ("psi", "rad", psi))]
