"""`rps design`: the values of a case that meet its requirements and minimise an objective."""

from __future__ import annotations

from typing import Any

import click

from rpscli.commands.inputs import write
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, leave
from rpscli.report.figures.look import Look


@click.command("design")
@click.argument("design", metavar="DESIGN", type=options.FILE)
@options.overrides_option("Override a value of the file (--set search.most=64) or of its base case")
@options.run_options
@options.result_options
def command(
    design: str,
    overrides: tuple[str, ...],
    output: options.OutputRequest,
    terminal: Terminal,
    look: Look,
    **choices: Any,
) -> None:
    """Find the values of DESIGN that meet its limits and minimise its objective.

    The file has a base case, `variables`, records and `limits` as a study, and `minimise`. The
    search starts from an even sample and continues where the verdict changes. The answer is the
    best design that passes in 90 % of the resamples of the records, if any does, and is validated
    on records that the search did not see.

    Every point is stored at once: after an interruption the same command continues. The exit
    code is 10 if no design passes, or if the best one fails the limits in its validation.
    """
    from rpscli.commands.design_run import designed
    from rpscli.commands.study import SweepChoices

    done = designed(design, overrides, SweepChoices(**choices), output, look, terminal)
    if done is None:
        return
    write(done.folder, terminal)
    document = done.document
    terminal.warn_first(document["warnings"], "with --json")
    terminal.result(document, done.tables)
    leave(done.error)
