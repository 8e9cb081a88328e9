"""`rps report`: one page for whoever checks, prints or keeps the results."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from functools import partial
from pathlib import Path

import click

from rpscli.case.conditions import Condition
from rpscli.commands import inputs, report_case
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, leave
from rpscli.errors import Refused, UsageError
from rpscli.report.figures.look import Look
from rpscli.report.figures.style import drawable_style
from rpscli.report.files import require_writable, write_whole
from rpscli.version import VERSION


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
@click.option("--project", metavar="TEXT", help="Name or number of the project, for the page.")
@click.option("--author", metavar="NAME", help="Who made the page and signs it.")
@click.option("--checker", metavar="NAME", help="Who checks the page and signs it.")
@click.option(
    "--budget",
    "with_budget",
    is_flag=True,
    help="Add the sensitivity of each limited result of a CASE, as in `rps budget`.",
)
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
    with_budget: bool,
    force: bool,
    **people: str | None,
) -> None:
    """One page about a CASE, a STUDY, a DESIGN or a FOLDER of results.

    It has the structure, the input, the formulas with their values, the ground motions, verdicts,
    tables and figures, and the command that repeats it. It needs no network and no scripts, and
    prints on A4. Histories of a CASE are computed, with mean and largest of several records; so are
    points of a STUDY or DESIGN that are not stored yet. Those of a FOLDER are computed again and
    compared with what is stored.
    """
    if place is not None and place.suffix.lower() not in {".html", ".htm"}:
        raise UsageError(f"-o {place}: the page is HTML; name a file that ends with .html")
    look = Look(style={} if style_file is None else drawable_style(style_file))
    request, asked = options.CaseRequest(subject, overrides), motion
    earlier = report_case.earlier_results(Path(subject)) if Path(subject).is_dir() else None
    kind = report_case.kind_of(subject) if earlier is None else earlier.run["command"]
    if earlier is not None and overrides:
        raise UsageError(f"{subject}: stored results keep the values they have; leave --set out")
    if (kind != report_case.HISTORY or earlier) and (records or asked != inputs.MotionRequest()):
        reason = f"a {'study' if kind == report_case.SWEEP else 'design'} has records of its own"
        reason = "a stored history has its record" if kind == report_case.HISTORY else reason
        raise UsageError(f"{subject}: {reason}; leave --record, --vertical and --scale out")
    if with_budget and kind != report_case.HISTORY:
        raise UsageError(f"{subject}: --budget is about one history; name a case")
    if conditions and kind == report_case.DESIGN:
        raise UsageError(f"{subject}: a design has limits of its own; leave --fail-on out")
    name: str
    make: Callable[[], report_case.PageDone]
    if kind == report_case.DESIGN:
        from rpscli.commands.report_study import design_page

        name = Path(subject).stem if earlier is None else earlier.run["name"]
        make = partial(design_page, subject, overrides, earlier, look, terminal)
    elif kind == report_case.SWEEP:
        from rpscli.commands.report_study import study_page
        from rpscli.commands.study import read

        folder = None if earlier is None else earlier.folder
        made = read(earlier.subject if earlier else request, conditions, terminal)
        name = made.layout.study.name
        make = partial(study_page, made, folder, look, terminal)
    else:
        if earlier is None:
            given = inputs.read_case(request, terminal)
            motions = [*inputs.single_motions(records, asked, terminal.warn)]
            typed: list[report_case.Asked] = [(records, asked)]
        else:
            given, motions = report_case.earlier_case(earlier)
            typed = report_case.typed_together(given.case, motions)
        name = given.case.name
        told = (given, motions, typed, conditions, look, earlier, terminal)
        make = partial(report_case.case_page, *told, with_budget=with_budget)
    file = place or inputs.RESULTS / name / "report.html"
    _require_free(file, name, force=force)
    done = make()
    names = {"project": "project", "author": "made by", "checker": "checked by"}
    signed = {name: people[key] or getattr(done.signed, key) for key, name in names.items()}
    _write(file, name, done, signed, terminal)
    leave(done.error)


def _require_free(file: Path, name: str, *, force: bool) -> None:
    """Refuse to replace what is no earlier page about the same."""
    require_writable(file.parent)
    if force or not file.exists():
        return
    from rpscli.report.html.page import is_about

    try:
        own = is_about(file.read_bytes(), name)
    except OSError:
        own = False
    if not own:
        raise Refused(
            f"{file} exists and is not a report of {name}; name another file with -o, or overwrite"
            " it with --force"
        )


def _write(
    file: Path,
    name: str,
    done: report_case.PageDone,
    signed: dict[str, str | None],
    terminal: Terminal,
) -> None:
    from rpscli.report.html.page import MOST_BYTES, Picture, page

    made = datetime.now().astimezone().strftime("%d %B %Y, %H:%M %Z")
    subtitle = f"{done.subtitle}. Made by rps {VERSION} on {made}."
    content = page(done.title, subtitle, done.sections, name, signed)
    write_whole({file: content})
    blocks = (block for section in done.sections for block in section.blocks)
    terminal.warn(fault for each in blocks if isinstance(each, Picture) for fault in each.faults)
    if len(content) > MOST_BYTES:
        terminal.warn([f"{file} has {1e-6 * len(content):.1f} MB: too many figures for a page"])
    terminal.note(f"written to {file}, {1e-3 * len(content):.0f} kB")
    terminal.result({**done.document, "command": "report", "files": [str(file)]}, [str(file)])
