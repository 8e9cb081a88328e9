"""`rps report`: one page for whoever checks, prints or keeps the results."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import datetime
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from rpscli.case.conditions import Condition
from rpscli.commands import inputs
from rpscli.commands.page_section import section_options
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, leave
from rpscli.errors import Refused, UsageError
from rpscli.registry import loaded
from rpscli.report.figures.look import Look
from rpscli.report.figures.style import drawable_style
from rpscli.report.files import require_writable, undrawn, write_whole
from rpscli.version import VERSION

if TYPE_CHECKING:
    from rpscli.commands.page_done import PageDone
    from rpscli.commands.report_page import Earlier

PEOPLE = {"project": "project", "author": "made by", "checker": "checked by"}
"""Options with which a page is signed, and their words there."""


@click.command("report")
@click.argument("subject", metavar="CASE|STUDY|DESIGN|FOLDER")
@click.option(
    "-o",
    "--output",
    "place",
    type=click.Path(path_type=Path),
    metavar="FILE.html",
    help="The page; results/<name>/report.html by default.",
)
@options.overrides_option("Override a value of the case or study")
@inputs.motion_options
@options.fail_on_option("A further limit, as in `rps timehistory`; repeatable.")
@click.option(
    "--project", metavar="TEXT", help="Name or number of the project, for the page."
)
@click.option("--author", metavar="NAME", help="Who made the page and signs it.")
@click.option("--checker", metavar="NAME", help="Who checks the page and signs it.")
@section_options
@options.style_option
@click.option("--force", is_flag=True, help="Overwrite a file that is not a report.")
@options.terminal_options
def command(
    subject: str,
    place: Path | None,
    overrides: tuple[str, ...],
    records: tuple[str, ...],
    conditions: list[Condition],
    style_file: Path | None,
    terminal: Terminal,
    motion: inputs.MotionRequest,
    *,
    extra: dict[str, str],
    force: bool,
    **people: str | None,
) -> None:
    """One page about a CASE, a STUDY, a DESIGN or a FOLDER of results.

    It has the structure, the input, the formulas with their values, the ground motions,
    verdicts, tables and figures, and the command that repeats it. It needs no network and
    no scripts, and prints on A4. Histories of a CASE are computed, with mean and largest
    of several records; so are points of a STUDY or DESIGN that are not stored yet. Those
    of a FOLDER are computed again and compared with what is stored.
    """
    if place is not None and place.suffix.lower() not in {".html", ".htm"}:
        raise UsageError(
            f"-o {place}: the page is HTML; name a file that ends with .html"
        )
    from rpscli.commands import report_page as pages
    from rpscli.report.page import FORMATS

    style = {} if style_file is None else drawable_style(style_file)
    request = options.CaseRequest(subject, overrides)
    wanted = _Wanted(request, records, motion, conditions, extra)
    earlier = pages.earlier_results(Path(subject)) if Path(subject).is_dir() else None
    kind = pages.kind_of(subject) if earlier is None else earlier.run["command"]
    if why := _unfit(wanted, kind, stored=earlier is not None):
        raise UsageError(f"{subject}: {why}")
    folder = None if earlier is None else earlier.folder
    out = options.Output(terminal, folder, look=Look(FORMATS, style=style))
    name, make = _page_of(wanted, kind, earlier, out)

    file = place or inputs.RESULTS / name / "report.html"
    _require_free(file, name, force=force)
    done = make()
    _write(file, name, done, people, terminal)
    leave(done.error)


class _Wanted(NamedTuple):
    """The subject of a page, and the options that say what stands on it."""

    request: options.CaseRequest
    records: tuple[str, ...]
    motion: inputs.MotionRequest
    conditions: list[Condition]
    extra: dict[str, str]


def _unfit(wanted: _Wanted, kind: str, *, stored: bool) -> str:
    """The reason why an option does not go with the subject; empty if all do."""
    from rpscli.commands import report_page as pages

    with_motion = wanted.records or wanted.motion != inputs.MotionRequest()
    if stored and wanted.request.overrides:
        return "stored results keep the values they have; leave --set out"
    if (kind != pages.HISTORY or stored) and with_motion:
        of = {pages.SWEEP: "study", **{name: name for name in pages.PAGES}}
        owner = (
            f"a {of[kind]} has records of its own"
            if kind in of
            else "a stored history has its record"
        )
        return f"{owner}; leave --record, --vertical and --scale out"
    if wanted.extra and kind != pages.HISTORY:
        return f"--{next(iter(wanted.extra))} is about one history; name a case"
    if wanted.conditions and kind in pages.PAGES:
        return f"a {kind} has limits of its own; leave --fail-on out"
    return ""


def _page_of(
    wanted: _Wanted, kind: str, earlier: Earlier | None, out: options.Output
) -> tuple[str, Callable[[], PageDone]]:
    """The name of the subject, which is read and checked, and what makes its page."""
    from rpscli.commands import report_page as pages
    from rpscli.commands.study import read

    request = wanted.request
    if kind in pages.PAGES:
        name = Path(request.source).stem if earlier is None else earlier.run["name"]
        return name, partial(loaded(pages.PAGES[kind]), request, earlier, out)
    if kind == pages.SWEEP:
        subject = earlier.subject if earlier else request
        from rpscli.commands.page_of_study import study_page

        study = read(subject, wanted.conditions, out.terminal)
        return study.layout.study.name, partial(study_page, study, out)
    if earlier is None:
        given = inputs.read_case(request, out.terminal)
        records = wanted.records
        motions = [*inputs.single_motions(records, wanted.motion, out.terminal.warn)]
        asked: list[pages.Asked] = [(records, wanted.motion)]
    else:
        given, motions = earlier.case()
        asked = pages.typed_together(given.case, motions)
    told = (given, motions, asked, wanted.conditions, earlier, out)
    make = partial(pages.history_page, *told, extra=wanted.extra)
    return given.case.name, make


def _require_free(file: Path, name: str, *, force: bool) -> None:
    """Refuse to replace what is no earlier page about the same."""
    require_writable(file.parent)
    if force or not file.exists():
        return
    from rpscli.report.page import is_about

    try:
        own = is_about(file.read_bytes(), name)
    except OSError:
        own = False
    if not own:
        raise Refused(
            f"{file} exists and is not a report of {name}; name another file with -o, or"
            " overwrite it with --force"
        )


def _write(
    file: Path,
    name: str,
    done: PageDone,
    people: Mapping[str, str | None],
    terminal: Terminal,
) -> None:
    """Write the page, signed by the people of the command line or of the case."""
    from rpscli.report.page import MOST_BYTES, Picture, page

    signed = {
        word: people[key] or getattr(done.signed, key) for key, word in PEOPLE.items()
    }
    made = datetime.now().astimezone().strftime("%d %B %Y, %H:%M %Z")
    subtitle = f"{done.subtitle}. Made by rps {VERSION} on {made}."
    content = page(
        done.title, subtitle, done.sections, name, signed, done.signed.language
    )
    write_whole({file: content})
    blocks = (block for section in done.sections for block in section.blocks)
    shown = (each.files.values() for each in blocks if isinstance(each, Picture))
    terminal.warn(undrawn(chain.from_iterable(shown)))
    if len(content) > MOST_BYTES:
        terminal.warn(
            [f"{file} has {1e-6 * len(content):.1f} MB: too many figures for a page"]
        )
    terminal.note(f"written to {file}, {1e-3 * len(content):.0f} kB")
    terminal.result(
        {**done.document, "command": "report", "files": [str(file)]}, [str(file)]
    )
