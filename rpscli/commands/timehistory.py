"""`rps timehistory`: response of cases to ground motions."""

from __future__ import annotations

from dataclasses import replace

import click

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.conditions import Condition
from rpscli.commands.inputs import (
    MotionRequest,
    motion_options,
    read_case,
    single_motions,
)
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import announce_compilation
from rpscli.errors import CaseError, UsageError, all_made
from rpscli.report.figures.look import FilmRequest


@click.command("timehistory")
@options.several_cases_options
@motion_options
@options.fail_on_option(
    "End with exit code 10 on overturning, on uplift, or if a result is beyond a value,"
    f" as in {', '.join(f'{result.name}={result.limit}' for result in LIMITED)} (SI"
    " units), or not-shown if several records are too few to show that a limit is met;"
    " repeatable."
)
@options.history_film_options
@click.option(
    "--floor-spectra",
    is_flag=True,
    help="Also compute spectra of every floor, on bearings and on a fixed base.",
)
@options.result_options
def command(
    requests: list[options.CaseRequest],
    records: tuple[str, ...],
    out: options.Output,
    conditions: list[Condition],
    film: FilmRequest | None,
    motion: MotionRequest,
    *,
    floor_spectra: bool,
) -> None:
    """Response of each CASE to its record, or to each --record.

    Overturning is a result, not an error: see --fail-on. The limits of the case
    count as well. Several histories end with one table and one verdict; ask for
    their figures with --figures.
    """
    from rpscli.commands.timehistory_run import histories_of, run_all, run_one

    motions = list(single_motions(records, motion, out.terminal.warn))
    cases = all_made(
        lambda request: read_case(request, out.terminal), requests, CaseError
    )
    histories = histories_of(cases, motions, out, floor_spectra=floor_spectra)
    announce_compilation(out.terminal)
    if len(histories) == 1:
        run_one(histories[0], conditions, film, out)
        return
    if film is not None:
        raise UsageError(
            f"--animate {film.file}: shows one history, not {len(histories)}"
        )
    if out.look.formats is None:
        out = replace(out, look=replace(out.look, formats=()))
        out.terminal.note(
            "figures of several histories are not drawn; add --figures png for those of"
            " each"
        )
    run_all(histories, conditions, out)
