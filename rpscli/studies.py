"""Studies: many histories from one case, stored as they end, and reports on them.

>>> from rpscli import load_study
>>> study = load_study({
...     "rps": 1, "title": "How wide must the ends be?", "analysis": "pushover",
...     "base": "cases/rigid_frame.yaml",
...     "vary": [{"podium.bearing.wedge_slenderness": [0.2, 0.3, 0.4]}],
... })
>>> result = study.run()
>>> result["podium.bearing.wedge_slenderness"].tolist()
[0.2, 0.3, 0.4]
>>> result["critical_rotation"].round(4).tolist()
[0.1974, 0.2915, 0.3805]
"""

from __future__ import annotations

import json
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property, partial
from hashlib import sha256
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any
from weakref import finalize

from rpscli.case.conditions import Condition
from rpscli.case.plausibility import doubts_of_many
from rpscli.case.study.schema import StudyFile
from rpscli.case.study.study import overridden, parse_study, study_of
from rpscli.case.text.document import Document, text_of_values
from rpscli.case.text.files import opened
from rpscli.constants import MOST_JOBS
from rpscli.errors import (
    LimitExceeded,
    RpsError,
    StudyIncomplete,
    UsageError,
    alike,
    hint,
    require_kind,
)
from rpscli.machine import available_cores
from rpscli.report.figures.look import Look
from rpscli.report.figures.style import drawable_style
from rpscli.report.files import CommandRun, OutputFolder, require_writable
from rpscli.report.study.collected import Collected
from rpscli.report.study.registry import REPORTS, lacking, requirement_faults
from rpscli.report.study.report import Found
from rpscli.report.study.statistics import (
    summary_columns,
    verdict_columns,
    verdict_lines,
)
from rpscli.report.table import Column
from rpscli.shown import Shown, data_frame, frozen
from rpscli.sweep.points import StudyPoints, lay_out
from rpscli.sweep.run import Engine, Progress, Start, run, start
from rpscli.sweep.statistics.summary import Summary, summary
from rpscli.sweep.statistics.verdicts import Verdict, judged, rate_notes
from rpscli.sweep.store import Store
from rpscli.sweep.systems import Watched, needs_of
from rpscli.sweep.table import (
    Columns,
    PointTable,
    StoredPoints,
    array,
    point_columns,
    points_csv,
    units_of_columns,
)

if TYPE_CHECKING:
    from rpscli.case.study.reports import ReportRequest
    from rpscli.report.figures.style import Target

FAILURES_SHOWN = 10


class StudyInterrupted(KeyboardInterrupt):
    """Somebody stopped a study; what is stored stays."""

    def __init__(self, stored: int, total: int, path: Path) -> None:
        super().__init__(
            f"interrupted: {stored} of {total} points are stored in {path}; the same"
            " command continues from there"
        )
        self.points = {"total": total, "stored": stored}


def load_study(
    source: Path | str | Mapping[str, Any],
    overrides: Sequence[str] = (),
    *,
    conditions: Iterable[Condition] = (),
    watched: Watched = iter,
) -> Study:
    """A study from its file, or from what such a file would say; all
    its systems are checked.

    Parameters
    ----------
    source
        A file, ``-`` for the standard input, or a mapping; relative names in a mapping
        start at the working folder.
    overrides, conditions
        Texts ``key=value`` over the study's own values, or over those of its base case;
        limits besides those of study and case.
    watched
        Goes through the numbers of the systems while they are checked.

    Raises
    ------
    CaseError
        If the study, one of its systems or what a report needs is not valid.
    """
    if isinstance(source, Mapping):
        text = text_of_values(source, "<study>")
        document = Document("<study>", json.loads(text))
        document, of_base = overridden(document, overrides, StudyFile)
        digest = sha256(text.encode()).hexdigest()
        checked = study_of(document, of_base, kinds=REPORTS, folder=Path(), digest=digest)
    else:
        require_kind(
            source, (str, Path), "the study", "give the name of a file, or a mapping"
        )
        checked = parse_study(**opened(source), kinds=REPORTS, overrides=overrides)
    study = Study(lay_out(checked, watched), tuple(overrides), tuple(conditions))
    study.require_results()
    return study


@dataclass(frozen=True, eq=False, repr=False)
class Study(Shown):
    """A study, laid out and checked; `len` is the number of its points.

    Parameters
    ----------
    layout
        Its points, each made when it is asked for.
    overrides, conditions
        What was put over the file; limits besides those of study and case.
    """

    layout: StudyPoints
    overrides: tuple[str, ...] = ()
    conditions: tuple[Condition, ...] = ()

    def require_results(self) -> None:
        """Refuse limits and reports on results that its systems do not have."""
        layout = self.layout
        layout.study.document.refuse(requirement_faults(layout))
        _ = [
            *rate_notes(layout)
        ]  # which refuses a hazard that the intensities do not go with
        for condition in self.conditions:
            if layout.plan.analysis != "timehistory":
                raise UsageError(
                    f"--fail-on {condition.name} needs analysis: timehistory"
                )
            if lacking(layout, condition.name, all):
                raise UsageError(f"--fail-on: {needs_of(condition.name, 'no')}")

    def __len__(self) -> int:
        return len(self.layout)

    @property
    def title(self) -> str:
        """Heading of reports."""
        return self.layout.study.title

    @property
    def reports(self) -> dict[str, ReportRequest]:
        """The reports that it asks for, by the names of their files."""
        return {request.stem: request for request in self.layout.study.reports}

    @property
    def warnings(self) -> list[str]:
        """Remarks on its file, and doubts about its systems, each kind once."""
        doubts = doubts_of_many(
            [properties.doubts for properties in self.layout.properties]
        )
        return [*self.layout.study.notes, *doubts]

    def facts(self) -> dict[str, Any]:
        """Counts of points, systems, records and scales."""
        layout = self.layout
        return {
            "title": self.title,
            "points": len(layout),
            "systems": len(layout.properties),
            "records": len(layout.records),
            "scales": len(layout.scales),
            "analysis": layout.plan.analysis,
            "reports": list(self.reports),
        }

    def output(
        self, place: Path, command: str = "sweep", *, force: bool = False
    ) -> OutputFolder:
        """A folder for its results, claimed for a command; a store
        there belongs to the study.

        Parameters
        ----------
        place, command
            The folder, and that which writes there.
        force
            Replace results of another study, or of another command.
        """
        # After a kill there may be files there that no `run.json` speaks of.
        require_writable(place)
        study = self.layout.study
        plan = self.layout.plan
        inputs = {
            "study": study.document.content,
            "base": plan.base,
            "overrides": list(self.overrides),
            "points": len(self),
            "solver": plan.solver,
        }
        file = None if study.source.startswith("<") else Path(study.source)
        known = Store(place).path.exists()
        return OutputFolder(
            place,
            CommandRun(command, study.name, file, study.digest, inputs),
            force=force or known,
        )

    def run(
        self,
        folder: Path | str | None = None,
        *,
        jobs: int | None = None,
        scheduler: str | None = None,
        fresh: bool = False,
        retry_failed: bool = False,
        progress: Callable[[Progress], None] = lambda _: None,
    ) -> StudyResult:
        """Compute what is not stored yet, and store each batch of points as it ends.

        Parameters
        ----------
        folder
            Of the store, which `rps sweep` reads and continues; without one the points
            are stored in a temporary folder that ends with the result.
        jobs, scheduler
            Threads, all cores by default; address of a Dask
            scheduler, in place of threads.
        fresh, retry_failed
            Discard stored results, or recompute failed points.
        progress
            Is told how far it is.

        Raises
        ------
        Refused
            If the folder holds something else.
        KeyboardInterrupt
            After Ctrl-C; what is stored stays, and the same call goes on from there.
        """
        keeper = _Temporary() if folder is None else None
        place = Path(keeper.place if keeper else folder or "")
        self.output(place)
        how: dict[str, Any] = {
            "jobs": jobs,
            "scheduler": scheduler,
            "retry_failed": retry_failed,
        }
        result = run_in(
            Store(place, fresh=fresh), self, lambda _: nullcontext(progress), **how
        )
        return replace(result, _keeper=keeper)


def run_in(
    store: Store,
    study: Study,
    watch: Callable[[Start], AbstractContextManager[Callable[[Progress], None]]],
    announce: Callable[[], None] = lambda: None,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
) -> StudyResult:
    """Run a study in a store. `watch` is told where it begins; what it
    gives is told how far it is.

    `announce` says that points under way will end after a first Ctrl-C.
    """
    if jobs is not None and not 0 < jobs <= MOST_JOBS:
        raise UsageError(
            f"jobs = {jobs} must be a number of threads from 1 to {MOST_JOBS}"
        )
    layout = study.layout
    jobs = jobs or available_cores()
    with store:
        begin = start(layout, store, retry_failed=retry_failed)
        done = Progress(len(study), begin.kept, 0, 0, 0.0)
        with watch(begin) as report:
            store.note(**begin.facts)
            try:
                if begin.pending:
                    engine = Engine(layout.context, jobs, scheduler)
                    done = run(layout, begin, store, engine, report, announce)
                if done.computed < len(begin.pending):
                    raise KeyboardInterrupt  # noqa: TRY301 -- told below
            except KeyboardInterrupt:
                known = store.outcomes()
                stored = sum(key in known for key in begin.keys)
                raise StudyInterrupted(stored, len(study), store.path) from None
        table = PointTable.of(layout, partial(store.results, begin.keys))
        return StudyResult(
            study, StoredPoints(table, begin.keys, store, jobs), begin, done
        )


@dataclass(frozen=True, eq=False, repr=False)
class StudyResult(Shown):
    """All points of a study that was run, statistics and reports; SI units.

    ``result["max_rotation"]`` is a column of `columns`.

    Parameters
    ----------
    study, results
        What was run, and its points as a table.
    begin, done
        What was stored before, and what was computed.
    """

    study: Study
    results: StoredPoints
    begin: Start
    done: Progress
    _keeper: object = None

    @property
    def layout(self) -> StudyPoints:
        """The points of the study."""
        return self.study.layout

    @property
    def folder(self) -> Path:
        """Of the store."""
        return self.results.store.path.parent

    @property
    def table(self) -> PointTable:
        """Results in the study's order."""
        return self.results.table

    def __len__(self) -> int:
        return len(self.table)

    def __getitem__(self, name: str) -> Any:
        """(points,) of a varied key or a result, as `points.csv` names it."""
        if name not in self.columns:
            near = (
                f"near are {', '.join(alike(str(name), self.columns, 3))}; `columns` has"
                " all"
            )
            raise KeyError(
                f"{name} is not a column; {hint(str(name), self.columns, near, 0.6)}"
            )
        return self.columns[name]

    @cached_property
    def columns(self) -> Columns:
        """(points,) arrays of all columns of `points.csv` by name;
        what does not exist is NaN.
        """
        return frozen(point_columns(self.table))

    @property
    def units(self) -> dict[str, str]:
        """SI units of the columns; ``-`` for those without one."""
        return units_of_columns(self.layout)

    @property
    def failures(self) -> dict[int, str]:
        """Reasons of failed points, by their places in the columns."""
        return self.table.messages

    @property
    def outcomes(self) -> dict[str, int]:
        """Counts of the points by their endings, the commonest first."""
        return dict(Counter(self.table.outcomes.tolist()).most_common())

    def to_dataframe(self) -> Any:
        """The columns as a table of pandas, which must be installed."""
        return data_frame(self.columns)

    def facts(self) -> dict[str, Any]:
        """Outcomes, and where they are stored."""
        return {
            "title": self.study.title,
            "points": len(self),
            **self.outcomes,
            "reports": list(self.study.reports),
            "stored": "in a temporary folder" if self._keeper else str(self.folder),
        }

    @cached_property
    def summary(self) -> Summary | None:
        """Statistics of each system at each intensity; None of
        analyses without histories.
        """
        if self.layout.plan.analysis != "timehistory":
            return None
        return summary(self.table, self.results.fixed_base)

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that distinguish the rows of statistics and verdicts."""
        return self.summary.keys if self.summary else ()

    @cached_property
    def judgements(self) -> list[Verdict]:
        """Verdicts on every limit of each system at each intensity."""
        return (
            judged(self.table, self.summary, self.study.conditions)
            if self.summary
            else []
        )

    @cached_property
    def statistics(self) -> Columns:
        """Columns of `statistics.csv`: a row a system and intensity.

        Counts, the share that overturned with its 95 % interval, and median, 84 %
        fractile and largest value of all demands, infinite where so many overturned.
        """
        return frozen(_arrays(summary_columns(self._of_histories())))

    @cached_property
    def verdicts(self) -> Columns:
        """Columns of `verdicts.csv`: a row a limit of the study or of
        its base case and system.
        """
        return frozen(
            _arrays(verdict_columns(self._of_histories().keys, self.judgements))
        )

    @property
    def passed(self) -> bool:
        """True if no limit is exceeded and no point failed."""
        return not self.failures and not any(
            verdict.exceeded for verdict in self.judgements
        )

    def _of_histories(self) -> Summary:
        if self.summary is None:
            raise UsageError("statistics and limits need analysis: timehistory")
        return self.summary

    @property
    def notes(self) -> list[str]:
        """Warnings about statistics and reports: what was pooled or left out."""
        return collected(self, Look(())).notes

    def report(self, name: str) -> Found:
        """Contents of a report that the study asks for, by the name of its files.

        Its `tables` are the columns of its CSV files, by what follows the name.
        """
        known = self.study.reports
        if name not in known:
            have = f"it has {', '.join(known)}" if known else "it has none"
            raise UsageError(f"{name} is not a report of the study; {have}")
        with self.results.store:
            return REPORTS[known[name].kind].make(self.results, known[name].options)

    def draw(self, name: str, target: Any = None, *, sheet: int = 1) -> Target:
        """The figure of a report.

        Parameters
        ----------
        name
            Of its files.
        target
            A figure, a part of one or axes of matplotlib to be drawn into; axes give
            their place to a part of their figure. A figure of its own by default.
        sheet
            Number of the sheet, where the report has several files of figures; for a
            figure of its own.
        """
        found = self.report(name)
        if found.figure is None:
            raise UsageError(f"{name}: {'; '.join(found.notes) or 'nothing to draw'}")
        return found.drawn(
            self.study.reports[name].options.title or self.study.title, target, sheet
        )

    def write(
        self,
        folder: Path | str | None = None,
        *,
        figures: Sequence[str] = ("png",),
        columns: int | None = None,
        style: Path | str | None = None,
        force: bool = False,
    ) -> list[str]:
        """Write points, statistics, verdicts and reports as `rps sweep`
        does; names of the files.

        Parameters
        ----------
        folder
            The one of the store by default.
        figures, columns, style
            Formats (png, svg, pdf), columns of a journal that figures fill (1 or 2), and
            a file with matplotlib's settings.
        force
            Overwrite what is in the way.

        Raises
        ------
        RpsError
            If a report cannot be made; all others are written.
        """
        if folder is None and self._keeper:
            raise UsageError("name a folder: that of the store ends with the result")
        look = Look(tuple(figures), columns, drawable_style(Path(style)) if style else {})
        made = self.study.output(Path(folder or self.folder), force=force)
        found = collected(self, look, made.folder)
        made.add_all(found.files.items())
        made.write()
        for fault in made.undrawn:
            warnings.warn(fault, stacklevel=2)
        if found.broken:
            raise found.broken[0]
        return made.files


def collected(result: StudyResult, look: Look, place: Path | None = None) -> Collected:
    """All files, for commands in them those of a place; a report
    that fails takes no other.
    """
    found = Collected({"points.csv": points_csv(result.table)})
    found.add_failures(result.layout, result.failures, place or result.folder)
    with result.results.store:
        if (statistics := result.summary) is not None:
            conditions = result.study.conditions
            found.add_statistics(result.table, statistics, result.judgements, conditions)
        for stem, request in result.study.reports.items():
            found.add_report(stem, request, result.results, result.study.title, look)
    return found


def error_of(
    result: StudyResult, found: Collected, *, limits: bool = True
) -> RpsError | None:
    """The gravest of what went wrong, whose exit code counts; its text tells of all."""
    errors: list[RpsError] = [*found.broken]
    if failed := [f"point {f.point}: {f.message}\n  {f.command}" for f in found.failures]:
        head = f"{len(failed)} of {len(result)} points failed; they enter no statistic"
        errors.append(StudyIncomplete("\n".join([head, *_first(failed, "failed.csv")])))
    if limits and (lines := verdict_lines(result.keys, result.judgements)):
        errors.append(LimitExceeded("\n".join(_first(lines, "verdicts.csv"))))
    return type(errors[0])("\n".join(map(str, errors))) if errors else None


def _first(texts: list[str], file: str) -> list[str]:
    more = len(texts) - FAILURES_SHOWN
    return [
        *texts[:FAILURES_SHOWN],
        *[f"... and {more} more, all in {file}"] * (more > 0),
    ]


class _Temporary:
    """A folder that is there as long as somebody holds this."""

    def __init__(self) -> None:
        self.place = Path(mkdtemp(prefix="rps-"))
        finalize(self, rmtree, self.place, ignore_errors=True)


def _arrays(columns: Sequence[Column]) -> Columns:
    return {column.name: array(column.values) for column in columns}
