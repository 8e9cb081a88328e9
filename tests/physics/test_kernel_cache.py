"""Where compiled kernels are kept, that other sources never find them, and what Ctrl-C leaves."""

import ast
import errno
import inspect
import os
import shutil
import signal
import sqlite3
import stat
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing

import numpy as np
import pytest
from paper_structures import known, needs_compiled_kernels, printed_by

from rpscli.compiler import functions
from rpscli.compiler.functions import Program
from rpscli.compiler.objects import DIGEST, Entry, Kept
from rpscli.compiler.values import DOUBLE
from rpscli.errors import OutputError
from rpscli.physics import kernels
from rpscli.physics.follow import follow
from rpscli.physics.integrate import hear, in_background
from rpscli.physics.kernels import OTHERS, SOURCES, cache_folder, not_kept, sources_digest
from rpscli.physics.records import records
from rpscli.physics.state import Field
from rpscli.user_cache import alone_in, user_cache


def twice(x: float) -> float:
    return 2.0 * x


@pytest.fixture(autouse=True)
def fresh_folder(monkeypatch):
    """The folder is remembered for the process; each test looks for it anew."""
    cache_folder.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    cache_folder.cache_clear()


def test_one_process_keeps_machine_code_at_a_time(tmp_path):
    with (
        alone_in(tmp_path),
        closing(sqlite3.connect(tmp_path / "saving", timeout=0)) as other,
        pytest.raises(sqlite3.OperationalError, match="locked"),
    ):
        other.execute("BEGIN EXCLUSIVE")


def test_the_place_is_that_of_the_user_then_of_the_system_then_none(
    fresh_folder, tmp_path
):
    (tmp_path / "file").write_text("no folder")
    nowhere = str(tmp_path / "file" / "below")
    fresh_folder.setattr(tempfile, "gettempdir", lambda: nowhere)
    for own, of_system, parent in (
        (str(tmp_path / "here"), nowhere, tmp_path / "here"),
        (nowhere, str(tmp_path / "cache"), tmp_path / "cache" / "rps"),
        (nowhere, nowhere, None),
    ):
        fresh_folder.setenv("RPS_CACHE_DIR", own)
        fresh_folder.setenv("XDG_CACHE_HOME", of_system)
        cache_folder.cache_clear()
        folder = cache_folder()
        assert (folder and folder.parent) == parent
        assert folder is None or folder.is_dir()


owners = pytest.mark.skipif(
    not hasattr(os, "getuid"), reason="folders have no owner here"
)


@owners
@pytest.mark.parametrize("mode", [0o777, 0o775, 0o722])
def test_a_place_that_others_may_write_to_is_not_used(fresh_folder, tmp_path, mode):
    """Machine code from there is run."""
    fresh_folder.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "shared"))
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared").chmod(mode)
    with pytest.warns(
        UserWarning, match=f"others may write to {tmp_path / 'shared'}.*chmod go-w"
    ):
        assert user_cache() == tmp_path / "cache" / "rps"
    assert stat.S_IMODE((tmp_path / "cache" / "rps").stat().st_mode) == 0o700
    (tmp_path / "shared").chmod(0o755)
    folder = known(cache_folder())
    assert folder.parent == tmp_path / "shared"
    folder.chmod(mode)
    cache_folder.cache_clear()
    with pytest.warns(UserWarning, match=f"others may write to {folder}"):
        assert cache_folder() is None


@owners
def test_a_temporary_folder_that_somebody_else_made_is_not_used(fresh_folder, tmp_path):
    (tmp_path / "file").write_text("no folder")
    fresh_folder.setenv("RPS_CACHE_DIR", "")
    fresh_folder.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    fresh_folder.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    own = tmp_path / f"rps-{os.getuid()}"
    assert user_cache() == own
    assert stat.S_IMODE(own.stat().st_mode) == 0o700
    somebody = os.getuid() + 1
    own.rename(tmp_path / f"rps-{somebody}")
    own.symlink_to(tmp_path / f"rps-{somebody}")
    assert user_cache() is None
    fresh_folder.setattr(os, "getuid", lambda: somebody)
    with pytest.warns(UserWarning, match="belongs to somebody else"):
        assert user_cache() is None


@pytest.mark.parametrize(
    "source",
    [
        "physics/laws/motion.py",
        "physics/devices/stop.py",
        "constants.py",
        "compiler/values.py",
    ],
)
def test_the_folder_is_named_after_the_sources(fresh_folder, tmp_path, source):
    """A changed kernel, or compiler, must not meet machine code of the old one."""
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "cache"))
    places = [tmp_path / place.name for place in (SOURCES, *OTHERS)]
    for place, copy in zip((SOURCES, *OTHERS), places, strict=True):
        (shutil.copytree if place.is_dir() else shutil.copy)(place, copy)
    fresh_folder.setattr(kernels, "SOURCES", places[0])
    fresh_folder.setattr(kernels, "OTHERS", tuple(places[1:]))
    before = known(cache_folder())
    assert (
        before.name == f"kernels-{sources_digest(SOURCES, *OTHERS)}"
    )  # wherever they are
    with tmp_path.joinpath(source).open("a") as file:
        file.write("\n")
    cache_folder.cache_clear()
    assert known(cache_folder()) != before


def test_what_physics_imports_decides_about_no_number_but_for_the_constants():
    imported = {
        name
        for source in SOURCES.rglob("*.py")
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom)
        and (name := str(node.module)).startswith("rpscli.")
        and not name.startswith(("rpscli.physics", "rpscli.compiler"))
    }
    assert imported <= {
        "rpscli.constants",
        "rpscli.errors",
        "rpscli.registry",
        "rpscli.user_cache",
    }


def run_of_kernels(cache, **more):
    """What a process prints that computes one history, with its cache in a folder."""
    script = "from physics import test_without_compilation as t; print(t.everything(1)['several'])"
    return printed_by("-c", script, RPS_CACHE_DIR=str(cache), **more)


@needs_compiled_kernels
def test_processes_that_compile_at_once_leave_one_whole_kernel(tmp_path):
    """Four of them; and a fifth takes what they left."""
    with ThreadPoolExecutor(4) as pool:
        four = list(pool.map(lambda _: run_of_kernels(tmp_path), range(4)))
    (folder,) = (each for each in tmp_path.glob("kernels-*"))
    assert [
        file.suffix for file in sorted(folder.iterdir()) if file.name != "saving"
    ] == [".o"]
    before = {file: file.stat().st_mtime_ns for file in folder.glob("*.o")}
    assert {*four, run_of_kernels(tmp_path)} == {four[0]}
    assert {file: file.stat().st_mtime_ns for file in folder.glob("*.o")} == before


@needs_compiled_kernels
@pytest.mark.posix
def test_a_cache_that_cannot_be_written_stops_nothing(tmp_path):
    """A home that is read only, before and after it holds the kernel; root may write anyway."""
    cache = tmp_path / "cache"
    cache.mkdir(mode=0o500)
    elsewhere = {"XDG_CACHE_HOME": str(tmp_path / "other")}
    first = run_of_kernels(cache, **elsewhere)
    assert run_of_kernels(tmp_path / "fresh") == first
    (kept,) = (tmp_path / "fresh").glob("kernels-*")
    kept.chmod(0o500)
    assert run_of_kernels(tmp_path / "fresh") == first


@needs_compiled_kernels
def test_damaged_machine_code_is_made_anew(tmp_path):
    made = []

    def make():
        made.append(True)
        return program_of(twice)

    store = Kept(tmp_path)
    code = store.get("twice.o", make)
    assert store.get("twice.o", make) == code
    assert len(made) == 1
    for damaged in (b"", code, code[:-1] + bytes(DIGEST), code[: len(code) // 2]):
        (tmp_path / "twice.o").write_bytes(damaged)
        assert store.get("twice.o", make) == code
        assert (tmp_path / "twice.o").read_bytes()[:-DIGEST] == code
    assert len(made) == 5


def program_of(function):
    program = Program()
    program.add(function, [DOUBLE], "@f")
    return program.text()


HISTORIES = """
import hashlib
from dataclasses import replace
from random import Random
from hunt.test_random_histories import motions, settings, structure
from rpscli.analyses.kernels.history import HistoryRequest, follow, run_of
from rpscli.analyses.kernels.systems import most_seconds, stacked_systems
from rpscli.records.ground_motion import MotionComponents

for seed in range(200):
    random = Random(f"bits {seed}")
    try:
        system = structure(random)
    except ValueError:  # no possible bearing
        continue
    record, up = motions(random)
    chosen = settings(random, system, record)
    motion = MotionComponents(record, up)
    if most_seconds(system, chosen, motion) < 0.8:
        systems = stacked_systems([(system, replace(chosen, free_vibration=2.0))])
        run = run_of(systems, [motion], [HistoryRequest(0, 0)], rows=20000, events=4000)
        follow(run, lanes=1)
        samples = run.output.samples[: int(run.results[0].intervals) + 1]
        print(seed, hashlib.sha256(run.results.tobytes() + samples.tobytes()).hexdigest())
"""


@pytest.mark.long
@needs_compiled_kernels
def test_right_after_the_compilation_bits_are_those_of_later(tmp_path):
    """Parts of the kernel in memory took the places of its own, with other last bits."""
    first, later = (
        printed_by("-c", HISTORIES, RPS_CACHE_DIR=str(tmp_path)) for _ in range(2)
    )
    assert first.count("\n") > 100
    assert first == later


@needs_compiled_kernels
def test_a_full_disk_keeps_nothing_and_stops_nothing(fresh_folder, tmp_path):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    fresh_folder.setattr(os, "fdopen", full)
    not_kept.cache_clear()
    with pytest.warns(UserWarning, match=rf"{tmp_path}.*No space left.*make room"):
        code = Kept(tmp_path, not_kept=not_kept).get("f.o", lambda: program_of(twice))
    assert Entry(code, "f", [DOUBLE], DOUBLE)(2.0) == 4.0
    assert [*tmp_path.iterdir()] == []


@pytest.mark.posix
def test_an_interruption_does_not_wait_for_a_compilation():
    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.15)
    ended = threading.Event()
    try:
        with pytest.raises(KeyboardInterrupt):
            in_background(ended.wait, 60.0)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        ended.set()


def test_what_fails_in_the_background_is_raised():
    with pytest.raises(ZeroDivisionError):
        in_background(divmod, 1, 0)


@needs_compiled_kernels
def test_a_kernel_without_sources_is_told(monkeypatch):
    def unreadable(*_):
        raise OSError("could not get source code")

    functions.tree_of_module.cache_clear()
    functions.tree_of.cache_clear()
    monkeypatch.setattr(inspect, "getsource", unreadable)
    with pytest.raises(OutputError, match="install rps with its sources"):
        kernels.program_text(follow, kernels.kinds_of_arguments(1, 1))


@pytest.mark.posix
def test_an_interruption_waits_for_the_end_of_the_kernel():
    state = records((Field("stop", "", "-", "asked for"),))
    ended = []

    def slow_to_hear():
        while state.view(np.ndarray)["stop"][0] == 0:
            time.sleep(0.01)
        time.sleep(0.3)  # a machine with other work
        ended.append(True)

    def interrupt(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.15)
    try:
        with pytest.raises(KeyboardInterrupt):
            hear(slow_to_hear, state)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert ended
