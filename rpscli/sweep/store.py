"""The store of a study: one SQLite file, one writer, every result on disk as it comes.

The rollback journal makes each transaction whole: a kill at any moment leaves the results that
were stored before. The writer holds the file's lock from the first to the last moment, so that a
second process is refused, and a dead one leaves nothing behind that needs to be removed.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Self

from rpscli.errors import OutputError, Refused, RpsError
from rpscli.sweep.evaluation.results import FAILED, Results

FILE = "study.sqlite"
FORMAT = "1"
APPLICATION = 0x72707331
"""Marks the file as ours in its header: "rps1"."""

SCHEMA = """
CREATE TABLE IF NOT EXISTS meta (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS points (
    key BLOB PRIMARY KEY,     -- digest of resolved case, record, scale and solver
    point TEXT NOT NULL,      -- what the study called it: varied keys, record, scale (JSON)
    outcome TEXT NOT NULL,
    message TEXT,             -- why it failed
    results TEXT NOT NULL     -- JSON
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS fixed_base (
    key BLOB PRIMARY KEY,
    storey_shears TEXT NOT NULL
) WITHOUT ROWID;
"""


class Stored(NamedTuple):
    """A point as it stands in the store."""

    outcome: str
    message: str | None
    results: Results


class Entry(NamedTuple):
    """A point on its way into the store."""

    key: bytes
    point: Mapping[str, Any]
    outcome: str
    message: str | None
    results: Results


class Store:
    """Results of the points of a study.

    Parameters
    ----------
    folder
        Of the study; made if it does not exist.
    fresh
        Throw away what an earlier run left.

    Raises
    ------
    Refused
        If another process works in this folder, or the file is not one of ours.
    OutputError
        If the file cannot be written.
    RpsError
        If it is damaged.
    """

    def __init__(self, folder: Path, *, fresh: bool = False) -> None:
        self.path = folder / FILE
        with self._told():
            folder.mkdir(parents=True, exist_ok=True)
            self._refuse_other_files()
            self._db = self._connected()
        try:
            if fresh:
                self._begin_anew()
            self._open()
        except BaseException:
            self._db.close()
            raise

    def _connected(self) -> sqlite3.Connection:
        db = sqlite3.connect(self.path, timeout=0.2, isolation_level=None)
        # The lock is held from the first access on, until the connection ends.
        db.execute("PRAGMA locking_mode = EXCLUSIVE")
        return db

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._db.close()

    def _refuse_other_files(self) -> None:
        """Never touch a file that is no SQLite file of ours."""
        if not self.path.exists() or not self.path.stat().st_size:
            return
        with self.path.open("rb") as file:
            header = file.read(100)
        if not header.startswith(b"SQLite format 3\0"):
            raise Refused(
                f"{self.path} is not the store of a study; move it away, or name another folder"
                " with -o"
            )

    def _begin_anew(self) -> None:
        """Delete the file, unless another process works on it; it may be damaged."""
        with self._told():
            try:
                self._db.execute("BEGIN EXCLUSIVE")
                self._refuse_other_programs()
            except sqlite3.OperationalError:  # locked, or not to be written
                raise
            except sqlite3.DatabaseError:  # damaged: what --fresh is for
                pass
            self._db.close()
            for name in (FILE, f"{FILE}-journal"):
                self.path.with_name(name).unlink(missing_ok=True)
            self._db = self._connected()

    def _open(self) -> None:
        with self._told():
            self._db.execute("BEGIN EXCLUSIVE")
            self._refuse_other_programs()
            for statement in SCHEMA.split(";\n"):
                self._db.execute(statement)
            self._db.execute(f"PRAGMA application_id = {APPLICATION}")
            self._db.execute("INSERT OR IGNORE INTO meta VALUES ('format', ?)", (FORMAT,))
            self._db.execute("COMMIT")
        self._check()

    def _tables(self) -> list[str]:
        return [name for (name,) in self._db.execute("SELECT name FROM sqlite_master")]

    def _refuse_other_programs(self) -> None:
        ours = self._db.execute("PRAGMA application_id").fetchone()[0] == APPLICATION
        if self._tables() and not ours:
            raise Refused(f"{self.path} belongs to another program; name another folder with -o")

    def _check(self) -> None:
        if self.meta("format") != FORMAT:
            raise Refused(
                f"{self.path} was written by another version of rps (format"
                f" {self.meta('format')}); use --fresh to begin anew, or another folder with -o"
            )

    def meta(self, name: str) -> str | None:
        """A fact about the study."""
        with self._told():
            row = self._db.execute("SELECT value FROM meta WHERE name = ?", (name,)).fetchone()
        return None if row is None else str(row[0])

    def note(self, **facts: str) -> None:
        """Write facts about the study."""
        with self._transaction():
            self._db.executemany("REPLACE INTO meta VALUES (?, ?)", facts.items())

    def add(self, entries: Iterable[Entry]) -> None:
        """Store points in one transaction; when this returns they are on disk."""
        rows = [(e.key, _json(e.point), e.outcome, e.message, _json(e.results)) for e in entries]
        with self._transaction():
            self._db.executemany("REPLACE INTO points VALUES (?, ?, ?, ?, ?)", rows)

    def outcomes(self) -> dict[bytes, bool]:
        """Keys of all stored points, and whether each failed."""
        with self._told():
            rows = self._db.execute("SELECT key, outcome FROM points")
            return {key: outcome == FAILED for key, outcome in rows}

    def stored(self, keys: Iterable[bytes]) -> Iterator[Stored | None]:
        """Points in the order of the keys; None for those that are not there."""
        with self._told():
            for key in keys:
                row = self._db.execute(
                    "SELECT outcome, message, results FROM points WHERE key = ?", (key,)
                ).fetchone()
                yield None if row is None else Stored(row[0], row[1], json.loads(row[2]))

    def fixed_base(self) -> dict[bytes, list[float]]:
        """Storey shears on a fixed base, by key."""
        with self._told():
            rows = self._db.execute("SELECT key, storey_shears FROM fixed_base")
            return {key: json.loads(text) for key, text in rows}

    def add_fixed_base(self, shears: Mapping[bytes, list[float]]) -> None:
        """Store storey shears on a fixed base."""
        rows = [(key, _json(values)) for key, values in shears.items()]
        with self._transaction():
            self._db.executemany("REPLACE INTO fixed_base VALUES (?, ?)", rows)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with self._told():
            self._db.execute("BEGIN")
            try:
                yield
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    @contextmanager
    def _told(self) -> Iterator[None]:
        """SQLite's and the system's complaints in words that help."""
        try:
            yield
        except sqlite3.Error as error:
            raise _explained(self.path, error) from None
        except OSError as error:
            reason = error.strerror or str(error)
            raise OutputError(f"{self.path}: {reason}; name another folder with -o") from None


def _explained(path: Path, error: sqlite3.Error) -> RpsError:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    if code in {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}:
        return Refused(
            f"{path} is in use: another `rps sweep` works in this folder; wait for it, or name"
            " another folder with -o"
        )
    if code == sqlite3.SQLITE_FULL:
        return OutputError(
            f"{path}: the disk is full; what was stored is safe. Make room and run the same"
            " command again: it goes on where it stopped"
        )
    if code in {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB}:
        return RpsError(
            f"{path} is damaged ({error}); begin anew with --fresh, or restore the file"
        )
    if code in {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM}:
        return OutputError(f"{path} cannot be written ({error}); name another folder with -o")
    return RpsError(f"{path}: {error}")


def _json(value: object) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)
