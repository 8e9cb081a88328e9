"""`rps sweep`: all points of a study."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

import click

from rpscli.case.conditions import Condition
from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, concluded, leave, rendered
from rpscli.commands.shell.waiting import passing_time
from rpscli.commands.study import SweepChoices, computed, read, show_dry_run, study_heading
from rpscli.errors import LimitExceeded
from rpscli.report.documents import heading
from rpscli.report.figures.look import Look
from rpscli.report.table import Heading, Part, Table

if TYPE_CHECKING:
    from rpscli.studies import Collected, StudyResult


OF_A_REPORT = 12
"""Warnings that are shown at most."""
MOST_LINES = 60
FEWER = (40, 30, 22, 16, 12, 9, 6, 4, 2, 1)
"""Rows of a table: the most of them that fit."""
ALL = "; --all prints them"


@click.command("sweep")
@click.argument("study", metavar="STUDY", type=options.FILE)
@options.overrides_option(
    "Override a value of the study (--set 'scale=[1, 2]') or of its base case"
    " (--set podium.bearing.slenderness=0.2)"
)
@options.run_options
@options.fail_on_option(
    "End with exit code 10 if overturning=0.1 (more than this share of the records of a system"
    " at an intensity), or a result of any record exceeds a value, as rotation_ratio=0.5 (SI"
    " units), or not-shown if too few records show that a limit is met; repeatable. The limits of"
    " study and case count as well."
)
@click.option("--report-only", is_flag=True, help="Draw the reports again from the stored points.")
@click.option(
    "--all",
    "whole",
    is_flag=True,
    help=f"Print statistics of all demands, and all rows; at most {MOST_LINES} lines without it.",
)
@options.result_options
def command(
    study: str,
    overrides: tuple[str, ...],
    output: options.OutputRequest,
    terminal: Terminal,
    conditions: list[Condition],
    look: Look,
    *,
    whole: bool,
    **choices: Any,
) -> None:
    """Compute all points of STUDY, and draw its reports.

    Every point is stored at once: after an interruption the same command continues. If points
    failed the exit code is 5, and failed.csv has the command that computes each of them alone. It
    is 10 if a limit of the study, of its base case or of --fail-on is exceeded.
    """
    chosen = SweepChoices(**choices)
    given = read(options.CaseRequest(study, overrides), conditions, terminal)
    if chosen.dry_run:
        show_dry_run(given, chosen, terminal)
        return
    from rpscli.report.limits import verdicts_in_short
    from rpscli.report.study.shown import note_of_directions
    from rpscli.report.study.statistics import summary_document, verdict_document
    from rpscli.studies import collected, error_of
    from rpscli.sweep.store import Store

    place = output.place or RESULTS / given.layout.study.name / "sweep"
    folder = given.output(place, force=output.force)
    with Store(place, fresh=chosen.fresh) as store:
        result = computed("sweep", given, store, chosen, terminal)
        with passing_time("making reports", terminal):
            found = collected(result, look)
        error = error_of(result, found)
        folder.add_all(found.files.items())
        store.require()
        write(folder, terminal)
    notes = [*given.warnings, *found.notes, *folder.undrawn]
    # Of each report: what one has to say takes no room from the next.
    for _, of_one in groupby(notes, lambda note: note.partition(": ")[0]):
        terminal.warn_first(list(of_one), "with --json", OF_A_REPORT)
    statistics: dict[str, Any] = {}
    if (rows := result.summary) is not None:
        statistics = {
            "pooled": rows.pooled,
            "statistics": summary_document(rows),
            "verdicts": [verdict_document(rows.keys, each) for each in result.judgements],
        }
    document = {
        **heading("sweep"),
        "study": study_heading(result.layout),
        "note": (result.summary and note_of_directions(result.layout)) or None,
        "points": {
            "total": len(result),
            "computed": result.done.computed,
            "kept": result.begin.kept,
            "failed": len(found.failures),
            "unused": result.begin.unused,
        },
        "outcomes": result.outcomes,
        **statistics,
        "reports": found.documents,
        "failures": [failure._asdict() for failure in found.failures],
        "notes": list(result.begin.notes),
        "warnings": notes,
        "files": [str(store.path), *folder.files],
    }
    terminal.result(concluded(document, error), _shown(result, found, whole=whole))
    if isinstance(error, LimitExceeded) and not (terminal.as_json or terminal.quiet):
        # The table has them one by one.
        error = LimitExceeded(verdicts_in_short(result.judgements))
    leave(error)


def _shown(result: StudyResult, found: Collected, *, whole: bool) -> list[Part]:
    """All, or as many rows of each table as fit into some lines: statistics are cut first."""
    from rpscli.report.limits import counts_of_limits
    from rpscli.report.study.shown import asked, cut, summary_tables

    judged, told = result.judgements, list(_told(result, found))
    if whole:
        return [*_head(result), *summary_tables(result.summary), *told]
    head = list(_head(result))
    statistics = list(summary_tables(result.summary, asked(result.layout)))
    few: list[Part] = []
    for rows, of_reports in [(n, FEWER[0]) for n in FEWER] + [(0, n) for n in FEWER]:
        some = cut(statistics, rows, ALL) if rows else [f"statistics are in statistics.csv{ALL}"]
        counts = [counts_of_limits(judged)] if len(judged) > of_reports else []
        few = [*head, *some, *counts, *cut(told, of_reports, ALL)]
        if rendered(few).count("\n") <= MOST_LINES:
            break
    return few


def _head(result: StudyResult) -> Iterator[Part]:
    """The title and counts of outcomes."""
    yield Heading(result.study.title)
    counts = {"points": len(result), **result.outcomes}
    listing = [(name, str(count)) for name, count in counts.items()]
    if aim := result.layout.scaled_to:
        listing.append(("records scaled to", aim))
    yield Table.listing(listing)


def _told(result: StudyResult, found: Collected) -> Iterator[Part]:
    """What counts as overturned, verdicts, reports; what several of them remark is said once."""
    from rpscli.report.study.shown import note_of_directions, of_first_system, verdict_table

    if result.summary is not None:
        yield of_first_system(result.layout)
        if result.judgements:
            yield verdict_table(result.summary, result.judgements)
    told: set[Part] = set()
    for part in found.parts:
        if isinstance(part, Table | Heading) or part not in told:
            yield part
        told |= set() if isinstance(part, Table) else {part}
    if result.summary and (note := note_of_directions(result.layout)):
        yield note
