"""The derived quantities of a case as tables for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rpscli.case.conditions import Condition, condition_text
from rpscli.report.numbers import large, shown
from rpscli.report.table import Heading, Part, Table
from rpscli.report.tables.derived import DYNAMICS, FIRST_PERIOD, GEOMETRY


def check_tables(document: Mapping[str, Any], limits: Sequence[Condition]) -> Iterator[Part]:
    """Geometry; masses, statics and periods; the record; the limits."""
    heads = ("", "symbol", "value", "unit")
    yield Heading(document["case"]["title"])
    for rows in (GEOMETRY, (*DYNAMICS, FIRST_PERIOD)):
        texts = []
        for row in rows:
            value, unit = large(document[row.name], row.unit)
            texts.append((row.label, row.symbol, shown(value), unit))
        yield Table.of_texts(heads, texts, words=2)
    if record := document["record"]:
        yield _record_table(record)
    if limits:
        yield Table.of_texts(("limit", ""), [(c.name, condition_text(c)) for c in limits], words=2)


def _record_table(record: Mapping[str, Any]) -> Table:
    rows = [
        ("record", record["name"]),
        ("", record["description"]),
        ("format", record["format"]),
        ("samples", f"{record['npts']} at {record['dt']:g} s, {shown(record['duration'])} s"),
        ("peak acceleration", f"{shown(record['pga'])} m/s2"),
        ("scale", f"{record['scale']:g}"),
    ]
    return Table.listing(row for row in rows if row[1])
