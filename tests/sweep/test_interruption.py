"""Killed, interrupted, with one thread or two: the same bytes at the end."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from click.testing import Result

from rpscli.sweep.batch import Bench
from rpscli.sweep.design import lay_out
from rpscli.sweep.keys import all_keys
from rpscli.sweep.resume import resume
from rpscli.sweep.runner import Progress, run
from rpscli.sweep.store import Store
from rpscli.sweep.threads import Threads
from sweep.small_studies import STUDY, Make, start

MORE_RECORDS = ("seed: [1, 2, 3]", "seed: {low: 1, high: 180, count: 180}")
"""2160 points: enough to be interrupted in the middle."""

CSV = "results/study/sweep/points.csv"
STORE = "results/study/sweep/study.sqlite"


@pytest.fixture
def long_study(workplace: Path) -> Path:
    (workplace / "study.yaml").write_text(STUDY.replace(*MORE_RECORDS))
    return workplace


def begun(process: subprocess.Popen[str], store: Path) -> None:
    """Wait until some batches of points are stored: the last that is seen may be half written."""
    sizes = set()
    for _ in range(36_000):
        if store.exists():
            sizes.add(store.stat().st_size)
        if process.poll() is not None or sum(size > 200_000 for size in sizes) > 1:
            return
        time.sleep(0.005)


def finished(folder: Path) -> dict[str, int]:
    """Run the study to its end; what it had to do."""
    process = start("sweep", "study.yaml", "--json", folder=folder)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    points: dict[str, int] = json.loads(out)["points"]
    return points


def undisturbed(folder: Path) -> bytes:
    """`points.csv` of a run in one go, with one thread."""
    process = start("sweep", "study.yaml", "--jobs", "1", "-o", "calm", folder=folder)
    process.communicate(timeout=120)
    assert process.returncode == 0
    return (folder / "calm/points.csv").read_bytes()


def test_kill_9_and_resume_end_in_the_same_bytes(long_study: Path) -> None:
    process = start("sweep", "study.yaml", "--jobs", "1", folder=long_study)
    begun(process, long_study / STORE)
    process.kill()
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    points = finished(long_study)
    assert 0 < points["kept"] < 2160
    assert points["kept"] + points["computed"] == 2160
    assert (long_study / CSV).read_bytes() == undisturbed(long_study)


def test_the_first_ctrl_c_drains_and_says_how_to_go_on(long_study: Path) -> None:
    process = start("sweep", "study.yaml", "--jobs", "1", "--json", folder=long_study)
    begun(process, long_study / STORE)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Ctrl-C again" in err
    assert "the same command goes on" in err
    document = json.loads(out)
    assert document["error"]["type"] == "Interrupted"
    stored = document["points"]["stored"]
    assert 0 < stored < 2160
    assert not (long_study / CSV).exists()
    assert finished(long_study)["kept"] == stored


def test_one_thread_or_two_give_the_same_bytes(
    sweep: Callable[..., Result], workplace: Path
) -> None:
    for jobs in ("1", "2"):
        assert sweep("study.yaml", "--jobs", jobs, "-o", jobs).exit_code == 0
    assert (workplace / "1/points.csv").read_bytes() == (workplace / "2/points.csv").read_bytes()


def test_the_second_ctrl_c_stops_at_once(study_of: Make, workplace: Path) -> None:
    design = lay_out(study_of(STUDY, MORE_RECORDS))
    bench = Bench(design.plan)
    keys = all_keys(design, bench)
    told: list[str] = []

    def interrupt(progress: Progress) -> None:
        if not told:
            os.kill(os.getpid(), signal.SIGINT)
            told.append("first")
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    with Store(workplace) as store:
        begin = resume(design, keys, store, retry_failed=False)
        with pytest.raises(KeyboardInterrupt):
            run(design, begin, store, Threads(bench, 1), interrupt)
        assert 0 < len(store.outcomes()) < 2160
    assert signal.getsignal(signal.SIGINT) is before


def test_progress_counts_and_foresees(study_of: Make, workplace: Path) -> None:
    design = lay_out(study_of())
    bench = Bench(design.plan)
    seen: list[Progress] = []
    with Store(workplace) as store:
        begin = resume(design, all_keys(design, bench), store, retry_failed=False)
        finish = run(design, begin, store, Threads(bench, 2), seen.append)
    assert (finish.computed, finish.interrupted) == (36, False)
    assert [p.done for p in seen] == sorted(p.done for p in seen)
    assert seen[-1].done == seen[-1].total == 36
    assert seen[-1].seconds_left == 0.0


def test_equal_points_are_computed_once(study_of: Make, workplace: Path) -> None:
    design = lay_out(study_of(STUDY, ("[0.5, 1.0]", "[1.0, 1.0]")))
    bench = Bench(design.plan)
    with Store(workplace) as store:
        begin = resume(design, all_keys(design, bench), store, retry_failed=False)
        assert len(begin.pending) == 18
        run(design, begin, store, Threads(bench, 1))
        rows = list(store.stored(begin.keys))
    assert len(rows) == 36
    assert rows[0] == rows[1]
    assert None not in rows


def test_an_error_of_the_engine_is_not_swallowed(study_of: Make, workplace: Path) -> None:
    design = lay_out(study_of())

    def broken() -> Iterator[list[object]]:
        yield [object()]

    engine = Threads(Bench(design.plan), 2)
    with pytest.raises(AttributeError):
        list(engine.outcomes(broken()))  # type: ignore[arg-type]
