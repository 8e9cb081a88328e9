"""Where compiled kernels are kept, that other sources never find them, and what Ctrl-C leaves."""

from __future__ import annotations

import ast
import errno
import os
import shutil
import signal
import sqlite3
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from paper_structures import known, needs_compiled_kernels, printed_by

from rpscli.physics import compile as compilation
from rpscli.physics import prepare
from rpscli.physics.compile import CONSTANTS, cache_folder, kernel, sources_digest
from rpscli.physics.follow import hear
from rpscli.physics.prepare import compile_kernel  # workers have one of their own
from rpscli.physics.state import Field, records
from rpscli.user_cache import alone_in, user_cache


def twice(x: float) -> float:
    return 2.0 * x


@pytest.fixture(autouse=True)
def fresh_folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """The folder is remembered for the process; each test looks for it anew."""
    cache_folder.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    cache_folder.cache_clear()


def test_one_process_keeps_machine_code_at_a_time(tmp_path: Path) -> None:
    with (
        alone_in(tmp_path),
        closing(sqlite3.connect(tmp_path / "saving", 0)) as other,
        pytest.raises(sqlite3.OperationalError, match="locked"),
    ):
        other.execute("BEGIN EXCLUSIVE")


def test_the_place_is_that_of_the_user_then_of_the_system_then_none(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
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
    assert kernel(twice)(3.0) == 6.0


owners = pytest.mark.skipif(not hasattr(os, "getuid"), reason="folders have no owner here")


@owners
@pytest.mark.parametrize("mode", [0o777, 0o775, 0o722])
def test_a_place_that_others_may_write_to_is_not_used(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path, mode: int
) -> None:
    """Machine code from there is run."""
    fresh_folder.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "shared"))
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared").chmod(mode)
    with pytest.warns(UserWarning, match=f"others may write to {tmp_path / 'shared'}.*chmod go-w"):
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
def test_a_temporary_folder_that_somebody_else_made_is_not_used(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
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


@pytest.mark.parametrize("source", ["laws.py", "devices.py", CONSTANTS.name])
def test_the_folder_is_named_after_the_sources(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path, source: str
) -> None:
    """A changed kernel must not meet machine code of the old one, inlined functions included."""
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "cache"))
    sources = tmp_path / "physics"
    shutil.copytree(compilation.SOURCES, sources, ignore=shutil.ignore_patterns("__pycache__"))
    constants = shutil.copy(CONSTANTS, tmp_path)
    fresh_folder.setattr(compilation, "SOURCES", sources)
    fresh_folder.setattr(compilation, "CONSTANTS", Path(constants))
    before = known(cache_folder())
    here = Path(compilation.__file__).parent
    assert before.name == f"kernels-{sources_digest(here, CONSTANTS)}"  # wherever they are
    with (tmp_path if source == CONSTANTS.name else sources).joinpath(source).open("a") as file:
        file.write("\n")
    cache_folder.cache_clear()
    assert known(cache_folder()) != before


def test_what_physics_imports_decides_about_no_number_but_for_the_constants() -> None:
    imported = {
        name
        for source in compilation.SOURCES.rglob("*.py")
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom)
        and (name := str(node.module)).startswith("rpscli.")
        and not name.startswith("rpscli.physics")
    }
    assert imported <= {"rpscli.constants", "rpscli.errors", "rpscli.user_cache"}


TWO_RECORDS = """
import sys
import numpy as np
from rpscli.physics.compile import kernel

@kernel
def inner(record) -> float:
    total = 0.0
    for i in range(record.x.shape[0]):
        total += record.x[i]
    BULK
    return total * record.y

@kernel
def outer(records) -> float:
    return inner(records[0])

KINDS = {
    "small": np.dtype([("y", float), ("x", float, (3,)), ("z", float, (2,))]),
    "large": np.dtype([("z", float, (20,)), ("x", float, (7,)), ("y", float)]),
}
for name in sys.argv[1:]:
    records = np.ones(1, KINDS[name]).view(np.recarray)
    records.y = 4.0
    print(round(outer(records), 9), sum(outer.stats.cache_hits.values()))
"""


@pytest.mark.long
@needs_compiled_kernels
def test_code_of_one_record_is_not_called_for_another(tmp_path: Path) -> None:
    """Compiled by two processes, loaded by a third."""
    program = tmp_path / "program.py"
    # Were it shorter, the compiler would copy the inner function into the outer one.
    bulk = "\n    ".join(
        f"total += np.cos(total) * np.sin({i}.0 * record.y) * 0.0" for i in range(60)
    )
    program.write_text(TWO_RECORDS.replace("BULK", bulk))
    for kinds, printed in (
        (("small",), "12.0 0\n"),
        (("large",), "28.0 0\n"),
        (("small", "large"), "12.0 1\n28.0 2\n"),
    ):
        found = printed_by(str(program), *kinds, RPS_CACHE_DIR=str(tmp_path / "cache"))
        assert found == printed


@needs_compiled_kernels
def test_other_processes_compile_and_run_nothing_from_the_working_folder(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "numba.py").write_text("open('was_run', 'w').close()\n")
    fresh_folder.chdir(tmp_path)
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "cache"))
    fresh_folder.setenv("NUMBA_DISABLE_JIT", "1")  # the others: they have nothing to compile

    for part in ("compile_alone", "compile_whole"):
        fresh_folder.setattr(prepare, part, lambda *_: None)
    fresh_folder.setattr(sys, "path", [place for place in sys.path if place])
    compile_kernel(1, 1)
    assert not (tmp_path / "was_run").exists()


HISTORIES = """
import hashlib
from dataclasses import replace
from random import Random
from hunt.test_random_histories import motions, settings, structure
from rpscli.analyses.kernels.history import Request, follow, run_of
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
        run = run_of(systems, [motion], [Request(0, 0)], rows=20000, events=4000)
        follow(run, lanes=1)
        samples = run.output.samples[: int(run.results[0].intervals) + 1]
        print(seed, hashlib.sha256(run.results.tobytes() + samples.tobytes()).hexdigest())
"""


@pytest.mark.long
@needs_compiled_kernels
def test_right_after_the_compilation_bits_are_those_of_later(tmp_path: Path) -> None:
    """Parts of the kernel in memory took the places of its own, with other last bits."""
    first, later = (printed_by("-c", HISTORIES, RPS_CACHE_DIR=str(tmp_path)) for _ in range(2))
    assert first.count("\n") > 100
    assert first == later


@needs_compiled_kernels
def test_a_full_disk_keeps_nothing_and_stops_nothing(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path))
    made = kernel(twice)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    fresh_folder.setattr("numba.core.caching.IndexDataCacheFile.save", full)
    with pytest.warns(UserWarning, match=rf"{tmp_path}.*No space left.*make room"):
        assert made(2.0) == 4.0


@pytest.mark.posix
def test_an_interruption_waits_for_the_end_of_the_kernel() -> None:
    state = records((Field("stop", "", "-", "asked for"),))
    ended = []

    def slow_to_hear() -> None:
        while state.view(np.ndarray)["stop"][0] == 0:
            time.sleep(0.01)
        time.sleep(0.3)  # a machine with other work
        ended.append(True)

    def interrupt(number: int, frame: object) -> None:
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
