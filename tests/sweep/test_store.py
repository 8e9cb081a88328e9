"""The store keeps what it was given, for one process at a time, and says what is wrong."""

from __future__ import annotations

import os
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rpscli
from rpscli.errors import OutputError, Refused, RpsError
from rpscli.sweep.evaluation import SOLVING, PointResults, digest_of_sources
from rpscli.sweep.store import FILE, Store


def key(number: int) -> bytes:
    return bytes([number] * 32)


def batch(*numbers: int, failed: bool = False) -> tuple[list[bytes], PointResults]:
    """Points that survived, or failed."""
    values = np.full(len(numbers), np.nan) if failed else 0.1 * np.array(numbers)
    outcomes = np.array(["failed" if failed else "survived"] * len(numbers), dtype="U20")
    messages = dict.fromkeys(range(len(numbers)), "why") if failed else {}
    columns = {"x": values, "list": np.column_stack([values, values + 1.0])}
    return list(map(key, numbers)), PointResults(outcomes, messages, columns)


def rows(store: Store, *numbers: int) -> list[Any]:
    """Outcome, message, x and the second of the list of some points."""
    found = store.results(list(map(key, numbers)), ["x", "list.1", "unknown"])
    nothing = np.full(len(numbers), np.nan)
    x, last = (found.columns.get(name, nothing).tolist() for name in ("x", "list.1"))
    assert "unknown" not in found.columns
    told = [found.messages.get(row) for row in range(len(numbers))]
    return [repr(row) for row in zip(found.outcomes.tolist(), told, x, last, strict=True)]


def test_what_is_stored_is_there_after_reopening(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add(*batch(1, 3))
        store.add(*batch(2, failed=True))
        store.note(study="a")
    with Store(tmp_path) as store:
        assert store.outcomes() == {key(1): False, key(3): False, key(2): True}
        assert rows(store, 2, 9, 1, 1) == [
            "('failed', 'why', nan, nan)",
            "('', None, nan, nan)",
            *["('survived', None, 0.1, 1.1)"] * 2,
        ]
        assert store.facts()["study"] == "a"
        store.add(*batch(2))
        assert store.outcomes()[key(2)] is False
        assert rows(store, 2) == ["('survived', None, 0.2, 1.2)"]
        store.add(*batch(2, failed=True))
        assert rows(store, 2) == ["('failed', 'why', nan, nan)"]


def test_a_second_process_is_refused(tmp_path: Path) -> None:
    with Store(tmp_path), pytest.raises(Refused, match=r"in use.*-o"):
        Store(tmp_path).__enter__()
    with Store(tmp_path), pytest.raises(Refused, match="in use"):
        Store(tmp_path, fresh=True).__enter__()


def test_fresh_begins_anew_even_where_the_file_is_damaged(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add(*batch(*range(200)))
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}
        store.add(*batch(*range(200)))
    path = tmp_path / FILE
    content = bytearray(path.read_bytes())
    content[1024:] = b"\xff" * (len(content) - 1024)
    path.write_bytes(content)
    with pytest.raises(RpsError, match=r"damaged.*--fresh"):
        Store(tmp_path).__enter__()
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}


@pytest.mark.parametrize("what", ["file", "folder", "other"])
def test_a_store_that_is_deleted_while_it_is_used_is_told(tmp_path: Path, what: str) -> None:
    folder = tmp_path / "o"
    with Store(folder) as store:
        store.add(*batch(1))
        store.require()
        if what == "folder":
            shutil.rmtree(folder)
        else:
            (folder / FILE).unlink()
        if what == "other":
            (folder / FILE).write_bytes(b"")
        with pytest.raises(OutputError, match=r"deleted or replaced.*same command"):
            store.add(*batch(2))
        with pytest.raises(OutputError, match="deleted or replaced"):
            store.require()


def test_files_of_others_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("notes of mine, not to be lost")
    for fresh in (False, True):
        with pytest.raises(Refused, match="not the store"):
            Store(tmp_path, fresh=fresh).__enter__()
    assert (tmp_path / FILE).read_text().startswith("notes")
    (tmp_path / FILE).unlink()
    with sqlite3.connect(tmp_path / FILE) as db:
        db.execute("CREATE TABLE mine (x)")
    db.close()
    whole = (tmp_path / FILE).read_bytes()
    for content in (whole, whole[:1024] + b"\xff" * (len(whole) - 1024)):  # damaged as well
        (tmp_path / FILE).write_bytes(content)
        for fresh in (False, True):
            with pytest.raises(Refused, match="not the store"):
                Store(tmp_path, fresh=fresh).__enter__()
        assert (tmp_path / FILE).read_bytes() == content


@pytest.mark.parametrize(("version", "told"), [(0, "before 4"), (5, "5")])
def test_another_format_is_refused(tmp_path: Path, version: int, told: str) -> None:
    with Store(tmp_path) as store:
        store.note(study="a")
    with closing(sqlite3.connect(tmp_path / FILE)) as db:
        db.execute(f"PRAGMA user_version = {version}")
    with pytest.raises(Refused, match=rf"format {told}.*--fresh"):
        Store(tmp_path).__enter__()
    with Store(tmp_path, fresh=True) as store:
        assert store.facts() == {}


def test_a_full_disk_is_told_and_what_was_stored_stays(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add(*batch(1))
        # SQLite reports a limit on its pages as a full disk.
        store._db.execute("PRAGMA max_page_count = 1")
        with pytest.raises(OutputError, match=r"disk is full.*same\s+command"):
            store.add(*batch(*range(2, 200)))
        assert list(store.outcomes()) == [key(1)]


PACKAGE = Path(rpscli.__file__).parent


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources."""
    copy = tmp_path_factory.mktemp("sources") / "rpscli"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    return copy


@pytest.mark.parametrize("name", SOLVING)
def test_a_changed_source_changes_the_digest(package: Path, name: str) -> None:
    place = package / name
    sources = [place] if place.is_file() else sorted(place.rglob("*.py"))
    assert sources, "every name stands for a source"
    before = digest_of_sources(package)
    for source in sources:
        text = source.read_text()
        source.write_text(f"{text}\n")
        assert digest_of_sources(package) != before, source
        source.write_text(text)
    assert digest_of_sources(package) == before


def test_every_module_behind_a_stored_number_counts() -> None:
    script = """
import sys
import rpscli.sweep.evaluation
print(*(m.__file__ for n, m in sys.modules.items() if n.startswith("rpscli.")), sep=chr(10))
"""
    paths = [str(PACKAGE.parent), *sys.path]
    done = subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=True,
    )
    modules = {Path(line).relative_to(PACKAGE).as_posix() for line in done.stdout.split()}
    counted = {name for name in modules if name.startswith(tuple(SOLVING))}
    assert "analyses/demand.py" in counted
    others = {"errors.py", "machine.py", "shown.py", "sweep/__init__.py", "version.py"}
    assert modules - counted == others
