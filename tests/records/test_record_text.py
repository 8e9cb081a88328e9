from __future__ import annotations

from pathlib import Path

import pytest

from rpscli.errors import RecordError
from rpscli.records.formats.record_text import read_text
from rpscli.records.loading import load_record
from rpscli.records.quantities import canonical_unit, numbers_in


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b" \r\n\n", "is empty"),
        (b"<!DOCTYPE html>\n<html><body>Log in</body></html>", "a web page.*log-in"),
        (b"\xef\xbb\xbf\n <html>", "a web page"),
        (b"PK\x03\x04rest", "a ZIP archive; unpack"),
        (b"PK\x03\x04 [Content_Types].xml xl/workbook.xml", "a spreadsheet.*as CSV"),
        (b"PK\x03\x04 mimetypeapplication/vnd.oasis.opendocument.spreadsheet", "a spreadsheet"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\x00", "an old Excel"),
        (b"\x1f\x8brest", "a gzip archive"),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
        (b"%PDF-1.7", "a PDF"),
        (b"PEER NGA\n\x00\x01\x02", "not a text file"),
    ],
)
def test_files_that_are_not_what_their_name_says(
    tmp_path: Path, content: bytes, message: str
) -> None:
    path = tmp_path / "rec.AT2"
    path.write_bytes(content)
    with pytest.raises(RecordError, match=message) as raised:
        load_record(str(path))
    assert str(path) in str(raised.value)


def test_encodings(tmp_path: Path) -> None:
    text = "# Düzce, units: g, dt: 0.01\n0.1\n0.2\n"
    path = tmp_path / "rec.txt"
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "latin-1"):
        path.write_bytes(text.encode(encoding))
        assert "Düzce" in load_record(str(path)).description


def test_an_end_of_file_mark_of_dos_is_no_line(tmp_path: Path) -> None:
    path = tmp_path / "rec.txt"
    path.write_bytes(b"0.1\r\r\n0.2\r\n\x1a\x1a")
    assert read_text(path, "rec.txt").lines == ("0.1", "0.2")


def test_an_unreadable_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="cannot be read"):
        read_text(tmp_path, "folder")


@pytest.mark.parametrize(
    ("line", "numbers"),
    [
        ("", []),
        (" 1 -2.5 .5 5. ", [1.0, -2.5, 0.5, 5.0]),
        ("3.0501E-1-1.3151E+0", [0.30501, -1.3151]),
        ("1,2,3,", [1.0, 2.0, 3.0]),
        ("1.5D-01", [0.15]),
        ("inf", None),
        ("1_000", None),
        ("1.5 g", None),
        ("1.2.3", None),
        ("1,,2", None),
        ("--1", None),
        ("E5", None),
        ("-", None),
    ],
)
def test_numbers_in_a_line(line: str, numbers: list[float] | None) -> None:
    assert numbers_in(line) == numbers


@pytest.mark.parametrize(
    ("spelling", "unit"),
    [
        ("G", "g"),
        ("(g)", "g"),
        ("cm/s/s", "cm/s2"),
        ("CM/SEC**2", "cm/s2"),
        ("m / s ^ 2", "m/s2"),
        ("m/s²", "m/s2"),
        ("Gals", "gal"),
        ("mm/s/s", "mm/s2"),
        ("cm/s", None),
        ("cm", None),
        ("kg", None),
    ],
)
def test_units(spelling: str, unit: str | None) -> None:
    assert canonical_unit(spelling) == unit


@pytest.mark.parametrize("ending", ["v1", "v1c", "V2", "V2c", "V2A"])
@pytest.mark.parametrize("query", ["", "?channel=1"])
def test_a_file_without_the_series_its_ending_promises(
    tmp_path: Path, ending: str, query: str
) -> None:
    path = tmp_path / f"another.{ending}"
    path.write_text("0.1\n0.2\nabc\n")
    with pytest.raises(RecordError, match=r"no series of accelerations begins.*another ending"):
        load_record(f"{path}{query}")


def test_a_long_word_of_digits_is_looked_at_once() -> None:
    """Were it tried at every division, this would take hours."""
    assert numbers_in("1" * 200_000 + "E") is None
