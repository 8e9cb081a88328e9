"""A slab that turns: its columns as a table, files, and words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rpscli.analyses.results import TimeHistoryResult
from rpscli.analyses.twist import TwistResult
from rpscli.report.table import Column, Part, Table, shown

DEPENDS = (
    "the turn depends on podium.twist.pivot_friction, scatter and"
    " superstructure.torsion.eccentricity, whose sizes, signs and places are not known: run"
    " both signs and five seeds"
)

MOST_COLUMNS = 16
"""Columns up to which each has a row in a terminal; of more, those that move most."""


def twist_parts(result: TimeHistoryResult) -> Iterator[Part]:
    """The slab's turn, a row each column, and what all of it depends on."""
    twist = result.twist
    if twist is None:
        return
    factor = twist.corner_factor
    told = (
        "" if factor is None else f", {shown(factor)} times as far as the slab's centre"
    )
    yield (
        f"the slab turns by {shown(1e3 * twist.max_twist)} mrad at most, by"
        f" {shown(1e3 * twist.residual_twist)} mrad at the end; its column that moves most"
        f" moves {shown(twist.max_corner_displacement)} m{told}"
    )
    yield columns_table(twist)
    yield (
        "rotations above that have limits are those of the worst column; all other demands"
        " above are of the slab's centre alone, which does not turn"
    )
    yield DEPENDS


def columns_table(twist: TwistResult) -> Table:
    """Columns by their places, those that move most first where there are many."""
    order = np.argsort(-twist.run.columns["max_u"], kind="stable")
    if len(order) <= MOST_COLUMNS:
        order = np.arange(len(order))
    rows = []
    for i in order[:MOST_COLUMNS].tolist():
        column = twist.run.columns[i]
        rows.append([
            f"{i + 1}", shown(float(column["x"])), shown(float(column["y"])),
            shown(float(twist.run.factors[i])), shown(float(column["max_u"])),
            shown(float(column["max_tilt"] / twist.run.critical[i])),
            shown(1e-3 * float(column["least_load"])),
            shown(1e-3 * float(column["most_load"])), f"{column['passes']}",
        ])  # fmt: skip
    heads = (
        "column", "x m", "y m", "slenderness times", "u m", "rotation ratio", "least N kN",
        "largest N kN", "passes",
    )  # fmt: skip
    return Table.of_texts(heads, rows, words=0)


def twist_document(twist: TwistResult | None) -> dict[str, Any] | None:
    """Energies, columns and what was taken, SI units; None where the slab does not turn."""
    if twist is None:
        return None
    columns = {name: values.tolist() for name, _, values in twist.by_column()}
    return {
        "outcome": twist.outcome,
        "max_centre_displacement": twist.max_centre_displacement,
        "worst_column": twist.worst_column,
        "energy": twist.energies,
        "columns": columns,
        "depends": DEPENDS,
    }


def twist_columns(twist: TwistResult) -> list[Column]:
    """`columns.csv`: one row a column."""
    return [Column(*of) for of in twist.by_column()]


def way_columns(twist: TwistResult) -> list[Column]:
    """`twist.csv`: the slab's ways at the samples."""
    u_x, u_y, psi = twist.ways.T
    named = (("time", "s", twist.time), ("u_x", "m", u_x), ("u_y", "m", u_y))
    return [Column(*of) for of in (*named, ("psi", "rad", psi))]
