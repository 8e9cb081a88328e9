"""The store of a study: one SQLite file, one writer, every batch on disk as it comes.

The rollback journal makes each transaction whole: a kill at any moment leaves the
batches that were stored before. The writer holds the file's lock from the first to the
last moment, so that a second process is refused, and a dead one leaves nothing behind
that needs to be removed.

What is stored are entries: a batch of points, facts about the study, storey shears of a
building on a fixed base. Each has one digest, which is compared whenever it is read: a
disk that lost a bit makes no number.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, Self

import numpy as np

from rpscli.errors import OutputError, Refused
from rpscli.model.podium import Array
from rpscli.sweep.evaluation import FAILED, MISSING, PointResults, at_path

FILE = "study.sqlite"
FORMAT = 4
APPLICATION = b"rps1"
"""Marks the file as ours in its header."""

SCHEMA = """
CREATE TABLE IF NOT EXISTS entries (
    id INTEGER PRIMARY KEY,   -- of two entries about the same thing the later one counts
    kind TEXT NOT NULL,       -- BATCH, FACTS or FIXED_BASE
    head TEXT NOT NULL,       -- what the numbers are, and what is text (JSON)
    numbers BLOB NOT NULL,
    digest BLOB NOT NULL      -- of the fields before
)"""

BATCH = "batch"
FACTS = "facts"
FIXED_BASE = "fixed base"

KEY = 32
"""Bytes of the key of a point."""

FLOAT = "<f8"

TROUBLES = dict.fromkeys(
    (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM),
    " cannot be written ({}); name another folder with -o",
) | {
    sqlite3.SQLITE_FULL: (
        ": the disk is full; what was stored is safe. Make room and run the same"
        " command again: it continues where it stopped"
    ),
    sqlite3.SQLITE_IOERR: (
        ": the disk cannot be read or written ({}); run the same command again, or name"
        " another folder with -o"
    ),
}
"""What is wrong with the file's place, by SQLite's codes."""


class Store:
    """Results of the points of a study, in its folder; `fresh` discards
    those of an earlier run.

    The file is open, and locked, as long as somebody is inside (``with store:``, which
    may be nested), and may be opened again.
    """

    def __init__(self, folder: Path, *, fresh: bool = False) -> None:
        self.path = folder / FILE
        self._fresh = fresh
        self._inside = 0
        self._identity: tuple[int, int] | None = None

    def __enter__(self) -> Self:
        if not self._inside:
            with self._explained():
                self._open()
        self._inside += 1
        return self

    def __exit__(self, *_: object) -> None:
        self._inside -= 1
        if not self._inside:
            self._db.close()

    def _open(self) -> None:
        if self._identity and not self.path.is_file():
            raise Refused(f"{self.path}: no longer exists; run the study again")
        self.path.parent.mkdir(parents=True, exist_ok=True)
        if self.path.exists() and self.path.stat().st_size:
            with self.path.open("rb") as file:
                head = file.read(72)
            # Of a damaged file the header alone tells whether it may be deleted.
            if not head.startswith(b"SQLite format 3\0") or head[68:] != APPLICATION:
                raise Refused(
                    f"{self.path} is not the store of a study; move it away, or name"
                    " another folder with -o"
                )
        if self._fresh:
            try:
                self._connect()
                self._db.close()
            except sqlite3.OperationalError:  # locked, or not to be written
                raise
            except (
                sqlite3.DatabaseError,
                UnicodeDecodeError,
            ):  # damaged: what --fresh is for
                pass
            for name in (FILE, f"{FILE}-journal"):
                self.path.with_name(name).unlink(missing_ok=True)
            self._fresh = False
        self._connect()
        self._identity = self._file()

    def _connect(self) -> None:
        """Lock the file, which is made if there is none; refuse one
        that is not of this format.
        """
        with ExitStack() as undone:
            self._db = sqlite3.connect(self.path, timeout=0.2, isolation_level=None)
            undone.callback(self._db.close)
            self._db.text_factory = (
                bytes  # text when the digest says that it is what was written
            )
            # The lock is held from the first access on, until the connection ends.
            self._db.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._db.execute("BEGIN EXCLUSIVE")
            tables, version = (
                self._db.execute(query).fetchone()[0]
                for query in ("SELECT count(*) FROM sqlite_master", "PRAGMA user_version")
            )
            if tables and version != FORMAT and not self._fresh:
                raise Refused(
                    f"{self.path} was written by another version of rps (format"
                    f" {version or 'before 4'}); use --fresh to start again, or another"
                    " folder with -o"
                )
            self._db.execute(SCHEMA)
            self._db.execute(f"PRAGMA application_id = {int.from_bytes(APPLICATION)}")
            self._db.execute(f"PRAGMA user_version = {FORMAT}")
            self._db.execute("COMMIT")
            undone.pop_all()

    def _file(self) -> tuple[int, int] | None:
        """Identity of the file among others of its name; None if there is none."""
        with suppress(OSError):
            status = self.path.stat()
            return status.st_dev, status.st_ino
        return None

    def require(self) -> None:
        """Refuse to go on without the file, which SQLite would do unseen."""
        if self._identity != self._file():
            raise OutputError(
                f"{self.path} was deleted or replaced while rps worked on it, and what"
                " was stored in it is lost; run the same command again"
            )

    def _add(self, entries: Iterable[tuple[str, Any, bytes]]) -> None:
        """Store entries of a kind, a head and numbers; when this
        returns they are on disk.
        """
        self.require()
        with self._explained():
            self._db.execute("BEGIN")
            try:
                for kind, head, numbers in entries:
                    text = json.dumps(head, separators=(",", ":"), allow_nan=False)
                    fields = (
                        kind,
                        text,
                        numbers,
                        _digest(kind.encode(), text.encode(), numbers),
                    )
                    self._db.execute(
                        "INSERT INTO entries VALUES (NULL, ?, ?, ?, ?)", fields
                    )
                self._db.execute("COMMIT")
            except BaseException:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise

    def _entries(self, kind: str) -> Iterator[tuple[Any, bytes]]:
        """Heads and numbers of all entries of a kind, the oldest first."""
        with self._explained():
            query = (
                "SELECT kind, head, numbers, digest FROM entries WHERE kind = ? ORDER BY"
                " id"
            )
            for *fields, digest in self._db.execute(query, (kind,)):
                if digest != _digest(*fields):
                    raise _damaged(self.path, "a row does not have its digest")
                yield json.loads(fields[1]), fields[2]

    def facts(self) -> dict[str, str]:
        """Facts that were noted about the study."""
        return {
            name: text for head, _ in self._entries(FACTS) for name, text in head.items()
        }

    def note(self, **facts: str) -> None:
        """Write facts about the study that are not known yet."""
        if facts != self.facts():
            self._add([(FACTS, facts, b"")])

    def add(self, keys: Sequence[bytes], results: PointResults) -> None:
        """Store the results of some points."""
        columns = {n: c for n, c in results.columns.items() if not np.isnan(c).all()}
        head = {
            "outcomes": results.outcomes.tolist(),
            "messages": results.messages,
            "columns": {name: column.shape[1:] for name, column in columns.items()},
        }
        numbers = (column.astype(FLOAT).tobytes() for column in columns.values())
        self._add([(BATCH, head, b"".join([*keys, *numbers]))])

    def batches(self) -> Iterator[tuple[list[bytes], PointResults]]:
        """Keys and results of all batches, the oldest first; columns
        are views of what was read.
        """
        for head, numbers in self._entries(BATCH):
            count = len(head["outcomes"])
            columns = {}
            start = count * KEY
            for name, sizes in head["columns"].items():
                column = np.frombuffer(numbers, FLOAT, count * math.prod(sizes), start)
                columns[name] = column.reshape(count, *sizes)
                start += column.nbytes
            messages = {int(row): text for row, text in head["messages"].items()}
            outcomes = np.array(head["outcomes"], dtype="U20")
            keys = [numbers[place : place + KEY] for place in range(0, count * KEY, KEY)]
            yield keys, PointResults(outcomes, messages, columns)

    def outcomes(self) -> dict[bytes, bool]:
        """Keys of all stored points, and whether each failed;
        everything stored is looked at.
        """
        failed: dict[bytes, bool] = {}
        for keys, results in self.batches():
            failed.update(zip(keys, (results.outcomes == FAILED).tolist(), strict=True))
        return failed

    def results(self, keys: Sequence[bytes], names: Iterable[str]) -> PointResults:
        """Results of points with some names; elements of lists by
        their index, as in `at_path`.
        """
        row_of: dict[bytes, int] = {}
        rows = np.array([row_of.setdefault(key, len(row_of)) for key in keys], np.int64)
        wanted = tuple(names)
        stored = PointResults.alike(len(row_of), MISSING)
        for batch, results in self.batches():
            known = [(i, row_of[key]) for i, key in enumerate(batch) if key in row_of]
            if not known:
                continue
            here, there = np.array(known).T
            stored.outcomes[there] = results.outcomes[here]
            stored.messages.update((row, results.messages.get(i, "")) for i, row in known)
            for column in stored.columns.values():
                column[there] = np.nan
            for name in wanted:
                values = at_path(results.columns, name)
                if values is not None:
                    stored.put(there, name, values[here])
        failed = np.flatnonzero(stored.outcomes[rows] == FAILED)
        messages = {row: stored.messages[rows[row]] for row in failed.tolist()}
        columns = {name: column[rows] for name, column in stored.columns.items()}
        return PointResults(stored.outcomes[rows], messages, columns)

    def fixed_base(self) -> dict[bytes, Array]:
        """Storey shears on a fixed base, by key."""
        every = self._entries(FIXED_BASE)
        return {
            numbers[:KEY]: np.frombuffer(numbers, FLOAT, offset=KEY)
            for _, numbers in every
        }

    def add_fixed_base(self, shears: Mapping[bytes, Array]) -> None:
        """Store storey shears on a fixed base."""
        each = ((key, values.astype(FLOAT).tobytes()) for key, values in shears.items())
        self._add((FIXED_BASE, None, key + numbers) for key, numbers in each)

    @contextmanager
    def _explained(self) -> Iterator[None]:
        """SQLite's and the system's complaints in words that help."""
        try:
            yield
        except sqlite3.Error as error:
            code = getattr(error, "sqlite_errorcode", 0) & 0xFF
            if code in {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}:
                raise Refused(
                    f"{self.path} is in use: another `rps sweep` works in this folder;"
                    " wait for it, or name another folder with -o"
                ) from None
            if code in TROUBLES:
                raise OutputError(f"{self.path}{TROUBLES[code].format(error)}") from None
            raise _damaged(self.path, str(error)) from None
        except (
            UnicodeDecodeError
        ) as error:  # names of columns are text in the file as well
            raise _damaged(self.path, str(error)) from None
        except OSError as error:
            reason = error.strerror or str(error)
            raise OutputError(
                f"{self.path}: {reason}; name another folder with -o"
            ) from None


def _damaged(path: Path, what: str) -> Refused:
    return Refused(
        f"{path} is damaged ({what}); start again with --fresh, or restore the file"
    )


def _digest(*fields: Any) -> bytes:
    """Of the fields of an entry, each with its length; what is
    damaged may be no bytes.
    """
    digest = hashlib.blake2b(digest_size=16)
    for field in fields:
        content = field if isinstance(field, bytes) else repr(field).encode()
        digest.update(b"%d:%b" % (len(content), content))
    return digest.digest()
