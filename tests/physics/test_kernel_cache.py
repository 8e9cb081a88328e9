"""Where compiled kernels are kept, and that other sources never find them."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from rpscli.physics import compile as compilation
from rpscli.physics.compile import (
    cache_folder,
    is_compiled,
    kernel,
    remember_compiled,
    sources_digest,
)
from rpscli.user_cache import user_cache


@pytest.fixture(autouse=True)
def fresh_folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """The folder is remembered for the process; each test looks for it anew."""
    cache_folder.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    cache_folder.cache_clear()


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


@pytest.mark.parametrize("source", ["energy.py", "uplifted/steps.py", "formulae/geometry.py"])
def test_the_folder_is_named_after_the_sources(
    fresh_folder: pytest.MonkeyPatch, tmp_path: Path, source: str
) -> None:
    """A changed kernel must not meet machine code of the old one, inlined functions included."""
    fresh_folder.setenv("RPS_CACHE_DIR", str(tmp_path / "cache"))
    sources = tmp_path / "physics"
    shutil.copytree(compilation.SOURCES, sources, ignore=shutil.ignore_patterns("__pycache__"))
    fresh_folder.setattr(compilation, "SOURCES", sources)
    before, digest = cache_folder(), sources_digest(sources)
    assert before is not None
    assert before.name == f"kernels-{digest}"
    assert digest == sources_digest(Path(compilation.__file__).parent)  # wherever they are
    with (sources / source).open("a") as file:
        file.write("\n")
    cache_folder.cache_clear()
    after = cache_folder()
    assert after is not None
    assert before != after
    assert digest != sources_digest(sources)


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
