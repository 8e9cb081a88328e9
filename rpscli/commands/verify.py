"""`rps verify`: whether this installation gives the numbers that are known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from itertools import groupby
from typing import TYPE_CHECKING

import click

from rpscli.commands.shell.failure import concluded, leave
from rpscli.commands.shell.options import terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation
from rpscli.errors import VerificationMismatch
from rpscli.report.documents import heading
from rpscli.report.table import Heading, Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.verification.known import Comparison

DIGITS = 7


@click.command("verify")
@terminal_options
def command(terminal: Terminal) -> None:
    """Compare this installation with closed forms, published numbers and a second integrator.

    Takes some seconds, half a minute if the kernels have to be compiled first. The exit code is 6
    if a single number is off.
    """
    from rpscli.analyses.verification import verification

    announce_compilation(terminal)
    found = list(verification())
    error = _mismatch(found)
    document = {
        **heading(),
        "command": "verify",
        "compared": len(found),
        "mismatches": sum(not line.holds for line in found),
        "comparisons": [{**asdict(line), "holds": line.holds} for line in found],
    }
    terminal.result(concluded(document, error), _tables(found))
    leave(error)


def _tables(found: Sequence[Comparison]) -> Iterator[Part]:
    for group, lines in groupby(found, lambda line: line.group):
        yield Heading(group)
        yield Table.of_texts(
            ("quantity", "expected", "computed", "tolerance", "verdict"),
            [
                (
                    f"{line.quantity} [{line.unit}]" if line.unit != "-" else line.quantity,
                    *_numbers(line),
                    "agrees" if line.holds else "DIFFERS",
                )
                for line in lines
            ],
        )
    off = sum(not line.holds for line in found)
    yield Heading(f"{len(found)} numbers compared, {off or 'none'} off")


def _numbers(line: Comparison) -> tuple[str, str, str]:
    """Expected, computed, tolerance; counts are whole."""
    if line.tolerance == 0.0:
        return f"{line.expected:g}", f"{line.computed:g}", "0"
    values = (shown(value, DIGITS) for value in (line.expected, line.computed))
    return next(values), next(values), shown(line.tolerance, 2)


def _mismatch(found: Sequence[Comparison]) -> VerificationMismatch | None:
    off = [line for line in found if not line.holds]
    if not off:
        return None
    first = (
        f"{len(off)} of {len(found)} numbers differ from what is known: do not trust results of"
        " this installation; install rps again, and report it if they still differ"
    )
    lines = [
        f"{line.quantity}: {computed} instead of {expected} {line.unit}, tolerance {tolerance}"
        f" ({line.group})"
        for line in off
        for expected, computed, tolerance in (_numbers(line),)
    ]
    return VerificationMismatch("\n".join([first, *lines]))
