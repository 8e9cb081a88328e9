"""The store keeps what it was given, for one process at a time, and says what is wrong."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from rpscli.errors import OutputError, Refused, RpsError
from rpscli.sweep.store import FILE, Entry, Store, Stored


def entry(number: int, outcome: str = "survived") -> Entry:
    return Entry(bytes([number] * 32), {"n": number}, outcome, None, {"x": 0.1 * number})


def test_what_is_stored_is_there_after_reopening(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add([entry(1), entry(2, "failed")])
        store.note(study="a")
    with Store(tmp_path) as store:
        assert store.outcomes() == {bytes([1] * 32): False, bytes([2] * 32): True}
        found = list(store.stored([bytes([2] * 32), bytes([9] * 32), bytes([1] * 32)]))
        assert found == [
            Stored("failed", None, {"x": 0.2}),
            None,
            Stored("survived", None, {"x": 0.1}),
        ]
        assert store.meta("study") == "a"
        store.add([entry(2)])
        assert store.outcomes()[bytes([2] * 32)] is False


def test_a_second_process_is_refused(tmp_path: Path) -> None:
    with Store(tmp_path), pytest.raises(Refused, match=r"in use.*-o"):
        Store(tmp_path)
    with Store(tmp_path), pytest.raises(Refused, match="in use"):
        Store(tmp_path, fresh=True)
    Store(tmp_path).__exit__()


def test_fresh_begins_anew_even_where_the_file_is_damaged(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add(entry(number) for number in range(200))
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}
        store.add(entry(number) for number in range(200))
    path = tmp_path / FILE
    content = bytearray(path.read_bytes())
    content[1024:] = b"\xff" * (len(content) - 1024)
    path.write_bytes(content)
    with pytest.raises(RpsError, match=r"damaged.*--fresh"):
        Store(tmp_path)
    with Store(tmp_path, fresh=True) as store:
        assert store.outcomes() == {}


def test_files_of_others_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / FILE).write_text("notes of mine, not to be lost")
    for fresh in (False, True):
        with pytest.raises(Refused, match="not the store"):
            Store(tmp_path, fresh=fresh)
    assert (tmp_path / FILE).read_text().startswith("notes")
    (tmp_path / FILE).unlink()
    with sqlite3.connect(tmp_path / FILE) as db:
        db.execute("CREATE TABLE mine (x)")
    db.close()
    for fresh in (False, True):
        with pytest.raises(Refused, match="another program"):
            Store(tmp_path, fresh=fresh)


def test_another_format_is_refused(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.note(format="0")
    with pytest.raises(Refused, match=r"format 0.*--fresh"):
        Store(tmp_path)


def test_a_full_disk_is_told_and_what_was_stored_stays(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add([entry(1)])
        # SQLite reports a limit on its pages as a full disk.
        store._db.execute("PRAGMA max_page_count = 1")
        big = [entry(n)._replace(results={"x": [0.0] * 5000}) for n in range(2, 9)]
        with pytest.raises(OutputError, match=r"disk is full.*same\s+command"):
            store.add(big)
        assert list(store.outcomes()) == [bytes([1] * 32)]


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="-o"):
        Store(tmp_path / "file" / "folder")


def test_numbers_that_json_does_not_know_are_never_stored(tmp_path: Path) -> None:
    with Store(tmp_path) as store, pytest.raises(ValueError, match="JSON"):
        store.add([entry(1)._replace(results={"x": float("nan")})])
