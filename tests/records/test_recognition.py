"""What is not recognised is refused: titles, units, factors, steps, directions, events."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rpscli
from rpscli.errors import RecordError
from rpscli.records.directions import direction_of
from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import GroundMotion, Recording
from rpscli.records.loading import expanded, load_components, load_record
from rpscli.records.recordings import clusters, earthquake
from rpscli.records.when import seconds_of
from rpscli.report.motions import two_column_text

TIMES = 0.005 * np.arange(200)
VALUES = 0.2 * np.sin(2.0 * np.pi * TIMES) * np.sin(np.pi * TIMES) ** 2 / 0.6


def table(heads, *columns):
    rows = zip(*columns, strict=True)
    return "\n".join([heads, *(",".join(f"{x:.6f}" for x in row) for row in rows)]) + "\n"


def series(*heads):
    return "\n".join([*heads, *(f"{x:.6f}" for x in VALUES)]) + "\n"


def read(tmp_path, text, options="", name="rec.txt"):
    (tmp_path / name).write_text(text, encoding="utf-8")
    return load_record(f"{tmp_path / name}{options}")


@pytest.mark.parametrize(
    ("heads", "factor"),
    [
        ("t_s,acc_gal", 0.01), ("Time (sec),Acc. (cm/s/s)", 0.01), ("time,accel in g", 9.80665),
        ("t [s],HNE [m/s^2]", 1.0), ("Tiempo (s),Aceleracion N (gal)", 0.01),
        ("elapsed time,acceleration_m_s2", 1.0), ("seconds,ag (g)", 9.80665),
    ],
)  # fmt: skip
def test_titles_that_are_understood(heads, factor, tmp_path):
    motion = read(tmp_path, table(heads, TIMES, VALUES))
    assert motion.dt == pytest.approx(0.005)
    assert motion.pga == pytest.approx(factor * np.abs(VALUES).max(), rel=1e-5)


@pytest.mark.parametrize(
    ("heads", "says"),
    [
        ("T [s],Se [m/s2]", "spectrum"), ("Tn (s),A (g)", "spectrum"),
        ("Period,PSA (g)", "spectrum"),
        ("distance (km),pga (g)", "a distance"), ("x (m),a (g)", "displacement"),
        ("drift,a (g)", "a drift"), ("frequency [Hz],a [g]", "spectrum"),
        ("timestamp,acc [g]", "'timestamp' is not understood"),
        ("time (s),v (m/s)", "velocity"), ("time (s),Arias [m/s]", "Arias"),
        ("time (s),load [kN]", "force"), ("time,value", "not understood"),
        ("sample,strain", "not understood"), ("T,a (g)", "'T' is not understood"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("options", ["", "?units=g"])
def test_titles_of_something_else_are_refused(heads, says, options, tmp_path):
    with pytest.raises(RecordError, match=says):
        read(tmp_path, table(heads, TIMES + 0.02, VALUES), options)
    # One option says what the columns are.
    motion = read(tmp_path, table(heads, TIMES, VALUES), "?columns=time,acc [g]")
    assert motion.pga == pytest.approx(9.80665 * np.abs(VALUES).max(), rel=1e-5)


@pytest.mark.parametrize(
    "heads", ["t_s,acc_gal", "time [s],acc [m/s2]", "time,acc (cm/s2)"]
)
def test_a_unit_of_the_user_does_not_overrule_the_file(heads, tmp_path):
    with pytest.raises(RecordError, match="units = g contradicts the file"):
        read(tmp_path, table(heads, TIMES, VALUES), "?units=g")


@pytest.mark.parametrize(
    "units",
    [
        "units: g x 1e-3", "units: g*10", "units: g (x 1000)", "units: g\nscale factor: 0.001",
        "units = gal × 10", "unit: g / 10", "units: g\nmultiplier = 1e-3", "units: g times 10",
    ],
)  # fmt: skip
def test_a_factor_beside_a_unit_is_asked_for(units, tmp_path):
    text = series("dt: 0.005", *units.split("\n"))
    with pytest.raises(
        RecordError, match=r"a factor on the values perhaps.*\?units=0\.001 g"
    ):
        read(tmp_path, text)
    unit = "gal" if "gal" in units else "g"
    motion = read(tmp_path, text, f"?units=0.5 {unit}")
    each = {"g": 9.80665, "gal": 0.01}[unit]
    assert motion.pga == pytest.approx(0.5 * each * np.abs(VALUES).max(), rel=1e-5)


@pytest.mark.parametrize(
    "step",
    [
        "dt: 5 (ms)", "dt: 5 x 10^-3 s", "DT= 5.0 MILLISEC", "dt: 1/200", "dt [ms]: 5",
        "sampling rate: 200 Hz", "SampleRate(Hz): 200", "fs = 200", "DELTA T = 5.0E-03",
        "time step = 5 msec", "sampling interval: 5·10^-3", "dt: 1/200 s",
    ],
)  # fmt: skip
def test_steps_in_other_forms(step, tmp_path):
    assert read(tmp_path, series(step, "units: g")).dt == pytest.approx(0.005, rel=1e-12)


@pytest.mark.parametrize("step", ["dt: 5 samples", "dt: 5", "dt: 0.1 min", "dt: 5 ns x"])
def test_steps_that_are_not_understood(step, tmp_path):
    with pytest.raises(RecordError, match=r"time|step"):
        read(tmp_path, series(step, "units: g"))


@pytest.mark.parametrize(
    ("up", "level"),
    [
        ("ACAP-VERTICAL", ("ACAP-N00E", "ACAP-N90E")), ("st_U", ("st_E", "st_N")),
        ("a.DN", ("a.NS", "a.EW")), ("GM1z", ("GM1x", "GM1y")), ("q-UD", ("q-NS", "q-EW")),
        ("site_vert", ("site_long", "site_tran")), ("b 3.HHZ", ("b 3.HHE", "b 3.HHN")),
    ],
)  # fmt: skip
def test_verticals_by_their_names_are_left_out(up, level, tmp_path):
    for name in (up, *level):
        (tmp_path / f"{name}.txt").write_text(series("dt: 0.005", "units: g"))
    found, notes = expanded([f"{tmp_path}"])
    assert sorted(found) == sorted(f"{tmp_path / name}.txt" for name in level)
    assert f"{up}.txt" in " ".join(notes)


def test_a_vertical_by_its_header_is_left_out(tmp_path):
    for name, way in (("one", "N10E"), ("two", "S80E"), ("three", "up")):
        (tmp_path / f"{name}.txt").write_text(
            series(f"component: {way}", "dt: 0.005", "units: g")
        )
    found, notes = expanded([f"{tmp_path}"])
    assert len(found) == 2
    assert "three.txt" in notes[0]


def test_a_third_component_is_asked_for(tmp_path):
    for name in ("s-N00E", "s-N90E", "s-ABC"):
        (tmp_path / f"{name}.txt").write_text(series("dt: 0.005", "units: g"))
    with pytest.raises(
        RecordError, match=r"third component beside s-N00E\.txt and s-N90E"
    ):
        expanded([f"{tmp_path}"])


def test_columns_of_a_table_stand_for_themselves_and_know_up(tmp_path):
    heads = "sampling interval: 0.005 s\nunits: cm/s2\nN-S,E-W,U-D"
    (tmp_path / "t.txt").write_text(table(heads, VALUES, 2 * VALUES, 3 * VALUES))
    found, notes = expanded([f"{tmp_path}"])
    assert [text.partition("?")[2] for text in found] == ["channel=1", "channel=2"]
    assert "vertical" in notes[0]
    with pytest.raises(RecordError, match="U-D is a vertical component"):
        load_components(f"{tmp_path / 't.txt'}?channel=N-S,U-D&both")
    own = load_components(f"{tmp_path / 't.txt'}?channel=N-S", vertical="own")
    assert own.vertical.pga == pytest.approx(3.0 * own.horizontal.pga, rel=1e-4)


@pytest.mark.parametrize(
    ("second", "says"), [("180", "0 degrees apart"), ("10", "10 degrees")]
)
def test_a_pair_along_one_line_is_refused(second, says, tmp_path):
    for name, way in (("a", "0"), ("b", second)):
        text = series(f"component: {way} deg", "dt: 0.005", "units: g")
        (tmp_path / f"{name}.txt").write_text(text.replace("0.0001", f"0.000{way[:1]}1"))
    with pytest.raises(RecordError, match=says):
        load_components(f"{tmp_path / 'a.txt'}?second=b.txt&both")


SAME = [
    "05/02/03, 23:42:38.5 UTC", "2003/05/02 23:42:38", "2003/05/03 08:42:38 JST",
    "20030502_234238", "2003 May 2 23:42:38 UT", "2003-05-02T23:42:39Z", "2 May 2003, 23:42:38",
]  # fmt: skip


@pytest.mark.parametrize("text", SAME)
def test_origins_are_seconds(text):
    assert seconds_of(text) == pytest.approx(1051918958.0, abs=1.5)


def test_one_earthquake_in_any_spelling(tmp_path):
    for k, text in enumerate(SAME):
        lines = (f"station: s{k}", f"origin time: {text}", "dt: 0.005", "units: g")
        (tmp_path / f"r{k}.txt").write_text(series(*lines))
    other = ("station: z", "origin time: 2003/05/03 01:42:38", "dt: 0.005", "units: g")
    (tmp_path / "z.txt").write_text(series(*other))
    sources = sorted(map(str, tmp_path.glob("*.txt")))
    assert clusters(sources, by="events") == (0,) * len(SAME) + (1,)
    assert len({*clusters(sources)}) == len(sources)


@pytest.mark.parametrize("ending", [".at2", ".txt"])
def test_what_is_written_keeps_the_recording(ending, tmp_path):
    recording = Recording(
        "Nowhere, 2003", "A 7", origin="2003/05/02 23:42:38", direction="UP"
    )
    motion = GroundMotion(VALUES, 0.005, "x", "x", "K-NET ASCII", "words", (), recording)
    text = (at2_text if ending == ".at2" else two_column_text)(motion)
    back = read(tmp_path, text, name=f"x{ending}").recording
    assert back.is_vertical
    assert (back.station, back.direction) == ("A 7", "UP")
    assert "Nowhere" in back.event
    assert seconds_of(back.origin) == seconds_of(recording.origin)


def test_a_peak_that_an_at2_header_states_is_compared(tmp_path):
    rows = "\n".join(f"{x:15.7E}" for x in VALUES)
    head = "PEER\nNowhere, 1/2/2001, A, 0\nACCELERATION IN UNITS OF G\n"
    head += "NPTS= 200, DT= .005 SEC, PGA= .9 G\n"
    motion = read(tmp_path, head + rows + "\n", name="x.at2")
    assert any("the header says 0.9" in text for text in motion.warnings)


@given(st.integers(0, 360))
def test_bearings_and_azimuths_agree(azimuth):
    way = direction_of(f"{azimuth:03d}")
    assert way is not None
    assert not way.vertical
    quadrant = azimuth % 360
    from_north = quadrant <= 90 or quadrant > 270
    degrees = min(quadrant, 360 - quadrant) if from_north else abs(quadrant - 180)
    side = "E" if 0 < quadrant <= 180 else "W"
    same = direction_of(f"{'N' if from_north else 'S'}{degrees}{side}")
    assert same.azimuth == pytest.approx(azimuth % 360)


def test_the_public_reader_is_the_same(tmp_path):
    (tmp_path / "x.csv").write_text(table("T [s],Se [m/s2]", TIMES + 0.02, VALUES))
    with pytest.raises(rpscli.RpsError, match="spectrum"):
        rpscli.load_record(f"{tmp_path / 'x.csv'}")


def test_all_values_in_one_line_and_two_records_in_one_file(tmp_path):
    line = " ".join(f"{x:.6f}" for x in VALUES)
    motion = read(tmp_path, f"dt: 0.005\nunits: g\n{line}\n")
    assert motion.npts == len(VALUES)
    both = series("dt: 0.005", "units: g") + "\n" + series().lstrip("\n")
    assert any("blank line" in text for text in read(tmp_path, both).warnings)


@pytest.mark.parametrize(
    ("title", "station", "way", "event"),
    [
        ("Kocaeli, Turkey, 8/17/1999, Duzce, UP", "Duzce", "UP", "kocaeli 1999"),
        ("Imperial Valley, 10/15/1979, El Centro Array 6, 230", "El Centro Array 6", "230",
         "imperial valley 1979"),
        ("NORTHRIDGE 01/17/94 1231, PACOIMA DAM, UP (CDMG)", "PACOIMA DAM", "UP",
         "northridge 1994"),
    ],
)  # fmt: skip
def test_titles_of_the_peer_collections(title, station, way, event, tmp_path):
    rows = "\n".join(f"{x:15.7E}" for x in VALUES)
    head = f"PEER\n{title}\nACCELERATION IN UNITS OF G\nNPTS= 200, DT= .005 SEC\n"
    motion = read(tmp_path, head + rows + "\n", name="x.at2")
    assert (motion.recording.station, motion.recording.direction) == (station, way)
    assert earthquake(motion.recording.event) == event
    back = read(tmp_path, at2_text(motion), name="y.at2").recording
    assert (back.station, back.direction) == (station, way)


@pytest.mark.parametrize(
    "line", ["sensor depth: 100 m", "Location: downhole", "GL -20 m"]
)
def test_instruments_below_the_ground_are_left_out(line, tmp_path):
    for name, head in (("s_NS", ()), ("s_EW", ()), ("b_NS", (line,)), ("b_EW", (line,))):
        (tmp_path / f"{name}.txt").write_text(series(*head, "dt: 0.005", "units: g"))
    found, notes = expanded([f"{tmp_path}"])
    assert [path[-8:] for path in found] == ["s_EW.txt", "s_NS.txt"]
    assert "in boreholes, left out" in notes[0]


PEAKS = [
    "PGA = 0.5 g", "max acc: 0.5 g", "maximum acceleration = 490.3 gal", "Amax = 0.5",
    "Peak ground acceleration (g): 0.5", "Peak value 0.5 g at 3.2 s", "PHA 0.5 g",
    "absolute maximum: 0.5 g", "MAX= .5 G", "PEAK VALUE = .5", "abs. max. acc. 4.903 m/s2",
]  # fmt: skip


@pytest.mark.parametrize("peak", PEAKS)
@pytest.mark.parametrize("factor", [1.0, 0.5])
def test_a_stated_peak_is_compared(peak, factor, tmp_path):
    samples = 0.5 * factor * np.sin(TIMES) / np.max(np.abs(np.sin(TIMES)))
    rows = "\n".join(f"{x:.8f}" for x in samples) + "\n"
    plain = read(tmp_path, f"dt: 0.005\nunits: g\n{peak}\n{rows}")
    head = f"PEER\nA, 1/1/2001, B, 0\nUNITS OF G\nNPTS= 200, DT= .005 SEC, {peak}\n"
    at2 = read(tmp_path, head + rows, name="x.at2")
    for motion in (plain, at2):
        assert ("the values peak at" in " ".join(motion.warnings)) == (factor != 1.0)


@pytest.mark.parametrize(
    "line",
    ["PSEUDO ACCELERATION SPECTRUM IN UNITS OF G", "PSA IN UNITS OF G",
     "FOURIER AMPLITUDE, UNITS OF G-S", "RESPONSE SPECTRA, UNITS: G"],
)  # fmt: skip
def test_spectra_as_at2_are_refused(line, tmp_path):
    rows = "\n".join(f"{x:15.7E}" for x in VALUES)
    head = "PEER\nA, 1/1/2001, B, 0\n{}\nNPTS= 200, DT= .005 SEC\n"
    with pytest.raises(RecordError, match="acceleration record of the same station"):
        read(tmp_path, head.format(line) + rows + "\n", name="x.at2")
    series_of = "SPECTRUM COMPATIBLE ACCELERATION TIME SERIES IN UNITS OF G"
    assert read(tmp_path, head.format(series_of) + rows + "\n", name="x.at2").npts == 200


@pytest.mark.parametrize(
    ("names", "kept", "told"),
    [
        (("rec.at2", "rec.csv"), 1, "the same component again, left out: "),
        (("rec.at2", "other.csv"), 2, "the same samples by other names, all taken: "),
        (("s-NS.at2", "s-EW.at2"), 2, ""),  # refused where they are a pair
        (("s.EW", "s.NS"), 2, ""),
    ],
)
def test_a_conversion_beside_its_file_counts_once(names, kept, told, tmp_path):
    motion = GroundMotion(VALUES, 0.005, name="rec")
    for name in names:
        ours = two_column_text(motion) if name.endswith("csv") else at2_text(motion)
        (tmp_path / name).write_text(ours)
    (tmp_path / "weaker.csv").write_text(two_column_text(motion.scaled(0.999)))
    found, notes = expanded([f"{tmp_path}"])
    assert len(found) == kept + 1
    assert len(notes) == bool(told) + 1
    assert told in " ".join(notes)
    assert "times a factor" in notes[-1]
    assert "weaker.csv (of" in notes[-1]


def test_keys_of_an_own_conversion_count_before_its_description(tmp_path):
    told = Recording("Northridge-01, 1/17/1994", station="Sylmar", direction="90")
    text = "PEER NGA; Northridge-01, 1/17/1994, Sylmar, 90"
    motion = GroundMotion(VALUES, 0.005, name="rec", recording=told, description=text)
    (tmp_path / "conv.txt").write_text(two_column_text(motion))
    (tmp_path / "rec.at2").write_text(at2_text(motion))
    assert load_record(f"{tmp_path / 'conv.txt'}").recording[:2] == told[:2]
    assert load_record(f"{tmp_path / 'conv.txt'}").recording.direction == "90"
    assert len(expanded([f"{tmp_path}"])[0]) == 1


def test_one_station_in_two_earthquakes_is_no_repetition(tmp_path):
    for name, event in (("a", "Kobe 1995"), ("b", "Tottori 2000")):
        told = Recording(event=f"{event}, 1/1/{event[-4:]}", station="S", direction="N")
        motion = GroundMotion(VALUES, 0.005, name="rec", recording=told)
        (tmp_path / f"{name}.at2").write_text(at2_text(motion))
    found, notes = expanded([f"{tmp_path}"])
    assert len(found) == 2
    assert "all taken" in notes[0]


def test_of_a_file_and_its_conversion_stays_what_states_more(tmp_path):
    told = Recording(event="Kobe 1995", station="JMA", direction="N")
    motion = GroundMotion(VALUES, 0.005, name="rec", recording=told)
    (tmp_path / "rec.at2").write_text(at2_text(motion))
    (tmp_path / "a.csv").write_text(series("dt: 0.005", "units: m/s2"))
    (tmp_path / "rec.csv").write_text(series("dt: 0.005", "units: m/s2"))
    found, notes = expanded([f"{tmp_path}"])
    assert [path.rsplit("/")[-1] for path in found] == ["a.csv", "rec.at2"]
    assert "rec.csv (as rec.at2)" in notes[0]


def test_the_depth_of_an_earthquake_is_not_that_of_an_instrument(tmp_path):
    text = series(
        "Hypocentral depth: 9 km", "event depth = 12000 m", "dt: 0.005", "units: g"
    )
    assert not read(tmp_path, text).recording.in_borehole


@pytest.mark.parametrize("separator", [";", "\t"])
def test_decimal_commas_where_commas_do_not_separate(separator, tmp_path):
    text = table("Zeit [s],Beschleunigung [m/s²]", TIMES, VALUES)
    text = text.replace(",", separator).replace(".", ",")
    motion = read(tmp_path, text)
    assert motion.pga == pytest.approx(np.abs(VALUES).max(), rel=1e-5)


def test_two_components_by_words_of_their_names_are_one_recording(tmp_path):
    for name in ("stA_NS", "stA_EW", "stB-N", "stB-E", "c_nord", "d_est"):
        (tmp_path / f"{name}.txt").write_text(series("dt: 0.005", "units: g"))
    sources = [
        f"{tmp_path / name}.txt" for name in ("stA_NS", "stA_EW", "stB-N", "stB-E")
    ]
    assert clusters(sources) == (0, 0, 1, 1)


def test_transverse_beside_longitudinal_is_no_period(tmp_path):
    heads = "dt: 0.005\nunits: g\nL,T,V"
    (tmp_path / "x.txt").write_text(table(heads, VALUES, 2 * VALUES, 3 * VALUES))
    found, notes = expanded([f"{tmp_path / 'x.txt'}"])
    assert [text[-1] for text in found] == ["1", "2"]
    assert "channel 3" in notes[0]
