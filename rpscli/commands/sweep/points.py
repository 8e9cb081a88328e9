"""Computing the points of a study, with an engine and with progress."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpscli.commands.shell.compilation import announce_compilation
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.sweep.input import StudyInput, SweepChoices
from rpscli.commands.sweep.progress import duration, progress_report
from rpscli.errors import Refused

if TYPE_CHECKING:
    from rpscli.sweep.run.engine import Engine
    from rpscli.sweep.run.resume import Resume
    from rpscli.sweep.run.runner import Finish
    from rpscli.sweep.store import Store


def begin(given: StudyInput, store: Store, choices: SweepChoices, terminal: Terminal) -> Resume:
    """Compare the study with its store, and say what changed.

    Raises
    ------
    Refused
        If the store holds another study, or `--report-only` lacks points.
    """
    from rpscli.sweep.run.keys import all_keys
    from rpscli.sweep.run.resume import remember, resume

    keys = all_keys(given.layout, given.context)
    start = resume(given.layout, keys, store, retry_failed=choices.retry_failed)
    for note in start.notes:
        terminal.note(note)
    if choices.report_only and start.pending:
        raise Refused(
            f"{store.path} lacks {len(start.pending)} of {len(keys)} points; run the study without"
            " --report-only first"
        )
    remember(given.layout, store)
    return start


def compute(
    given: StudyInput, start: Resume, store: Store, choices: SweepChoices, terminal: Terminal
) -> Finish:
    """Compute what is not stored yet."""
    from rpscli.sweep.run.runner import Finish, run

    if not start.pending:
        return Finish(0, 0, 0.0, interrupted=False)
    if start.kept:
        terminal.note(f"going on: {start.kept} of {len(start.keys)} points are stored already")
    engine = _engine(given, choices, terminal)

    def announce() -> None:
        terminal.note("\nstopping after the points under way; Ctrl-C again stops at once")

    total = start.kept + len(start.pending)
    with progress_report(terminal, start.kept, total) as report:
        finish = run(given.layout, start, store, engine, report, announce)
    rate = finish.computed / finish.seconds if finish.seconds else 0.0
    terminal.note(
        f"computed {finish.computed} points in {duration(finish.seconds)}, {rate:.3g} points/s"
    )
    return finish


def _engine(given: StudyInput, choices: SweepChoices, terminal: Terminal) -> Engine:
    if choices.scheduler:
        from rpscli.sweep.run.cluster import Cluster  # an optional extra

        return Cluster(choices.scheduler, given.layout.plan)
    from rpscli.sweep.run.threads import Threads, available_cores

    if given.layout.plan.analysis == "timehistory":
        announce_compilation(terminal)
    return Threads(given.context, choices.jobs or available_cores())
