"""What a command says: results on the standard output, everything else on the standard error."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TextIO

from rpscli.errors import OutputError
from rpscli.report.files.json_text import json_text

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

PLAIN_WIDTH = 100
"""Columns where the output is no terminal and COLUMNS is not set."""


@dataclass(frozen=True)
class Terminal:
    """How much is said, and in which form.

    Parameters
    ----------
    as_json
        One JSON document in place of tables.
    quiet
        No tables, no notes; errors are still reported.
    """

    as_json: bool = False
    quiet: bool = False
    told: set[str] = field(default_factory=set, init=False, compare=False)
    """The warnings so far, each of which is said once."""

    def note(self, text: str) -> None:
        """A line about what goes on, on the standard error."""
        if not self.quiet:
            emit(text + "\n", sys.stderr)

    def warn(self, texts: Iterable[str]) -> None:
        """Lines that should be read before the numbers are used."""
        for text in texts:
            if text not in self.told:
                self.told.add(text)
                self.note(f"warning: {text}")

    def result(self, document: Mapping[str, Any], tables: Iterable[RenderableType] = ()) -> None:
        """The result, as a document or as tables."""
        if self.as_json:
            emit(json_text(document), sys.stdout)
        elif not self.quiet:
            emit(rendered(tables), sys.stdout)


def fitting(shown: RenderableType, console: Console) -> Iterator[RenderableType]:
    """The parts of a table that is wider than the terminal: its first column begins each."""
    from rich.measure import Measurement
    from rich.table import Table

    def width(table: RenderableType) -> int:
        return Measurement.get(console, console.options.update(max_width=10_000), table).minimum

    if not isinstance(shown, Table) or len(shown.columns) < 3 or width(shown) <= console.width:
        yield shown
        return
    first, *others = shown.columns
    while others:
        for count in range(len(others), 0, -1):
            part = copy(shown)
            part.columns = [first, *others[:count]]
            if count == 1 or width(part) <= console.width:
                break
        others = others[count:]
        yield part


def rendered(tables: Iterable[RenderableType]) -> str:
    """Text of tables for the standard output: coloured and as wide as a terminal, if it is one."""
    from rich.console import Console

    screen = sys.stdout is not None and sys.stdout.isatty()
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    page = io.TextIOWrapper(io.BytesIO(), encoding, errors="replace", newline="\n")
    console = Console(
        file=page,
        force_terminal=screen or None,  # None leaves it to FORCE_COLOR
        width=None if screen or "COLUMNS" in os.environ else PLAIN_WIDTH,
        # rich leaves bold letters where NO_COLOR asks for none.
        color_system=None if os.environ.get("NO_COLOR") else "auto",
        highlight=False,
        # Titles and file names may hold [brackets] and :colons:, which mean nothing here.
        markup=False,
        emoji=False,
    )
    for number, part in enumerate(part for table in tables for part in fitting(table, console)):
        if number:
            console.print()
        console.print(part, crop=False)  # too wide is better than cut off
    page.seek(0)
    return page.read()


def emit(text: str, stream: TextIO | None) -> None:
    """Write at once. What the stream cannot encode becomes ``?``; a reader that left is no error.

    After `rps ... | head -1` there is nobody left to read. The command goes on, so that its files
    and its exit code do not depend on who listens. The same holds for a stream that is closed.

    Raises
    ------
    OutputError
        If the standard output goes to a file that cannot be written.
    """
    if stream is None:
        return
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(text.encode(encoding, "replace").decode(encoding))
        stream.flush()
    except OSError as error:
        # What is still in the stream's buffer must not fail again when the program ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if stream is sys.stdout and not isinstance(error, BrokenPipeError):
            raise OutputError(f"standard output: cannot be written: {error.strerror}") from None
