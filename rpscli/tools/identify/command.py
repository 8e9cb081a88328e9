"""`rps identify`: what measurements on a standing building say about its case."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.inputs import CaseInput, case_heading, read_case
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, announce_compilation, passing_time
from rpscli.errors import AnalysisError, RecordError, UsageError, beginning, listed
from rpscli.report.files import heading
from rpscli.report.table import Heading, Part, Table, shown
from rpscli.titled_table import TitledTable
from rpscli.tools.identify.pull_options import PullRequest, pull_options

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rpscli.tools.identify.estimates import Identified

    Columns = dict[str, NDArray[Any]]

TESTS = (
    "rocking",
    "ambient",
    "release",
    "earthquake",
)  # of `identify`, which is slow to import
PULL_BACK = "pull-back"
"""The test that has no record, in place of a file."""
FEWEST = 20
"""Samples of a measurement."""
LARGEST = 1e15
"""A measured number beyond it, or none at all, is a slip."""


@click.command("identify")
@options.case_options
@click.argument("data", metavar=f"DATA.csv|{PULL_BACK}", type=options.FILE)
@click.argument(
    "test", metavar=f"[{'|'.join(TESTS)}]", type=click.Choice(TESTS), required=False
)
@click.option(
    "--from",
    "first",
    type=options.FiniteRange(),
    metavar="S",
    help="Ignore samples before this time.",
)
@click.option(
    "--to",
    "last",
    type=options.FiniteRange(),
    metavar="S",
    help="Ignore samples after this time.",
)
@pull_options
@options.terminal_options
def command(
    request: options.CaseRequest,
    data: str,
    test: str | None,
    first: float | None,
    last: float | None,
    pull: PullRequest,
    terminal: Terminal,
) -> None:
    """Identify properties of CASE from DATA.csv, measured on the
    structure, with 90 % intervals.

    Its header has names and units, as in `time [s],rotation [mrad]`. rocking: free
    rocking after a release from rest, `rotation` or `cap_beam_displacement`, gives the
    loss at impacts, and the lever of a rolling_resistance in the case. Before uplift the
    period and the damping follow from a `floor_acceleration`: ambient vibration, the
    release of a pull, or an earthquake with `ground_acceleration` as well.

    CASE pull-back, without a file, gives the slenderness from two numbers: how far the
    cap beam was pushed before it was let go, and when it was at rest. Its interval is
    that over the ranges of what is not known, and no probability.
    """
    given = read_case(request, terminal)
    test = _test_of(data, test, pull, parts=(first, last) != (None, None))
    if test == PULL_BACK:
        from rpscli.tools.identify.pull_report import told_pull_back

        told_pull_back(given, pull, terminal)
        return
    columns = measured(data, test, first, last)
    _tell_of_record(given, data, test, columns, terminal)


def _tell_of_record(
    given: CaseInput, data: str, test: str, columns: Columns, terminal: Terminal
) -> None:
    """Find what a record says, and tell it."""
    from rpscli.tools.identify.estimates import LEVEL
    from rpscli.tools.identify.identification import identified

    announce_compilation(terminal)
    with passing_time("fitting", terminal):
        try:
            found = identified(given.case.structure, test, columns)
        except AnalysisError as error:
            raise AnalysisError(f"{data}: {error}") from None
    document = {
        **heading("identify"),
        "case": case_heading(given),
        "test": test,
        "level": LEVEL,
        **_of_fit(found),
        "warnings": given.case.warnings,
        "files": [],
    }
    tables = [Heading(given.case.title), *_tables(found), found.remarks]
    fault = AnalysisError(f"{data}: {found.fault}") if found.fault else None
    terminal.finish(document, tables, fault)


def _test_of(data: str, test: str | None, pull: PullRequest, *, parts: bool) -> str:
    """The test that the words name; refuse options that go with another one."""
    if data == PULL_BACK and test is None:
        if parts:
            raise UsageError(f"{PULL_BACK}: --from and --to go with a file")
        return PULL_BACK
    if test is None:
        raise UsageError(f"{data}: say behind it what was measured: {listed(TESTS)}")
    if pull != PullRequest():
        raise UsageError(
            f"{test}: --displacement, --rest, --within and --range go with {PULL_BACK},"
            " in place of a file"
        )
    return test


def _of_fit(found: Identified) -> dict[str, Any]:
    """Estimates and what was fitted, for the document."""
    return {
        "estimates": [
            {"name": name, "unit": unit, **value._asdict()}
            for (name, unit), value in found.estimates.items()
        ],
        "misfit": found.misfit,
        "ensembles": found.ensembles,
        "residuals": found.residuals,
        "sensor": found.sensor,
        "keys": found.keys,
    }


def _tables(found: Identified) -> Iterator[Part]:
    rows = [
        (name, *(shown(number, 5) for number in value), unit.strip("-"))
        for (name, unit), value in found.estimates.items()
    ]
    yield Table.of_texts(("", "value", "from", "to", "unit"), rows)
    swings = []
    for each in found.residuals:
        top = each["amplitude"]
        model = each["model_amplitude"]
        numbers = (each["time"], each["model_time"], 1e3 * top, 1e3 * model)
        off = shown((top - model) / each["amplitude_error"], 2)
        swings.append((*(shown(number, 5) for number in numbers), off))
    heads = (
        "swing at s",
        "of the model",
        "rotation mrad",
        "of the model",
        "over its error",
    )
    if swings:
        yield Table.of_texts(heads, swings, words=0)
    if found.keys:
        sets = options.set_words(f"{key}={value}" for key, value in found.keys.items())
        yield f"in the case, or behind it: {shlex.join(sets)}"


def measured(source: str, test: str, first: float | None, last: float | None) -> Columns:
    """Columns that a test needs, in SI units, in the time that is looked at."""
    from rpscli.case.text.files import read_text
    from rpscli.titled_table import titled_table
    from rpscli.tools.identify.identification import TESTS

    table = titled_table(read_text(source, wide=True), source, RecordError)
    names = table.names
    columns: Columns = {}
    for wanted in ((("time", "s"),), *TESTS[test]):
        column = next((each for each in wanted if each[0] in names), None)
        if column is None:
            missing = listed(f"`{name} [{unit}]`" for name, unit in wanted)
            raise RecordError(
                f"{source}:1: no column {missing}; {test} needs one: name it so"
            )
        name, unit = column
        columns[name] = _column(table, names.index(name), name, unit)
    time = columns["time"]
    _require_even_times(time, source)

    ends = (time[0] if first is None else first), (time[-1] if last is None else last)
    kept = (time >= ends[0]) & (time <= ends[1])
    if kept.sum() < FEWEST:
        raise UsageError(
            f"{source}: {kept.sum()} samples lie between --from and --to; {FEWEST} are"
            " needed"
        )
    return {name: values[kept] for name, values in columns.items()}


def _column(table: TitledTable, place: int, name: str, unit: str) -> NDArray[Any]:
    """Numbers of a column in an SI unit; refuse what is none, or far too large."""
    import numpy as np

    from rpscli.titled_table import number_of
    from rpscli.units import si_factor

    rule = f"write numbers, in {unit} or another such unit"
    try:
        factor = si_factor(table.titles[place].unit or unit, unit)
    except ValueError as error:
        raise RecordError(f"{table.source}: column {name}: {error}; {rule}") from None
    values = factor * np.array([number_of(row.cells[place]) for row in table.rows])
    if (bad := np.flatnonzero(~(np.abs(values) < LARGEST))).size:
        line, cells = table.rows[bad[0]]
        found = beginning(cells[place]) if cells[place] else "is empty"
        raise RecordError(f"{table.source}:{line}: column {name}: {found}; {rule}")
    return values


def _require_even_times(time: NDArray[Any], source: str) -> None:
    """Refuse samples that are few, or not at even times."""
    import numpy as np

    steps = np.diff(time)
    even = len(time) >= FEWEST and steps.mean() > 0.0
    if not (even and np.allclose(steps, steps.mean(), rtol=1e-2, atol=0.0)):
        raise RecordError(
            f"{source}: at least {FEWEST} samples at even times that rise are needed;"
            " resample it"
        )
