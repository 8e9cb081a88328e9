"""Printing: one table, the same width on a terminal and in a file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich import box
from rich.console import Console
from rich.table import Table

_CONSOLE = Console(width=132, highlight=False)


def show(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Print a table that Markdown understands."""
    table = Table(*columns, title=title, title_justify="left", box=box.MARKDOWN)
    for row in rows:
        table.add_row(*row)
    _CONSOLE.print(table)


def say(line: str) -> None:
    """Print a line under a table."""
    _CONSOLE.print(line, soft_wrap=True, markup=False)


def figure(value: float) -> str:
    """Three figures, without an exponent."""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.3g}"
