"""Worst instants of the most loaded column of a history, as a table and sentences."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.analyses.column_design import ColumnInstant, no_line
from rpscli.analyses.results import TimeHistoryResult
from rpscli.errors import listed
from rpscli.report.table import Part, Table, shown

LARGEST = {
    "column_moment": "moment", "max_column_force": "axial force",
    "contact_pressure_ratio": "pressure on arcs", "crushed_width_ratio": "crushed edge",
}  # fmt: skip
"""Words for what is largest at worst instants."""


def column_table(result: TimeHistoryResult) -> Iterator[Part]:
    """Worst instants of the most loaded column, and where its pressure is another one."""
    if (column := result.column_demand) is None:
        return
    heads = (
        "largest",
        "end",
        "t s",
        "rad",
        "N kN",
        "F kN",
        "M/N m",
        "M kN m",
        "p_0 MPa",
        "b_c mm",
    )
    rows = [
        (
            _largest_text(each), each.end, shown(each.time, 5), shown(each.rotation),
            *(shown(1e-3 * force) for force in (each.axial_force, each.shear)),
            shown(each.eccentricity, 3), shown(1e-3 * each.moment),
            shown(each.contact_pressure and 1e-6 * each.contact_pressure),
            shown(each.crushed_depth and 1e3 * each.crushed_depth),
        )
        for each in column.instants
    ]  # fmt: skip
    yield Table.of_texts(heads, rows, words=2)
    yield from _about_contacts(result)
    for doubt in dict.fromkeys(each.doubt for each in column.instants if each.doubt):
        of = [LARGEST[each.largest] for each in column.instants if each.doubt == doubt]
        yield f"p_0 at the largest {listed(of, 'and')}: {doubt}"
    if corner := no_line(result.structure, both=result.both_components):
        yield f"no pressure: {corner}"
        yield (
            "moments of tilted columns are about a corner, sqrt(2) times those of the"
            " inscribed circle; the section resists them about its diagonal"
        )


def _largest_text(at: ColumnInstant) -> str:
    """What is largest, and how an arc touches where its pressure is."""
    words = LARGEST[at.largest]
    of_pressure = at.largest == "contact_pressure_ratio"
    return f"pressure, {at.contact.kind}" if of_pressure and at.contact else words


def _about_contacts(result: TimeHistoryResult) -> Iterator[str]:
    """Where the largest pressure is, and about which axis a square section bends."""
    assert result.column_demand is not None, "it is asked for"
    for each in result.column_demand.instants:
        if each.largest == "contact_pressure_ratio":
            yield f"largest p_0: {each.contact}"
    structure = result.structure
    design = structure.column
    square = design is not None and design.section == "square"
    if square and result.both_components and structure.bearing.is_of_revolution:
        yield (
            "moments act in any direction: about its diagonal, a square section resists"
            " 1/sqrt(2) of what it does about a side"
        )
