"""A structure under several records: CSV tables and documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rpscli.analyses.result_quantities import HISTORY
from rpscli.report.study.statistics import reached, share_document
from rpscli.report.table import Column
from rpscli.sweep.statistics.record_set import RecordSet, SetVerdict

STATISTICS = {
    "mean_of_maxima": "mean",
    "median": "median",
    "fractile_84": "high",
    "largest": "largest",
}
"""Names in CSV and JSON, and the attribute of a demand."""


def record_columns(labels: Sequence[str], histories: Sequence[Mapping[str, Any]]) -> list[Column]:
    """`records.csv`: one row a record."""
    return [
        Column("record", "-", labels),
        Column("scale", "-", [history["record"]["scale"] for history in histories]),
        Column("outcome", "-", [history["outcome"] for history in histories]),
        *(
            Column(quantity.name, quantity.unit, [history[quantity.name] for history in histories])
            for quantity in HISTORY
        ),
    ]


def statistics_columns(together: RecordSet) -> list[Column]:
    """`statistics.csv`: one row a quantity; ``inf`` where so many overturned."""
    demands = together.demands
    return [
        Column("quantity", "-", [quantity.name for quantity in demands]),
        Column("unit", "-", [quantity.unit for quantity in demands]),
        *(
            Column(name, "SI", [reached(getattr(each, attribute)) for each in demands.values()])
            for name, attribute in STATISTICS.items()
        ),
    ]


def record_set_document(together: RecordSet) -> dict[str, Any]:
    """Counts and demands in JSON; a demand is null where so many overturned."""
    return {
        "counted": together.counted,
        "failed": together.failed,
        "overturned": share_document(together.overturned),
        "demands": {
            quantity.name: {key: getattr(each, name) for key, name in STATISTICS.items()}
            for quantity, each in together.demands.items()
        },
    }


def set_verdict_document(verdict: SetVerdict, labels: Sequence[str]) -> dict[str, Any]:
    """A verdict in JSON; the value is null where the record overturned."""
    return {
        **asdict(verdict.condition),
        "counted": verdict.beyond.of,
        "beyond": share_document(verdict.beyond),
        "value": verdict.value,
        "record": labels[verdict.worst],
        "exceeded": verdict.exceeded,
    }
