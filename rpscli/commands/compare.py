"""`rps compare`: what differs between two cases or folders of results."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpscli.analyses.result_quantities import plain
from rpscli.commands.inputs import RESULTS, MotionRequest, read_case, single_motions
from rpscli.commands.report_case import DESIGN, HISTORY, SUMMARY, SWEEP, kind_of
from rpscli.commands.shell.options import (
    FILE,
    CaseRequest,
    OutputRequest,
    records_option,
    terminal_options,
)
from rpscli.commands.shell.terminal import Terminal, concluded, leave
from rpscli.errors import LimitExceeded, UsageError
from rpscli.report.documents import heading, versions
from rpscli.report.figures.look import Look
from rpscli.report.files import RUN_FILE
from rpscli.report.table import csv_text

if TYPE_CHECKING:
    from rpscli.report.differences import Side

NOT_DRAWN = Look(formats=())


@click.command("compare")
@click.argument("a", metavar="A", type=FILE)
@click.argument("b", metavar="B", type=FILE)
@records_option
@click.option(
    "--tolerance",
    type=click.FloatRange(min=0.0),
    metavar="SHARE",
    help="End with exit code 10 if a result differs by more than this share of its largest value:"
    " 0 requires equality to the last digit, 0.01 one percent.",
)
@terminal_options
def command(
    a: str, b: str, records: tuple[str, ...], tolerance: float | None, terminal: Terminal
) -> None:
    """What differs between A and B: each a case, a study, a folder of results, or its run.json.

    Inputs are compared with all defaults written out, then versions, then every result, with the
    change that 1 % less or more motion makes. For a case the history is computed, or only what `rps
    check` shows if neither names a record. For a study missing points are computed and stored;
    nothing else is written.
    """
    from rpscli.report.differences import comparison_document, differences, tables

    known = [_of_folder(source) if _folder(source) else None for source in (a, b)]
    kinds = [of[0] if of else kind_of(source) for source, of in zip((a, b), known, strict=True)]
    for source, kind, of in zip((a, b), kinds, known, strict=True):
        if kind == DESIGN and of is None:
            remedy = f"run both by `rps {kind}`, and compare the folders of their results"
            raise UsageError(f"{source}: is a design; {remedy}")
        if records and (kind != HISTORY or of):
            raise UsageError(f"{source}: has records of its own; leave --record out")
    _require_alike(a, b, kinds)
    of_case = partial(_of_case, records=records, terminal=terminal, alone=any(known))
    (of_a, first), (of_b, second) = (
        of or (_of_study(source, terminal) if kind == SWEEP else of_case(source))
        for source, kind, of in zip((a, b), kinds, known, strict=True)
    )
    _require_alike(a, b, (of_a, of_b))
    for side in (first, second):
        terminal.warn(f"{side.source}: {text}" for text in side.warnings)
    found = differences(first, second)
    error = None
    if beyond := [each.name for each in found if each.exceeds(tolerance)]:
        error = LimitExceeded(
            f"{len(beyond)} results of {a} and {b} differ by more than {tolerance:g} of their"
            f" largest value: {', '.join(beyond[:5])}{' ...' * (len(beyond) > 5)}"
        )
    document = {**heading("compare"), "tolerance": tolerance}
    document |= comparison_document(first, second, found)
    terminal.result(concluded(document, error), tables(first, second, found, tolerance))
    leave(error)


def _require_alike(a: str, b: str, kinds: Sequence[str]) -> None:
    if kinds[0] != kinds[1]:
        raise UsageError(
            f"{a} is of `rps {kinds[0]}`, {b} of `rps {kinds[1]}`: compare two of one kind, cases"
            " under one motion by --record"
        )


def _folder(source: str) -> Path | None:
    """The folder of results that a source names, by itself or by a file that stands in each."""
    path = Path(source)
    if path.name in {RUN_FILE, SUMMARY}:
        return path.parent
    return path if path.is_dir() else None


def _of_case(
    source: str, records: tuple[str, ...], terminal: Terminal, *, alone: bool
) -> tuple[str, Side]:
    from rpscli.commands.shell.waiting import announce_compilation
    from rpscli.commands.timehistory_run import compute, history_requests, look_beside
    from rpscli.commands.timehistory_set import computed_set
    from rpscli.report.differences import Side, leaves
    from rpscli.report.study.statistics import demand_columns, records_columns
    from rpscli.report.tables.derived import derived_quantities

    given = read_case(CaseRequest(source, ()), terminal)
    unwritten = OutputRequest(Path(), force=True)
    side = Side(source, versions(), dict(leaves(plain({"case": given.case.document}))))
    if given.case.record is None and not records and not alone:
        side.add_document(plain(derived_quantities(given.case.structure)))
        return "check", side
    requests = history_requests([given], [*single_motions(records, MotionRequest())], unwritten)
    announce_compilation(terminal)
    if len(requests) == 1:
        side.inputs = dict(leaves(plain(requests[0].folder.run.inputs)))
        done, result = compute(requests[0], (), NOT_DRAWN, terminal)
        look_beside(done, result)
        side.add_document(plain(done.document))
        return HISTORY, side
    found = computed_set(requests, (), NOT_DRAWN, terminal, None, written=False)
    rows = records_columns(found.labels, [history.document for history in found.histories])
    side.add_table("records.csv", csv_text(rows))
    side.add_table("statistics.csv", csv_text(demand_columns(found.together)))
    return HISTORY, side


def _of_study(source: str, terminal: Terminal) -> tuple[str, Side]:
    from rpscli.commands.study import read, stored_study
    from rpscli.report.differences import Side, leaves
    from rpscli.report.study.folder import study_inputs

    study = read(CaseRequest(source, ()), (), terminal)
    folder = RESULTS / study.layout.study.name / SWEEP
    run, found = stored_study("compare", study, folder, NOT_DRAWN, terminal)
    side = Side(source, versions(), dict(leaves(plain(study_inputs(run.layout, study.overrides)))))
    for name, content in found.files.items():
        if name.endswith(".csv"):
            side.add_table(name, str(content))
    return SWEEP, side


def _of_folder(source: str) -> tuple[str, Side]:
    from rpscli.report.differences import Side, leaves

    folder, file = _folder(source) or Path(), RUN_FILE
    try:
        run = json.loads((folder / RUN_FILE).read_text(encoding="utf-8"))
        side = Side(source, run["versions"], dict(leaves(run["inputs"])))
        names = [name for name in run["files"] if name.endswith(".csv")]
        if run["command"] == HISTORY and "records" not in run["inputs"]:
            file, names = SUMMARY, []
            side.add_document(json.loads((folder / file).read_text(encoding="utf-8")))
        for file in names:
            side.add_table(file, (folder / file).read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        reason = error.strerror if isinstance(error, OSError) else f"it is damaged ({error!r})"
        raise UsageError(
            f"{folder / file}: cannot be compared: {reason}; name a folder with the results of one"
            f" command of rps and its {RUN_FILE}"
        ) from None
    return str(run["command"]), side
