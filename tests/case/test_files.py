"""Files that are none, too large, or written to keep a reader busy: each is named."""

import io
import os
import threading
from pathlib import Path

import pytest

from rpscli.analyses.verification import answers_of_file
from rpscli.case.case import load_case
from rpscli.case.text import files
from rpscli.case.text.document import Document
from rpscli.errors import CaseError, RecordError, RpsError
from rpscli.records.loading import expand_sources, load_record
from rpscli.records.target import load_target
from rpscli.sweep.statistics.hazard import read_hazard
from rpscli.tools.comparison.observed import read_observed
from rpscli.tools.identify.command import measured

from .conftest import BUILDING, refusal


def of_file(source):
    """What a file is refused with."""
    with pytest.raises(CaseError) as error:
        load_case(source)
    return str(error.value)


def test_a_case_knows_where_it_comes_from(tmp_path):
    path = tmp_path / "tower.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + BUILDING.replace("\n", "\r\n").encode())
    case = load_case(path)
    assert (case.name, case.title, case.folder) == ("tower", "tower", tmp_path)
    assert case.source == str(path)


def test_missing_file_names_the_nearest(tmp_path):
    (tmp_path / "six_storey.yaml").write_text(BUILDING)
    message = of_file(tmp_path / "six_story.yaml")
    assert "six_story.yaml: there is no such file" in message
    assert f"did you mean {tmp_path / 'six_storey.yaml'}?" in message
    assert "rps init" in of_file(tmp_path / "other.txt")
    assert "does not exist either" in of_file(tmp_path / "nowhere" / "a.yaml")


def test_a_folder_is_no_file(tmp_path):
    (tmp_path / "one.yaml").write_text(BUILDING)
    message = of_file(tmp_path)
    assert "is a folder" in message
    assert str(tmp_path / "one.yaml") in message


def test_a_file_as_folder_is_refused(tmp_path):
    (tmp_path / "one.yaml").write_text(BUILDING)
    assert "cannot be read" in of_file(tmp_path / "one.yaml" / "two.yaml")
    assert "do not show; rename the file" in of_file("with\0zero.yaml")


def test_other_encodings_are_refused_with_the_place(tmp_path):
    path = tmp_path / "latin.yaml"
    path.write_bytes("rps: 1\ntitle: Geb\xe4ude\n".encode("latin-1"))
    message = of_file(path)
    assert message.startswith(f"{path}:2:11: the byte 0xe4 is not UTF-8")
    assert "save" in message
    path.write_bytes("rps: 1\n".encode("utf-16"))
    assert "is not UTF-8" in of_file(path)


def test_standard_input(monkeypatch):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(BUILDING.encode())))
    case = load_case("-", ["title=From a pipe"])
    assert (case.name, case.title, case.folder) == ("stdin", "From a pipe", Path())
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"rps: 2\n")))
    assert of_file("-").startswith("<stdin>:1:1: superstructure is missing")
    monkeypatch.setattr("sys.stdin", None)
    assert of_file("-").startswith("<stdin>: the standard input is closed; name a file")


def test_a_name_too_long_is_refused():
    assert "cannot be read: File name too long; check" in of_file("x" * 5000)
    assert len(of_file("x" * 5000)) < 400
    for read in (load_record, lambda source: expand_sources([source])):
        with pytest.raises(RecordError, match="cannot be read: File name too long"):
            read("x" * 5000)
        with pytest.raises(RecordError, match="there is no such user"):
            read("~nobodysuch/rec.at2")
        with pytest.raises(RecordError, match="no path holds a zero byte"):
            read("a\0b.at2")


def test_any_refusal_of_the_system_is_an_error_in_plain_words(monkeypatch, tmp_path):
    """Permissions do not stop root, under whom tests may run."""

    def denied(*_, **__):
        raise PermissionError(13, "Permission denied", "a")

    monkeypatch.setattr(Path, "stat", denied)
    assert "cannot be read: Permission denied" in of_file(tmp_path / "c.yaml")
    for read in (load_record, lambda source: expand_sources([source])):
        with pytest.raises(RecordError, match="cannot be read: Permission denied"):
            read(str(tmp_path / "rec.at2"))


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/null", "/dev/urandom"])
def test_devices_are_refused(device):
    assert "is a device; name a file" in of_file(device)


def test_a_pipe_is_read_if_somebody_writes(tmp_path, monkeypatch):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    monkeypatch.setattr(files, "_PATIENCE", 0.05)
    assert "nothing writes to this pipe" in of_file(pipe)
    monkeypatch.setattr(files, "_PATIENCE", 10.0)
    writer = threading.Thread(target=lambda: pipe.write_text(BUILDING))
    writer.start()
    assert load_case(pipe).name == "pipe"
    writer.join()


def test_sizes_are_refused_before_they_are_read(tmp_path):
    path = tmp_path / "large.yaml"
    path.write_bytes(b"rps: 1\ntitle: " + b"x" * files.LARGEST)
    assert "more than 2 MB is not a case or a study" in of_file(path)


def test_of_many_faults_the_first_hundred_are_told():
    lines = refusal(
        "title: t\n" + "".join(f"key_{n}: 1\n" for n in range(3000))
    ).splitlines()
    assert len(lines) == 101
    assert lines[-1].startswith("c.yaml: 29")
    assert lines[-1].endswith("more faults; correct these first")


def test_long_keys_are_cut():
    assert max(map(len, refusal("title: t\n" + "k" * 5000 + ": 1\n").splitlines())) < 300


def test_nothing_is_told_of_a_file_that_is_no_case():
    message = refusal("key_of_somebody: 1\nsecret:\n")
    assert "rps is missing" in message
    assert not {"key_of_somebody", "secret"} & {*message.replace(":", " ").split()}


def test_a_decimal_comma_in_braces_is_named():
    text = "rps: 1\nsuperstructure: {storeys: 3, period: 0,3, storey_height: 3}\n"
    lines = refusal(text).splitlines()
    named = [line for line in lines if "period" in line]
    assert named == [
        "c.yaml:2:38: superstructure.period = 0,3 has a decimal comma; write 0.3"
    ]
    assert not any("the key 3" in line for line in lines)
    assert "the key 3 must be text" in refusal("a: {b: 0, 3}\n")


TABLES = {
    "period [s],acceleration [g]": lambda file: load_target(str(file)),
    "PGV [cm/s],rate [1/year]": lambda file: read_hazard(file, "PGV"),
    "time [s],rotation [rad]": lambda file: measured(str(file), "rocking", None, None),
    "problem,quantity,value": lambda file: answers_of_file(file.read_text(), str(file)),
    "record,overturned": lambda at: read_observed(
        str(at), at.parent, (), Document("s.yaml", {})
    ),
}


@pytest.mark.parametrize("head", TABLES)
def test_a_lost_quote_in_a_table_is_told(tmp_path, head):
    file = tmp_path / "x.csv"
    file.write_text(f'{head}\r1,1\r"{"1" * 140_000}', encoding="utf-8", newline="")
    with pytest.raises(RpsError, match=r"x\.csv:[23]: is not CSV: field larger"):
        TABLES[head](file)
