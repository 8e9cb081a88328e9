"""The store of a study: one SQLite file, one writer, every result on disk as it comes.

The rollback journal makes each transaction whole: a kill at any moment leaves the results that
were stored before. The writer holds the file's lock from the first to the last moment, so that a
second process is refused, and a dead one leaves nothing behind that needs to be removed.

Points are stored by batches, whose results are columns of binary numbers. Every row of the file
carries a digest of its fields, which is compared whenever it is read: a disk that lost a bit makes
no number.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import numpy as np

from rpscli.errors import OutputError, Refused, RpsError
from rpscli.sweep.evaluation.results import FAILED, Array, PointResults, at_path, no_results, put

FILE = "study.sqlite"
FORMAT = "3"
APPLICATION = 0x72707331
"""Marks the file as ours in its header: "rps1"."""

SCHEMA = """
CREATE TABLE IF NOT EXISTS meta (
    name TEXT PRIMARY KEY,
    value TEXT NOT NULL,
    digest BLOB NOT NULL      -- of the other fields, here and below
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS batches (
    id INTEGER PRIMARY KEY,   -- of two results of a point the later one counts
    keys BLOB NOT NULL,       -- of each point the digest of resolved case, record, scale and solver
    outcomes BLOB NOT NULL,   -- of each point
    messages TEXT NOT NULL,   -- by the number of the point in the batch: why it failed (JSON)
    columns TEXT NOT NULL,    -- name and sizes of the results of a point (JSON)
    numbers BLOB NOT NULL,    -- of each column, point by point; NaN where there is none
    digest BLOB NOT NULL
);
CREATE TABLE IF NOT EXISTS fixed_base (
    key BLOB PRIMARY KEY,
    storey_shears BLOB NOT NULL,
    digest BLOB NOT NULL
) WITHOUT ROWID;
"""

KEY = 32
"""Bytes of the key of a point."""

WORD = 20
"""Bytes of an outcome."""

FLOAT = "<f8"

Stored = Callable[[Iterable[str]], PointResults]
"""Reads results of some points by name; elements of lists by their index, as in `at_path`."""


class Store:
    """Results of the points of a study, in its folder; `fresh` discards those of an earlier run."""

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
        """Refuse to go on without the file, which SQLite would do unseen."""
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
                f" {row[0].decode(errors='replace')}); use --fresh to start again, or another"
                " folder with -o"
            )

    def meta(self, name: str) -> str | None:
        """A fact about the study."""
        with self._told():
            row = self._db.execute("SELECT * FROM meta WHERE name = ?", (name,)).fetchone()
            return None if row is None else self._verified(row)[1].decode()

    def _verified(self, row: Sequence[Any]) -> tuple[Any, ...]:
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

    def add(self, keys: Sequence[bytes], results: PointResults) -> None:
        """Store the results of some points; when this returns they are on disk."""
        columns = {n: c for n, c in results.columns.items() if not np.isnan(c).all()}
        fields = (
            b"".join(keys),
            results.outcomes.astype(f"S{WORD}").tobytes(),
            _json(results.messages),
            _json({name: column.shape[1:] for name, column in columns.items()}),
            b"".join(column.astype(FLOAT).tobytes() for column in columns.values()),
        )
        with self._transaction():
            sql = "INSERT INTO batches VALUES (NULL, ?, ?, ?, ?, ?, ?)"
            self._db.execute(sql, _signed(*fields))

    def _batches(self) -> Iterator[tuple[list[bytes], PointResults]]:
        """Keys and results of all batches, the oldest first; columns are views of what was read."""
        with self._told():
            for _, *row in self._db.execute("SELECT * FROM batches ORDER BY id"):
                keys, outcomes, messages, shapes, numbers = self._verified(row)
                count, start, columns = len(keys) // KEY, 0, {}
                for name, sizes in json.loads(shapes).items():
                    length = count * math.prod(sizes)
                    column = np.frombuffer(numbers, FLOAT, length, start)
                    columns[name] = column.reshape(count, *sizes)
                    start += column.nbytes
                words = np.frombuffer(outcomes, f"S{WORD}").astype(str)
                told = {int(row): text for row, text in json.loads(messages).items()}
                split_keys = [keys[i : i + KEY] for i in range(0, len(keys), KEY)]
                yield split_keys, PointResults(words, told, columns)

    def outcomes(self) -> dict[bytes, bool]:
        """Keys of all stored points, and whether each failed; everything stored is looked at."""
        found: dict[bytes, bool] = {}
        for keys, results in self._batches():
            found.update(zip(keys, (results.outcomes == FAILED).tolist(), strict=True))
        return found

    def stored(self, keys: Sequence[bytes]) -> Stored:
        """Points in the order of the keys, of which the results with some names are read."""
        return lambda names: self._read(keys, names)

    def _read(self, keys: Sequence[bytes], names: Iterable[str]) -> PointResults:
        places: dict[bytes, int] = {}
        rows = np.array([places.setdefault(key, len(places)) for key in keys], np.int64)
        wanted, found = tuple(names), no_results(len(places))
        for batch, results in self._batches():
            known = [(i, places[key]) for i, key in enumerate(batch) if key in places]
            if not known:
                continue
            here, there = np.array(known).T
            found.outcomes[there] = results.outcomes[here]
            found.messages.update((place, results.messages.get(i, "")) for i, place in known)
            for column in found.columns.values():
                column[there] = np.nan
            for name in wanted:
                values = at_path(results.columns, name)
                if values is not None:
                    put(found, there, name, values[here])
        failed = np.flatnonzero(found.outcomes[rows] == FAILED)
        messages = {row: found.messages[rows[row]] for row in failed.tolist()}
        columns = {name: column[rows] for name, column in found.columns.items()}
        return PointResults(found.outcomes[rows], messages, columns)

    def fixed_base(self) -> dict[bytes, Array]:
        """Storey shears on a fixed base, by key."""
        with self._told():
            rows = map(self._verified, self._db.execute("SELECT * FROM fixed_base"))
            return {key: np.frombuffer(numbers, FLOAT) for key, numbers in rows}

    def add_fixed_base(self, shears: Mapping[bytes, Array]) -> None:
        """Store storey shears on a fixed base."""
        rows = [_signed(key, values.astype(FLOAT).tobytes()) for key, values in shears.items()]
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
            " command again: it continues where it stopped"
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
    return Refused(f"{path} is damaged ({what}); start again with --fresh, or restore the file")


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
