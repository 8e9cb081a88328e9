"""What commands show on a terminal, as parts of a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from rpscli.report.html.page import Block, Table

if TYPE_CHECKING:
    from rich.console import RenderableType


def blocks_of(shown: Iterable[RenderableType]) -> Iterator[Block]:
    """The same tables and lines; titles are left out, since the page has its own."""
    from rich.table import Table as ShownTable

    for each in shown:
        if isinstance(each, ShownTable):
            columns = each.columns
            words = sum(column.justify != "right" for column in columns)
            heads = [str(column.header) for column in columns]
            rows = zip(*(map(str, column.cells) for column in columns), strict=True)
            yield Table(heads, list(rows), words)
        elif isinstance(each, str):
            yield each
