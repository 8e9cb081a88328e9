"""Storeys that yield, as tables for a terminal: their strengths, and what a history did to them."""

from __future__ import annotations

from collections.abc import Iterator

from rpscli.model.podium import PodiumStructure
from rpscli.model.statics import storey_strengths
from rpscli.report.table import Part, Table, shown

UPPER = (
    "strengths go as the shears of the first mode, so upper storeys yield most: modes of uplifted"
    " columns are stiffer, and load them more than the first mode on a fixed base does"
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
                f"{'after' if each.uplift_first else 'BEFORE'} uplift",
                shown(1e3 * each.yield_drift),
            )
            for storey, each in reversed([*enumerate(storey_strengths(seen), 1)])
        ]
        if rows:
            heads = "strength kN", "of V_st", "shear at uplift kN", "yields", "at a drift of mm"
            yield Table.of_texts((f"storey{way.replace('_', ', in ')}", *heads), rows)
    building = structure.superstructure
    if building is not None and building.yields_by_first_mode:
        yield f"{UPPER} (ductility 1.8 of the first, 6.7 of the last of six in one history)"
