"""Storeys that yield, as tables for a terminal: their strengths, and what a history did to them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rpscli.model.podium import PodiumStructure
from rpscli.model.statics import storey_strengths
from rpscli.report.table import Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.pushover import PushoverResult
    from rpscli.analyses.results import TimeHistoryResult

UPPER = (
    "strengths follow the shears of the first mode on a fixed base, so upper storeys yield most:"
    " modes of uplifted columns are stiffer, and load upper storeys more than that mode does"
)


def strength_tables(structure: PodiumStructure) -> Iterator[Part]:
    """Strength of each storey beside its shear at uplift, the roof on top; in y if that differs."""
    for way, seen in structure.ways.items():
        rows = [
            (
                str(storey),
                shown(1e-3 * each.strength),
                "" if each.strength_ratio is None else shown(each.strength_ratio),
                shown(1e-3 * each.shear_at_uplift),
                f"yields {'after' if each.uplift_first else 'BEFORE'} uplift",
                shown(1e3 * each.yield_drift),
            )
            for storey, each in reversed([*enumerate(storey_strengths(seen), 1)])
        ]
        if rows:
            heads = "strength kN", "of V_st", "shear at uplift kN", "under slow ground motion"
            storey = f"storey{way.replace('_', ', in ')}"
            yield Table.of_texts((storey, *heads, "at a drift of mm"), rows)
    building = structure.superstructure
    if building is not None and building.yields_by_first_mode:
        yield f"{UPPER} (one history of six storeys: ductility 1.8 of the first, 6.7 of the last)"


def yielding_tables(result: PushoverResult) -> Iterator[Part]:
    """Storeys that yield on the capacity curves, and where each begins."""
    building = result.structure.superstructure
    if building is None or building.strengths is None:
        return
    rows = [
        (curve.pattern, str(storey), shown(1e-3 * force), shown(force / result.uplift_force))
        for curve in result.capacity
        for storey, force in sorted(curve.yielding.items(), key=lambda item: item[1])
    ]
    if not rows:
        yield "columns lift first: pushed slowly no storey ever yields, only in motion"
        return
    heads = "pattern", "storey yields", "at floor forces of kN", "of uplift force"
    yield Table.of_texts(heads, rows)
    if building.hardening == 0.0:
        yield "without hardening a curve ends where the first storey yields: it is a mechanism then"


def yielded_tables(result: TimeHistoryResult) -> Iterator[Part]:
    """What a history did to storeys that yield, the roof on top, and which of them yield most."""
    building = result.structure.superstructure
    if building is None or not building.yields:
        return
    columns = (
        result.ductilities,
        1e3 * result.plastic_drifts,
        1e3 * result.residual_drifts,
        1e-3 * result.energies_yielded,
        result.first_yields,
    )
    rows = [
        (str(storey + 1), *(shown(float(column[storey])).replace("inf", "-") for column in columns))
        for storey in reversed(range(building.storeys))
    ]
    heads = "ductility", "plastic drift mm", "residual mm", "yielded kJ", "first at s"
    yield Table.of_texts(("storey", *heads), rows)
    most = int(result.ductilities.argmax())
    if most > 0 and result.ductilities[most] > 1.0:
        reason = f": {UPPER}" if building.yields_by_first_mode else ""
        yield f"storey {most + 1}, not the first, has the largest ductility{reason}"
