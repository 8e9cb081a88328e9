"""Several records of one case in a terminal: a table of what was asked and of the main
demands, a line for each further one, and the worst record.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.errors import listed
from rpscli.report.table import Part, Table, headed, large, measured, shown, standing
from rpscli.sweep.statistics.fractiles import Spread
from rpscli.sweep.statistics.summary import Summary

DIGITS = 4
A_TABLE = 5
"""Quantities side by side in a table that fits a page."""
FIRST = (
    "rotation_ratio", "max_cap_beam_displacement", "max_corner_displacement",
    "corner_factor", "max_base_shear", "drift_ratio",
    "max_floor_acceleration", "fixed_base_ratio",
)  # fmt: skip
"""Demands in the order of the table, after what limits ask for; others follow."""
ALSO = ("max_damper_force", "max_stop_force", "residual_displacement", "lost_prestress")
"""Results that are shown where they differ from zero."""
STATISTICS = {
    "mean": "mean of maxima",
    "median": "median",
    "high": "84 %",
    "largest": "largest",
}
STANDING = {"low_stands": "least that stands", "high_stands": "largest that stands"}


@dataclass(frozen=True)
class Records:
    """Histories of a case under several records: names, documents, and their statistics.

    `asked` are names of results that limits are about, `further` of those shown besides
    the demands.
    """

    labels: Sequence[str]
    documents: Sequence[Mapping[str, Any]]
    together: Summary
    asked: Sequence[str] = ()
    further: Sequence[str] = ()

    @property
    def several(self) -> bool:
        """True of more than one."""
        return len(self.documents) > 1

    @property
    def overturned(self) -> int:
        """Number of histories."""
        return self.together.rows[0].overturned.number

    @property
    def words(self) -> list[str]:
        """Outcomes as people read them."""
        outcomes = [str(each["outcome"]) for each in self.documents]
        return [
            "overturned" if each.startswith("overturned") else each.replace("_", " ")
            for each in outcomes
        ]

    def values(self, of: ResultQuantity) -> list[float | None]:
        """A result of each history."""
        return [each[of.name] for each in self.documents]

    def standing(self, of: ResultQuantity) -> list[float | None]:
        """A result of histories that stand, or of all where none does."""
        pairs = [*zip(self.values(of), self.words, strict=True)]
        stand = [value for value, word in pairs if word != "overturned"]
        return stand or self.values(of)

    @property
    def quantities(self) -> dict[ResultQuantity, Spread]:
        """What is shown, in order, with its statistics."""
        spreads = zip(
            self.together.quantities, self.together.rows[0].spreads, strict=True
        )
        order = [*dict.fromkeys((*self.asked, *FIRST))]
        known = {
            of: spread
            for of, spread in spreads
            if not of.from_below
            and (of.demand or of.name in {*self.asked, *self.further, *ALSO})
            and (of.name in self.asked or any(self.standing(of)))
        }
        names = {of.name: n for n, of in enumerate(known, start=len(order))}
        names |= {name: n for n, name in enumerate(order)}
        return dict(sorted(known.items(), key=lambda pair: names[pair[0].name]))

    def same(self, of: ResultQuantity) -> bool:
        """True of a result that is equal in all of several histories."""
        return self.several and not self.overturned and len({*self.values(of)}) == 1

    def worst(self, of: ResultQuantity) -> str:
        """The record with the largest value, of those that stand where there are any."""
        standing = [word != "overturned" for word in self.words]
        pairs = [
            (-math.inf if value is None or any(standing) > stands else value, label)
            for value, label, stands in zip(
                self.values(of), self.labels, standing, strict=True
            )
        ]
        return max(pairs, key=lambda pair: pair[0])[1]


def records_parts(records: Records) -> Iterator[Part]:
    """The table, lines of further demands, what is equal in all, and the worst record."""
    quantities = records.quantities
    if not records.several:
        every = [*quantities.items()]
        for first in range(0, len(every), A_TABLE):
            yield _table(records, dict(every[first : first + A_TABLE]))
        return
    differing = [pair for pair in quantities.items() if not records.same(pair[0])]
    yield _table(records, dict(differing[:A_TABLE]))
    if others := differing[A_TABLE:]:
        yield _others(records, dict(others))
    lines = []
    if alike := [of for of in quantities if records.same(of)]:
        texts = (f"{of.label} {measured(records.values(of)[0], of.unit)}" for of in alike)
        lines.append(f"equal in all: {', '.join(texts)}")
    if worst := worst_record(records):
        lines.append(worst)
    if lines:
        yield "; ".join(lines)


def _table(records: Records, quantities: Mapping[ResultQuantity, Spread]) -> Table:
    """A row a record, and statistics; with outcomes where these differ."""
    differ = not records.several or len({*records.words}) > 1
    rows = []
    for number, (label, word) in enumerate(
        zip(records.labels, records.words, strict=True)
    ):
        values = [large(records.values(of)[number], of.unit)[0] for of in quantities]
        texts = (shown(value, DIGITS) for value in values)
        rows.append([label, *[word] * differ, *texts])
    names = statistics_names(records) if records.several else {}
    for name, label in names.items():
        numbers = [
            large(getattr(each, name), of.unit)[0] for of, each in quantities.items()
        ]
        texts = (standing(value, DIGITS) for value in numbers)
        rows.append([label, *[""] * differ, *texts])
    heads = [headed(of.label, of.unit) for of in quantities]
    own = ["record", *[""] * differ]
    return Table.of_texts([*own, *heads], rows, words=len(own))


def statistics_names(records: Records) -> dict[str, str]:
    """Statistics and what they are called; the median of an even number is a value."""
    names = STATISTICS | (STANDING if records.overturned else {})
    if len(records.documents) % 2 == 0:
        names |= {"median": "lower median"}
    return names


def _others(records: Records, quantities: Mapping[ResultQuantity, Spread]) -> Table:
    """A row a further demand: mean, largest, and under which record that is."""
    rows = []
    for of, spread in quantities.items():
        stands = spread.high_stands if records.overturned else spread.largest
        values = (large(value, of.unit)[0] for value in (spread.mean, stands))
        texts = [standing(value, DIGITS) for value in values]
        rows.append([headed(of.label, of.unit), *texts, records.worst(of)])
    largest = "largest that stands" if records.overturned else "largest"
    heads = ["further demands", "mean of maxima", largest, "under"]
    return Table.of_texts(heads, rows)


def worst_record(records: Records) -> str:
    """The record that overturns, or has the largest rotation; empty if none has."""
    fallen = [
        label
        for label, word in zip(records.labels, records.words, strict=True)
        if word == "overturned"
    ]
    if fallen:
        some = [*fallen[:3], *[f"{len(fallen) - 3} more"] * (len(fallen) > 3)]
        return f"overturns under {listed(some, 'and')}"
    known = {of.name: of for of in records.together.quantities}
    for of in (known.get("rotation_ratio"), known.get("max_rotation")):
        if of is not None and any(values := records.values(of)):
            value = measured(max(v for v in values if v is not None), of.unit)
            return f"worst record: {records.worst(of)}, {of.label} {value}"
    return ""
