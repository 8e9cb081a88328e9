"""Files appear whole or not at all, and only where they may; CSV and JSON are what was computed."""

import csv
import errno
import io
import json
import math
import os
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpscli.analyses.result_quantities import plain
from rpscli.case.case import load_case
from rpscli.errors import OutputError, Refused, RpsError
from rpscli.report import table
from rpscli.report.figures import floors, style
from rpscli.report.files import CommandRun, Drawing, OutputFolder, json_text, write_whole
from rpscli.report.study.fragility_options import LimitState
from rpscli.report.study.report import add_notes, with_band
from rpscli.report.table import Column, Table, csv_text, records
from rpscli.sweep.names import label


def folder_of(place, digest="a", *, force=False, **inputs):
    return OutputFolder(
        place, CommandRun("modal", "x", place / "../x.yaml", digest, inputs), force=force
    )


def test_run_json_says_what_was_run(tmp_path):
    folder = folder_of(tmp_path / "out", scale=2.0)
    folder.add("a.csv", "1\n")
    folder.write()
    run = json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))
    assert run["inputs"] == {"scale": 2.0}
    assert run["file"] == "../x.yaml"  # a project may move as a whole
    assert run["files"] == ["a.csv"]
    assert set(run["versions"]) == {"rps", "python", "numpy", "llvmlite"}


def test_files_of_an_earlier_run_that_are_no_longer_made_go_away(tmp_path):
    first = folder_of(tmp_path)
    for name in ("a.csv", "b.csv"):
        first.add(name, name)
    first.write()
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    second = folder_of(tmp_path)
    second.add("a.csv", "new")
    second.write()
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "a.csv",
        "notes.txt",
        "run.json",
    ]
    assert second.removed == ["b.csv"]


def test_results_are_written_before_anything_is_drawn(tmp_path):
    """A figure that fails is told, the others are drawn, and the next run draws it."""
    seen = []

    def draws():
        seen.extend(sorted(file.name for file in tmp_path.iterdir()))
        return b"PNG"

    def fails():
        raise RuntimeError("no figure")

    def written(first, then=draws):
        folder = folder_of(tmp_path)
        for name, draw in {"first.png": first, "second.png": then}.items():
            folder.add(name, Drawing(name, draw))
        folder.add("a.csv", "1")
        folder.write()
        return folder

    assert written(draws).undrawn == []
    assert seen[:2] == ["a.csv", "run.json"]
    reason = (
        "first.png is not drawn: RuntimeError: no figure; the results are not concerned"
    )
    assert written(fails).undrawn == [reason]
    both = reason.replace("first.png is", "first.png and second.png are")
    assert written(fails, fails).undrawn == [both]
    assert not (tmp_path / "first.png").exists()  # nor that of the run before
    assert written(draws).undrawn == []
    assert (
        (tmp_path / "first.png").read_bytes()
        == (tmp_path / "second.png").read_bytes()
        == b"PNG"
    )


def test_nothing_outside_the_folder_is_taken_away(tmp_path):
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
def test_a_strange_run_json_is_refused(tmp_path, text):
    (tmp_path / "run.json").write_text(text, encoding="utf-8")
    with pytest.raises(Refused, match=r"run\.json is not a description"):
        folder_of(tmp_path)
    folder_of(tmp_path, force=True).write()
    assert not folder_of(tmp_path).replaces_other_inputs


def test_other_inputs_are_noticed(tmp_path):
    assert not folder_of(tmp_path).replaces_other_inputs
    folder_of(tmp_path, "a", scale=1.0).write()
    assert not folder_of(tmp_path, "a", scale=1.0).replaces_other_inputs
    assert folder_of(tmp_path, "b", scale=1.0).replaces_other_inputs
    assert folder_of(tmp_path, "a", scale=2.0).replaces_other_inputs


def test_a_full_disk_or_an_interruption_leaves_everything_as_it_was(
    tmp_path, monkeypatch
):
    write_whole({tmp_path / "a": b"old"})
    write = Path.write_bytes

    def stopped(path, data):
        if data == b"interrupted":
            raise KeyboardInterrupt
        if data == b"too much":
            write(path, data[:3])
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, data)

    monkeypatch.setattr(Path, "write_bytes", stopped)
    with pytest.raises(
        OutputError, match=r"b: cannot be written: No space left on device"
    ):
        write_whole({tmp_path / "a": b"new", tmp_path / "b": b"too much"})
    with pytest.raises(KeyboardInterrupt):
        write_whole({tmp_path / "a": b"interrupted"})
    assert [file.name for file in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_bytes() == b"old"


def test_a_folder_in_the_way(tmp_path):
    (tmp_path / "a").mkdir()
    with pytest.raises(OutputError, match="there is a folder of this name"):
        write_whole({tmp_path / "a": b"new"})


def test_a_folder_without_permission(tmp_path, monkeypatch):
    monkeypatch.setattr("rpscli.report.files.os.access", lambda *_: False)
    with pytest.raises(OutputError, match="no permission"):
        folder_of(tmp_path / "out")


@pytest.mark.posix
def test_what_the_system_forbids_is_told():
    """As somebody else than root, whom nothing is forbidden: in a process of its own."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        (place / "case.yaml").write_text("rps: 1\n", encoding="utf-8")
        (place / "case.yaml").chmod(0)
        place.chmod(0o555)
        child = os.fork()
        if not child:
            told = 0
            try:
                if not os.getuid():
                    os.setuid(65534)
                for ask, said in (
                    (lambda: folder_of(place / "out"), "no permission"),
                    (lambda: load_case(place / "case.yaml"), "Permission denied"),
                ):
                    try:
                        ask()
                    except RpsError as error:
                        told += said in str(error)
            finally:
                os._exit(told)
        _, status = os.waitpid(child, 0)
        place.chmod(0o700)
    assert os.waitstatus_to_exitcode(status) == 2


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=10,
)  # fmt: skip


@given(st.dictionaries(st.text(), values, max_size=4))
def test_json_is_read_back_as_it_was(document):
    assert json.loads(json_text(document)) == document


def test_json_knows_no_nan_and_no_numpy():
    document = {
        "a": np.array([1.0, math.nan, -math.inf]),
        "b": np.float64(2.5),
        "c": np.array([1 + 2j]),
        "d": (np.int64(3), True),
        "e": -0.0,
    }
    expected = {
        "a": [1.0, None, None],
        "b": 2.5,
        "c": [[1.0, 2.0]],
        "d": [3, True],
        "e": 0.0,
    }
    assert plain(document) == expected
    assert "-0.0" not in json_text(document)


def test_lists_of_numbers_stay_on_one_line():
    assert json_text({"a": [1, 2, 3]}) == '{\n  "a": [1, 2, 3]\n}\n'


@given(st.lists(st.floats(-1e300, 1e300), min_size=1))
def test_a_csv_holds_ten_digits(numbers):
    lines = csv_text([Column("x", "m", np.array(numbers))]).splitlines()
    assert lines[0] == "x [m]"
    assert [float(line) for line in lines[1:]] == pytest.approx(
        numbers, rel=1e-9, abs=0.0
    )


def test_what_does_not_exist_is_an_empty_cell():
    columns = [
        Column("x", "m", [1.0, math.nan, None]),
        Column("kind", "-", ["a", "b", "c"]),
    ]
    assert csv_text(columns) == "x [m],kind [-]\n1,a\n,b\n,c\n"


def test_columns_of_different_lengths_are_a_mistake():
    with pytest.raises(ValueError, match="zip"):
        csv_text([Column("x", "m", [1.0]), Column("y", "m", [1.0, 2.0])])


texts = st.text(st.characters(codec="utf-8", exclude_characters="\0"))


@given(st.lists(texts, min_size=1), texts)
def test_a_cell_may_hold_anything(cells, head):
    text = csv_text([Column(head, "-", cells), Column("x", "m", range(len(cells)))])
    rows = [[f"{head} [-]", "x [m]"], *([cell, str(i)] for i, cell in enumerate(cells))]
    assert list(csv.reader(io.StringIO(text, newline=""))) == rows


def test_lists_and_mappings_are_written_as_json():
    lists = Column("a", "-", [[1, 2], {"b": None}])
    assert csv_text([lists]) == 'a [-]\n"[1, 2]"\n"{""b"": null}"\n'


def test_a_table_has_one_row_for_readers_files_and_documents():
    shear = Column("max_base_shear", "N", [1.5e6, None], "base shear kN")
    columns = [Column("record", "-", ["El Centro, 1940.at2", "b"], "record", str), shear]
    assert Table(columns).heads == ["record", "base shear kN"]
    assert Table(columns).rows == [("El Centro, 1940.at2", "1500"), ("b", "-")]
    assert csv_text(columns).splitlines()[1:] == ['"El Centro, 1940.at2",1500000', "b,"]
    assert records(columns)[1] == {"record": "b", "max_base_shear": None}


EXAMPLES = {
    "figures": [
        (floors.shown_floors(6), [1, 4, 6]),
        (
            style.folded(r"$|\theta_{max}|$ [-], flat", 0.6, 8.0),
            "$|\\theta_{max}|$ [-],\nflat",
        ),
        (style.folded("a_name_of_many_letters", 0.6, 8.0), "a_name_of\n_many_let\nters"),
        (
            [style.engineering(size)[1] for size in (999.0, 1e3, 5e5, 1e6)],
            ["", "k", "k", "M"],
        ),
        (LimitState("min_column_force", 1e5).label, "min_column_force < 100000"),
        (label("superstructure.period", "300 ms"), "T₁ = 300 ms"),
    ],
    "numbers": [
        (
            [table.shown(value) for value in (0.10501282, 17321.4, 3)],
            ["0.1050", "17321", "3"],
        ),
        ([table.shown(value) for value in (None, 2.4e-9)], ["-", "2.400e-09"]),
        (
            [table.large(*of) for of in ((0.1, "rad"), (0.2, "-"))],
            [(0.1, "rad"), (0.2, "")],
        ),
        ([table.measured(*of) for of in ((1.5e6, "N"), (None, "s"))], ["1500 kN", "-"]),
        ([table.percent(1.0, of) for of in (3.0, 0.0)], ["33.3 %", "-"]),
        (with_band(*[math.nan] * 3), "-"),
    ],
}


@pytest.mark.parametrize("of", EXAMPLES)
def test_examples(of):
    for found, wanted in EXAMPLES[of]:
        assert found == wanted


def test_notes_of_several_reports_are_said_once():
    notes = ["fragility: the data are separated"]
    add_notes(notes, "risk", ["the data are separated", "the hazard curve is continued"])
    assert notes == [
        "fragility: the data are separated",
        "risk: the hazard curve is continued",
    ]
