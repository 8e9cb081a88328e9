"""Options of commands, and words with which a shell completes them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from rpscli.case.conditions import parse_condition
from rpscli.commands.shell.terminal import Terminal
from rpscli.constants import MOST_JOBS
from rpscli.errors import UsageError, hint, listed
from rpscli.registry import of_tools
from rpscli.report.figures.look import (
    FIGURES,
    FORMATS,
    RATES,
    USUAL,
    USUAL_SIZE,
    FilmRequest,
    Look,
)
from rpscli.report.figures.style import drawable_style

FILE = click.Path(allow_dash=True, readable=False)
"""A file, of which the command itself says what is wrong with it."""


class FiniteRange(click.FloatRange):
    """A number in a range; NaN and infinity, which compare with
    bounds as they like, are none.
    """

    def __init__(self, remedy: str = "", **bounds: Any) -> None:
        super().__init__(**bounds)
        self.remedy = remedy

    def _describe_range(self) -> str:
        bounded = self.min is not None or self.max is not None
        return super()._describe_range() if bounded else ""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """The number, or a refusal."""
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a finite number{self.remedy}", param, ctx)
        return super().convert(number, param, ctx)


Words = Mapping[str, str | None] | Iterable[str]
"""For a shell, what they mean beside them where that is known."""


def completing(known: Callable[[], Words], *, or_file: bool = False) -> dict[str, Any]:
    """For `click.option`: the words that a shell may complete a value with, or files."""

    def words(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
        known_words = known()
        meanings = (
            known_words
            if isinstance(known_words, Mapping)
            else dict.fromkeys(known_words)
        )
        begin = [each for each in meanings.items() if each[0].startswith(begun)]
        fit = [CompletionItem(word, help=text) for word, text in begin]
        return (
            [CompletionItem(begun, type="file")]
            if or_file and not (begun and fit)
            else fit
        )

    return {"shell_complete": words}


def _case_keys() -> dict[str, str | None]:
    """Keys of a case that hold a value, after `--set`."""
    # pydantic is slow.
    from rpscli.case.schema.case_file import CaseFile
    from rpscli.case.schema.keys import field_at, known_paths, section_of

    fields = {
        ".".join(map(str, path)): field_at(CaseFile, path)
        for path in known_paths(CaseFile)
    }
    return {
        key: field.description
        for key, field in fields.items()
        if field and section_of(field.annotation) is None
    }


def _condition_names() -> dict[str, str | None]:
    """Events and results after `--fail-on`, these with the unit of their limit."""
    from rpscli.case.conditions import EVENTS, LIMITS, NOT_SHOWN

    return {
        **{name: f"records that {verb}" for name, verb in EVENTS.items()},
        NOT_SHOWN: "limits met by too few records to show it",
        **{
            name: f"{quantity.label} [{quantity.unit}]"
            for name, quantity in LIMITS.items()
        },
    }


def _sources() -> Iterator[str]:
    """Records of sets, after `--record`."""
    from rpscli.records import sets
    from rpscli.records.source import SET

    return (f"{SET}:{name}" for name in (*sets.COMPONENTS, *sets.WHOLE))


def measures() -> list[str]:
    """Measures that `--scale-to` may begin with."""
    from rpscli.records.measures import MEASURES

    return [f"{name}=" for name in MEASURES.names()]


Command = Callable[..., None]
Decorator = Callable[[Command], Command]


@dataclass(frozen=True)
class CaseRequest:
    """The case that a command works on: a file or ``-``, and values put over it."""

    source: str
    overrides: tuple[str, ...] = ()

    @property
    def words(self) -> list[str]:
        """The case on a command line, with what is put over it."""
        return [self.source, *set_words(self.overrides)]


def set_words(settings: Iterable[str]) -> list[str]:
    """Values that are put over a case, on a command line."""
    return [word for setting in settings for word in ("--set", setting)]


@dataclass(frozen=True)
class Output:
    """Where results go: terminal, folder, None for the default one, and
    the look of its figures.
    """

    terminal: Terminal
    place: Path | None = None
    force: bool = False
    look: Look = USUAL


def gathered(name: str, make: Callable[..., Any], *options: Decorator) -> Decorator:
    """Options whose values reach the command as one argument, which is made of them."""
    taken = tuple(signature(make).parameters)

    def decorate(function: Command) -> Command:
        @functools.wraps(function)
        def command(**given: Any) -> None:
            value = make(**{key: given.pop(key) for key in taken if key in given})
            function(**{name: value}, **given)

        made: Command = command
        for option in options[::-1]:  # the help lists the last one first
            made = option(made)
        return made

    return decorate


_TERMINAL = (
    click.option(
        "--json",
        "as_json",
        is_flag=True,
        help="Print one JSON document in place of tables.",
    ),
    click.option("-q", "--quiet", is_flag=True, help="Print errors only (and --json)."),
)
terminal_options = gathered("terminal", Terminal, *_TERMINAL)
"""--json and --quiet, as `terminal`."""


records_option = click.option(
    "--record",
    "records",
    multiple=True,
    metavar="SRC",
    type=FILE,
    **completing(_sources, or_file=True),
    help=(
        "Ground motion in place of the case's own: file, folder, set, pulse, both"
        " components of a pair (fema_p695:farfield/1?both); repeatable."
    ),
)


def overrides_option(meaning: str) -> Decorator:
    """--set, with what it does for the command, as `overrides`."""
    return click.option(
        "--set",
        "overrides",
        multiple=True,
        metavar="KEY=VALUE",
        **completing(_case_keys),
        help=f"{meaning}; repeatable.",
    )


_overrides = overrides_option(
    "Override a value of the case, such as --set podium.bearing.curvature_ratio=1.5"
)

style_option = click.option(
    "--style",
    "style_file",
    type=click.Path(path_type=Path),
    metavar="FILE.mplstyle",
    help="matplotlib's settings for the figures: fonts, sizes, lines, colours.",
)


case_options = gathered(
    "request",
    CaseRequest,
    click.argument("source", metavar="CASE", type=FILE),
    _overrides,
)
"""CASE and --set, as `request`."""


OF_ONE_RESULT = ("modal", "pushover", "timehistory")
"""Commands whose results other packages may draw."""


def _look(figures: str | None, columns: str | None, style_file: Path | None) -> Look:
    formats, added = (None, ()) if figures is None else _formats(figures)
    command = click.get_current_context().info_name
    if added and command not in OF_ONE_RESULT:
        raise UsageError(
            f"--figures {figures}: {added[0]} is drawn by {listed(OF_ONE_RESULT)} alone"
        )
    style = {} if style_file is None else drawable_style(style_file)
    return Look(formats, None if columns is None else int(columns), style, added)


def _formats(text: str) -> tuple[tuple[str, ...] | None, tuple[str, ...]]:
    """Formats of figures, none at all for the word none; and
    figures of other packages.
    """
    words = list(dict.fromkeys(word.strip() for word in text.split(",")))
    if [word.lower() for word in words] == ["none"]:
        return (), ()
    formats = tuple(word.lower() for word in words if word.lower() in FORMATS)
    added = tuple(word for word in words if word.lower() not in FORMATS)
    for word in added:
        if word not in (known := FIGURES.names()):
            known = [*FORMATS, "none", *known]
            meant = hint(word.lower(), known, "write png, svg, pdf, svg,pdf or none", 0.6)
            what = (
                f"{text}: {word} is not a format"
                if word
                else f"{text!r}: a format is missing"
            )
            raise UsageError(f"--figures {what}; {meant}")
        FIGURES[word]  # refused before the work
    return tuple(dict.fromkeys(formats)) or None, added


def _output(
    *,
    as_json: bool,
    quiet: bool,
    place: Path | None,
    force: bool,
    figures: str | None = None,
    columns: str | None = None,
    style_file: Path | None = None,
) -> Output:
    terminal = Terminal(as_json, quiet)
    return Output(terminal, place, force, _look(figures, columns, style_file))


direction_option = click.option(
    "--direction",
    type=click.Choice(["x", "y"]),
    default="x",
    help=(
        "The horizontal direction that is looked at: y has the building of"
        " superstructure.y and the rows of podium.plan.y; x by default."
    ),
)


_WRITTEN = (
    click.option(
        "-o",
        "--output",
        "place",
        type=click.Path(path_type=Path, readable=False),
        metavar="DIR",
        help="Folder of the results; results/<name>/<command> by default.",
    ),
    click.option(
        "--force", is_flag=True, help="Overwrite files that this command did not write."
    ),
    *_TERMINAL,
)
written_options = gathered("out", _output, *_WRITTEN)
"""-o, --force, --json and --quiet, as `out`."""
result_options = gathered(
    "out",
    _output,
    click.option(
        "--figures",
        metavar="FORMATS",
        **completing(lambda: (*FORMATS, "svg,pdf", "none")),
        help="Formats of the figures: png, svg, pdf, several as in svg,pdf, or none; also"
        " figures that other packages add.",
    ),
    click.option(
        "--columns",
        type=click.Choice(("1", "2")),
        help="Make figures as wide as one column of a journal (89 mm), or two (178 mm).",
    ),
    style_option,
    *_WRITTEN,
)
"""Options of every command that draws and writes, as `out`."""


def _film(
    file: Path | None = None,
    size: int | None = None,
    speed: float | None = None,
    first: float | None = None,
    last: float | None = None,
) -> FilmRequest | None:
    wishes = {"size": size, "speed": speed, "first": first, "last": last}
    asked: dict[str, Any] = {
        name: value for name, value in wishes.items() if value is not None
    }
    if asked and file is None:
        raise UsageError("options that begin with --animate- go with --animate FILE")
    return None if file is None else FilmRequest(file, **asked)


_FILM = (
    click.option(
        "--animate",
        "file",
        type=click.Path(path_type=Path),
        metavar="FILE",
        help=f"Also draw an animation: {' or, with ffmpeg, '.join(RATES)}.",
    ),
    click.option(
        "--animate-size",
        "size",
        type=click.IntRange(200, 4000),
        metavar="PIXELS",
        help=f"Width of the animation; {USUAL_SIZE} by default.",
    ),
)
_SECOND = FiniteRange(min=0.0)
_PART = (
    click.option(
        "--animate-speed",
        "speed",
        type=FiniteRange(min=0.0, min_open=True),
        metavar="FACTOR",
        help="Speed over real time, such as 0.5; by default the animation lasts 9 s.",
    ),
    click.option(
        "--animate-from",
        "first",
        type=_SECOND,
        metavar="S",
        help="Start of the animation [s]; by default where the motion begins.",
    ),
    click.option("--animate-to", "last", type=_SECOND, metavar="S", help="Its end [s]."),
)
_FILMED = bool(of_tools("films"))
film_options = gathered("film", _film, *(_FILM if _FILMED else ()))
"""--animate and --animate-size, as `film`."""
history_film_options = gathered("film", _film, *((*_PART, *_FILM) if _FILMED else ()))
"""--animate and its options, with speed and part of a history, as `film`."""


@dataclass(frozen=True)
class RunChoices:
    """Choices of the run of a study."""

    jobs: int | None = None
    scheduler: str | None = None
    dry_run: bool = False
    fresh: bool = False
    retry_failed: bool = False
    report_only: bool = False

    def __post_init__(self) -> None:
        if self.report_only and (self.fresh or self.retry_failed or self.scheduler):
            raise UsageError(
                "--report-only computes no points; remove --fresh, --retry-failed and"
                " --scheduler"
            )
        if self.scheduler and self.jobs:
            raise UsageError(
                "--jobs counts threads of this machine; --scheduler has its own"
            )


run_options = gathered(
    "choices",
    RunChoices,
    click.option(
        "--jobs",
        type=click.IntRange(1, MOST_JOBS),
        metavar="N",
        help="Threads; all cores by default.",
    ),
    click.option(
        *("--scheduler", "--cluster", "scheduler"),
        metavar="ADDRESS",
        help="Use a Dask cluster, as in tcp://head:8786.",
    ),
    click.option(
        "--dry-run", is_flag=True, help="Check the file; show its points and an estimate."
    ),
    click.option("--fresh", is_flag=True, help="Discard stored results."),
    click.option("--retry-failed", is_flag=True, help="Recompute failed points."),
)
"""The choices for the points of a study, as `choices`."""


def _case_requests(
    cases: tuple[str, ...], overrides: tuple[str, ...]
) -> list[CaseRequest]:
    if cases.count("-") > 1:
        raise UsageError("the standard input, -, can be read once only")
    return [CaseRequest(case, overrides) for case in cases]


several_cases_options = gathered(
    "requests",
    _case_requests,
    click.argument("cases", metavar="CASE...", nargs=-1, required=True, type=FILE),
    _overrides,
)
"""CASE... and --set, as `requests`."""


def fail_on_option(meaning: str) -> Decorator:
    """--fail-on, with what it does for the command, as `conditions`."""
    return gathered(
        "conditions",
        lambda fail_on: [parse_condition(text) for text in fail_on],
        click.option(
            "--fail-on",
            multiple=True,
            metavar="WHAT",
            **completing(_condition_names),
            help=meaning,
        ),
    )
