"""A file that is none is named, and what to do about it."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from rpscli.case.case import load_case
from rpscli.errors import CaseError


def refusal(source: Path | str) -> str:
    with pytest.raises(CaseError) as error:
        load_case(source)
    return str(error.value)


def test_a_case_knows_where_it_comes_from(tmp_path: Path, building: str) -> None:
    path = tmp_path / "tower.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + building.replace("\n", "\r\n").encode())
    case = load_case(path)
    assert (case.name, case.title, case.folder) == ("tower", "tower", tmp_path)
    assert case.source == str(path)


def test_missing_file_names_the_nearest(tmp_path: Path, building: str) -> None:
    (tmp_path / "six_storey.yaml").write_text(building)
    message = refusal(tmp_path / "six_story.yaml")
    assert "six_story.yaml: there is no such file" in message
    assert f"did you mean {tmp_path / 'six_storey.yaml'}?" in message
    assert "rps init" in refusal(tmp_path / "other.txt")
    assert "does not exist either" in refusal(tmp_path / "nowhere" / "a.yaml")


def test_a_folder_is_no_file(tmp_path: Path, building: str) -> None:
    (tmp_path / "one.yaml").write_text(building)
    message = refusal(tmp_path)
    assert "is a folder" in message
    assert str(tmp_path / "one.yaml") in message


def test_a_file_as_folder_is_refused(tmp_path: Path, building: str) -> None:
    (tmp_path / "one.yaml").write_text(building)
    assert "cannot be read" in refusal(tmp_path / "one.yaml" / "two.yaml")
    assert "do not show; rename the file" in refusal("with\0zero.yaml")


def test_other_encodings_are_refused_with_the_place(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes("rps: 1\ntitle: Geb\xe4ude\n".encode("latin-1"))
    message = refusal(path)
    assert message.startswith(f"{path}:2:11: the byte 0xe4 is not UTF-8")
    assert "save" in message
    path.write_bytes("rps: 1\n".encode("utf-16"))
    assert "is not UTF-8" in refusal(path)


def test_standard_input(monkeypatch: pytest.MonkeyPatch, building: str) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(building.encode())))
    case = load_case("-", ["title=From a pipe"])
    assert (case.name, case.title, case.folder) == ("stdin", "From a pipe", Path())
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"rps: 2\n")))
    assert refusal("-").startswith("<stdin>:1:1: superstructure is missing")
    monkeypatch.setattr("sys.stdin", None)
    assert refusal("-").startswith("<stdin>: the standard input is closed; name a file")
