"""A report of a study: what may be asked, what it finds, and how it names varied keys."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, Literal

from rpscli.analyses.result_quantities import DEMANDS
from rpscli.case.schema.fields import Quantity
from rpscli.case.study.reports import Options, ReportKind
from rpscli.case.study.schema import Axis
from rpscli.report.figures.look import USUAL, Look
from rpscli.report.figures.style import (
    WIDTH,
    Draw,
    Target,
    drawn,
    drawn_into,
    figure_files,
    require,
)
from rpscli.report.files import Drawing
from rpscli.report.table import (
    Column,
    Part,
    Table,
    columns_of,
    csv_text,
    large,
    percent,
    records,
    shown,
)
from rpscli.report.table_files import latex, workbook
from rpscli.sweep.names import (
    NamedKey,
    Values,
    cell_of,
    plain,
    symbol,
    unit_of,
    with_unit,
)
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.table import StoredPoints
from rpscli.units import Written

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    DemandName = str
else:
    DemandName = Literal[tuple(quantity.name for quantity in DEMANDS)]

_WORDS = ("mean", "median", "largest")
Statistic = Annotated[
    float | str, Quantity(symbol="a fractile", above=0, below=1, words=_WORDS)
]
"""A statistic of several histories."""
StatisticOrShare = Annotated[
    float | str,
    Quantity(symbol="a fractile", above=0, below=1, words=(*_WORDS, "overturned")),
]
"""A statistic of several histories, or the share that overturned."""

SHEET = "_sheet_"
"""Before the number, in names of files of a figure from its second sheet on."""

ENDS = ("_low", "_high")  # of names of columns that hold the ends of a band

OVERTURNED = dict.fromkeys(("inf", "-inf"), "overturned")
"""Cells of `reached` as readers see them."""

Tables = Mapping[str, list[Column]]
"""Columns of each CSV file, by what follows the report's name in the file's."""


@dataclass(frozen=True)
class Found:
    """Tables, figure and notes of a report.

    `figure` draws its figure under a title; None where nothing can be drawn. `notes` are
    what the user should know about the numbers. `shown` has labels of columns of tables
    that are for the terminal too, none if all are; `remark` stands below them.
    """

    tables: Tables
    figure: Callable[[str], Draw] | None
    notes: Sequence[str] = ()
    shown: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    remark: str = ""

    def __post_init__(self) -> None:
        """Refuse what would be no files, or files elsewhere."""
        for suffix, columns in self.tables.items():
            if not re.fullmatch(r"\w*", suffix):
                raise ValueError(f"tables: {suffix!r} is no part of a file's name")
            if len({len([*column.values]) for column in columns}) != 1:
                raise ValueError(f"tables: columns of {suffix!r} must be equally long")
        if not {*self.shown} <= {*self.tables}:
            raise ValueError(
                f"shown: {[*self.shown]} must be among the tables {[*self.tables]}"
            )

    def parts(self) -> Iterator[Part]:
        """Tables and remark for a terminal or a page."""
        for suffix, labels in self.shown.items():
            yield _readable(self.tables[suffix], labels)
        if self.remark:
            yield self.remark

    def document(self) -> dict[str, Any]:
        """Tables and remark in JSON, with all columns."""
        rows = {
            suffix.lstrip("_") or "rows": records(self.tables[suffix])
            for suffix in self.shown
        }
        return {**rows, "remark": self.remark} if rows else {}

    def drawn(
        self, title: str, target: Target | Axes | None = None, sheet: int = 1
    ) -> Target:
        """A sheet of its figure, which is no file yet; all of it drawn into the target if
        there is one, or what has room there.
        """
        assert self.figure is not None, "asked before"
        if target is not None:
            return drawn_into(target, self.figure(title))
        sheets = self.sheets()
        require("sheets", sheet, range(1, len(sheets) + 1))
        return drawn(sheets[sheet - 1](title))

    def files(
        self, stem: str, title: str, look: Look = USUAL, formats: Sequence[str] = ()
    ) -> Iterator[tuple[str, str | bytes | Drawing]]:
        """Names and contents of its files; tables are also in the formats."""
        for suffix, columns in self.tables.items():
            yield f"{stem}{suffix}.csv", csv_text(columns)
        if "tex" in formats:
            for suffix, columns in self.tables.items():
                if suffix in (self.shown or [""]):
                    table = _readable(columns, self.shown.get(suffix, {}))
                    yield f"{stem}{suffix}.tex", latex(table, title, self._remarks())
        if "xlsx" in formats:
            sheets = {
                suffix.lstrip("_") or stem: columns
                for suffix, columns in self.tables.items()
            }
            yield f"{stem}.xlsx", workbook(sheets)
        draws = {
            f"{stem}{SHEET}{number}" if number > 1 else stem: sheet(title)
            for number, sheet in enumerate(self.sheets(look), start=1)
        }
        yield from figure_files(draws, look).items()

    def _remarks(self) -> list[str]:
        """What stands above its figure and below its table."""
        above = getattr(self.figure, "above", ())
        return [*filter(None, (*above, self.remark))]

    def sheets(self, look: Look = USUAL) -> Sequence[Callable[[str], Draw]]:
        """The figure in parts of at most a page, if it knows how; none without one."""
        if self.figure is None:
            return []
        if (parts := getattr(self.figure, "sheets", None)) is None:
            return [self.figure]
        return list(parts(look.width(WIDTH)))


def with_band(value: float, low: float, high: float) -> str:
    """A value and the band around it."""
    if not math.isfinite(value):
        return "-"
    known = math.isfinite(low) and math.isfinite(high)
    return (
        f"{shown(value, 3)}"
        f" ({f'{shown(low, 2)} to {shown(high, 2)}' if known else 'no band'})"
    )


def _has_words(values: Iterable[object]) -> bool:
    """True of values that are no plain numbers, as those of keys may be."""
    return any(
        isinstance(value, list | Written)
        or (isinstance(value, str) and value not in OVERTURNED)
        for value in values
    )


def _readable(columns: Sequence[Column], labels: Mapping[str, str]) -> Table:
    """The columns that have labels, or all; a value and the ends
    of its band are one cell.
    """
    known = {column.name: list(column.values) for column in columns}
    heads = []
    cells = []
    words = 0
    named = named_cells(columns)
    for column in columns:
        name = column.name
        factor, unit = large(1.0, column.unit)
        values = known[column.name]
        if name in named:
            heads += [symbol(name)] * bool(named[name])
            cells += [named[name]] * bool(named[name])
            words = len(heads)
            continue
        if name.endswith(ENDS) or (labels and name not in labels):
            continue
        if not labels and ";" in name:
            continue  # what else a cell of a table is made of
        own = labels.get(name) or column.label or symbol(name).replace("_", " ")
        if _has_words(values) or ("." in name and not column.label):
            head, texts = key_cells(column, own)
            heads.append(head)
            cells.append(texts)
            words = len(heads)
            continue
        values = [_times(value, factor) for value in values]
        heads.append(own if own.endswith(unit) else f"{own} {unit}".rstrip())
        # The band of a count is that of its share.
        stem = name.removesuffix("_share")
        if f"{name}_share" not in known and stem + ENDS[0] in known:
            ends = ([_times(v, factor) for v in known[stem + end]] for end in ENDS)
            rows = zip(values, *ends, strict=True)
            cells.append([with_band(*row) for row in rows])
        elif name.startswith("share_"):
            cells.append(
                ["-" if math.isnan(value) else percent(value, 1.0) for value in values]
            )
        else:
            cells.append(_with_overturned(values, known.get(f"{name};overturned")))
    return Table.of_texts(heads, zip(*cells, strict=True), words=words, keys=words)


def _with_overturned(
    values: Sequence[Any], overturned: Sequence[int] | None
) -> list[str]:
    """Texts of values, with how many histories overturned where a statistic leaves them
    out.
    """
    told = [OVERTURNED.get(str(value)) for value in values]
    plain = [word or shown(v, 3) for word, v in zip(told, values, strict=True)]
    counts = overturned or [0] * len(plain)
    return [
        f"{text} ({count} overturned)" if count and word is None else text
        for text, word, count in zip(plain, told, counts, strict=True)
    ]


def _times(value: Any, factor: float | None) -> Any:
    """A number in a larger unit; words and whole numbers as they are."""
    return value * factor if isinstance(value, float) and factor else value


@dataclass(frozen=True)
class Report(ReportKind[Options]):
    """One kind of report: what a study may say about it, and how it is made.

    `results` names results that every system must have, and `requires` tells
    what is wrong with the points of a study that it cannot show; both are seen
    before anything is computed.
    """

    make: Callable[[StoredPoints, Options], Found]
    results: Callable[[Options], Iterable[str]] = lambda _: ()
    requires: Callable[[StudyPoints, Options], Iterable[str]] = lambda *_: ()


def without_uplift(layout: StudyPoints, _: object) -> Iterable[str]:
    """The fault of results over alpha, g tan(alpha) or V_st where these are 0."""
    if any(properties.alpha == 0.0 for properties in layout.properties):
        yield "it shows results over alpha, g tan(alpha) or V_st, which is 0 without a flat part"


def add_notes(notes: list[str], name: str, found: Iterable[str]) -> None:
    """Notes under the name of their report; what another report
    has said is not said again.
    """
    told = {note.partition(": ")[2] for note in notes}
    notes += [f"{name}: {note}" for note in found if note not in told]


def key_columns(keys: Sequence[str], rows: Sequence[Values]) -> list[Column]:
    """One column a key, from its values in each row."""
    return [
        Column(key, unit_of(key), [cell_of(key, row[place]) for row in rows])
        for place, key in enumerate(keys)
    ]


def key_cells(column: Column, name: str) -> tuple[str, list[str]]:
    """Head and cells of the column of a key: values as their file has them."""
    values = list(column.values)
    if any(isinstance(value, Written) for value in values):
        return name, [with_unit(column.name, value) for value in values]
    return f"{name} {column.unit}".removesuffix(" -"), [plain(value) for value in values]


def named_cells(columns: Sequence[Column]) -> dict[str, list[str]]:
    """Cells of keys whose rows have names: these in the first column of each axis, and
    nothing in its others, which readers need not see.
    """
    keys = [column.name for column in columns]
    rows = list(zip(*(column.values for column in columns), strict=True))
    found: dict[str, list[str]] = {}
    told: list[Axis] = []
    for key in (key for key in keys if isinstance(key, NamedKey)):
        names = [key.name_of(dict(zip(keys, row, strict=True))) for row in rows]
        known = [name for name in names if name is not None]
        if len(known) == len(rows):
            found[key] = [] if key.axis in told else known
            told.append(key.axis)
    return found


def keyed(keys: Sequence[str], heads: str, rows: Iterable[Sequence[Any]]) -> list[Column]:
    """Columns of some keys, and of heads as `columns_of`; a row begins
    with values of the keys.
    """
    known = list(rows)
    further = columns_of(heads, (row[1:] for row in known))
    return [*key_columns(keys, [row[0] for row in known]), *further]


def reached(value: float) -> float | str:
    """A demand for a cell of a CSV file: ``inf`` or ``-inf`` for that
    of an overturned history.
    """
    return str(value) if math.isinf(value) else value


def axis_label(key: str) -> str:
    """A key's letter or last word with its unit, if it has one."""
    unit = unit_of(key)
    return symbol(key) if unit == "-" else f"{symbol(key)} [{unit}]"
