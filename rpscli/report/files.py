"""Documents and files of results: whole or not at all, and never
over what is not their own.
"""

from __future__ import annotations

import json
import os
import platform
import secrets
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from rpscli.analyses.result_quantities import plain
from rpscli.errors import (
    OutputError,
    Refused,
    RpsError,
    UsageError,
    is_number,
    listed,
    refused_by_system,
    visible,
)
from rpscli.machine import mode_of
from rpscli.version import VERSION

SCHEMA_VERSION = 1  # version of every JSON document that rps writes


def json_text(document: Mapping[str, Any]) -> str:
    """The document, indented by two, with a newline at its end."""
    return _text(plain(document), "") + "\n"


def _text(value: Any, indent: str) -> str:
    deeper = indent + "  "
    if isinstance(value, dict) and value:
        items = (
            f"{deeper}{json.dumps(key)}: {_text(item, deeper)}"
            for key, item in value.items()
        )
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        return (
            "[\n"
            + ",\n".join(deeper + _text(item, deeper) for item in value)
            + f"\n{indent}]"
        )
    return json.dumps(value, allow_nan=False)


def versions() -> dict[str, str | None]:
    """Versions of rps, Python, numpy and llvmlite, without importing any of them."""
    others = {name: installed(name) for name in ("numpy", "llvmlite")}
    return {"rps": VERSION, "python": platform.python_version(), **others}


def installed(package: str) -> str | None:
    """Version of a package; None if it is not there."""
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


Document = dict[str, Any]


def heading(command: str = "", status: str = "ok") -> Document:
    """The keys with which every document begins."""
    begin = {"schema_version": SCHEMA_VERSION, "rps_version": VERSION, "status": status}
    return begin | ({"command": command} if command else {})


def failure_document(kind: str, message: str, exit_code: int) -> Document:
    """The keys by which a document says that its command failed."""
    return {
        **heading(status="error"),
        "passed": False,
        "exit_code": exit_code,
        "error": {"type": kind, "message": message, "exit_code": exit_code},
    }


def read_json(path: Path, kinds: Any) -> Document:
    """A document of an earlier run, checked whole; a ValueError says
    what is wrong and where.
    """
    # Kinds are types, lists of one kind, tuples of one that may be missing, mappings of
    # kinds.
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise ValueError(f"the file is no JSON at {place}") from None
    except UnicodeDecodeError:
        raise ValueError("the file is no text in UTF-8") from None
    except RecursionError:
        raise ValueError("the file is nested too deeply") from None
    except OSError as error:
        raise ValueError(f"the file cannot be read: {error.strerror}") from None
    return dict(_checked(document, kinds, "the file"))


def _checked(value: Any, kinds: Any, place: str) -> Any:
    if isinstance(kinds, tuple):
        return None if value is None else _checked(value, kinds[0], place)
    kind = type(kinds) if isinstance(kinds, dict | list) else kinds
    if not (is_number(value) if kind is float else isinstance(value, kind)):
        known = {dict: "a mapping", list: "a list", float: "a number", str: "a text"}
        raise ValueError(f"{place} must be {known[kind]}")
    if isinstance(value, str) and visible(value) != value:
        raise ValueError(f"{place} must be a text that shows")
    if isinstance(kinds, list):
        return [_checked(each, kinds[0], f"{place}[{n}]") for n, each in enumerate(value)]
    if isinstance(kinds, dict):
        return value | {
            key: _checked(value.get(key), of, key) for key, of in kinds.items()
        }
    return value


MADE_ANEW = {"files", "rps_version", "case", "verdicts", "passed", "exit_code", "command"}
"""Keys of a document that are no results."""


def leaves(value: object, name: str = "") -> Iterator[tuple[str, Any]]:
    """Values of nested mappings and of lists of mappings under dotted
    names; other lists whole.
    """
    if isinstance(value, list) and any(isinstance(item, dict) for item in value):
        value = {str(index): item for index, item in enumerate(value)}
    if not isinstance(value, dict) or not value:
        yield name, value
        return
    for key, item in value.items():
        yield from leaves(item, f"{name}.{key}" if name else key)


def results_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """The results of a document by dotted name."""
    return dict(leaves({key: document[key] for key in document if key not in MADE_ANEW}))


def as_text(value: object) -> str:
    """A value of a document for a table, cut where it is long."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) < 60 else f"{text[:57]}..."


_writing = partial(
    refused_by_system,
    fault=OutputError,
    verb="written",
    remedy="name another place with -o",
)


@dataclass
class Drawing:
    """A file that is drawn when called, after results are
    written; empty if that fails.
    """

    name: str
    draw: Callable[[], bytes]
    reason: str = ""  # why it failed

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
            self.reason = f"{kind}{error}"
            return b""


def undrawn(drawings: Iterable[object]) -> list[str]:
    """Sentences on drawings that failed, those with one reason together."""
    names: dict[str, list[str]] = {}
    for each in drawings:
        if isinstance(each, Drawing) and each.reason:
            names.setdefault(each.reason, []).append(each.name)
    return [
        f"{listed(failed, 'and')} {'are' if len(failed) > 1 else 'is'} not drawn:"
        f" {reason}; the results are not concerned"
        for reason, failed in names.items()
    ]


Written: TypeAlias = bytes | Iterator[str]
"""Of a file, or its lines, which are made as they are written."""
Content: TypeAlias = Written | Drawing
Files: TypeAlias = Iterator[tuple[str, str | Content]]
"""Names and contents."""


def encoded(text: str) -> bytes:
    r"""As UTF-8; bytes of a file name that cannot be decoded become \udce4."""
    return text.encode("utf-8", "backslashreplace")


def write_whole(contents: Mapping[Path, Written]) -> None:
    """Write files so that each appears whole or not at all, in folders
    that are made if needed.
    """
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
        # The system lets go when the process ends, however it ends. Where folders cannot
        # be locked (Windows, some file systems of networks), two processes must not write
        # to one.
        with suppress(ImportError, OSError):
            import fcntl  # not on every system

            handle = os.open(folder, os.O_RDONLY)
            lock.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def require_writable(folder: Path) -> None:
    """Refuse a folder that cannot be made or written to: better
    before the work than after.
    """
    if "\0" in str(folder):
        raise OutputError(
            f"{str(folder)[:200]!r}: no path holds a zero byte; correct the name"
        )
    with _writing(folder):
        existing = next(
            place for place in (folder, *folder.absolute().parents) if mode_of(place)
        )
    if not existing.is_dir():
        raise OutputError(
            f"{folder}: cannot be a folder of results, {existing} is a file"
        )
    if not os.access(existing, os.W_OK | os.X_OK):
        raise OutputError(
            f"{folder}: no permission to write there; name another place with -o"
        )


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
class CommandRun:
    """The subject of a command; one without a file is known by
    the SHA-256 of its text.
    """

    command: str
    name: str
    file: Path | None
    digest: str
    inputs: Mapping[str, Any] = field(default_factory=dict)
    record: Path | str | None = None


class OutputFolder:
    """The files that one run leaves behind, in a folder that is
    made when they are written.
    """

    # A later run of the same command on the same file under the same record may replace
    # them, though the file's content or the options have changed.
    def __init__(self, folder: Path, run: CommandRun, *, force: bool = False) -> None:
        self.folder = folder
        self.run = run
        self.force = force
        self.contents: dict[Path, Content] = {}
        self.removed: list[str] = []
        self.keeps_earlier = False  # files of an earlier run that this one has not
        self.kept: list[str] = []
        self._earlier = self._claimed()

    @property
    def files(self) -> list[str]:
        """Paths of what will be, or was, written, as the user would type them."""
        return [str(path) for path in (*self.contents, self.folder / RUN_FILE)]

    @property
    def undrawn(self) -> list[str]:
        """Why figures could not be drawn."""
        return undrawn(self.contents.values())

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
        """Collect a file that stands elsewhere; it is guarded
        like those of the folder.
        """
        self.contents[path] = encoded(content) if isinstance(content, str) else content

    def write(self) -> None:
        """Write all files, `run.json` with them, and then draw what is to be drawn."""
        with locked(self.folder):
            # Another process may have written here since this one began.
            self._earlier = self._claimed()
            for path in self.contents:
                if path.exists() and self._known_as(path) not in self._own:
                    self._refuse(
                        f"{path} exists and is not an earlier output of this command"
                    )
            run = self.folder / RUN_FILE
            made = {self._known_as(path) for path in (*self.contents, run)}
            stale = sorted(name for name in self._own - made if self._stands(name))
            self.kept = stale if self.keeps_earlier else []
            results = {
                p: c for p, c in self.contents.items() if not isinstance(c, Drawing)
            }
            document = {
                "schema_version": SCHEMA_VERSION,
                "command": self.run.command,
                "name": self.run.name,
                "file": self._subject["file"],
                "sha256": self.run.digest,
                "record": self._subject["record"],
                "inputs": self.run.inputs,
                "versions": versions(),
                "files": [*(self._known_as(path) for path in self.contents), *self.kept],
            }
            write_whole({**results, run: json_text(document).encode()})
            for name in () if self.keeps_earlier else stale:
                (self.folder / name).unlink()
                self.removed.append(name)
            for path, drawing in self.contents.items():
                if isinstance(drawing, Drawing):
                    path.unlink(
                        missing_ok=True
                    )  # that of an earlier run shows other results
                    if drawn := drawing():
                        write_whole({path: drawn})

    def _stands(self, name: str) -> bool:
        """True of a file in the folder itself: what stands elsewhere is left alone."""
        return Path(name).name == name and (self.folder / name).is_file()

    @property
    def _subject(self) -> dict[str, Any]:
        """File and record of the run, as the folder knows them."""
        run = self.run
        record = self.run.record
        return {
            "file": None if run.file is None else self._known_as(run.file),
            "record": self._known_as(record) if isinstance(record, Path) else record,
        }

    def _known_as(self, path: Path) -> str:
        # Relative to the folder: a project that is moved as a whole keeps knowing its
        # results.
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
            raise Refused(
                f"{reason}; name another place with -o, or overwrite with --force"
            )
        return {}
