"""Tables for documents and spreadsheets: LaTeX with booktabs, and workbooks."""

from __future__ import annotations

import io
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from importlib.util import find_spec
from typing import Any

from rpscli.errors import RpsError
from rpscli.report.table import Column, Table

LIBRARY = "openpyxl"
MISSING = (
    f"xlsx needs {LIBRARY}, which is not installed: `pip install {LIBRARY}`, or leave"
    " xlsx out of formats; the CSV files have the same tables"
)
MOST_ROWS = 1_048_575
"""Of a sheet of a workbook, below its head."""

SIGNS = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "<": "$<$", ">": "$>$", "|": "$|$", "α": r"$\alpha$", "ρ": r"$\rho$",
    "γ": r"$\gamma$", "η": r"$\eta$", "ξ": r"$\xi$", "θ": r"$\theta$", "β": r"$\beta$",
    "μ": r"$\mu$", "₁": "$_1$", "′": "$'$", "²": "$^2$", "\n": " ",
}  # fmt: skip
"""Letters that LaTeX takes for something else, or does not have in every font."""


def latex_text(text: str) -> str:
    r"""A text as LaTeX prints it.

    >>> latex_text("50 % of V_st, tan α")
    '50 \\% of V\\_st, tan $\\alpha$'
    """
    return "".join(SIGNS.get(letter, letter) for letter in text)


def latex(table: Table, title: str, remarks: Iterable[str] = ()) -> str:
    """The table as readers see it, with rules of booktabs; words stand left, numbers
    right. Remarks are comments.
    """
    sides = "l" * table.words + "r" * (len(table.heads) - table.words)
    rows = [_latex_row(row) for row in table.rows]
    return "\n".join([
        rf"% {' '.join(title.split())}; needs \usepackage{{booktabs}}",
        *(f"% {' '.join(text.split())}" for text in remarks),
        rf"\begin{{tabular}}{{{sides}}}",
        r"\toprule",
        _latex_row(table.heads),
        r"\midrule",
        *rows,
        r"\bottomrule",
        r"\end{tabular}",
        "",
    ])  # fmt: skip


def _latex_row(texts: Iterable[str]) -> str:
    return " & ".join(map(latex_text, texts)) + r" \\"


def has_workbooks() -> bool:
    """True if the library that writes workbooks is installed."""
    return find_spec(LIBRARY) is not None


def workbook(tables: Mapping[str, Sequence[Column]]) -> bytes:
    """Tables by the names of their sheets, with the heads and the numbers of CSV files.

    Raises
    ------
    RpsError
        Without the library, and for tables that are too long.
    """
    try:
        from openpyxl import Workbook  # not everybody has it
    except ImportError:
        raise RpsError(MISSING) from None
    book = Workbook()
    book.remove(book.active)
    for name, columns in tables.items():
        values = [list(column.values) for column in columns]
        if (rows := len(values[0])) > MOST_ROWS:
            raise RpsError(
                f"formats: xlsx: the table {name} has {rows} rows, and a sheet has room"
                f" for {MOST_ROWS}; use its CSV file"
            )
        sheet = book.create_sheet(re.sub(r"[\[\]]", "_", name)[:31])
        sheet.append([column.title for column in columns])
        sheet.freeze_panes = "A2"
        for row in zip(*values, strict=True):
            sheet.append([_cell(value) for value in row])
            for cell in sheet[sheet.max_row]:
                if cell.data_type == "f":
                    cell.data_type = "s"  # a text that begins with = is no formula
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _cell(value: Any) -> Any:
    """A value as a cell: numbers as such, lists and mappings as text."""
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, list | tuple | dict):
        return json.dumps(value)
    return value
