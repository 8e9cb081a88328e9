"""The store keeps what it was given, for one process at a time, and says what is wrong."""

from __future__ import annotations

import shutil
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
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


def test_one_digit_of_a_result_is_not_believed(tmp_path: Path) -> None:
    with Store(tmp_path) as store:
        store.add(entry(number) for number in range(9))
        store.note(study="pinned")
        store.add_fixed_base({b"key": [1.25]})
    path = tmp_path / FILE
    whole = path.read_bytes()
    for old, new in ((b'"x":0.4', b'"x":0.9'), (b"survived", b"survivex"), (b"1.25", b"1.26")):
        assert old in whole
        path.write_bytes(whole.replace(old, new, 1))
        with Store(tmp_path) as store, pytest.raises(RpsError, match=r"damaged.*digest.*--fresh"):
            (store.outcomes(), store.fixed_base())
    path.write_bytes(whole.replace(b"pinned", b"pinnex"))
    with Store(tmp_path) as store, pytest.raises(RpsError, match=r"damaged.*--fresh"):
        store.meta("study")


def contents(folder: Path) -> list[Any]:
    keys = [bytes([number] * 32) for number in range(40)]
    with Store(folder) as store:
        return [store.outcomes(), list(store.stored(keys)), store.fixed_base(), store.meta("study")]


@pytest.mark.parametrize("seed", range(4))
def test_damage_is_one_message_with_a_remedy_or_harmless(tmp_path: Path, seed: int) -> None:
    """Bits flipped and ends cut off: what is still read is what was written."""
    with Store(tmp_path) as store:
        store.add(entry(number) for number in range(40))
        store.note(study="pinned")
        store.add_fixed_base({b"key": [1.25]})
    path, told = tmp_path / FILE, 0
    whole, known = path.read_bytes(), contents(tmp_path)
    rng = np.random.default_rng(seed)
    for _ in range(60):
        content = bytearray(whole)
        if rng.random() < 0.2:
            content = content[: int(rng.integers(1, len(content)))]
        else:
            content[int(rng.integers(len(content)))] ^= 1 << int(rng.integers(8))
        path.write_bytes(content)
        try:
            found = contents(tmp_path)
        except Refused as error:  # not all of them must raise
            damaged = f"{path} is damaged (" in str(error)
            told += damaged
            assert ("--fresh" if damaged else "-o") in str(error)  # noqa: PT017
        else:
            # a point that is found under no name is computed again
            for before, after in zip(known[1], found[1], strict=True):
                assert after in (before, None)
            assert found[2] in (known[2], {})
            assert found[3] in (known[3], None)
    assert told > 10


@pytest.mark.parametrize("what", ["file", "folder", "other"])
def test_a_store_that_is_deleted_while_it_is_used_is_told(tmp_path: Path, what: str) -> None:
    folder = tmp_path / "o"
    with Store(folder) as store:
        store.add([entry(1)])
        store.require()
        if what == "folder":
            shutil.rmtree(folder)
        else:
            (folder / FILE).unlink()
        if what == "other":
            (folder / FILE).write_bytes(b"")
        with pytest.raises(OutputError, match=r"deleted or replaced.*same command"):
            store.add([entry(2)])
        with pytest.raises(OutputError, match="deleted or replaced"):
            store.require()


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
