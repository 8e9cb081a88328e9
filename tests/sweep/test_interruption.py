"""Killed, interrupted, with one thread or two: the same bytes at the end."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from click.testing import Result

from rpscli.sweep.context import Point, StudyContext
from rpscli.sweep.evaluation import MISSING, PointResults, run_batch
from rpscli.sweep.points import lay_out
from rpscli.sweep.run import Engine, Progress, run, start
from rpscli.sweep.store import Store
from sweep.small_studies import ROOT, STUDY, Make

POINTS = 36
"""Of the study; one thread computes them in batches of nine."""

CSV = "results/study/sweep/points.csv"


def ended(*arguments: str, folder: Path, program: str = "-mrpscli") -> tuple[int, str, str]:
    """Exit code, output and errors of a process."""
    done = subprocess.run(
        [sys.executable, program, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


def interrupted(number: signal.Signals, folder: Path) -> tuple[int, str, str]:
    """A run of the study that gets a signal at its third batch."""
    program = str(Path(__file__).with_name("interrupted.py"))
    study = ("sweep", "study.yaml", "--jobs", "1", "--json")
    return ended(number.name, *study, folder=folder, program=program)


def finished(folder: Path) -> dict[str, int]:
    """Run the study to its end; what it had to do."""
    code, out, err = ended("sweep", "study.yaml", "--json", folder=folder)
    assert code == 0, err
    points: dict[str, int] = json.loads(out)["points"]
    return points


@pytest.mark.posix
def test_kill_9_and_resume_end_in_the_same_bytes(workplace: Path) -> None:
    code, _, _ = interrupted(signal.SIGKILL, workplace)
    assert code == -signal.SIGKILL
    points = finished(workplace)
    assert (points["kept"], points["computed"]) == (18, 18)
    code, _, err = ended("sweep", "study.yaml", "--jobs", "1", "-o", "calm", folder=workplace)
    assert code == 0, err
    assert (workplace / CSV).read_bytes() == (workplace / "calm/points.csv").read_bytes()


@pytest.mark.posix
def test_the_first_ctrl_c_drains_and_says_how_to_go_on(workplace: Path) -> None:
    code, out, err = interrupted(signal.SIGINT, workplace)
    assert code == 130
    assert "Ctrl-C again" in err
    assert "the same command continues" in err
    document = json.loads(out)
    assert document["error"]["type"] == "Interrupted"
    # The batch under way was finished and stored.
    assert document["points"] == {"total": POINTS, "stored": 27}
    assert not (workplace / CSV).exists()
    assert finished(workplace)["kept"] == 27


def test_one_thread_or_two_give_the_same_bytes(
    sweep: Callable[..., Result], workplace: Path
) -> None:
    for jobs in ("1", "2"):
        assert sweep("study.yaml", "--jobs", jobs, "-o", jobs).exit_code == 0
    assert (workplace / "1/points.csv").read_bytes() == (workplace / "2/points.csv").read_bytes()


@pytest.mark.posix
def test_the_second_ctrl_c_stops_at_once(
    study_of: Make, workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    layout = lay_out(study_of())
    told: list[str] = []
    over = threading.Event()

    def one_batch(context: StudyContext, points: Sequence[Point]) -> PointResults:
        if points[0].number:
            over.wait()
        return run_batch(context, points)

    def interrupt(progress: Progress) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        told.append("first")
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr("rpscli.sweep.run.run_batch", one_batch)
    before = signal.getsignal(signal.SIGINT)
    with Store(workplace) as store:
        begin = start(layout, store)
        with pytest.raises(KeyboardInterrupt):
            run(layout, begin, store, Engine(layout.context, 1), interrupt)
        assert told == ["first"]
        assert len(store.outcomes()) == 9  # the second batch is still under way
    over.set()
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.posix
def test_a_ctrl_c_given_to_another_thread_is_heard(
    study_of: Make, workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    layout = lay_out(study_of())
    heard = threading.Event()

    def one_batch(context: StudyContext, points: Sequence[Point]) -> PointResults:
        time.sleep(0.5)  # until the main thread waits
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        os.kill(os.getpid(), signal.SIGINT)  # only this thread takes it: the waiting one sleeps on
        assert heard.wait(20.0)
        return run_batch(context, points)

    monkeypatch.setattr("rpscli.sweep.run.run_batch", one_batch)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with Store(workplace) as store:
            begin = start(layout, store)
            finish = run(layout, begin, store, Engine(layout.context, 1), announce=heard.set)
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    assert (finish.computed, len(begin.pending)) == (9, POINTS)


def test_equal_points_are_computed_once(study_of: Make, workplace: Path) -> None:
    layout = lay_out(study_of(STUDY, ("[0.5, 1.0]", "[1.0, 1.0]")))
    with Store(workplace) as store:
        begin = start(layout, store)
        assert len(begin.pending) == 18
        run(layout, begin, store, Engine(layout.context, 1))
        found = store.results(begin.keys, ["max_rotation"])
    rotation = found.columns["max_rotation"]
    assert rotation.shape == (36,)
    assert rotation[0] == rotation[1]
    assert MISSING not in found.outcomes
