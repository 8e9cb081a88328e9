"""Tables for a terminal. rich is imported when the first of them is made."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text


LONGEST_WORD, LONGEST_HEAD = 30, 14
"""Which is not broken, in cells and in heads."""


def title(text: str) -> Text:
    """A heading above tables."""
    from rich.text import Text

    return Text(text, style="bold")


def sentence(text: str) -> Text:
    """A remark between tables."""
    from rich.text import Text

    return Text(text)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], *, words: int = 1) -> Table:
    """A table of texts.

    Parameters
    ----------
    heads
        Titles of the columns.
    rows
        One text for each column.
    words
        So many columns from the left hold words, which fold where the terminal is narrow; those
        after them hold numbers, which stand right and are never broken.
    """
    from rich import box
    from rich.table import Table

    made = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    cells = list(rows)
    for index, head in enumerate(heads):
        longest = max((len(row[index]) for row in cells), default=0)
        in_head = min(max(map(len, head.split()), default=0), LONGEST_HEAD)
        if index < words:
            word = max((len(w) for row in cells for w in row[index].split()), default=0)
            least = max(min(word, LONGEST_WORD), in_head)
            made.add_column(head, overflow="fold", min_width=least)
        else:
            made.add_column(head, justify="right", overflow="fold", min_width=max(longest, in_head))
    for row in cells:
        made.add_row(*row)
    return made


def listing(rows: Iterable[tuple[str, str]]) -> Table:
    """Names and what they stand for, without a head."""
    from rich.table import Table

    made = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    made.add_column()
    made.add_column(overflow="fold")
    for row in rows:
        made.add_row(*row)
    return made
