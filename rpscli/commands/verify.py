"""`rps verify`: correct digits of the certified problems, by this
installation or any program.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpscli.commands.inputs import MotionRequest, load_motion
from rpscli.commands.shell.options import FILE, FiniteRange, terminal_options
from rpscli.commands.shell.terminal import Terminal, announce_compilation
from rpscli.errors import Refused, UsageError, VerificationMismatch
from rpscli.report.files import heading, write_whole
from rpscli.report.table import Heading, Part, Table, shown

if TYPE_CHECKING:
    from rpscli.analyses.conformance import Recomputed
    from rpscli.analyses.verification import Comparison, Key

DIGITS = 10
OWN_DIGITS = 9.0
"""Digits that rps itself must have, or all that are certified: another processor rounds
in another way, which weights of the steps and impacts multiply."""
INSTALLATION = (
    "differ from what is known: do not trust results of this installation; install rps"
    " again, and report it if they still differ"
)
OF_OTHERS = (
    "are missing, or have less than {:g} digits right; the pages say how to get them"
)


@click.command("verify")
@click.option(
    "--problems",
    metavar="FOLDER",
    type=click.Path(path_type=Path),
    help=(
        "Write certified problems, with a page and a case each, and answers.csv to fill"
        " in."
    ),
)
@click.option(
    "--score",
    metavar="FILE.csv",
    type=FILE,
    help=(
        "Count correct digits of any program's answers (columns problem, quantity,"
        " value)."
    ),
)
@click.option(
    "--digits",
    type=FiniteRange(min=0.0, max=12.0),
    default=3.0,
    show_default=True,
    help=(
        "Correct digits that --score requires; fewer in one answer end with exit code 6."
    ),
)
@click.option(
    "--table",
    is_flag=True,
    help=(
        "Compute again the rows of the table of conformance that need no tests, each with"
        " what is expected, its share of the tolerance and a verdict."
    ),
)
@terminal_options
def command(
    *,
    problems: Path | None,
    score: str | None,
    digits: float,
    table: bool,
    terminal: Terminal,
) -> None:
    """Compute the certified problems, and count how many digits are correct.

    Their answers come from closed forms, quadratures and other integrators. Takes some
    seconds, after a minute in which the kernels for one plane and for both directions are
    compiled once. The exit code is 6 if a single number is off.
    """
    if problems is not None and score is not None:
        raise UsageError("--problems writes what --score reads; take one of them")
    if table and (problems is not None or score is not None):
        raise UsageError("--table computes rows here; take it without the others")
    if table:
        announce_compilation(terminal)
        _show_table(terminal)
    elif problems is not None:
        _write_problems(problems, terminal)
    elif score is not None:
        from rpscli.analyses.verification import answers_of_file
        from rpscli.case.text.files import read_text

        given = answers_of_file(read_text(Path(score)), score)
        if not given:
            raise UsageError(f"{score} answers nothing; fill in its column `value`")
        _conclude(given, digits, OF_OTHERS.format(digits), terminal)
    else:
        announce_compilation(terminal)
        _conclude(_own_answers(), OWN_DIGITS, INSTALLATION, terminal)


def _own_answers() -> dict[Key, list[float]]:
    from rpscli.analyses.verification import FOLDER, LEFT_OUT, answers, certified
    from rpscli.case.case import load_case

    given: dict[Key, list[float]] = {}
    for problem in dict.fromkeys(problem for problem, _ in certified()):
        if problem not in LEFT_OUT:
            case = load_case(FOLDER / f"{problem}.yaml")
            motion = load_motion(case, MotionRequest())
            given |= answers(problem, case.structure, motion, case.analysis)
    return given


def _conclude(
    given: Mapping[Key, Sequence[float]], digits: float, what: str, terminal: Terminal
) -> None:
    from rpscli.analyses.verification import scored

    compared, left = scored(given, digits)
    off = [line for line in compared if not line.holds]
    faults = [f"{len(off)} of {len(compared)} numbers {what}"]
    for line in off:
        expected, computed, tolerance = _numbers(line)
        text = f"{computed} instead of {expected} {line.unit}, tolerance {tolerance}"
        faults.append(f"{line.quantity}: {text} ({line.group})")
    document = {
        **heading("verify"),
        "compared": len(compared),
        "mismatches": len(off),
        "comparisons": [
            {**asdict(each), "holds": each.holds, "digits": each.digits}
            for each in compared
        ],
        "not_answered": left,
    }
    parts: list[Part] = []
    for group, lines in groupby(compared, lambda line: line.group):
        heads = ("quantity", "expected", "computed", "tolerance", "verdict")
        named = (
            (f"{one.quantity} [{one.unit}]".removesuffix(" [-]"), one) for one in lines
        )
        rows = [(name, *_numbers(one), one.verdict) for name, one in named]
        parts += [Heading(group), Table.of_texts(heads, rows)]
    parts.append(Heading(f"{len(compared)} numbers compared, {len(off) or 'none'} off"))
    if right := [line.digits for line in compared if line.digits is not None]:
        parts.append(f"{sum(right) / len(right):.1f} digits in the mean")
    if left:
        parts.append(f"not answered: {', '.join(left)}")
    terminal.finish(
        document, parts, VerificationMismatch("\n".join(faults)) if off else None
    )


def _show_table(terminal: Terminal) -> None:
    """Rows by capability, each computed again by this installation."""
    from rpscli.analyses.conformance import known_rows, recomputed

    rows = recomputed(_own_answers())
    off = [each for each in rows if not each.holds]
    document = {
        **heading("verify"),
        "compared": len(rows),
        "mismatches": len(off),
        "rows_of_tests": len(known_rows()),
        "rows": [each.document() for each in rows],
    }
    parts: list[Part] = []
    heads = ("quantity", "expected", "computed", "share", "verdict")
    for capability, group in groupby(rows, lambda each: each.row.capability):
        cells = [
            (each.row.quantity, *_compared_numbers(each), each.verdict) for each in group
        ]
        parts += [Heading(capability), Table.of_texts(heads, cells)]
    parts.append(Heading(f"{len(rows)} rows computed again, {len(off) or 'none'} off"))
    parts.append(
        f"the tests compare {len(known_rows())}: CONFORMANCE.md and conformance.json have"
        " the authority, source and test of each"
    )
    faults = [f"{len(off)} of {len(rows)} rows {INSTALLATION}"]
    for each in off:
        expected, computed, share = _compared_numbers(each)
        text = f"{computed} instead of {expected}, {share} tolerances"
        faults.append(f"{each.row.quantity}: {text} ({each.row.capability})")
    terminal.finish(
        document, parts, VerificationMismatch("\n".join(faults)) if off else None
    )


def _compared_numbers(each: Recomputed) -> tuple[str, str, str]:
    """Expected, computed, share of the tolerance."""
    return (
        f"{each.row.expected:.{DIGITS}g}",  # no more digits than were printed
        f"{each.computed:.{DIGITS}g}",
        shown(each.share, 2),
    )


def _numbers(line: Comparison) -> tuple[str, str, str]:
    """Expected, computed, tolerance."""
    return (
        shown(line.expected, DIGITS),
        shown(line.computed, DIGITS),
        shown(line.tolerance, 2),
    )


def _write_problems(folder: Path, terminal: Terminal) -> None:
    from rpscli.analyses.verification import ANSWERS, problem_files

    files = {folder / name: content for name, content in problem_files().items()}
    if there := [path for path in files if path.exists()]:
        raise Refused(f"{there[0]} exists; name another folder, or remove it")
    write_whole(files)
    terminal.note(
        f"written to {folder}; begin with README.md, fill in {folder / ANSWERS}"
    )
    if terminal.as_json:
        terminal.result({**heading("verify"), "files": [str(path) for path in files]})
