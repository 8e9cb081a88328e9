"""What moves the results of one history: inputs changed one at a
time, and what comes of each.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.result_quantities import LIMITED, ResultQuantity
from rpscli.case.case import Case
from rpscli.case.conditions import LIMITS, Condition, case_conditions
from rpscli.errors import UsageError
from rpscli.report.figures import style
from rpscli.report.figures.look import Look
from rpscli.report.files import Files
from rpscli.report.limits import bound_text
from rpscli.report.page import Block, Picture, Section, page_look, pictures
from rpscli.report.table import Table, columns_of, csv_text, headed, large, shown
from rpscli.sweep.statistics.fractiles import HIGH, LOW, Share, fractiles, share_of
from rpscli.sweep.statistics.summary import Records
from rpscli.sweep.statistics.verdicts import exceeds, worse
from rpscli.sweep.table import Array

FACTOR = 2.0  # by which a result changes its order of magnitude
SHARES = (LOW, 0.5, HIGH)
RECORDS = "records"  # the cause of all rows that are other records
REMARK = (
    "one input at a time, without the error of the model itself; the default loss is 0.3"
    " for plane contact, 1 for edges"
)
NO_CHANGE = "no change"
CAPTION = (
    "orange: factor 2, red: other verdict, dots: records; overturned at the right end"
)


class Row(NamedTuple):
    """One change, by options of `rps timehistory`: its results
    [SI], or why there are none.
    """

    cause: str
    change: str
    options: str
    outcome: str
    values: dict[str, float]
    record: str
    refused: str

    @property
    def label(self) -> str:
        """Cause and change."""
        return f"{self.cause}: {self.change}" if self.change else self.cause


class Effect(NamedTuple):
    """Of one limit or result on all rows."""

    name: str
    quantity: ResultQuantity | None
    limit: Condition | None
    values: Array  # infinitely bad where it overturned, NaN if none
    exceeded: NDArray[np.bool_]
    spread: list[float]  # fractiles `SHARES` over the records
    beyond: Share  # the limit

    @property
    def turned(self) -> NDArray[np.bool_]:
        """(rows,) with the other verdict than the first."""
        return np.asarray(self.exceeded != self.exceeded[0])

    @property
    def moved(self) -> NDArray[np.bool_]:
        """(rows,) away from the first by `FACTOR`, or with the other sign."""
        own = self.values[0]
        size = np.abs(self.values)
        far = np.maximum(size, abs(own)) >= FACTOR * np.minimum(size, abs(own))
        other_sign = np.sign(self.values) * np.sign(own) < 0.0
        return np.asarray((self.values != own) & ~np.isnan(size) & (far | other_sign))


@dataclass(frozen=True)
class Budget:
    """All rows under a case, the first as the case is, and
    what they do to each result.
    """

    case: Case
    every: list[Row]

    @cached_property
    def rows(self) -> list[Row]:
        """Those with results."""
        return [row for row in self.every if not row.refused]

    @cached_property
    def effects(self) -> list[Effect]:
        """On all limits, else on the main demands."""
        return [*self._effects()]

    def _effects(self) -> Iterator[Effect]:
        case = self.case
        rows = self.rows
        limits = case_conditions(case.limits, case.structure)
        judged: dict[str, Condition | None] = {each.name: each for each in limits}
        values = [row.values for row in rows]
        table = Records.of([r.outcome for r in rows], values, [r.record for r in rows])
        others = np.nonzero([row.cause == RECORDS for row in rows])[0]
        main = [q.name for q in LIMITED if q.demand and not np.isnan(values[0][q.name])]
        for name, limit in (judged or dict.fromkeys(main)).items():
            quantity = LIMITS.get(name)
            bad = worse(table, name)
            if quantity:
                bad[np.isnan(table.columns[name]) & ~table.overturned] = np.nan
                if limit and np.isnan(bad[0]):
                    needs = quantity.needed or "what the case has not"
                    raise UsageError(f"{limit.source}: {name} needs {needs}")
            sign = Condition(name, 0.0, "").sign
            known = ~np.isnan(bad)
            bound = limit.limit if limit else np.inf
            beyond = exceeds(table, name, bound) & known & (limit is not None)
            spread = (sign * fractiles(bad[others], SHARES)).tolist()
            share = share_of(table, others, beyond[others])
            yield Effect(name, quantity, limit, sign * bad, beyond, spread, share)

    def sentences(self, effect: Effect) -> str:
        """Which changes turn the verdict, and which the order of magnitude."""
        of = Counter(row.cause for row in self.rows)
        name = effect.name
        turned, moved = (
            ", ".join(
                f"{cause} ({n} of {of[cause]})" for cause, n in Counter(causes).items()
            )
            for which in (effect.turned, effect.moved)
            for causes in [[self.rows[row].cause for row in np.flatnonzero(which)]]
        )
        told = (
            f"{name} changes by a factor of {FACTOR:g} or more with:"
            f" {moved or NO_CHANGE}."
        )
        if effect.limit is None:
            return told
        word = "EXCEEDED" if effect.exceeded[0] else "met"
        first = f"{name} is {word}; the verdict turns with: {turned or NO_CHANGE}."
        return f"{first} {told}" if effect.quantity else first

    def tables(self) -> Iterator[Table | str]:
        """Of each result; options, and what gave no number, once at the end."""
        for effect in self.effects:
            if effect.quantity:
                yield self._table(effect, effect.quantity)
            share = f" Beyond it in {RECORDS}: {effect.beyond}." if effect.limit else ""
            yield self.sentences(effect) + share
        told = [
            (row.label, row.refused or row.options)
            for row in self.every
            if row.refused or row.cause != RECORDS
        ]
        heads = ("", "options of rps timehistory CASE, or why there are none")
        yield Table.of_texts(heads, told, words=2)
        yield REMARK

    def _table(self, effect: Effect, quantity: ResultQuantity) -> Table:
        """The value as it is, after every change, and fractiles over the records."""
        words = np.where(effect.exceeded, "EXCEEDED", "met" if effect.limit else "")
        every = zip(self.rows, effect.values, words, strict=True)
        lines = [(row.label, v, word) for row, v, word in every if row.cause != RECORDS]
        number = len(self.rows) - len(lines)
        for share, value in zip(SHARES, effect.spread, strict=True):
            lines.append(
                (f"{RECORDS}: {100.0 * share:g} % fractile of {number}", value, "")
            )
        cells = []
        for name, value, word in lines:
            text = (
                "overturned" if np.isinf(value) else shown(large(value, quantity.unit)[0])
            )
            ratio = value / effect.values[0] if effect.values[0] else np.nan
            cells.append(
                [name, text, f"{ratio:.3g}" if np.isfinite(ratio) else "-", word]
            )
        bound = "" if effect.limit is None else bound_text(effect.limit)
        return Table.of_texts(
            ["", headed(quantity.label, quantity.unit), "ratio", bound], cells
        )

    def document(self) -> dict[str, Any]:
        """All rows, and of each result what turns or moves it."""
        options = np.array([row.options for row in self.rows])
        results = [
            {
                "name": effect.name,
                "limit": effect.limit.limit if effect.limit else None,
                "exceeded": bool(effect.exceeded[0]),
                "turned_by": options[effect.turned],
                "moved_by": options[effect.moved & bool(effect.quantity)],
                "sentences": self.sentences(effect),
                "records_fractiles": effect.spread,
                "records_beyond": str(effect.beyond),
            }
            for effect in self.effects
        ]
        return {"rows": [row._asdict() for row in self.every], "results": results}

    def files(self, look: Look) -> Files:
        """`budget.csv`, and a picture of each result."""
        known = {
            e.name: f"{e.name} [{e.quantity.unit}]" for e in self.effects if e.quantity
        }
        cells = [
            (*row[:4], row.refused, *map(row.values.get, known)) for row in self.every
        ]
        heads = ", ".join(("cause, change, options, outcome, refused", *known.values()))
        yield "budget.csv", csv_text(columns_of(heads, cells))
        draws = {e.name: partial(self.figure, e) for e in self.effects if e.quantity}
        yield from style.figure_files(draws, look).items()

    def section(self, look: Look, record: str) -> Section:
        """Of a page: pictures above the tables, sentences and options."""
        blocks: list[Block] = [
            Picture(files, f"What moves {name} under {record}; {CAPTION}.")
            for name, files in pictures(self.files(page_look(look))).items()
        ]
        return Section("Sensitivity of the results", [*blocks, *self.tables()])

    def figure(self, effect: Effect, figure: style.Figure) -> None:
        """Bars from the value as it is to each changed one, records as
        points, limits as lines.
        """
        assert effect.quantity is not None, "events have no picture"
        label = effect.quantity.label
        unit = effect.quantity.unit
        others = np.array([row.cause == RECORDS for row in self.rows])
        values = effect.values[~others]
        labels = [r.label for r in self.rows if r.cause != RECORDS]
        names = [style.folded(text, 0.42 * style.room(figure), 7.0) for text in labels]
        most = max(1 + name.count("\n") for name in names)
        lines = [(values[0], style.BLACK, "-")]
        if effect.limit:
            lines.append((effect.limit.limit, style.RED, "--"))
        sizes = np.array([*effect.values, *(line[0] for line in lines)])
        far = 1.15 * np.max(sizes[np.isfinite(sizes)], initial=0.0)
        factor = large(1.0, unit)[0] or 1.0
        places = np.arange(len(names))
        style.begin(
            figure, (self.case.title, CAPTION), 1.2 + (0.07 + 0.12 * most) * len(names)
        )
        axes = figure.subplots()
        kind = np.array([style.BLUE, style.ORANGE, style.RED])
        kinds = np.where(effect.turned, 2, effect.moved)[~others]
        ends, points = (
            factor * np.clip(v, -far, far) for v in (values, effect.values[others])
        )
        axes.barh(places, ends - ends[0], left=ends[0], height=0.65, color=kind[kinds])
        axes.plot(points, [len(names)] * len(points), ".", color=style.GREY, alpha=0.6)
        for value, colour, dash in lines:
            axes.axvline(factor * min(value, far), color=colour, ls=dash)
        axes.set_yticks(
            [*places, len(names)], [*names, RECORDS], fontsize=7, parse_math=False
        )
        axes.invert_yaxis()
        axes.set_xlabel(headed(label, unit))
