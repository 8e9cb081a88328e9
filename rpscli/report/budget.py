"""What moves each result: a table and a picture about its value."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from rpscli.analyses.result_quantities import ResultQuantity
from rpscli.report.bundles import Files
from rpscli.report.figures import style
from rpscli.report.figures.look import Look, figure_files
from rpscli.report.html.page import Block, Picture, Section, page_look, pictures
from rpscli.report.table import Table, columns_of, csv_text, headed, large, shown
from rpscli.sweep.budget import FACTOR, RECORDS, SHARES, Effect, Row

REMARK = (
    "one input at a time, without the error of the model itself; the default loss is 0.3 for"
    " plane contact, 1 for edges"
)

CAPTION = "orange: factor 2, red: other verdict, dots: records; overturned at the right end"


def sentences(rows: Sequence[Row], effect: Effect) -> str:
    """Which changes turn the verdict, and which the order of magnitude."""
    of, name = Counter(row.cause for row in rows), effect.name
    turned, moved = (
        ", ".join(f"{cause} ({n} of {of[cause]})" for cause, n in counted.items()) or "no change"
        for which in (effect.turned, effect.moved)
        for counted in [Counter(row.cause for row, it in zip(rows, which, strict=True) if it)]
    )
    told = f"{name} changes by a factor of {FACTOR:g} or more with: {moved}."
    if effect.limit is None:
        return told
    word = "EXCEEDED" if effect.exceeded[0] else "met"
    first = f"{name} is {word}; the verdict turns with: {turned}."
    return f"{first} {told}" if effect.quantity else first


def budget_tables(rows: Sequence[Row], found: Sequence[Effect]) -> Iterator[Table | str]:
    """Of each result; options, and what gave no number, once at the end."""
    known = [row for row in rows if not row.refused]
    for effect in found:
        if effect.quantity:
            yield _table(known, effect, effect.quantity)
        share = f" Beyond it in {RECORDS}: {effect.beyond}." if effect.limit else ""
        yield sentences(known, effect) + share
    told = [(_named(r), r.refused or r.options) for r in rows if r.refused or r.cause != RECORDS]
    yield Table.of_texts(
        ("", "options of rps timehistory CASE, or why there are none"), told, words=2
    )
    yield REMARK


def _named(row: Row) -> str:
    change = row.change if len(row.change) <= 40 else f"{row.change[:37]}..."
    return f"{row.cause}: {change}" if change else row.cause


def _table(rows: Sequence[Row], effect: Effect, quantity: ResultQuantity) -> Table:
    """The value as it is, after every change, and fractiles over the records."""
    words = np.where(effect.exceeded, "EXCEEDED", "met" if effect.limit else "")
    every = zip(rows, effect.values, words, strict=True)
    lines = [(_named(row), v, word) for row, v, word in every if row.cause != RECORDS]
    number = len(rows) - len(lines)
    for share, value in zip(SHARES, effect.spread, strict=True):
        lines.append((f"{RECORDS}: {100.0 * share:g} % fractile of {number}", value, ""))
    cells = []
    for name, value, word in lines:
        text = "overturned" if np.isinf(value) else shown(large(value, quantity.unit)[0])
        ratio = value / effect.values[0] if effect.values[0] else np.nan
        cells.append([name, text, f"{ratio:.3g}" if np.isfinite(ratio) else "-", word])
    bound = "" if effect.limit is None else effect.limit.bound
    return Table.of_texts(["", headed(quantity.label, quantity.unit), "ratio", bound], cells)


def budget_document(rows: Sequence[Row], found: Sequence[Effect]) -> dict[str, Any]:
    """All rows, and of each result what turns or moves it."""
    known = [row for row in rows if not row.refused]
    options = np.array([row.options for row in known])
    results = [
        {
            "name": effect.name,
            "limit": effect.limit.limit if effect.limit else None,
            "exceeded": bool(effect.exceeded[0]),
            "turned_by": options[effect.turned],
            "moved_by": options[effect.moved & bool(effect.quantity)],
            "sentences": sentences(known, effect),
            "records_fractiles": effect.spread,
            "records_beyond": str(effect.beyond),
        }
        for effect in found
    ]
    return {"rows": [row._asdict() for row in rows], "results": results}


def budget_files(rows: Sequence[Row], found: Sequence[Effect], title: str, look: Look) -> Files:
    """`budget.csv`, and a picture of each result."""
    heads = dict.fromkeys(("cause", "change", "options", "outcome", "refused"), "-")
    units = {e.name: e.quantity.unit for e in found if e.quantity}
    cells = [
        [*(getattr(row, name) for name in heads), *(row.values.get(name) for name in units)]
        for row in rows
    ]
    yield "budget.csv", csv_text(columns_of(heads | units, cells))
    known = [row for row in rows if not row.refused]
    draws = {e.name: partial(budget_figure, known, e, title) for e in found if e.quantity}
    yield from figure_files(draws, look).items()


def budget_section(
    rows: Sequence[Row], found: Sequence[Effect], title: str, look: Look, record: str
) -> Section:
    """Of a page: pictures above the tables, sentences and options."""
    drawn = pictures(budget_files(rows, found, title, page_look(look)))
    blocks: list[Block] = [
        Picture(files, f"What moves {name} under {record}; {CAPTION}.") for name, files in drawn
    ]
    return Section("Sensitivity of the results", [*blocks, *budget_tables(rows, found)])


def budget_figure(rows: Sequence[Row], effect: Effect, title: str) -> bytes:
    """Bars from the value as it is to that of each change, records as points, the limit as line."""
    assert effect.quantity is not None, "events have no picture"
    label, unit = effect.quantity.label, effect.quantity.unit
    others = np.array([row.cause == RECORDS for row in rows])
    values, names = effect.values[~others], [_named(row) for row in rows if row.cause != RECORDS]
    lines = [values[0], effect.limit.limit] if effect.limit else [values[0]]
    far = 1.15 * np.max([v for v in (*effect.values, *lines) if np.isfinite(v)], initial=0.0)
    factor, places = large(1.0, unit)[0] or 1.0, np.arange(len(names))

    def draw(figure: style.Figure) -> None:
        style.heading(figure, title, CAPTION)
        axes, kind = figure.subplots(), np.array([style.BLUE, style.ORANGE, style.RED])
        kinds = np.where(effect.turned, 2, effect.moved)[~others]
        ends, points = (factor * np.clip(v, -far, far) for v in (values, effect.values[others]))
        axes.barh(places, ends - ends[0], left=ends[0], height=0.65, color=kind[kinds])
        axes.plot(points, [len(names)] * len(points), ".", color=style.GREY, alpha=0.6)
        for value, colour, dash in zip(lines, (style.BLACK, style.RED), ("-", "--"), strict=False):
            axes.axvline(factor * min(value, far), color=colour, ls=dash)
        axes.set_yticks([*places, len(names)], [*names, RECORDS], fontsize=7, parse_math=False)
        axes.invert_yaxis()
        axes.set_xlabel(headed(label, unit))

    return style.picture(draw, 1.2 + 0.19 * len(names))
