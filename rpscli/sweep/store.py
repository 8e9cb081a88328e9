"""The store of a study: one SQLite file, one writer, every result on disk as it comes.

The rollback journal makes each transaction whole: a kill at any moment leaves the results that
were stored before. The writer holds the file's lock from the first to the last moment, so that a
second process is refused, and a dead one leaves nothing behind that needs to be removed.

Every row carries a digest of its fields, which is compared whenever it is read: a disk that lost a
bit makes no number.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Self

from rpscli.errors import OutputError, Refused, RpsError
from rpscli.sweep.evaluation.results import FAILED, Results

FILE = "study.sqlite"
FORMAT = "2"
APPLICATION = 0x72707331
"""Marks the file as ours in its header: "rps1"."""

SCHEMA = """
CREATE TABLE IF NOT EXISTS meta (
    name TEXT PRIMARY KEY,
    value TEXT NOT NULL,
    digest BLOB NOT NULL      -- of the other fields, here and below
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS points (
    key BLOB PRIMARY KEY,     -- digest of resolved case, record, scale and solver
    point TEXT NOT NULL,      -- what the study called it: varied keys, record, scale (JSON)
    outcome TEXT NOT NULL,
    message TEXT,             -- why it failed
    results TEXT NOT NULL,    -- JSON
    digest BLOB NOT NULL
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS fixed_base (
    key BLOB PRIMARY KEY,
    storey_shears TEXT NOT NULL,
    digest BLOB NOT NULL
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
        If the file cannot be written, or was deleted since it was opened.
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
            self._identity = self._file()
        except BaseException:
            self._db.close()
            raise

    def _connected(self) -> sqlite3.Connection:
        db = sqlite3.connect(self.path, timeout=0.2, isolation_level=None)
        db.text_factory = bytes  # read as text when the digest says that it is what was written
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
            self._refuse_other_formats()
            if self._db.execute("SELECT count(*) FROM meta").fetchone() == (0,):
                self._db.execute("INSERT INTO meta VALUES (?, ?, ?)", _signed("format", FORMAT))
            self._db.execute("COMMIT")

    def _file(self) -> tuple[int, int] | None:
        """What tells the file from others of its name; None if there is none."""
        try:
            found = self.path.stat()
        except OSError:
            return None
        return found.st_dev, found.st_ino

    def require(self) -> None:
        """Refuse to go on without the file, which SQLite would do unseen.

        Raises
        ------
        OutputError
            If it was deleted or replaced since it was opened.
        """
        if self._identity != self._file():
            raise OutputError(
                f"{self.path} was deleted or replaced while rps worked on it, and what was stored"
                " in it is lost; run the same command again"
            )

    def _tables(self) -> list[bytes]:
        return [name for (name,) in self._db.execute("SELECT name FROM sqlite_master")]

    def _refuse_other_programs(self) -> None:
        ours = self._db.execute("PRAGMA application_id").fetchone()[0] == APPLICATION
        if self._tables() and not ours:
            raise Refused(f"{self.path} belongs to another program; name another folder with -o")

    def _refuse_other_formats(self) -> None:
        row = self._db.execute("SELECT value FROM meta WHERE name = 'format'").fetchone()
        if row is not None and row[0] != FORMAT.encode():
            raise Refused(
                f"{self.path} was written by another version of rps (format"
                f" {row[0].decode(errors='replace')}); use --fresh to begin anew, or another folder"
                " with -o"
            )

    def meta(self, name: str) -> str | None:
        """A fact about the study."""
        with self._told():
            row = self._db.execute("SELECT * FROM meta WHERE name = ?", (name,)).fetchone()
            return None if row is None else self._verified(row)[1].decode()

    def _verified(self, row: tuple[Any, ...]) -> tuple[Any, ...]:
        """The fields of a row before its digest, which they must have."""
        *fields, digest = row
        if digest != _digest(fields):
            raise _damaged(self.path, "a row does not have its digest")
        return tuple(fields)

    def note(self, **facts: str) -> None:
        """Write facts about the study."""
        with self._transaction():
            rows = [_signed(*fact) for fact in facts.items()]
            self._db.executemany("REPLACE INTO meta VALUES (?, ?, ?)", rows)

    def add(self, entries: Iterable[Entry]) -> None:
        """Store points in one transaction; when this returns they are on disk."""
        rows = [
            _signed(e.key, _json(e.point), e.outcome, e.message, _json(e.results)) for e in entries
        ]
        with self._transaction():
            self._db.executemany("REPLACE INTO points VALUES (?, ?, ?, ?, ?, ?)", rows)

    def outcomes(self) -> dict[bytes, bool]:
        """Keys of all stored points, and whether each failed; every row is looked at."""
        with self._told():
            rows = map(self._verified, self._db.execute("SELECT * FROM points"))
            return {key: outcome.decode() == FAILED for key, _, outcome, _, _ in rows}

    def stored(self, keys: Iterable[bytes]) -> Iterator[Stored | None]:
        """Points in the order of the keys; None for those that are not there."""
        with self._told():
            for key in keys:
                row = self._db.execute("SELECT * FROM points WHERE key = ?", (key,)).fetchone()
                yield None if row is None else self._point(row)

    def _point(self, row: tuple[Any, ...]) -> Stored:
        _, _, outcome, message, results = self._verified(row)
        message = None if message is None else message.decode()
        return Stored(outcome.decode(), message, json.loads(results))

    def fixed_base(self) -> dict[bytes, list[float]]:
        """Storey shears on a fixed base, by key."""
        with self._told():
            rows = map(self._verified, self._db.execute("SELECT * FROM fixed_base"))
            return {key: json.loads(text) for key, text in rows}

    def add_fixed_base(self, shears: Mapping[bytes, list[float]]) -> None:
        """Store storey shears on a fixed base."""
        rows = [_signed(key, _json(values)) for key, values in shears.items()]
        with self._transaction():
            self._db.executemany("REPLACE INTO fixed_base VALUES (?, ?, ?)", rows)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self.require()
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
        except UnicodeDecodeError as error:  # names of columns are text in the file as well
            raise _damaged(self.path, str(error)) from None
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
    if code in {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM}:
        return OutputError(f"{path} cannot be written ({error}); name another folder with -o")
    if code == sqlite3.SQLITE_IOERR:
        return OutputError(
            f"{path}: the disk cannot be read or written ({error}); run the same command again, or"
            " name another folder with -o"
        )
    return _damaged(path, str(error))


def _damaged(path: Path, what: str) -> Refused:
    return Refused(f"{path} is damaged ({what}); begin anew with --fresh, or restore the file")


def _signed(*fields: bytes | str | None) -> tuple[bytes | str | None, ...]:
    """The fields of a row, and their digest."""
    return (*fields, _digest(fields))


def _digest(fields: Iterable[bytes | str | None]) -> bytes:
    """Of the fields of a row, each with its length."""
    digest = hashlib.blake2b(digest_size=16)
    for field in fields:
        content = field if isinstance(field, bytes) else str(field).encode()
        digest.update(b"-" if field is None else b"%d:%b" % (len(content), content))
    return digest.digest()


_json = json.JSONEncoder(separators=(",", ":"), allow_nan=False).encode
