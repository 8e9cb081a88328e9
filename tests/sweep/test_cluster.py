"""A Dask cluster that loses a worker in the middle: nothing is lost, nothing comes twice."""

from __future__ import annotations

import os
import signal
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rpscli.errors import RpsError, UsageError
from rpscli.sweep.evaluation.context import StudyContext
from rpscli.sweep.evaluation.points import Plan, Point
from rpscli.sweep.points.layout import lay_out
from rpscli.sweep.points_csv import points_csv
from rpscli.sweep.run.engines import Cluster, Threads, compute
from rpscli.sweep.run.resume import all_keys, resume
from rpscli.sweep.run.runner import Progress, run
from rpscli.sweep.run.schedule import Engine
from rpscli.sweep.store import Store
from rpscli.sweep.table import tabulate
from sweep.small_studies import STUDY, Make

distributed = pytest.importorskip("distributed")

RECORDS = ("seed: [1, 2, 3]", "seed: {low: 1, high: 16, count: 16}")


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """Address of a cluster of two worker processes, which are replaced when they die."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # sockets of the worker that is killed
        with distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster:
            yield cluster.scheduler_address


@pytest.mark.posix
def test_a_killed_worker_changes_no_byte(study_of: Make, workplace: Path, scheduler: str) -> None:
    layout = lay_out(study_of(STUDY, RECORDS))
    context = StudyContext(layout.plan)
    keys = all_keys(layout, context)
    engine = Cluster(scheduler, layout.plan)
    workers = list(engine._client.run(os.getpid).values())
    killed: list[int] = []

    def kill_one(progress: Progress) -> None:
        if not killed:
            os.kill(workers[0], signal.SIGKILL)
            killed.append(workers[0])

    texts = []
    engines: list[tuple[str, Engine]] = [("cluster", engine), ("threads", Threads(context, 1))]
    for name, made in engines:
        with Store(workplace / name) as store:
            begin = resume(layout, keys, store, retry_failed=False)
            finish = run(layout, begin, store, made, kill_one)
            assert (finish.computed, finish.failed) == (len(layout), 0)
            texts.append("".join(points_csv(tabulate(layout, store.stored(keys)))))
    assert killed
    assert texts[0] == texts[1]


def test_a_worker_of_another_version_is_refused(study_of: Make) -> None:
    plan: Plan = lay_out(study_of()).plan
    other = Plan(**{**plan.__dict__, "solver": "another"})
    with pytest.raises(RpsError, match="same version"):
        compute("digest", other, [])


@pytest.mark.posix
def test_points_that_kill_every_worker_come_back_as_failed(study_of: Make, scheduler: str) -> None:
    layout = lay_out(study_of())
    engine = Cluster(scheduler, layout.plan)

    class Deadly:
        """What Dask hands back for a task that took its workers with it."""

        status = "error"

    error = distributed.KilledWorker("task", None, 3)
    deadly = Deadly()
    given: dict[Any, list[Point]] = {deadly: [layout[0], layout[1]]}
    finished = distributed.as_completed(loop=engine._client.loop, with_results=True)
    assert engine._computed(deadly, error, given, finished) == []
    # Each is tried alone, and these can be computed after all.
    alone = [engine._computed(future, found, given, finished) for future, found in finished]
    assert sorted(points[0].number for ((points, _),) in alone) == [0, 1]
    given[deadly] = [layout[0]]
    ((points, results),) = engine._computed(deadly, error, given, finished)
    assert (points[0].number, results.outcomes.tolist()) == (0, ["failed"])
    assert "died" in results.messages[0]
    engine._client.close()


def test_no_scheduler_is_told(study_of: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rpscli.sweep.run.engines.PATIENCE", 0.3)
    with pytest.raises(UsageError, match="no Dask scheduler"):
        Cluster("tcp://127.0.0.1:9", lay_out(study_of()).plan)
