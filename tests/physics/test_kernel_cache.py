"""Where compiled kernels are kept, and that other sources never find them."""

from __future__ import annotations

import ast
import os
import pickle
import shutil
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from paper_structures import needs_compiled_kernels

from rpscli.physics.core import compile as compilation
from rpscli.physics.core.compile import (
    CONSTANTS,
    cache_folder,
    is_compiled,
    kernel,
    remember_compiled,
    sound_cache,
    sources_digest,
)
from rpscli.physics.core.kernel_files import NOTES, discard_damaged, note_files
from rpscli.user_cache import user_cache


@pytest.fixture(autouse=True)
def fresh_folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """The folder is remembered for the process; each test looks for it anew."""
    for remembered in (cache_folder, sound_cache):
        remembered.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    for remembered in (cache_folder, sound_cache):
        remembered.cache_clear()


def test_the_user_may_name_the_place(fresh_folder: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "here"))
    folder = cache_folder()
    assert folder is not None
    assert folder.parent == tmp_path / "here"
    assert folder.is_dir()


def test_a_place_that_cannot_be_written_is_passed_over(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("no folder")
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "file" / "below"))
    fresh_folder.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = cache_folder()
    assert folder is not None
    assert folder.parent == tmp_path / "cache" / "rps"


def test_nowhere_to_write_means_no_cache(fresh_folder: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    nowhere = str(tmp_path / "file" / "below")
    fresh_folder.setenv("RPS_CACHE_DIR", nowhere)
    fresh_folder.setenv("XDG_CACHE_HOME", nowhere)
    fresh_folder.setattr(tempfile, "gettempdir", lambda: nowhere)
    assert cache_folder() is None
    double = kernel(twice)
    assert double(3.0) == 6.0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="folders have no owner here")
def test_a_shared_temporary_folder_is_used_only_if_nobody_else_can_write_there(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Machine code from there is run."""
    (tmp_path / "file").write_text("no folder")
    fresh_folder.setenv("RPS_CACHE_DIR", "")
    fresh_folder.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    fresh_folder.setattr(tempfile, "gettempdir", lambda: str(tmp_path))
    own = tmp_path / f"rps-{os.getuid()}"
    assert user_cache() == own
    assert stat.S_IMODE(own.stat().st_mode) == 0o700
    own.chmod(0o777)
    assert user_cache() is None
    own.chmod(0o700)
    somebody = os.getuid() + 1
    own.rename(tmp_path / f"rps-{somebody}")
    fresh_folder.setattr(os, "getuid", lambda: somebody)
    assert user_cache() is None


@pytest.mark.parametrize("source", ["core/lanes.py", "planar/steps.py", "planar/devices/rest.py"])
def test_the_folder_is_named_after_the_sources(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path, source: str
) -> None:
    """A changed kernel must not meet machine code of the old one, inlined functions included."""
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "cache"))
    sources = tmp_path / "physics"
    shutil.copytree(compilation.SOURCES, sources, ignore=shutil.ignore_patterns("__pycache__"))
    fresh_folder.setattr(compilation, "SOURCES", sources)
    before, digest = cache_folder(), sources_digest(sources, CONSTANTS)
    assert before is not None
    assert before.name == f"kernels-{digest}"
    here = Path(compilation.__file__).parents[1]
    assert digest == sources_digest(here, CONSTANTS)  # wherever they are
    with (sources / source).open("a") as file:
        file.write("\n")
    cache_folder.cache_clear()
    after = cache_folder()
    assert after is not None
    assert before != after
    assert digest != sources_digest(sources, CONSTANTS)


def test_all_that_decides_about_a_kernel_is_in_the_digest(tmp_path: Path) -> None:
    """What physics imports of the rest decides about no number, but for the constants."""
    imported = {
        name
        for source in compilation.SOURCES.rglob("*.py")
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom)
        and (name := str(node.module)).startswith("rpscli.")
        and not name.startswith("rpscli.physics")
    }
    assert imported <= {"rpscli.constants", "rpscli.errors", "rpscli.user_cache"}
    changed = tmp_path / "constants.py"
    changed.write_text(CONSTANTS.read_text(encoding="utf-8").replace("200", "64"))
    assert sources_digest(tmp_path, CONSTANTS) != sources_digest(tmp_path, changed)


def test_a_source_that_moves_to_another_folder_counts_as_changed(tmp_path: Path) -> None:
    for place in ("one", "two"):
        (tmp_path / place / "sub").mkdir(parents=True)
    (tmp_path / "one" / "a.py").write_text("A = 1\n")
    (tmp_path / "two" / "sub" / "a.py").write_text("A = 1\n")
    one, two = (sources_digest(tmp_path / place) for place in ("one", "two"))
    assert one != two
    # what is no source does not count
    (tmp_path / "one" / "notes.txt").write_text("A = 2\n")
    assert sources_digest(tmp_path / "one") == one


def twice(x: float) -> float:
    return 2.0 * x


def test_what_was_compiled_is_remembered(fresh_folder: pytest.MonkeyPatch, tmp_path: Path) -> None:
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path))
    fresh_folder.setattr(compilation, "_compiled_here", set())
    assert not is_compiled("three, of them")
    remember_compiled("three, of them")
    assert is_compiled("three, of them")
    # another process, so to speak: only the disk knows
    fresh_folder.setattr(compilation, "_compiled_here", set())
    assert is_compiled("three, of them")
    assert not is_compiled("three")


PROGRAM = """
from rpscli.physics.core import compile as compilation
@compilation.kernel
def four(x: float) -> float:
    return 4.0 * x
assert four(0.5) == 2.0
print(sum(four.stats.cache_hits.values()), compilation.is_compiled("four"))
compilation.remember_compiled("four")
"""


@needs_compiled_kernels
def test_a_damaged_cache_is_thrown_away_and_filled_again(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    environment = {**os.environ, "RPS_CACHE_DIR": str(tmp_path / "cache")}

    def run() -> str:
        """Kernels found in the cache, and whether the program believed so before."""
        command = [sys.executable, str(program)]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True
        ).stdout.strip()

    def only(suffix: str) -> Path:
        (file,) = (tmp_path / "cache").rglob(f"*.{suffix}")
        return file

    assert run() == "0 False"
    assert run() == "1 True"
    only("nbi").write_bytes(b"")  # what a power loss leaves
    assert run() == "0 False"
    code = bytearray(only("nbc").read_bytes())
    code[len(code) // 2] ^= 4  # numba would run it
    only("nbc").write_bytes(code)
    assert run() == "0 False"
    assert run() == "1 True"


@pytest.mark.parametrize("damage", [b"", b"no pickle", pickle.dumps([1, 2, 3])[:-3]])
def test_an_index_that_is_not_whole_is_damaged(tmp_path: Path, damage: bytes) -> None:
    index, code = tmp_path / "a.nbi", tmp_path / "a.1.nbc"
    index.write_bytes(pickle.dumps("version") + pickle.dumps({"a": code.name}))
    code.write_bytes(b"machine code")
    (tmp_path / "a.compiled").touch()
    note_files(tmp_path)
    assert not discard_damaged(tmp_path)
    index.write_bytes(damage)
    note_files(tmp_path)  # by a process that ends later
    assert discard_damaged(tmp_path)
    assert not list(tmp_path.iterdir())


def test_an_index_of_another_form_is_not_damaged(tmp_path: Path) -> None:
    (tmp_path / "a.nbi").write_bytes(b"no pickle")
    note_files(tmp_path)
    assert not discard_damaged(tmp_path)


def test_notes_that_are_damaged_themselves_are_made_anew(tmp_path: Path) -> None:
    code = tmp_path / "below" / "a.nbc"
    code.parent.mkdir()
    code.write_bytes(b"machine code")
    note_files(tmp_path)
    assert not discard_damaged(tmp_path)
    for notes in (b"", b"[1]", b"\xff"):
        (tmp_path / NOTES).write_bytes(notes)
        assert not discard_damaged(tmp_path)
    note_files(tmp_path)
    code.write_bytes(b"other code!!")
    assert discard_damaged(tmp_path)
    assert not code.exists()
