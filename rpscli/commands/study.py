"""A study for `rps sweep`, `rps design` and `rps report`: read,
tried, computed and shown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import groupby
from typing import Any, NamedTuple

import click

from rpscli import studies
from rpscli.case.conditions import Condition
from rpscli.commands.inputs import RESULTS, write
from rpscli.commands.shell import terminal as shell
from rpscli.commands.shell.options import CaseRequest, Output, RunChoices
from rpscli.commands.shell.terminal import Terminal, duration, passing_time
from rpscli.errors import LimitExceeded, Refused, RpsError
from rpscli.machine import available_cores
from rpscli.report.files import OutputFolder, failure_document, heading
from rpscli.report.limits import counts_of_limits, verdicts_in_short
from rpscli.report.study import statistics as of_study
from rpscli.report.study.collected import Collected
from rpscli.report.study.registry import asked
from rpscli.report.study.statistics import summary_document, verdict_document
from rpscli.report.table import Heading, Part, Table
from rpscli.studies import Study, StudyInterrupted, StudyResult
from rpscli.sweep.estimate import estimated_seconds
from rpscli.sweep.names import labels
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.run import Progress, Start
from rpscli.sweep.statistics.grouping import shown_keys
from rpscli.sweep.store import Store
from rpscli.sweep.systems import balance_note

POINTS_SHOWN = 3
"""At each end of a study."""
OF_A_REPORT = 12
"""Warnings that are shown at most."""
FEWER = (40, 30, 26, 22, 19, 16, 14, 12, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1)
"""Rows of a table: the most of them that fit."""
SOME_ROWS = 4
"""Of a table at least, before another one gives way."""
ALL = "; --all prints them"


def read(
    request: CaseRequest, conditions: Iterable[Condition], terminal: Terminal
) -> Study:
    """Read and check a study and all its systems."""
    examined = partial(shell.watched, "systems examined", terminal)
    how: dict[str, Any] = {"conditions": conditions, "watched": examined}
    study = studies.load_study(request.source, request.overrides, **how)
    if (section := study.layout.study.file.sample) and (note := balance_note(section)):
        terminal.warn([note])
    return study


def computed(
    command: str, study: Study, store: Store, choices: RunChoices, terminal: Terminal
) -> StudyResult:
    """A study whose points are in a store; what goes on is said, and
    an interruption ends it.
    """
    layout = study.layout

    @contextmanager
    def watch(begin: Start) -> Iterator[Callable[[Progress], None]]:
        for note in begin.notes if command != "design" else ():  # which is many studies
            terminal.note(note)
        pending = len(begin.pending)
        _begin(begin, layout, store, choices, terminal)
        with shell.progress_report(terminal, begin.kept, begin.kept + pending) as report:
            yield report

    def announce() -> None:
        terminal.note("\nstopping after the points under way; Ctrl-C again stops at once")

    names = ("jobs", "scheduler", "retry_failed")
    how: dict[str, Any] = {name: getattr(choices, name) for name in names}
    try:
        result = studies.run_in(store, study, watch, announce, **how)
    except StudyInterrupted as interruption:
        text = str(interruption)
        terminal.note(text)
        document = {
            **heading(command),
            "study": study_heading(layout),
            "points": interruption.points,
            **failure_document("Interrupted", text, shell.INTERRUPTED),
        }
        terminal.result(document)
        raise click.exceptions.Exit(shell.INTERRUPTED) from None
    if count := result.done.computed:
        seconds = result.done.seconds
        rate = count / seconds if seconds else 0.0
        terminal.note(
            f"computed {count} points in {duration(seconds)}, {rate:.3g} points/s"
        )
    return result


def _begin(
    begin: Start,
    layout: StudyPoints,
    store: Store,
    choices: RunChoices,
    terminal: Terminal,
) -> None:
    """Say what is stored already and what comes first, or refuse to compute anything."""
    pending = len(begin.pending)
    total = len(begin.keys)
    if choices.report_only and pending:
        raise Refused(
            f"{store.path} lacks {pending} of {total} points, which `rps sweep` computes"
        )
    if pending and begin.kept:
        terminal.note(f"continuing: {begin.kept} of {total} points are stored already")
    if pending and layout.plan.analysis == "timehistory" and not choices.scheduler:
        shell.announce_compilation(terminal)


def study_heading(layout: StudyPoints) -> dict[str, str]:
    """The study in a JSON document."""
    study = layout.study
    own = {"name": study.name, "title": study.title, "source": study.source}
    return {**own, "scaled_to": layout.scaled_to}


def counts_of_points(result: StudyResult) -> dict[str, int]:
    """All points of a study, and those of each outcome."""
    return {"points": len(result), **result.outcomes}


class Swept(NamedTuple):
    """A study that was computed, and the files and tables of its reports."""

    result: StudyResult
    found: Collected
    error: RpsError | None
    folder: OutputFolder

    @property
    def notes(self) -> list[str]:
        """Warnings about the study, its statistics and reports, and figures."""
        return [*self.result.study.warnings, *self.found.notes, *self.folder.undrawn]

    def document(self, command: str) -> dict[str, Any]:
        """All of it in JSON."""
        result = self.result
        found = self.found
        layout = self.result.layout
        statistics: dict[str, Any] = {}
        if (rows := result.summary) is not None:
            statistics = {
                "pooled": rows.pooled,
                "statistics": summary_document(rows),
                "verdicts": [
                    verdict_document(rows.keys, each) for each in result.judgements
                ],
            }
        document = {
            **heading(command),
            "study": study_heading(layout),
            "note": (result.summary and of_study.note_of_directions(layout)) or None,
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
            "warnings": self.notes,
            "files": [str(result.results.store.path), *self.folder.files],
        }
        return shell.concluded(document, self.error)

    def tables(self, most: int = 0) -> list[Part]:
        """All, or what fits into some lines: reports whole rather than
        verdicts and statistics, of which few rows stand, or counts.
        """
        result = self.result
        counts = counts_of_points(result)
        listing = [(name, str(count)) for name, count in counts.items()]
        listing.append(("records scaled to", result.layout.scaled_to))
        head: list[Part] = [Heading(result.study.title), Table.listing(listing)]
        note = result.summary and of_study.note_of_directions(result.layout)
        last = [note] if note else []
        if not most:
            every = (
                {of.name for of in result.summary.quantities} if result.summary else None
            )
            statistics = of_study.summary_tables(result.summary, every)
            return [*head, *statistics, *self._verdicts(), *self._reports(), *last]
        few = head
        for parts in self._fewer():
            few = [*head, *parts, *last]
            if shell.rendered(few).count("\n") <= most:
                break
        return few

    def _fewer(self) -> Iterator[list[Part]]:
        """Parts for ever fewer lines: rows of statistics go first, then those of verdicts,
        then those of reports, which were asked for.
        """
        result = self.result
        verdicts = list(self._verdicts())
        reports = list(self._reports())
        statistics = list(of_study.summary_tables(result.summary, asked(result.layout)))
        tables = sum(isinstance(part, Table) for part in statistics)
        for count in dict.fromkeys((tables, *(n for n in (3, 2) if n < tables))):
            some = of_study.first_tables(statistics, count, ALL)
            for rows in FEWER:
                yield [*of_study.cut(some, rows, ALL), *verdicts, *reports]
        elsewhere: list[Part] = [f"statistics are in statistics.csv{ALL}"]
        if result.summary is None:
            elsewhere = []
        yield [*elsewhere, *verdicts, *reports]
        judged = [counts_of_limits(result.judgements)] * bool(result.judgements)
        for rows in (n for n in FEWER if n >= SOME_ROWS):
            yield [*elsewhere, *judged, *of_study.cut(verdicts, rows, ALL), *reports]
        remarks = [part for part in verdicts if not isinstance(part, Table)]
        for some in _fewer_reports(reports):
            yield [*elsewhere, *judged, *remarks, *some]

    def _verdicts(self) -> Iterator[Part]:
        """Parts on what counts as overturned, and verdicts."""
        result = self.result
        if result.summary is not None:
            yield of_study.of_first_system(result.layout)
            if result.judgements:
                yield of_study.verdict_table(result.summary, result.judgements)

    def _reports(self) -> Iterator[Part]:
        """Parts of reports; a remark of several is said once."""
        remarks = set[Part]()
        for part in self.found.parts:
            if isinstance(part, Table):
                yield part
                continue
            if isinstance(part, Heading) or part not in remarks:
                yield part
            remarks.add(part)


def _fewer_reports(reports: Sequence[Part]) -> Iterator[list[Part]]:
    """Reports with ever fewer rows; where some rows of each leave no room for all, the
    first reports, and in which files the others are.
    """
    starts = [n for n, part in enumerate(reports) if isinstance(part, Heading)]
    for count in range(len(starts), 0, -1):
        end = starts[count] if count < len(starts) else len(reports)
        others = [f"{reports[n]}: {reports[n]}.csv{ALL}" for n in starts[count:]]
        for rows in (n for n in FEWER if n >= SOME_ROWS or count == 1):
            yield [*of_study.cut(reports[:end], rows, ALL), *others]


def swept(
    command: str,
    study: Study,
    folder: OutputFolder,
    choices: RunChoices,
    out: Output,
) -> Swept:
    """Compute what is not stored yet; only a sweep writes into
    the folder of the store.
    """
    with Store(folder.folder, fresh=choices.fresh) as store:
        result = computed(command, study, store, choices, out.terminal)
        with passing_time("making reports", out.terminal):
            found = studies.collected(result, out.look)
        if command == "sweep":
            folder.add_all(found.files.items())
            store.require()
            # The same points had other reports, or a report that comes again failed.
            folder.keeps_earlier = choices.report_only
            write(folder, out.terminal)
    return Swept(result, found, studies.error_of(result, found), folder)


def sweep(
    request: CaseRequest,
    conditions: Iterable[Condition],
    choices: RunChoices,
    out: Output,
    most: int,
) -> None:
    """Compute, write and show a study, in so many lines; 0 shows all."""
    terminal = out.terminal
    study = read(request, conditions, terminal)
    if choices.dry_run:
        show_dry_run("sweep", study, choices, terminal)
        return
    place = out.place or RESULTS / study.layout.study.name / "sweep"
    folder = study.output(place, force=out.force)
    done = swept("sweep", study, folder, choices, out)
    # Of each report: what one has to say takes no room from the next.
    for _, of_one in groupby(done.notes, lambda note: note.partition(": ")[0]):
        terminal.warn_first(list(of_one), "with --json", OF_A_REPORT)
    terminal.result(done.document("sweep"), done.tables(most))
    error = done.error
    if isinstance(error, LimitExceeded) and not (terminal.as_json or terminal.quiet):
        # The table has them one by one.
        error = LimitExceeded(verdicts_in_short(done.result.judgements))
    shell.leave(error)


def _points_at_the_ends(layout: StudyPoints, count: int) -> dict[int, dict[str, Any]]:
    """The first and the last of so many points by their numbers."""
    # Where a measure decides about the factor, it is not known yet.
    factor_known = layout.plan.analysis == "timehistory" and layout.plan.measure is None
    points: dict[int, dict[str, Any]] = {}
    for number in sorted({*range(count)[:POINTS_SHOWN], *range(count)[-POINTS_SHOWN:]}):
        point = layout[number]
        points[number + 1] = layout.described(number)
        if factor_known:
            points[number + 1]["scale"] = point.scale * point.scale_change
    return points


def show_dry_run(
    command: str, study: Study, choices: RunChoices, terminal: Terminal
) -> None:
    """Count, first and last points, and an estimate of the time."""
    terminal.warn(
        study.warnings
    )  # first: trying points may take long where the case is at fault
    layout = study.layout
    count = len(study)
    jobs = choices.jobs or available_cores()
    points = _points_at_the_ends(layout, count)
    listed = [{"point": number, **varied} for number, varied in points.items()]
    with passing_time("trying some of the points", terminal):
        seconds, source = estimated_seconds(layout, jobs)
    counts = {
        "points": count,
        "systems": len(layout.properties),
        "records": len(layout.records),
        "scales": len(layout.scales),
        "members": len(layout.members),
    }
    document: dict[str, Any] = {
        **heading(command),
        "study": study_heading(layout),
        "dry_run": True,
        "analysis": layout.plan.analysis,
        **counts,
        "first_points": listed[:POINTS_SHOWN],
        "last_points": listed[-POINTS_SHOWN:],
        "estimate": {"seconds": seconds, "jobs": jobs, "source": source},
        "warnings": study.warnings,
    }
    time = f"about {duration(seconds)} on {jobs} cores, by {source}"
    listing = [*((name, str(number)) for name, number in counts.items()), ("time", time)]
    tried = [
        (f"point {n}", labels(shown_keys(layout, [*each]), [*each.values()]))
        for n, each in points.items()
    ]
    parts = (Heading(study.title), Table.listing(listing), Table.listing(tried))
    terminal.result(document, parts)
