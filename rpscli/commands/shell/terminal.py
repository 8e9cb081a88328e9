"""Streams of a command: results on the standard output, all else on
the standard error; errors.

What takes long says on the standard error how far it is: in a line that comes and goes
where somebody looks at a terminal.
"""

from __future__ import annotations

import io
import os
import re
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import (
    AbstractContextManager,
    ExitStack,
    contextmanager,
    nullcontext,
    suppress,
)
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TextIO

import click

from rpscli.errors import (
    TRACEBACK,
    LimitExceeded,
    OutputError,
    PluginError,
    RpsError,
    visible,
    words_of,
)
from rpscli.report.files import failure_document, json_text
from rpscli.report.table import Heading, Part, Table
from rpscli.user_cache import VARIABLE

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as RichTable
    from rich.text import Text

    from rpscli.case.case import Case
    from rpscli.records.ground_motion import MotionComponents
    from rpscli.sweep.run import Progress

WARNINGS_SHOWN = 5
PLAIN_WIDTH = 100
"""Columns where the output is no terminal and COLUMNS is not set."""
LONGEST_WORD = 30
LONGEST_HEAD = 14
MOST_LINES = 9
"""Letters of a word that is not broken, in cells and in heads; lines of heads."""
ALL_FOLD = 0
"""Lines of heads where numbers are broken as well, since one column
beside the keys is too wide."""
LAST = -MOST_LINES
"""The last way: columns that are as narrow as their words leave
it to others to give room."""
GAP = 3
"""Between two columns."""


def _columns_asked() -> bool:
    """True if COLUMNS says a width; 0 and words say none."""
    return os.environ.get("COLUMNS", "").isdigit() and int(os.environ["COLUMNS"]) > 0


@dataclass(frozen=True)
class Terminal:
    """One JSON document in place of tables; quiet: neither
    tables nor notes, but errors.
    """

    as_json: bool = False
    quiet: bool = False
    told: set[str] = field(default_factory=set, init=False, compare=False)
    """The warnings so far, each of which is said once."""

    def note(self, text: str) -> None:
        """A line about what goes on, on the standard error."""
        if not self.quiet:
            emit(visible(text) + "\n", sys.stderr)

    def warn(self, texts: Iterable[str]) -> None:
        """Lines that should be read before the numbers are used."""
        for text in texts:
            if text not in self.told:
                self.told.add(text)
                self.note(f"warning: {text}")

    def warn_first(
        self, texts: Sequence[str], where: str, most: int = WARNINGS_SHOWN
    ) -> None:
        """The first warnings, and how many there are besides."""
        self.warn(texts[:most])
        if len(texts) > most:
            self.note(f"... and {len(texts) - most} more {where}")

    def result(self, document: Mapping[str, Any], tables: Iterable[Part] = ()) -> None:
        """The result, as a document or as tables."""
        if self.as_json:
            emit(json_text(document), sys.stdout)
        elif not self.quiet:
            emit(rendered(tables), sys.stdout)

    def finish(
        self, document: Mapping[str, Any], tables: Iterable[Part], error: RpsError | None
    ) -> None:
        """The result, with the error that belongs to it and ends the command."""
        self.result(concluded(document, error), tables)
        leave(error)


def _fitting(table: Table, console: Console) -> Iterator[RichTable]:
    """The parts of a table that is wider than the terminal: its keys begin each."""
    columns = list(range(len(table.columns)))
    keys = columns[: table.keys]
    others = columns[table.keys :]
    while others:
        for count in range(len(others), 0, -1):
            shown = [*keys, *others[:count]]
            widths = _widths(table, shown, console.width, fold=count == 1)
            if widths:
                break
        others = others[count:]
        yield _made(table, shown, widths)


def _widths(table: Table, columns: Sequence[int], room: int, *, fold: bool) -> list[int]:
    """Widths that fit, or none: heads of numbers break into as few
    lines as do, then words fold.

    Numbers never do, but where one column beside the keys is too wide.
    """
    heads = [visible(table.heads[i]) for i in columns]
    rows = table.rows
    cells = [[visible(row[i]) for row in rows] for i in columns]
    for lines in (1, 2, 3, MOST_LINES, *[ALL_FOLD] * fold, LAST):
        both = [
            _width_of_words(head, own)
            if index < table.words
            else _width_of_numbers(head, own, lines)
            for index, head, own in zip(columns, heads, cells, strict=True)
        ]
        widths = [width for width, _ in both]
        least = [narrowest for _, narrowest in both]
        give = [
            i for i, n in enumerate(columns) if n < table.words or lines in {1, ALL_FOLD}
        ]
        for _ in range(sum(widths) + GAP * (len(widths) - 1) - room):
            if lines == LAST:
                give = [i for i in give if widths[i] > least[i]]
            widest = max(give, key=widths.__getitem__, default=0)
            if widths[widest] <= least[widest]:
                break
            widths[widest] -= 1
        else:
            return widths
    return []


def _width_of_words(head: str, cells: Sequence[str]) -> tuple[int, int]:
    """Width of a column of words without breaks, and the least that it can have."""
    longest = max((len(part) for cell in cells for part in cell.split()), default=0)
    least = max(min(longest, LONGEST_WORD), _longest_in_head(head))
    return max(1, *map(len, [head, *cells])), least


def _width_of_numbers(head: str, cells: Sequence[str], lines: int) -> tuple[int, int]:
    """Width of a column of numbers whose head has so many lines, and the least."""
    most = max(1, *map(len, [head, *cells]))
    number = max([_longest_in_head(head), *map(len, cells)])
    broken = (w for w in range(number, most + 1) if len(wrap(head, w)) <= abs(lines))
    width = next(broken, most)
    return width, {1: number, ALL_FOLD: 1}.get(lines, width)


def _longest_in_head(head: str) -> int:
    """Letters of the longest word of a head, at most those that are not broken."""
    return min(max(map(len, head.split()), default=1), LONGEST_HEAD)


def _made(table: Table, columns: Sequence[int], widths: Sequence[int]) -> RichTable:
    """Some columns of a table: words stand left, numbers
    right; a listing has no heads.
    """
    from rich import box
    from rich.table import Table as RichTable

    if listing := not any(table.heads):
        made = RichTable(
            box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0)
        )
    else:
        made = RichTable(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    fixed: Sequence[int | None] = widths or [None] * len(columns)
    for index, width in zip(columns, fixed, strict=True):
        justify: Literal["left", "right"] = "left" if index < table.words else "right"
        if listing:
            made.add_column(overflow="fold" if index else "ellipsis")
        else:
            head = visible(table.heads[index])
            made.add_column(head, justify=justify, overflow="fold", width=width)
    for row in table.rows:
        made.add_row(*(visible(row[index]) for index in columns))
    return made


def rendered(tables: Iterable[Part]) -> str:
    """Text of tables for the standard output: coloured and as wide as
    a terminal, if it is one.
    """
    from rich.console import Console

    screen = sys.stdout is not None and sys.stdout.isatty()
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    page = io.TextIOWrapper(io.BytesIO(), encoding, errors="replace", newline="\n")
    console = Console(
        file=page,
        force_terminal=screen or None,  # None leaves it to FORCE_COLOR
        width=None if screen or _columns_asked() else PLAIN_WIDTH,
        # rich leaves bold letters where NO_COLOR asks for none.
        color_system=None if os.environ.get("NO_COLOR") else "auto",
        highlight=False,
        # Titles and file names may hold [brackets] and :colons:, which mean nothing here.
        markup=False,
        emoji=False,
    )
    for number, part in enumerate(_parts(tables, console)):
        if number:
            console.print()
        console.print(part, crop=False)  # too wide is better than cut off
    page.seek(0)
    return page.read()


def _parts(tables: Iterable[Part], console: Console) -> Iterator[RichTable | Text]:
    from rich.text import Text

    for part in tables:
        if isinstance(part, Table):
            yield from _fitting(part, console)
        else:
            yield Text(visible(part), style="bold" if isinstance(part, Heading) else "")


def emit(text: str, stream: TextIO | None) -> None:
    """Write at once; what cannot be encoded becomes ``?``, and a
    reader that left is no error.
    """
    if stream is None:
        return
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(text.encode(encoding, "replace").decode(encoding))
        stream.flush()
    except (OSError, ValueError) as error:  # of a closed stream
        # What is still in the stream's buffer must not fail again when the program ends.
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        if stream is sys.stdout and not isinstance(error, BrokenPipeError):
            reason = getattr(error, "strerror", None) or error
            raise OutputError(f"standard output: cannot be written: {reason}") from None


INTERRUPTED = 130
INTERNAL = 1


class Ending(NamedTuple):
    """An error as it is told: its kind, its text and the exit code that stands for it."""

    kind: str
    message: str
    code: int

    @classmethod
    def of(cls, error: BaseException) -> Ending:
        """All faults of the command line are one kind; words of
        hundreds of letters are cut.
        """
        name = type(error).__name__
        code = INTERNAL
        if isinstance(error, RpsError | click.ClickException):
            code = error.exit_code
        if isinstance(error, click.ClickException):
            name = "UsageError"
            text = error.format_message()
        elif isinstance(error, RpsError):
            text = str(error)
        elif isinstance(error, KeyboardInterrupt | click.Abort):
            name = "Interrupted"
            code = INTERRUPTED
            text = (
                "interrupted; no file is half written; the same command may be given"
                " again"
            )
        elif isinstance(error, OSError):
            place = f"{str(error.filename)[:200]}: " if error.filename else ""
            text = (
                f"{place}{error.strerror or error}; check the path, its permissions and"
                " the disk"
            )
        elif isinstance(error, MemoryError | RecursionError):
            text = "there is not enough memory; use fewer points, samples or storeys"
        else:
            last = traceback.extract_tb(error.__traceback__)[-1:]
            where = f" ({Path(last[0].filename).name}:{last[0].lineno})" if last else ""
            text = (
                f"internal error{where}: {words_of(error)}; this is a fault of rps: please"
                f" report it with the traceback that {TRACEBACK}=1 shows"
            )
        # The end of a path says most of it.
        cut = re.sub(
            r"\S{301,}", lambda word: f"{word[0][:140]}...{word[0][-140:]}", text
        )
        return cls(name, cut, code)


def report(error: BaseException, *, as_json: bool) -> int:
    """Say on the streams what went wrong; returns the exit code."""
    ending = Ending.of(error)
    code = ending.code
    emit(_lines(error), sys.stderr)
    if as_json:
        try:
            emit(json_text(failure_document(*ending)), sys.stdout)
        except OutputError as unwritten:
            if not isinstance(error, OutputError):
                emit(_lines(unwritten), sys.stderr)
            code = unwritten.exit_code
    return code


def concluded(document: Mapping[str, Any], error: RpsError | None) -> dict[str, Any]:
    """The document of a result with its exit code; status ``ok``
    although a limit is exceeded.
    """
    if error is not None and not isinstance(error, LimitExceeded):
        return {**document, **failure_document(*Ending.of(error))}
    code = 0 if error is None else error.exit_code
    return {**document, "passed": code == 0, "exit_code": code}


def leave(error: RpsError | None) -> None:
    """End a command that has given its result, if an error belongs to it."""
    if error is not None:
        emit(_lines(error), sys.stderr)
        raise click.exceptions.Exit(error.exit_code)


def _lines(error: BaseException) -> str:
    ending = Ending.of(error)
    shown = isinstance(error, PluginError)  # where it was raised
    if ending.code == INTERNAL and os.environ.get(TRACEBACK) and not shown:
        return "".join(traceback.format_exception(error))
    if (
        type(error).__name__ == "NoArgsIsHelpError"
    ):  # click >= 8.2: a group without a subcommand
        return f"{ending.message}\n"
    usage = ""
    if isinstance(error, click.UsageError) and error.ctx is not None:
        usage = f"{error.ctx.get_usage()}\ntry {error.ctx.command_path} --help\n"
    return usage + "".join(
        f"error: {line}\n" for line in visible(ending.message).splitlines()
    )


MANY = 5000
"""Of what takes a millisecond each."""
LONG = 10.0
"""Time that is worth a word [s]."""
USUALLY = "a few seconds"
FIRST_LINE = 2.0
GROWTH = 1.6
"""Seconds until the first plain line; the next ones come after ever longer times."""

_bars: list[Any] = []
"""The one on the terminal; work inside other work becomes a line of it."""


@contextmanager
def _line(
    what: str, terminal: Terminal
) -> Iterator[Callable[[int, int, str], None] | None]:
    """A line until the work is done, and a function for how far it
    is; None if nobody looks.
    """
    if terminal.quiet or sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    with ExitStack() as opened:
        if not _bars:
            # The clock first: a line that is too long is cut at its end.
            columns = BarColumn(20), TimeElapsedColumn(), TextColumn("{task.description}")
            bar = Progress(*columns, console=Console(stderr=True), transient=True)
            _bars.append(opened.enter_context(bar))
            opened.callback(_bars.clear)
        else:
            opened.callback(lambda: bar.remove_task(task))
        bar = _bars[0]
        task = bar.add_task(what, total=None)

        def tell(done: int, total: int, text: str) -> None:
            bar.update(
                task, completed=done, total=total, description=f"{done}/{total}{text}"
            )

        yield tell


@contextmanager
def passing_time(what: str, terminal: Terminal) -> Iterator[None]:
    """A line with the work in progress and the time that has
    passed, where somebody looks.
    """
    with _line(what, terminal):
        yield


@contextmanager
def counted(what: str, terminal: Terminal) -> Iterator[Callable[[int, int], None]]:
    """A function that shows how many of how many are done: a bar on a
    terminal, else one line.
    """
    with _line(what, terminal) as tell:
        if tell is None:
            terminal.note(what)
        yield lambda done, total: tell(done, total, f", {what}") if tell else None


def watched(
    what: str, terminal: Terminal, numbers: range, *, many: int = MANY
) -> Iterator[int]:
    """The numbers; how many are done is shown where they are many."""
    if len(numbers) < many:
        yield from numbers
        return
    with counted(f"{len(numbers)} {what}", terminal) as tell:
        for number in numbers:
            tell(number, len(numbers))
            yield number


def patience(
    case: Case, motion: MotionComponents, terminal: Terminal
) -> AbstractContextManager[None]:
    """Around a history: what a long one costs is said before."""
    from rpscli.analyses.kernels.systems import most_seconds, most_steps

    seconds = most_seconds(case.structure, case.analysis, motion)
    if seconds < LONG:
        return nullcontext()
    steps = most_steps(case.structure, case.analysis, motion.duration)
    terminal.note(
        f"a long history: about {steps:.2g} steps of {case.structure.storeys} modes,"
        f" {seconds:.0f} s if it does not come to rest before; analysis.free_vibration"
        " shortens it"
    )
    return passing_time("computing", terminal)


def announce_compilation(terminal: Terminal) -> None:
    """Say so if a kernel has to be compiled, and how long that takes."""
    from rpscli.analyses.kernels.history import announce_to
    from rpscli.physics.kernels import cache_folder

    @contextmanager
    def announced(kernel: str) -> Iterator[None]:
        nowhere = (
            "each time: no folder that is yours alone can be written; name one in"
            f" {VARIABLE}"
        )
        often = "once for this version" if cache_folder() else nowhere
        terminal.note(f"compiling the {kernel}, {often}: {USUALLY}")
        with passing_time(f"compiling the {kernel} ({USUALLY})", terminal):
            yield

    announce_to(announced)


@contextmanager
def progress_report(
    terminal: Terminal, kept: int, total: int
) -> Iterator[Callable[[Progress], None]]:
    """A function that shows how far a study is: a bar on a terminal,
    else a line now and then.
    """
    due = FIRST_LINE
    with nullcontext() if kept == total else _line("", terminal) as tell:

        def report(progress: Progress) -> None:
            nonlocal due  # later and later: logs stay short
            if tell is not None:
                tell(
                    progress.done, total, "".join(f", {text}" for text in _pace(progress))
                )
            elif progress.seconds >= due and progress.done < progress.total:
                due = progress.seconds * GROWTH
                terminal.note(progress_line(progress))

        if tell is not None:
            tell(kept, total, "")
        yield report


def progress_line(progress: Progress) -> str:
    """Points done, rate and time left in one line."""
    return ", ".join((f"{progress.done} of {progress.total} points", *_pace(progress)))


def _pace(progress: Progress) -> Iterator[str]:
    """Failures, rate and time left, as far as they are known."""
    if progress.failed:
        yield f"{progress.failed} failed"
    if progress.rate:
        yield f"{progress.rate:.3g} points/s"
    if progress.seconds_left is not None:
        yield f"{duration(progress.seconds_left)} left"


def duration(seconds: float) -> str:
    """A time as people say it."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
