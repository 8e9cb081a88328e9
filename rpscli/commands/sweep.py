"""`rps sweep`: all points of a study, and its reports."""

from __future__ import annotations

import click

from rpscli.case.conditions import Condition
from rpscli.commands.shell import options

MOST_LINES = 60


@click.command("sweep")
@click.argument("study", metavar="STUDY", type=options.FILE)
@options.overrides_option(
    "Override a value of the study (--set 'scale=[1, 2]') or of its base case"
    " (--set podium.bearing.slenderness=0.2)"
)
@options.run_options
@options.fail_on_option(
    "End with exit code 10 if overturning=0.1 (more than this share of the records of a"
    " system at an intensity), or a result of any record exceeds a value, as"
    " rotation_ratio=0.5 (SI units), or not-shown if too few records show that a limit"
    " is met; repeatable. The limits of study and case count as well."
)
@click.option(
    "--report-only", is_flag=True, help="Draw the reports again from the stored points."
)
@click.option(
    "--all",
    "whole",
    is_flag=True,
    help=(
        f"Print statistics of all demands, and all rows; at most {MOST_LINES} lines"
        " without it."
    ),
)
@options.result_options
def command(
    study: str,
    overrides: tuple[str, ...],
    choices: options.RunChoices,
    out: options.Output,
    conditions: list[Condition],
    *,
    whole: bool,
) -> None:
    """Compute all points of STUDY, and draw its reports.

    Every point is stored at once: after an interruption the same command continues.
    If points failed the exit code is 5, and failed.csv has the command that
    computes each of them alone. It is 10 if a limit of the study, of its base case
    or of --fail-on is exceeded.
    """
    from rpscli.commands.study import sweep

    given = options.CaseRequest(study, overrides)
    sweep(given, conditions, choices, out, 0 if whole else MOST_LINES)
