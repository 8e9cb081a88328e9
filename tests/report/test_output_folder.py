"""Files appear whole or not at all, and only where they may."""

from __future__ import annotations

import errno
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from rpscli.errors import OutputError, Refused
from rpscli.report.files import Drawing, OutputFolder, Run, write_whole


def folder_of(
    place: Path, digest: str = "a", *, force: bool = False, **inputs: object
) -> OutputFolder:
    return OutputFolder(place, Run("modal", "x", place / "../x.yaml", digest, inputs), force=force)


def test_run_json_says_what_was_run(tmp_path: Path) -> None:
    folder = folder_of(tmp_path / "out", scale=2.0)
    folder.add("a.csv", "1\n")
    folder.write()
    run = json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))
    assert run["inputs"] == {"scale": 2.0}
    assert run["file"] == "../x.yaml"  # a project may move as a whole
    assert run["files"] == ["a.csv"]
    assert set(run["versions"]) == {"rps", "python", "numpy", "numba"}


def test_files_of_an_earlier_run_that_are_no_longer_made_go_away(tmp_path: Path) -> None:
    first = folder_of(tmp_path)
    for name in ("a.csv", "b.csv"):
        first.add(name, name)
    first.write()
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    second = folder_of(tmp_path)
    second.add("a.csv", "new")
    second.write()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.csv", "notes.txt", "run.json"]
    assert second.removed == ["b.csv"]


def test_results_are_written_before_anything_is_drawn(tmp_path: Path) -> None:
    """A figure that fails is told, the others are drawn, and the next run draws it."""
    seen: list[str] = []

    def draws() -> bytes:
        seen.extend(sorted(file.name for file in tmp_path.iterdir()))
        return b"PNG"

    def fails() -> bytes:
        raise RuntimeError("no figure")

    def written(first: Callable[[], bytes]) -> OutputFolder:
        folder = folder_of(tmp_path)
        for name, draw in {"first.png": first, "second.png": draws}.items():
            folder.add(name, Drawing(name, draw))
        folder.add("a.csv", "1")
        folder.write()
        return folder

    assert written(draws).undrawn == []
    assert seen[:2] == ["a.csv", "run.json"]
    reason = "first.png is not drawn: RuntimeError: no figure; the results are not concerned"
    assert written(fails).undrawn == [reason]
    assert not (tmp_path / "first.png").exists()  # nor that of the run before
    assert written(draws).undrawn == []
    assert (tmp_path / "first.png").read_bytes() == (tmp_path / "second.png").read_bytes() == b"PNG"


def test_nothing_outside_the_folder_is_taken_away(tmp_path: Path) -> None:
    film = tmp_path / "film.gif"
    first = folder_of(tmp_path / "out")
    first.add_at(film, b"GIF")
    first.write()
    folder_of(tmp_path / "out").write()
    assert film.read_bytes() == b"GIF"
    third = folder_of(tmp_path / "out")
    third.add_at(film, b"GIF2")
    with pytest.raises(Refused):  # the run before this one did not write it
        third.write()


@pytest.mark.parametrize("text", ["", "[]", "{}", "null", '{"command": 1}', "\0"])
def test_a_strange_run_json_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "run.json").write_text(text, encoding="utf-8")
    with pytest.raises(Refused, match=r"run\.json is not a description"):
        folder_of(tmp_path)
    folder_of(tmp_path, force=True).write()
    assert not folder_of(tmp_path).replaces_other_inputs


def test_other_inputs_are_noticed(tmp_path: Path) -> None:
    assert not folder_of(tmp_path).replaces_other_inputs
    folder_of(tmp_path, "a", scale=1.0).write()
    assert not folder_of(tmp_path, "a", scale=1.0).replaces_other_inputs
    assert folder_of(tmp_path, "b", scale=1.0).replaces_other_inputs
    assert folder_of(tmp_path, "a", scale=2.0).replaces_other_inputs


def test_a_full_disk_or_an_interruption_leaves_everything_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_whole({tmp_path / "a": b"old"})
    write = Path.write_bytes

    def stopped(path: Path, data: bytes) -> int:
        if data == b"interrupted":
            raise KeyboardInterrupt
        if data == b"too much":
            write(path, data[:3])
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, data)

    monkeypatch.setattr(Path, "write_bytes", stopped)
    with pytest.raises(OutputError, match=r"b: cannot be written: No space left on device"):
        write_whole({tmp_path / "a": b"new", tmp_path / "b": b"too much"})
    with pytest.raises(KeyboardInterrupt):
        write_whole({tmp_path / "a": b"interrupted"})
    assert [file.name for file in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"old"


def test_a_folder_in_the_way(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    with pytest.raises(OutputError, match="there is a folder of this name"):
        write_whole({tmp_path / "a": b"new"})


def test_a_folder_without_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rpscli.report.files.os.access", lambda *_: False)
    with pytest.raises(OutputError, match="no permission"):
        folder_of(tmp_path / "out")
