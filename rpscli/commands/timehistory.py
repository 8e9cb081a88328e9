"""`rps timehistory`: response of cases to ground motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import click

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import Condition
from rpscli.commands.inputs import MotionRequest, motion_options, read_case, single_motions, write
from rpscli.commands.shell.options import (
    CaseRequest,
    OutputRequest,
    fail_on_option,
    history_film_options,
    result_options,
    several_cases_options,
)
from rpscli.commands.shell.terminal import Terminal, leave
from rpscli.commands.shell.waiting import announce_compilation, counted
from rpscli.commands.timehistory_run import (
    HistoryRequest,
    add_summary,
    compute,
    history_requests,
    look_beside,
)
from rpscli.errors import CaseError, UsageError, all_made
from rpscli.report.figures.film import FilmRequest
from rpscli.report.figures.look import Look, drawn_with


@click.command("timehistory")
@several_cases_options
@motion_options
@fail_on_option(
    "End with exit code 10 on overturning, on uplift, or if a result is beyond a value, as in"
    f" {', '.join(f'{result.name}={result.limit}' for result in LIMITED)} (SI units), or"
    " not-shown if several records are too few to show that a limit is met; repeatable."
)
@history_film_options
@click.option(
    "--floor-spectra",
    is_flag=True,
    help="Also compute spectra of every floor, on bearings and on a fixed base.",
)
@result_options
def command(
    requests: list[CaseRequest],
    records: tuple[str, ...],
    output: OutputRequest,
    terminal: Terminal,
    conditions: list[Condition],
    film: FilmRequest | None,
    look: Look,
    motion: MotionRequest,
    *,
    floor_spectra: bool,
) -> None:
    """Response of each CASE to its record, or to each --record.

    Overturning is a result, not an error: see --fail-on. The limits of the case count as well.
    Several histories end with one table and one verdict; ask for their figures with --figures.
    """
    motions = list(single_motions(records, motion, terminal.warn))
    cases = all_made(lambda request: read_case(request, terminal), requests, CaseError)
    histories = [
        replace(history, floor_spectra=floor_spectra)
        for history in history_requests(cases, motions, output)
    ]
    announce_compilation(terminal)
    if len(histories) == 1:
        _one(histories[0], conditions, look, film, terminal)
        return
    if film is not None:
        raise UsageError(f"--animate {film.file}: shows one history, not {len(histories)}")
    from rpscli.commands.timehistory_set import run_all

    chosen = look if look.formats is not None else replace(look, formats=())
    run_all(histories, conditions, chosen, output, terminal)


def _one(
    request: HistoryRequest,
    conditions: Sequence[Condition],
    look: Look,
    film: FilmRequest | None,
    terminal: Terminal,
) -> None:
    from rpscli.report.tables.timehistory import neighbours_texts, passes_text, timehistory_tables

    title = request.given.case.title
    done, result = compute(request, conditions, look, terminal)
    beside = look_beside(done, result)
    if film is not None:
        from rpscli.report.figures.animation import history_film

        with counted("drawing the animation", terminal) as progress:
            draw = partial(history_film, result, title, film, progress)
            request.folder.add_at(film.file, drawn_with(look, film.ending, draw))
    add_summary(done)
    write(request.folder, terminal)
    terminal.warn(done.document["warnings"])
    scaled_to = request.ground.scaled_to
    tables = timehistory_tables(result, done.verdicts, title, scaled_to)
    single = neighbours_texts(result, beside)
    told = [*single, passes_text(result), done.document["note"]]
    terminal.result(done.document, [*tables, *filter(None, told)])
    leave(done.error)
