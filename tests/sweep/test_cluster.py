"""A Dask cluster that loses a worker in the middle: nothing is lost, nothing comes twice."""

from __future__ import annotations

import os
import signal
import warnings
from collections.abc import Iterator
from concurrent.futures import Executor, Future
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from rpscli.errors import RpsError, UsageError
from rpscli.sweep.evaluation import Plan
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import Engine, Progress, compute, run, start
from rpscli.sweep.store import Store
from rpscli.sweep.table import Table, points_csv
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
    client = distributed.Client(scheduler, set_as_default=False)
    workers = list(client.run(os.getpid).values())
    client.close()
    killed: list[int] = []

    def kill_one(progress: Progress) -> None:
        if not killed:
            os.kill(workers[0], signal.SIGKILL)
            killed.append(workers[0])

    texts = []
    for name, address in (("cluster", scheduler), ("threads", None)):
        with Store(workplace / name) as store:
            begin = start(layout, store)
            engine = Engine(layout.context, 1, address)
            finish = run(layout, begin, store, engine, kill_one)
            assert (finish.computed, finish.failed) == (len(layout), 0)
            table = Table.of(layout, partial(store.results, begin.keys))
            texts.append("".join(points_csv(table)))
    assert killed
    assert texts[0] == texts[1]


def test_a_worker_of_another_version_is_refused(study_of: Make) -> None:
    plan: Plan = lay_out(study_of()).plan
    other = Plan(**{**plan.__dict__, "solver": "another"})
    with pytest.raises(RpsError, match="same version"):
        compute("digest", other, [])


def test_points_that_kill_every_worker_come_back_as_failed(study_of: Make) -> None:
    layout = lay_out(study_of())
    engine = Engine(layout.context, 1)
    tried: list[list[int]] = []

    class Deadly(Executor):
        """A cluster on which the first point takes its workers with it."""

        def submit(self, work: Any, /, *inputs: Any, **_: Any) -> Future[Any]:
            future: Future[Any] = Future()
            tried.append([point.number for point in inputs[-1]])
            if 0 in tried[-1]:
                future.set_exception(distributed.KilledWorker("task", None, 3))
            else:
                future.set_result(work(*inputs))
            return future

    engine._executor, engine._deadly = Deadly(), distributed.KilledWorker
    engine._digest, engine._plan = "deadly", layout.plan
    found = {ps[0].number: results for ps, results in engine.outcomes([[layout[0], layout[1]]])}
    assert tried == [[0, 1], [0], [1]]  # each is tried alone
    assert found[0].outcomes.tolist() == ["failed"]
    assert "died" in found[0].messages[0]
    assert found[1].messages == {}


def test_no_scheduler_is_told(study_of: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rpscli.sweep.run.PATIENCE", 0.3)
    with pytest.raises(UsageError, match="no Dask scheduler"):
        Engine(lay_out(study_of()).context, 1, "tcp://127.0.0.1:9")
