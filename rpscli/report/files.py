"""Files and folders of results: whole or not at all, and never over what is not their own."""

from __future__ import annotations

import json
import os
import secrets
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from rpscli.errors import OutputError, Refused, RpsError, UsageError, refused_by_system
from rpscli.machine import mode_of
from rpscli.report.documents import SCHEMA_VERSION, json_text, read_json, versions

_writing = partial(
    refused_by_system, fault=OutputError, verb="written", remedy="name another place with -o"
)


@dataclass
class Drawing:
    """A file that is drawn when called, after results are written; empty if that fails."""

    name: str
    draw: Callable[[], bytes]
    fault: str = ""  # why it failed

    @property
    def ending(self) -> str:
        """The format."""
        return self.name.rpartition(".")[2]

    def __call__(self) -> bytes:
        """The content of the file."""
        try:
            return self.draw()
        except UsageError:  # what was asked for in vain is an error all the same
            raise
        except Exception as error:  # noqa: BLE001 -- no picture is worth the results
            kind = "" if isinstance(error, RpsError) else f"{type(error).__name__}: "
            self.fault = f"{self.name} is not drawn: {kind}{error}; the results are not concerned"
            return b""


Written: TypeAlias = bytes | Iterator[str]
"""Of a file, or its lines, which are made as they are written."""
Content: TypeAlias = Written | Drawing


def encoded(text: str) -> bytes:
    r"""As UTF-8; bytes of a file name that cannot be decoded become \udce4."""
    return text.encode("utf-8", "backslashreplace")


def write_whole(contents: Mapping[Path, Written]) -> None:
    """Write files so that each appears whole or not at all, in folders that are made if needed."""
    ready: dict[Path, Path] = {}
    try:
        for path, data in contents.items():
            with _writing(path):
                path.parent.mkdir(parents=True, exist_ok=True)
                if path.is_dir():
                    raise IsADirectoryError(0, "there is a folder of this name")
                ready[path] = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
                if isinstance(data, bytes):
                    ready[path].write_bytes(data)
                else:
                    with ready[path].open("wb") as file:
                        file.writelines(map(encoded, data))
        for path, temporary in ready.items():
            with _writing(path):
                temporary.replace(path)
    finally:
        for temporary in ready.values():
            temporary.unlink(missing_ok=True)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Make the folder, and wait until no other process that asks writes there."""
    with _writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as lock:
        # The system lets go when the process ends, however it ends. Where folders cannot be locked
        # (Windows, some file systems of networks), two processes must not write to one.
        with suppress(ImportError, OSError):
            import fcntl  # not on every system

            handle = os.open(folder, os.O_RDONLY)
            lock.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def require_writable(folder: Path) -> None:
    """Refuse a folder that cannot be made or written to: better before the work than after."""
    if "\0" in str(folder):
        raise OutputError(f"{str(folder)[:200]!r}: no path holds a zero byte; correct the name")
    with _writing(folder):
        existing = next(place for place in (folder, *folder.absolute().parents) if mode_of(place))
    if not existing.is_dir():
        raise OutputError(f"{folder}: cannot be a folder of results, {existing} is a file")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: no permission to write there; name another place with -o")


def require_writable_file(file: Path) -> None:
    """Refuse a file that cannot be made or replaced."""
    require_writable(file.parent)
    with _writing(file):
        if stat.S_ISDIR(mode_of(file)):
            raise IsADirectoryError(0, "there is a folder of this name")


RUN_FILE = "run.json"
RUN_KINDS = {
    "command": str, "name": str, "file": (str,), "sha256": str, "record": (str,), "files": [str],
    "inputs": {},
}  # fmt: skip
"""What it holds."""


@dataclass(frozen=True)
class Run:
    """The subject of a command; one without a file is known by the SHA-256 of its text."""

    command: str
    name: str
    file: Path | None
    digest: str
    inputs: Mapping[str, Any] = field(default_factory=dict)
    record: Path | str | None = None


class OutputFolder:
    """The files that one run leaves behind, in a folder that is made when they are written."""

    # A later run of the same command on the same file under the same record may replace them,
    # though the file's content or the options have changed.
    def __init__(self, folder: Path, run: Run, *, force: bool = False) -> None:
        self.folder, self.run, self.force = folder, run, force
        self.contents: dict[Path, Content] = {}
        self.removed: list[str] = []
        self.undrawn: list[str] = []  # why figures could not be drawn
        self._earlier = self._claimed()

    @property
    def files(self) -> list[str]:
        """Paths of what will be, or was, written, as the user would type them."""
        return [str(path) for path in (*self.contents, self.folder / RUN_FILE)]

    @property
    def replaces_other_inputs(self) -> bool:
        """True if earlier results are there, and come from other inputs."""
        earlier = {key: self._earlier.get(key) for key in ("sha256", "inputs")}
        return bool(self._earlier) and earlier != json.loads(
            json_text({"sha256": self.run.digest, "inputs": self.run.inputs})
        )

    def add(self, name: str, content: str | Content) -> None:
        """Collect a file of the folder."""
        self.add_at(self.folder / name, content)

    def add_all(self, files: Iterable[tuple[str, str | Content]]) -> None:
        """Collect files of the folder by their names."""
        for name, content in files:
            self.add(name, content)

    def add_at(self, path: Path, content: str | Content) -> None:
        """Collect a file that stands elsewhere; it is guarded like those of the folder."""
        self.contents[path] = encoded(content) if isinstance(content, str) else content

    def write(self) -> None:
        """Write all files, `run.json` with them, and then draw what is to be drawn."""
        with locked(self.folder):
            # Another process may have written here since this one began.
            self._earlier = self._claimed()
            for path in self.contents:
                if path.exists() and self._known_as(path) not in self._own:
                    self._refuse(f"{path} exists and is not an earlier output of this command")
            run = self.folder / RUN_FILE
            results = {p: c for p, c in self.contents.items() if not isinstance(c, Drawing)}
            document = {
                "schema_version": SCHEMA_VERSION,
                "command": self.run.command,
                "name": self.run.name,
                "file": self._subject["file"],
                "sha256": self.run.digest,
                "record": self._subject["record"],
                "inputs": self.run.inputs,
                "versions": versions(),
                "files": [self._known_as(path) for path in self.contents],
            }
            write_whole({**results, run: json_text(document).encode()})
            for stale in self._own - {self._known_as(path) for path in (*self.contents, run)}:
                if Path(stale).name == stale and (self.folder / stale).is_file():
                    (self.folder / stale).unlink()  # never outside the folder
                    self.removed.append(stale)
            for path, drawing in self.contents.items():
                if isinstance(drawing, Drawing):
                    path.unlink(missing_ok=True)  # that of an earlier run shows other results
                    if drawn := drawing():
                        write_whole({path: drawn})
                    self.undrawn += [drawing.fault] * bool(drawing.fault)

    @property
    def _subject(self) -> dict[str, Any]:
        """File and record of the run, as the folder knows them."""
        run, record = self.run, self.run.record
        return {
            "file": None if run.file is None else self._known_as(run.file),
            "record": self._known_as(record) if isinstance(record, Path) else record,
        }

    def _known_as(self, path: Path) -> str:
        # Relative to the folder: a project that is moved as a whole keeps knowing its results.
        try:
            return Path(os.path.relpath(path, self.folder)).as_posix()
        except ValueError:  # another drive
            return str(path.absolute())

    @property
    def _own(self) -> set[str]:
        return {*self._earlier.get("files", ()), RUN_FILE} if self._earlier else set()

    def _claimed(self) -> dict[str, Any]:
        """The earlier `run.json` if it is this run's own; empty if there is none."""
        require_writable(self.folder)
        place = self.folder / RUN_FILE
        try:
            earlier = read_json(place, RUN_KINDS)
        except FileNotFoundError:
            return {}
        except ValueError as error:
            return self._refuse(f"{place} is not a description of a run of rps: {error}")
        file = f" ({earlier['file']})" if earlier["file"] else ""
        owner = f"`rps {earlier['command']}` on {earlier['name']}{file}"
        if record := earlier["record"]:
            owner = f"{owner} under {record}"
        own = {"command": self.run.command, **self._subject}
        if self.run.file is None:  # what has no file is known by what it says
            own["sha256"] = self.run.digest
        if own == {key: earlier[key] for key in own}:
            return earlier
        return self._refuse(f"{self.folder} holds the results of {owner}")

    def _refuse(self, reason: str) -> dict[str, Any]:
        if not self.force:
            raise Refused(f"{reason}; name another place with -o, or overwrite with --force")
        return {}
