"""Names and texts of others: none leaves its folder, and none reaches the terminal as a command."""

import csv
import json

import pytest

from rpscli.records.formats.at2 import at2_text
from rpscli.records.loading import load_record
from rpscli.report.page import page

from .conftest import write_case

PULSE = at2_text(load_record("pulse:half_sine?amplitude=0.3g&period=0.6&dt=0.05"))
HISTORY = ("timehistory", "small.yaml", "--figures", "none")


def _files(folder):
    return {path.parent.name for path in folder.rglob("events.csv")}


def test_names_of_dots_and_capitals_have_folders_of_their_own(workplace, rps):
    records = ["...at2", "A.at2", "a.at2"]
    for folder, name in zip("xyz", records, strict=True):
        (workplace / folder).mkdir()
        (workplace / folder / name).write_text(PULSE)
    given = [
        word
        for f, n in zip("xyz", records, strict=True)
        for word in ("--record", f"{f}/{n}")
    ]
    rps(*HISTORY, *given, "-o", "deep/many")
    assert _files(workplace / "deep") == {"...at2", "A", "a_2"}
    assert {path.name for path in (workplace / "deep").iterdir()} == {"many"}


@pytest.mark.parametrize("name", ["a\x1b[31mb.at2", "a\nb.at2", "a\u202eb.at2"])
def test_names_that_a_terminal_obeys_are_refused(workplace, rps, name):
    (workplace / name).write_text(PULSE)
    for words in (
        ("record", "info", name),
        ("check", name),
        (*HISTORY, "--record", "*.at2"),
    ):
        result = rps(*words, exit_code=3, says="rename the file")
        assert name not in result.stderr


def test_texts_of_files_cannot_change_the_terminal(workplace, rps):
    lines = PULSE.split("\n")
    (workplace / "r.at2").write_text(
        "\n".join([lines[0], "\x1b[2Jclear \u202e", *lines[2:]])
    )
    write_case("t.yaml", ("Three", "\\e[31mThree\\a"))
    write_case("k.yaml", ("  storeys", '  "\\e[31m": 1\n  storeys'))
    for line, code in (
        ("record info r.at2", 0),
        ("check t.yaml", 0),
        ("check k.yaml", 3),
    ):
        result = rps(*line.split(), exit_code=code)
        assert "\ufffd[" in result.stdout + result.stderr
        assert not {"\x1b", "\x07", "\u202e"} & {*result.stdout, *result.stderr}


@pytest.mark.posix
def test_names_that_are_not_utf_8_are_written_as_their_bytes(workplace, rps):
    name = "H\udce4"  # as Latin-1 writes an umlaut
    (workplace / f"{name}.at2").write_text(PULSE)
    records = (
        "--record",
        f"{name}.at2",
        "--record",
        "pulse:sine?amplitude=0.1g&period=0.5",
    )
    rps(*HISTORY, *records, "-o", "o")
    first = next(csv.DictReader((workplace / "o/records.csv").read_text().splitlines()))
    assert first["record [-]"] == r"H\udce4"
    sources = json.loads((workplace / f"o/{name}/run.json").read_text())["record"]
    assert (workplace / "o" / name / sources).resolve() == workplace / f"{name}.at2"
    assert rb"H\udce4" in page("title", "", [], name)


def test_lists_and_folders_hold_names_with_marks(workplace, rps):
    (workplace / "h").mkdir()
    for name in ("a#b.at2", "a.at2", "n?b=c.at2", "x #y.at2"):
        (workplace / "h" / name).write_text(PULSE)
    (workplace / "l.txt").write_text(
        "# a remark\nh/a#b.at2?factor=2\nh/n?b=c.at2?factor=2 # other\nh/x #y.at2\n"
    )
    rps(*HISTORY, "--record", "h", "-o", "o")
    assert _files(workplace / "o") == {"a#b", "a", "n?b=c", "x #y"}
    rps(*HISTORY, "--record", "list:l.txt", "-o", "p")
    assert _files(workplace / "p") == {"a#b_x2", "n?b=c_x2", "x #y"}


@pytest.mark.parametrize(
    "files", ["5", "null", '["..", "../small.yaml"]', '"ab"', "[[1]]", "{}"]
)
def test_damaged_run_files_harm_nothing(workplace, rps, files):
    rps(*HISTORY, "-o", "o")
    run = json.loads((workplace / "o/run.json").read_text())
    (workplace / "o/run.json").write_text(json.dumps({**run, "files": json.loads(files)}))
    rps(*HISTORY, "-o", "o", exit_code=7)
    rps(*HISTORY, "-o", "o", "--force")
    assert (workplace / "small.yaml").exists()
