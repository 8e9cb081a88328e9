"""`rps verify`: whether this installation, or any program, gives the numbers that are known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.shell.options import FILE, terminal_options
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.commands.shell.waiting import announce_compilation
from rpscli.errors import Refused, UsageError, VerificationMismatch
from rpscli.report.documents import heading
from rpscli.report.files import write_whole
from rpscli.report.table import Heading, Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.verification.known import Comparison

DIGITS = 7
INSTALLATION = (
    "differ from what is known: do not trust results of this installation; install rps again, and"
    " report it if they still differ"
)


@click.command("verify")
@click.option(
    "--problems",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help="Write certified problems, with a page and a case each, and answers.csv to fill in.",
)
@click.option(
    "--score",
    metavar="FILE.csv",
    type=FILE,
    help="Count correct digits of any program's answers (columns problem, quantity, value).",
)
@click.option(
    "--digits",
    type=click.FloatRange(min=0.0, max=12.0),
    default=3.0,
    show_default=True,
    help="Correct digits that --score requires; fewer in one answer end with exit code 6.",
)
@terminal_options
def command(*, problems: Path | None, score: str | None, digits: float, terminal: Terminal) -> None:
    """Compare this installation with closed forms, published numbers and a second integrator.

    Takes some seconds, after a minute in which the kernels for one plane, for both directions and
    for compliant ends are compiled once. The exit code is 6 if a single number is off.
    """
    if problems is not None and score is not None:
        raise UsageError("--problems writes what --score reads; take one of them")
    if problems is not None:
        _write_problems(problems, terminal)
    elif score is not None:
        _score(score, digits, terminal)
    else:
        from rpscli.analyses.verification import verification

        announce_compilation(terminal)
        _conclude(list(verification()), INSTALLATION, terminal)


def _conclude(
    found: Sequence[Comparison], what: str, terminal: Terminal, *remarks: str, **told: Any
) -> None:
    error = _mismatch(found, what)
    document = {
        **heading("verify"),
        "compared": len(found),
        "mismatches": sum(not line.holds for line in found),
        "comparisons": [
            {**asdict(each), "holds": each.holds, "digits": each.digits} for each in found
        ],
        **told,
    }
    terminal.result(concluded(document, error), (*_tables(found), *remarks))
    leave(error)


def _write_problems(folder: Path, terminal: Terminal) -> None:
    from rpscli.analyses.verification.certified import ANSWERS, problem_files

    files = {folder / name: content for name, content in problem_files().items()}
    if there := [path for path in files if path.exists()]:
        raise Refused(f"{there[0]} exists; name another folder, or remove it")
    write_whole(files)
    terminal.note(f"written to {folder}; begin with README.md, fill in {folder / ANSWERS}")
    if terminal.as_json:
        terminal.result({**heading("verify"), "files": [str(path) for path in files]})


def _score(source: str, digits: float, terminal: Terminal) -> None:
    from rpscli.analyses.verification.certified import answers
    from rpscli.case.text.files import read_text

    found, left = answers(read_text(Path(source)), source, digits)
    if not found:
        raise UsageError(f"{source} answers nothing; fill in its column `value`")
    what = f"are missing, or have less than {digits:g} digits right; the pages say how to get them"
    right = [line.digits for line in found if line.digits is not None]
    remarks = [f"{sum(right) / len(right):.1f} digits in the mean"] if right else []
    remarks += [f"not answered: {', '.join(left)}"] if left else []
    _conclude(found, what, terminal, *remarks, not_answered=left)


def _tables(found: Sequence[Comparison]) -> Iterator[Part]:
    for group, lines in groupby(found, lambda line: line.group):
        yield Heading(group)
        yield Table.of_texts(
            ("quantity", "expected", "computed", "tolerance", "verdict"),
            [
                (
                    f"{line.quantity} [{line.unit}]" if line.unit != "-" else line.quantity,
                    *_numbers(line),
                    line.verdict,
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


def _mismatch(found: Sequence[Comparison], what: str) -> VerificationMismatch | None:
    off = [line for line in found if not line.holds]
    if not off:
        return None
    first = f"{len(off)} of {len(found)} numbers {what}"
    lines = [
        f"{line.quantity}: {computed} instead of {expected} {line.unit}, tolerance {tolerance}"
        f" ({line.group})"
        for line in off
        for expected, computed, tolerance in (_numbers(line),)
    ]
    return VerificationMismatch("\n".join([first, *lines]))
