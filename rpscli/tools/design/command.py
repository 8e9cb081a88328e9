"""`rps design`: the best values of a case."""

from __future__ import annotations

import click

from rpscli.commands.shell import options


@click.command("design")
@click.argument("design", metavar="DESIGN", type=options.FILE)
@options.overrides_option(
    "Override a value of the file (--set search.most=64) or of its base case"
)
@options.run_options
@options.result_options
def command(
    design: str,
    overrides: tuple[str, ...],
    choices: options.RunChoices,
    out: options.Output,
) -> None:
    """Find the values of DESIGN that meet its limits and minimise its objective.

    The file has a base case, `variables`, records and `limits` as a study, and
    `minimise`. The search starts from evenly spread designs and refines where the verdict
    changes. The answer is the best design that passes in 90 % of the resamples of the
    records, if any does, and is validated on records that the search did not see.

    Every point is stored at once: after an interruption the same command
    continues. The exit code is 10 if no design passes, or if the best one fails
    the limits in its validation.
    """
    from rpscli.tools.design.run import designed

    request = options.CaseRequest(design, overrides)
    done = designed(request, choices, out)
    if done is not None:
        done.conclude(out.terminal)
