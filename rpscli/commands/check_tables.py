"""The derived quantities of a case as tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from rpscli.commands.numbers import shown
from rpscli.commands.tables import listing, table, title

if TYPE_CHECKING:
    from rich.console import RenderableType

# Key in the document, what it is, symbol, unit and the factor to it from SI.
GEOMETRY = (
    ("semi_diagonal", "semi-diagonal", "R", "m", 1.0),
    ("column_height", "column height", "2H", "m", 1.0),
    ("flat_width", "width of the flat part", "2B", "m", 1.0),
    ("arc_radius", "radius of the arcs", "r", "m", 1.0),
    ("alpha", "slenderness angle", "alpha", "rad", 1.0),
    ("alpha_wedge", "slenderness angle of the wedge", "alpha'", "rad", 1.0),
    ("curvature_ratio", "curvature ratio", "rho", "", 1.0),
    ("rho_cr_paper", "critical curvature ratio, first order", "rho_cr", "", 1.0),
    ("rho_cr_exact", "critical curvature ratio, exact", "rho_cr", "", 1.0),
    ("beta", "rolling ends at", "beta", "rad", 1.0),
    ("critical_rotation", "critical rotation", "theta_cr", "rad", 1.0),
    ("critical_rotation_paper", "critical rotation, first order", "theta_cr", "rad", 1.0),
    ("overturns", "overturns", "", "", None),
)
DYNAMICS = (
    ("columns_mass", "all columns", "N m_c", "t", 1e-3),
    ("cap_beam_mass", "cap beam", "m_b", "t", 1e-3),
    ("superstructure_mass", "superstructure", "M_tot", "t", 1e-3),
    ("gamma", "cap beam over columns", "gamma", "", 1.0),
    ("eta", "superstructure over cap beam", "eta", "", 1.0),
    ("gamma_total", "both over columns", "gamma (1 + eta)", "", 1.0),
    ("restitution", "restitution at impact", "e", "", 1.0),
    ("uplift_acceleration", "quasi-static uplift at", "g tan(alpha)", "m/s2", 1.0),
    ("uplift_force", "uplift force at the cap beam", "W tan(alpha)", "kN", 1e-3),
    ("static_base_shear", "base shear at uplift", "V_st", "kN", 1e-3),
    ("initial_stiffness", "stiffness after uplift", "", "kN/m", 1e-3),
    ("p_hat", "frequency parameter, rigid", "p_hat", "rad/s", 1.0),
    ("T1", "first period on a fixed base", "T1", "s", 1.0),
)


def check_tables(document: Mapping[str, Any]) -> Iterator[RenderableType]:
    """Geometry; masses, statics and periods; the record; the limits."""
    heads = ("", "symbol", "value", "unit")
    yield title(document["case"]["title"])
    for rows in (GEOMETRY, DYNAMICS):
        texts = [
            (name, symbol, shown(_scaled(document[key], factor)), unit)
            for key, name, symbol, unit, factor in rows
        ]
        yield table(heads, texts, words=2)
    if record := document["record"]:
        yield _record_table(record)
    if limits := document["limits"]:
        yield table(("limit", "at most"), [(name, f"{value:g}") for name, value in limits.items()])


def _scaled(value: Any, factor: float | None) -> Any:
    return value if factor is None or value is None else value * factor


def _record_table(record: Mapping[str, Any]) -> RenderableType:
    rows = [
        ("record", record["name"]),
        ("", record["description"]),
        ("format", record["format"]),
        ("samples", f"{record['npts']} at {record['dt']:g} s, {shown(record['duration'])} s"),
        ("peak acceleration", f"{shown(record['pga'])} m/s2"),
        ("scale", f"{record['scale']:g}"),
    ]
    return listing(row for row in rows if row[1])
