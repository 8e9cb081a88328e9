"""Causes that move the results of one history: inputs changed one at a time, and what
comes of each.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
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
from rpscli.report.page import Block, Picture, ReportSection, page_look, pictures
from rpscli.report.table import Table, columns_of, csv_text, headed, large, shown_beside
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
FELT = 1e-3
"""Of a value: smaller changes are not listed row by row."""

NO_CHANGE = "no change"
MOST_PANELS = 4
SEEN = 0.01
"""Of a value, what a bar of the picture shows."""
BETWEEN = " / "
"""Between the values of one input, and what follows from each."""
MOST_BARS = 24
"""In the picture; the table has all."""
CAPTION = "dots: records; arrows: overturned, or farther"


COLOURS = (style.BLUE, style.ORANGE, style.RED)
KINDS = ("within a factor of 2", "a factor of 2 or more", "another verdict")
"""Of bars, by what they mean."""


class BudgetRow(NamedTuple):
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

    def move(self, row: int) -> float:
        """Size of the change over the value as the case is; infinite where it
        overturns.
        """
        value = self.values[row]
        own = self.values[0]
        if np.isnan(value) or value == own:
            return 0.0
        return float(abs(value - own) / abs(own)) if own else np.inf

    @property
    def label(self) -> str:
        """Of axes, without a unit: ratios have none."""
        return self.quantity.label if self.quantity else self.name

    @property
    def own_text(self) -> str:
        """The value as the case is, and its verdict."""
        assert self.quantity is not None, "events have no value"
        if not np.isfinite(self.values[0]):
            return "overturned"
        limit = large(self.limit.limit if self.limit else None, self.quantity.unit)[0]
        text = shown_beside(large(self.values[0], self.quantity.unit)[0], limit)
        return f"{text} {_word(self.exceeded[0])}" if self.limit else text

    def text(self, row: int) -> str:
        """The ratio to the value as the case is, with the verdict where that turns."""
        word = f" {_word(self.exceeded[row])}" if self.turned[row] else ""
        return f"{_over(self.values[row], self.values[0])}{word}"


def _stem(change: str) -> tuple[str, float]:
    """A change without the number that it ends with, and that number.

    >>> _stem("period=0.27"), _stem("--scale 1.01"), _stem("rigid")
    (('period=', 0.27), ('--scale ', 1.01), ('rigid', 0.0))
    """
    found = re.fullmatch(r"([\w.]+=|\S+ )([-+]?[\d.]+(?:e[-+]?\d+)?)", change)
    return (found[1], float(found[2])) if found else (change, 0.0)


def _without_record(change: str) -> str:
    """A change without the source of its record, and the factor with four digits.

    >>> _without_record("--record x?both --scale 0.962040295058"), _without_record("e=1")
    ('factor 0.962', 'e=1')
    """
    plain = re.sub(r"--record \S+\s*", "", change)
    return re.sub(r"--scale (\S+)", lambda match: f"factor {float(match[1]):.4g}", plain)


def _word(exceeded: object) -> str:
    return "EXCEEDED" if exceeded else "met"


def _over(value: float, own: float) -> str:
    """A value over that of the case; ``-`` where one of them is none."""
    if np.isinf(value):
        return "overturned"
    if np.isnan(value) or not (own and np.isfinite(own)):
        return "-"
    return f"x {value / own:.3g}"


def _headed(effect: Effect) -> str:
    """Head of a column: the result, its unit and its limit."""
    assert effect.quantity is not None, "events have no column"
    bound = "" if effect.limit is None else f", {bound_text(effect.limit)}"
    return f"{headed(effect.quantity.label, effect.quantity.unit)}{bound}"


@dataclass(frozen=True)
class Budget:
    """All rows under a case, the first as the case is, and
    what they do to each result.
    """

    case: Case
    every: list[BudgetRow]

    @cached_property
    def rows(self) -> list[BudgetRow]:
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

    @cached_property
    def inputs(self) -> list[int]:
        """Rows that are no other records, but for the first: what moves most comes
        first.
        """
        rows = [n for n, row in enumerate(self.rows) if n and row.cause != RECORDS]
        return sorted(rows, key=lambda n: -max(e.move(n) for e in self.effects))

    def tables(self) -> Iterator[Table | str]:
        """One table of what moves something, then sentences of each result."""
        yield self._table()
        yield "below the first row: times the value of the case as it is"
        still = [self.rows[n].label for n in self.inputs if not self._moves(n)]
        if still:
            yield f"moved by less than {100.0 * FELT:g} % of all: {'; '.join(still)}"
        for effect in self.effects:
            share = f" Beyond it in {RECORDS}: {effect.beyond}." if effect.limit else ""
            yield self.sentences(effect) + share
        if worst := [*self._worst_records()]:
            yield f"the worst of the {RECORDS}: {'; '.join(worst)}"
        for row in self.every:
            if row.refused:
                yield f"{row.label}: {row.refused}"
        yield f"options of rps timehistory for each row stand in budget.csv; {REMARK}"

    def _moves(self, row: int, least: float = FELT) -> bool:
        return any(e.move(row) >= least or e.turned[row] for e in self.effects)

    def _by_input(self, least: float) -> dict[str, list[int]]:
        """Rows of each input, by its name and the values that it takes; of those that
        move something by so much, what moves most first.
        """
        changes = [_without_record(row.change) for row in self.rows]
        found: dict[tuple[str, str], list[int]] = {}
        for row in self.inputs:
            stem, _ = _stem(changes[row])
            found.setdefault((self.rows[row].cause, stem), []).append(row)
        named = {}
        for (cause, stem), rows in found.items():
            if any(self._moves(row, least) for row in rows):
                rows.sort(key=lambda row: _stem(changes[row])[1])
                each = dict.fromkeys(changes[row] for row in rows)
                values = BETWEEN.join(change.removeprefix(stem) for change in each)
                change = f"{stem}{values}"
                named[f"{cause}: {change}" if change else cause] = rows
        return named

    def _table(self) -> Table:
        """Values as the case is, then over them those of changes and of records."""
        shown_ones = [effect for effect in self.effects if effect.quantity]
        heads = [_headed(effect) for effect in shown_ones]
        cells = [["as it is", *(effect.own_text for effect in shown_ones)]]
        for label, rows in self._by_input(FELT).items():
            texts = [BETWEEN.join(map(effect.text, rows)) for effect in shown_ones]
            cells.append([label, *texts])
        number = len(self.rows) - len(self.inputs) - 1
        for k, share in enumerate(SHARES if number else ()):
            texts = [_over(effect.spread[k], effect.values[0]) for effect in shown_ones]
            cells.append([f"{RECORDS}: {100.0 * share:g} % fractile of {number}", *texts])
        return Table.of_texts(["", *heads], cells)

    def _worst_records(self) -> Iterator[str]:
        """The record that is worst for each result, by name."""
        others = [n for n, row in enumerate(self.rows) if row.cause == RECORDS]
        for effect in self.effects if others else ():
            if effect.quantity and np.isfinite(effect.values[others]).any():
                sign = Condition(effect.name, 0.0, "").sign
                bad = np.nan_to_num(sign * effect.values[others], nan=-np.inf)
                yield f"{effect.name} {self.rows[others[int(np.argmax(bad))]].record}"

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
        if any(effect.quantity for effect in self.effects):
            yield from style.figure_files({"budget": self.figure}, look).items()

    def section(self, look: Look, record: str) -> ReportSection:
        """Of a page: pictures above the tables, sentences and options."""
        caption = (
            f"What moves the results under {record}, over the case as it is; {CAPTION}."
        )
        blocks: list[Block] = [
            Picture(files, caption)
            for files in pictures(self.files(page_look(look))).values()
        ]
        return ReportSection("Sensitivity of the results", [*blocks, *self.tables()])

    def figure(self, figure: style.Figure) -> None:
        """A tornado: a panel a result, bars from the case as it is, sorted; records as
        points above, limits as lines.
        """
        every = [effect for effect in self.effects if effect.quantity]
        shown_ones = every[: 2 if style.narrow(figure) else MOST_PANELS]
        more = len(every) - len(shown_ones)
        note = f"{CAPTION}; below {100.0 * SEEN:g} %: in the table"
        note += f", as {more} more results are" * bool(more)
        inputs = self._by_input(SEEN)
        rows = [*inputs.values()][:MOST_BARS]
        part = 0.42 if style.narrow(figure) else 0.3
        names = [
            style.folded(label, part * style.room(figure), 7.0)
            for label in [*inputs][:MOST_BARS]
        ]
        most = max((1 + name.count("\n") for name in names), default=1)
        height = 1.3 + (0.07 + 0.12 * most) * (1 + len(names))
        style.begin(figure, (self.case.title, note), height)
        panels = figure.subplots(1, len(shown_ones), sharey=True, squeeze=False)[0]
        width = 0.8 * (0.9 - part) * style.room(figure) / max(len(shown_ones), 1)
        for axes, effect in zip(panels, shown_ones, strict=True):
            self._draw(axes, effect, rows)
            label = f"{effect.label} over the case as it is"
            axes.set_xlabel(style.folded(label, width, 7.0), fontsize=7)
        panels[0].set_yticks(
            range(-1, len(rows)), [RECORDS, *names], fontsize=7, parse_math=False
        )
        panels[0].invert_yaxis()
        for colour, label in zip(COLOURS, KINDS, strict=True):
            panels[0].bar([np.nan], [0.0], color=colour, label=label)
        if any(effect.limit for effect in shown_ones):
            panels[0].plot([], [], color=style.RED, ls="--", lw=0.9, label="limit")
        style.legend_below(figure, [panels[0]])

    def _draw(self, axes: style.Axes, effect: Effect, rows: Sequence[list[int]]) -> None:
        """Ratios of one result to that of the case; what overturns ends at the panel's
        end, with a mark. Of an input that takes several values the longest bar is below
        the others.
        """
        own = effect.values[0] or 1.0
        ratio = effect.values / own
        others = [n for n, row in enumerate(self.rows) if row.cause == RECORDS]
        pairs = [(place, row) for place, of in enumerate(rows) for row in of]
        pairs.sort(key=lambda pair: -effect.move(pair[1]))
        places, every = np.array(pairs, dtype=int).reshape(-1, 2).T
        bound = effect.limit.limit / own if effect.limit else np.nan
        far = _end_of_axis(ratio[every], bound)
        bars = np.clip(np.nan_to_num(ratio[every], nan=1.0), -far, far)
        colours = np.array(COLOURS)
        kinds = np.where(effect.turned, 2, effect.moved)[every]
        look: dict[str, Any] = {
            "left": 1.0,
            "height": 0.65,
            "edgecolor": "white",
            "linewidth": 0.3,
        }
        axes.barh(places, bars - 1.0, color=colours[kinds], **look)
        at_ends: dict[str, Any] = {"color": style.BLACK, "ms": 4.0}
        at_ends["ls"] = ""
        beyond = ~np.isfinite(ratio[every]) & ~np.isnan(ratio[every])
        axes.plot(bars[beyond], places[beyond], ">", **at_ends)
        points = np.clip(ratio[others], -far, far)
        axes.plot(points, [-1.0] * len(points), ".", color=style.GREY, alpha=0.6)
        if (np.abs(ratio[others]) > far).any():
            axes.plot([far], [-1.0], ">", **at_ends)
        axes.axvline(1.0, color=style.BLACK, lw=0.8)
        if abs(bound) <= far:
            axes.axvline(bound, color=style.RED, ls="--", lw=0.9)
        elif effect.limit:
            axes.set_title(f"limit at {bound:.3g}", fontsize=7, color=style.RED)


FARTHEST_LIMIT = 2.0
"""Times the longest bar, up to which the limit is drawn; else it is told."""


def _end_of_axis(ratios: Array, bound: float) -> float:
    """Size up to which a panel goes: all bars of what stands, and the limit near them."""
    finite = np.abs(ratios[np.isfinite(ratios)])
    far = 1.1 * max(1.0, float(finite.max(initial=1.0)))
    return max(far, 1.05 * abs(bound)) if abs(bound) <= FARTHEST_LIMIT * far else far
