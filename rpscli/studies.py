"""Studies from Python: many histories from one case, stored as they end, and reports on them.

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
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any
from weakref import finalize

from rpscli.case.conditions import Condition
from rpscli.case.overrides import apply_overrides
from rpscli.case.rules.plausibility import doubts_of_many
from rpscli.case.study.schema import StudyFile
from rpscli.case.study.study import Study as CheckedStudy
from rpscli.case.study.study import parse_study, shared_out, study_of
from rpscli.case.text.document import Document, text_of_values
from rpscli.case.text.files import read_text
from rpscli.constants import MOST_JOBS
from rpscli.errors import UsageError, hint, require_kind
from rpscli.report.figures.look import Look
from rpscli.report.figures.style import drawable_style
from rpscli.report.study.folder import study_folder
from rpscli.report.study.registry import REPORTS
from rpscli.report.study.report import Found
from rpscli.report.study.statistics import summary_columns, verdict_columns
from rpscli.report.table import Column
from rpscli.shown import Shown, data_frame, frozen
from rpscli.study_run import StudyRun, require_results
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.points.check import Watched
from rpscli.sweep.points.layout import StudyPoints, lay_out
from rpscli.sweep.points_csv import Columns, array, point_columns, units_of_columns
from rpscli.sweep.run.runner import Progress
from rpscli.sweep.statistics.summary import Summary
from rpscli.sweep.statistics.verdicts import Verdict
from rpscli.sweep.store import Store
from rpscli.sweep.table import Table

if TYPE_CHECKING:
    from rpscli.case.study.reports import ReportRequest
    from rpscli.report.figures.style import Target


def load_study(source: Path | str | Mapping[str, Any], overrides: Sequence[str] = ()) -> Study:
    """A study from its file, or from what such a file would say; all its systems are checked.

    Parameters
    ----------
    source
        A file, or a mapping; relative names in a mapping start at the working folder.
    overrides
        Texts ``key=value`` over the study's own values, or over those of its base case.

    Raises
    ------
    CaseError
        If the study, one of its systems or what a report needs is not valid.
    """
    return read_study(source, overrides)


def read_study(
    source: Path | str | Mapping[str, Any],
    overrides: Sequence[str] = (),
    conditions: Iterable[Condition] = (),
    watched: Watched = iter,
) -> Study:
    """A study from a file, the standard input (``-``) or a mapping, whose systems are `watched`."""
    if isinstance(source, Mapping):
        study = _study_of(source, overrides)
    else:
        require_kind(source, (str, Path), "the study", "give the name of a file, or a mapping")
        piped = str(source) == "-"
        study = parse_study(
            read_text(source),
            name="<stdin>" if piped else str(source),
            kinds=REPORTS,
            folder=None if piped else Path(source).parent,
            overrides=overrides,
        )
    layout = lay_out(study, watched)
    require_results(layout, conditions)
    return Study(layout, StudyContext(layout.plan, layout.examined), tuple(overrides))


def _study_of(mapping: Mapping[str, Any], overrides: Sequence[str]) -> CheckedStudy:
    text = text_of_values(mapping, "<study>")
    own, of_base = shared_out(overrides, StudyFile)
    document = apply_overrides(Document("<study>", json.loads(text)), own, model=StudyFile)
    digest = sha256(text.encode()).hexdigest()
    return study_of(document, of_base, kinds=REPORTS, folder=Path(), digest=digest)


@dataclass(frozen=True, eq=False, repr=False)
class Study(Shown):
    """A study, laid out and checked; `len` is the number of its points.

    Parameters
    ----------
    layout
        Its points, each made when it is asked for.
    context
        Its systems and motions.
    overrides
        What was put over the file.
    """

    layout: StudyPoints
    context: StudyContext
    overrides: tuple[str, ...] = ()

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
        """What is to be said of its file, and what is unusual about its systems, each kind once."""
        doubts = doubts_of_many([properties.doubts for properties in self.layout.properties])
        return [*self.layout.study.notes, *doubts]

    def facts(self) -> dict[str, Any]:
        """How many of what."""
        layout = self.layout
        return {
            "title": self.title,
            "points": len(layout),
            "systems": len(layout.combinations),
            "records": len(layout.records),
            "scales": len(layout.scales),
            "analysis": layout.plan.analysis,
            "reports": list(self.reports),
        }

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
        """Compute what is not stored yet, and store each point as it ends.

        Parameters
        ----------
        folder
            Of the store, which `rps sweep` reads and continues; without one the points are stored
            in a temporary folder that ends with the result.
        jobs
            Threads; all cores by default.
        scheduler
            Address of a Dask scheduler, in place of threads.
        fresh
            Discard stored results.
        retry_failed
            Recompute failed points.
        progress
            Is told how far it is.

        Raises
        ------
        Refused
            If the folder holds something else.
        KeyboardInterrupt
            After Ctrl-C; what is stored stays, and the same call goes on from there.
        """
        if jobs is not None and not 0 < jobs <= MOST_JOBS:
            raise UsageError(f"jobs = {jobs} must be a number of threads from 1 to {MOST_JOBS}")
        keeper = _Temporary() if folder is None else None
        place = keeper.place if keeper else Path(folder or "")
        study_folder(self.layout, place, self.overrides)
        with Store(place, fresh=fresh) as store:
            run = self.opened(store, jobs=jobs, scheduler=scheduler, retry_failed=retry_failed)
            run.compute(progress)
        return StudyResult(self, place, run, keeper)

    def opened(self, store: Store, **choices: Any) -> StudyRun:
        """Its run in a store that is open."""
        return StudyRun(self.layout, self.context, store, **choices)


@dataclass(frozen=True, eq=False, repr=False)
class StudyResult(Shown):
    """All points of a study that was run, statistics and reports; SI units.

    ``result["max_rotation"]`` is a column of `columns`.

    Parameters
    ----------
    study
        What was run.
    folder
        Of the store.
    """

    study: Study
    folder: Path
    _run: StudyRun
    _keeper: _Temporary | None = None

    @property
    def table(self) -> Table:
        """Results in the study's order."""
        return self._run.table

    def __len__(self) -> int:
        return len(self.table)

    def __getitem__(self, name: str) -> Any:
        """(points,) of a varied key or a result, as `points.csv` names it."""
        if name not in self.columns:
            there_are = f"there are {', '.join(self.columns)}"
            raise KeyError(
                f"{name} is not a column; {hint(str(name), self.columns, there_are, 0.6)}"
            )
        return self.columns[name]

    @cached_property
    def columns(self) -> Columns:
        """(points,) arrays of all columns of `points.csv` by name; what does not exist is NaN."""
        return frozen(point_columns(self.table))

    @property
    def units(self) -> dict[str, str]:
        """SI units of the columns; ``-`` for those without one."""
        return dict(units_of_columns(self.study.layout))

    @property
    def failures(self) -> dict[int, str]:
        """Why points failed, by their places in the columns."""
        return self.table.messages

    def to_dataframe(self) -> Any:
        """The columns as a table of pandas, which must be installed."""
        return data_frame(self.columns)

    def facts(self) -> dict[str, Any]:
        """Outcomes, and where they are stored."""
        stored = "in a temporary folder" if self._keeper else str(self.folder)
        return {
            "title": self.study.title,
            "points": len(self),
            **self._run.outcomes,
            "reports": list(self.study.reports),
            "stored": stored,
        }

    @cached_property
    def statistics(self) -> Columns:
        """Columns of `statistics.csv`: a row a system and intensity.

        Counts, the share that overturned with its 95 % interval, and median, 84 % fractile and
        largest value of all demands, infinite where so many overturned.
        """
        return frozen(_arrays(summary_columns(self._summary)))

    @cached_property
    def verdicts(self) -> Columns:
        """Columns of `verdicts.csv`: a row a limit of the study or of its base case and system."""
        return frozen(_arrays(verdict_columns(self._summary.keys, self._verdicts)))

    @property
    def passed(self) -> bool:
        """Whether no limit is exceeded and no point failed."""
        return not self.failures and not any(verdict.exceeded for verdict in self._verdicts)

    @property
    def notes(self) -> list[str]:
        """What must be read before statistics and reports are used: what was pooled or left out."""
        with self._run.reopened():
            return self._run.collect(self.folder, Look(())).notes

    def report(self, name: str) -> Found:
        """What a report finds that the study asks for, by the name of its files.

        Its `tables` are the columns of its CSV files, by what follows the name.
        """
        request = self._request(name)
        with self._run.reopened() as results:
            return REPORTS[request.kind].make(results, request.options)

    def draw(self, name: str, target: Any = None) -> Target:
        """The figure of a report.

        Parameters
        ----------
        name
            Of its files.
        target
            A figure, a part of one or axes of matplotlib to be drawn into; axes give their place to
            a part of their figure. A figure of its own by default.
        """
        request, found = self._request(name), self.report(name)
        if found.figure is None:
            raise UsageError(f"{name}: {'; '.join(found.notes) or 'nothing to draw'}")
        return found.drawn(request.options.title or self.study.title, target)

    def write(
        self,
        folder: Path | str | None = None,
        *,
        figures: Sequence[str] = ("png",),
        columns: int | None = None,
        style: Path | str | None = None,
        force: bool = False,
    ) -> list[str]:
        """Write points, statistics, verdicts and reports as `rps sweep` does; names of the files.

        Parameters
        ----------
        folder
            The one of the store by default.
        figures
            Formats: png, svg, pdf.
        columns
            Of a journal that figures fill, 1 or 2.
        style
            A file with matplotlib's settings.
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
        place = Path(folder or self.folder)
        made = study_folder(self.study.layout, place, self.study.overrides, force=force)
        with self._run.reopened():
            found = self._run.collect(made.folder, look)
        made.add_all(found.files.items())
        made.write()
        if found.broken:
            raise found.broken[0]
        return made.files

    def _request(self, name: str) -> ReportRequest:
        known = self.study.reports
        if name not in known:
            have = f"it has {', '.join(known)}" if known else "it has none"
            raise UsageError(f"{name} is not a report of the study; {have}")
        return known[name]

    @cached_property
    def _summary(self) -> Summary:
        with self._run.reopened():
            found = self._run.summary
        if found is None:
            raise UsageError("statistics and limits need analysis: timehistory")
        return found

    @cached_property
    def _verdicts(self) -> list[Verdict]:
        with self._run.reopened():
            return self._run.verdicts


class _Temporary:
    """A folder that is there as long as somebody holds this."""

    def __init__(self) -> None:
        self.place = Path(mkdtemp(prefix="rps-"))
        finalize(self, rmtree, self.place, ignore_errors=True)


def _arrays(columns: Sequence[Column]) -> Columns:
    return {column.name: array(column.values) for column in columns}
