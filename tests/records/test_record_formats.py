"""Small files in the layouts of the agencies; real ones are read in test_shared_records.py."""

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from small_records import VALUES, cosmos, csmip, esm, fixed, geonet, knet, smc, write

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats import FORMATS, contents
from rpscli.records.formats.at2 import at2_text
from rpscli.records.formats.record_text import read_text
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.records.source import Source

TITLE = "PEER NGA STRONG MOTION DATABASE RECORD"
EVENT = "Northridge-01, 1/17/1994, Somewhere, 9"
UNITS = "ACCELERATION TIME SERIES IN UNITS OF G"
NPTS = "NPTS=      7, DT=   .0050 SEC"
ROWS = "  .1000000E-01 -.2000000E-01  .3000000E+00  .4000000E-01  .5000000E-01\n"
ROWS += "  .6000000E-01 -.7000000E-01\n"
IN_G = [0.01, -0.02, 0.3, 0.04, 0.05, 0.06, -0.07]


SINCE_2000 = csmip().lower().replace("  (units: cm/sec/sec)", ", in cm/sec2. (8f10.4)")


def peer(npts=NPTS, values=ROWS, units=UNITS):
    return f"{TITLE}\n{EVENT}\n{units}\n{npts}\n{values}"


def load(folder, text, name="rec.AT2", options=""):
    (folder / name).write_bytes(text.encode("latin-1"))
    return load_record(name + options, folder=folder)


@pytest.mark.parametrize(
    ("text", "name", "form", "tol"),
    [
        (csmip(), "a.V2", "CSMIP volume 2", 1e-12),
        (SINCE_2000, "a.V2", "CSMIP volume 2", 1e-12),
        (cosmos(), "a.v1", "COSMOS v1", 1e-12),
        (esm(), "a.ASC", "ESM ASCII", 1e-12),
        (smc(), "a.smc", "SMC", 5e-5),  # four decimals of the mantissa
        (geonet(), "a.V2A", "GeoNet volume 2", 0.5e-2),  # 0.1 mm/s2
    ],
)
@pytest.mark.parametrize("named", [True, False])
def test_reads(tmp_path, text, name, form, tol, *, named):
    path = write(tmp_path, text, name if named else "record")
    made = load_record(path)
    assert made.format == form
    assert made.dt == pytest.approx(0.02, rel=1e-12)
    np.testing.assert_allclose(made.acceleration * 100.0, VALUES, atol=tol, rtol=1e-4)
    assert made.warnings == ()
    assert contents(Path(path))


def test_knet_is_centred_and_says_so(tmp_path):
    made = load_record(write(tmp_path, knet(), "CHB002.NS"))
    centred = np.array(VALUES) - np.mean(VALUES)
    # Counts are whole: half of 0.001 gal.
    np.testing.assert_allclose(made.acceleration * 100.0, centred, atol=6e-4)
    assert made.dt == 0.02
    assert made.name == "CHB002_NS"
    assert "mean of 11.9" in made.description
    assert "removed" in made.description
    assert made.warnings == ()


def test_a_channel_is_chosen_by_its_number(tmp_path):
    path = write(tmp_path, csmip((4, 6)), "a.V2")
    with pytest.raises(
        RecordError, match=r"2 channels.*\?channel=4.*4: 90 DEG; 6: 90 DEG"
    ):
        load_record(path)
    with pytest.raises(RecordError, match="no channel 5; the file has 4: 90 DEG; 6"):
        load_record(f"{path}?channel=5")
    made = load_record(f"{path}?channel=6")
    assert (made.npts, made.name) == (12, "a_ch6")
    assert (
        load_record(f"{write(tmp_path, geonet(('N', 'Up')), 'a.V2A')}?channel=2").npts
        == 12
    )
    with pytest.raises(RecordError, match="channel 1 comes 2 times"):
        load_record(f"{write(tmp_path, csmip((1, 1)), 'b.V2')}?channel=1")


def test_only_one_format_recognises_each_layout(tmp_path):
    for made in (csmip(), cosmos(), esm(), smc(), geonet(), knet()):
        text = read_text(Path(write(tmp_path, made, "rec")), Source.parse("rec"))
        matching = [form.name for form in FORMATS.values() if form.recognises(text)]
        assert [name for name in matching if name != "columns"][1:] == []
        assert matching[0] != "columns"


COLUMN = "dt: 0.02\nunits: g\n.1\n.2\n-.3\n.1\n"
AT2 = "a title\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .02 SEC\n.1 .2 -.1 0\n"


FIXED = fixed([8500], 1, "{:8d} ")


MADE = {
    "at2": AT2,
    "column": COLUMN,
    "csmip": csmip(),
    "cosmos": cosmos(),
    "knet": knet(),
    "esm": esm(),
    "smc": smc(),
    "geonet": geonet(),
}


def repeated(text, line, times):
    lines = text.split("\n")
    return "\n".join([*lines[:line], *lines[line : line + 1] * times, *lines[line + 1 :]])


FIRST_ROW = {
    "at2": ".1 .2",
    "csmip": "     1.500",
    "cosmos": "   1.50000",
    "knet": "    8500",
    "esm": "1.500000",
    "smc": " 1.5000E+0",
    "geonet": "    15.0",
}


@pytest.mark.parametrize("name", FIRST_ROW)
@pytest.mark.parametrize("times", [0, 2])
def test_a_row_too_few_or_too_many_is_refused(tmp_path, name, times):
    text = MADE[name]
    starts = [line.startswith(FIRST_ROW[name]) for line in text.split("\n")]
    with pytest.raises(
        RecordError, match=r"(announces|NPTS =|of the) .*\d+ values|a row where"
    ):
        load_record(write(tmp_path, repeated(text, starts.index(True), times), "rec"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (knet().replace("  0.24", "  0.16"), "announces 8 values, and 12 stand"),
        (knet() + "\n" + knet(), "announces 12 values, and 12 stand before 'Origin Time"),
        (
            csmip().replace(" 12 POINTS OF ACC", "  8 POINTS OF ACC"),
            "announces 8 values, and 12 stand before '12 POINTS",
        ),
        (
            cosmos().replace("   12  acc", "    8  acc"),
            "announces 8 values, and 12 stand",
        ),
        (
            cosmos().replace("(8F10.5)", "(6F10.5)"),
            "8 value.s. in a row where the format has 6",
        ),
        (geonet().replace("points  12", "points  10"), "announces 10 values, and"),
        (repeated(geonet(), 1, 0), "in a row where the format has 10"),
        (esm() + "\n0.1\n0.2", "announces 12 values, and 14 stand before the end"),
        (
            esm().replace("1.500000", "1.500000 0.1").replace("NDATA: 12", "NDATA: 13"),
            "a row",
        ),
        (smc().replace("        12", "         8"), "announces 8 values, and 12 stand"),
        (
            knet().replace("    8500     4750", "    8500 4750     1"),
            "9 value.s. in a row where",
        ),
        (
            knet().replace(FIXED, "", 1) + FIXED,
            r"7 value.s. in a row where the format has 8",
        ),
        (
            peer("NPTS=  9, DT= .005 SEC"),
            r"rec.AT2:6: .* 9 values, and 7 stand before the end.*correct the count",
        ),
        (
            peer("NPTS=  6, DT= .005 SEC"),
            "announces 6 values, and 7 stand before the end",
        ),
        (peer("NPTS=  7, DT= .000 SEC"), "DT = .000 must be positive"),
        (peer("NPTS=  7, DT= -.01 SEC"), "must be positive"),
        (peer(values=""), "announces 7 values, and 0 stand before the end"),
        (peer("NPTS=  7"), "no header line gives NPTS and DT"),
        (peer("DT= .005"), "no header line gives NPTS and DT"),
        (peer(values=".1 1_000"), "and 0 stand before '.1 1_000"),
        (peer(values=".1,,2"), "and 0 stand before '.1,,2"),
        (peer(values=".1 --1"), "and 0 stand before '.1 --1"),
        (peer(values="  .1 .2 NaN .4 .5 .6 .7"), "and 0 stand before '.1 .2 NaN"),
        (
            peer(values=ROWS.replace(".6000000E-01", "*" * 12)),
            "rec.AT2:6: .*and 5 stand before",
        ),
        (peer(values=ROWS.replace(".6000000E-01", "1E999")), "5 stand before '1E999"),
        (peer(values=ROWS.replace("-.7", "0.6.7")), "5 stand before '.6000000E-01 0.6.7"),
        (peer(values=ROWS.replace("\n", "\nNEXT RECORD\n", 1)), "5 stand before 'NEXT"),
        (
            peer(values=ROWS + "NEXT RECORD\n .1 .2\n"),
            "more numbers follow after the 7 values",
        ),
        (
            peer(units="ACCELERATION TIME SERIES IN UNITS OF FURLONGS"),
            "not a unit of acceleration",
        ),
        (
            peer(units="VELOCITY TIME SERIES IN UNITS OF CM/S"),
            "this is a velocity record",
        ),
        (
            peer(units="DISPLACEMENT TIME HISTORY IN UNITS OF CM"),
            "this is a displacement record",
        ),
        (
            peer(units="ACCELERATION TIME SERIES IN UNITS OF CM/S"),
            "not a unit of acceleration",
        ),
        (
            peer(npts=f"NPTS= {'9' * 5000}, DT= .01 SEC"),
            "no header line gives NPTS and DT",
        ),
        # Headers that contradict themselves.
        (
            AT2.replace("NPTS= 4,", "NPTS= 4, NPTS= 9,"),
            "rec:3: NPTS = 9 contradicts NPTS = 4",
        ),
        (AT2.replace("SEC", "DT= .01"), "DT = .01 contradicts DT = .02 of line 3"),
        (AT2.replace("OF G\n", "OF G\nUNITS OF CM/S2\n"), "UNITS = CM/S2 contradicts"),
        (
            COLUMN.replace("units: g", "units: g, units: gal"),
            "units = gal contradicts units = g",
        ),
        (
            COLUMN.replace("dt: 0.02", "dt: 0.02, dt: 0.01"),
            "dt = 0.01 contradicts dt = 0.02",
        ),
        (
            COLUMN.replace("units", "npts: 4\nnpts: 5\nunits"),
            "npts = 5 contradicts npts = 4",
        ),
        (
            esm().replace("STREAM", "NDATA: 11\nSTREAM"),
            "= 11 contradicts NDATA = 12 of line 6",
        ),
        (
            esm().replace("STREAM", "DURATION_S: 0.48\nSTREAM"),
            "12 values 0.02 s apart last",
        ),
        (
            geonet().replace("Duration 0.22", "Duration 0.44"),
            "Duration = 0.44 s, but 12 values",
        ),
        (cosmos().replace("approx    0", "approx   60"), "approx = 60 s, but 12 values"),
        (
            knet().replace("Dir.              N-S", "Scale Factor      1(gal)/2"),
            "Scale Factor = 2000.gal./2000000 contradicts",
        ),
        # Numbers that cannot be read.
        (
            knet().replace("50Hz", "0Hz"),
            r"rec:11: Sampling Freq\(Hz\) = 0 must be positive",
        ),
        (knet().replace("50Hz", "..Hz"), r"rec:11: .* = '..' is not a finite number"),
        (knet().replace("50Hz", "1.2.3Hz"), "'1.2.3' is not a finite number"),
        (
            knet().replace("  0.24", "  0"),
            r"rec:12: Duration Time\(s\) = 0 must be positive",
        ),
        (knet().replace("  0.24", "  ."), "'.' is not a finite number"),
        (knet().replace("/2000000", "/0"), "rec:14: Scale Factor = 0 must be positive"),
        (
            knet().replace("Max. Acc. (gal)   ", "Max. Acc. (gal)   1.2."),
            "is not a finite number",
        ),
        (
            knet().replace("  0.24", "  1E9"),
            "which is more or less than a record can have",
        ),
        (
            esm().replace("0.020000", "0,02"),
            r"rec:5: SAMPLING_INTERVAL_S = 0,02 .* write 0\.02",
        ),
        (
            esm().replace("NDATA: 12", "NDATA: 12.0"),
            "'12.0' should be a number of values",
        ),
        (
            esm().replace("NDATA: 12", "NDATA: abc"),
            "rec:6: NDATA = 'abc' should be a number",
        ),
        (esm().replace("2: 30.125000", "2: n/a"), "'n/a' is not a finite number"),
        (AT2.replace(".02 SEC", "1E999"), "rec:3: DT = '1E999' is not a finite number"),
        (AT2.replace(".02 SEC", "1E-320"), "cannot be the time step"),
        (AT2.replace(".02 SEC", "1E-99999999999999999999"), "must be positive"),
        (AT2.replace(".02 SEC", "1E99999999999999999999"), "is not a finite number"),
        (
            AT2.replace(".02 SEC", "0,01"),
            r"rec:3: DT = 0,01 has a decimal comma; write 0\.01",
        ),
        (AT2.replace(".02 SEC", "1E300"), "cannot be the time step"),
        (AT2.replace("NPTS= 4", "NPTS= " + "4" * 500), "should be a number of values"),
        ("dt: 0,02\nunits: g\n.1\n.2\n", r"dt = 0,02 has a decimal comma; write 0\.02"),
        ("units: g\n0 .1\n1E999 .2\n", "not a row of finite numbers"),
        ("units: g\n0 .1\n1E-320 .2\n", "cannot be the time step"),
        ("units: g\n0 .1\n1E-99999999999999999999 .2\n", "do not increase"),
        ("units: g\n0 .1\n1E300 .2\n", "cannot be the time step"),
        (
            "units: g\n0,00 0,1\n0,02 0,2\n",
            ":2: '0,00 0,1' is not a row of numbers .decimal commas: write points",
        ),
        (AT2.replace(".1 .2 -.1 0", "1E300 1 2 3"), "which is not a ground acceleration"),
        (AT2.replace(".1 .2 -.1 0", "0,1 0,2 -0,1 0"), "decimal commas: write points"),
        # Contents that are not acceleration, or not known.
        (cosmos("Raw acceleration counts"), "'Raw acceleration counts'.*only corrected"),
        (cosmos("Velocity"), "'Velocity.*only corrected acceleration"),
        (cosmos(interval=-999.0), "value 62, the sampling interval"),
        (cosmos().replace("cm/sec2", "counts"), "no line announces acceleration values"),
        (
            cosmos().replace("   12  acc", "   19  acc"),
            "19 values, and 12 stand before '/&  -",
        ),
        (csmip().replace(" 12 POINTS OF ACCEL", " 11 POINTS OF ACCEL"), "11 values, and"),
        (
            csmip().replace("ACCEL DATA", "SOME DATA"),
            "no line announces the acceleration data",
        ),
        (
            "Uncorrected Accelerogram Data\n   200 Accelerogram points at 200 pts/sec, in g/10\n",
            r"uncorrected accelerogram \(volume 1\)",
        ),
        (esm("VELOCITY"), "the file holds velocity"),
        (esm(count=13), "announces 13 values, and 12 stand"),
        (esm(units="cm"), "UNITS says 'cm', which is not a unit of acceleration"),
        (esm().replace("NDATA: 12", "NDATA:"), "the header lacks NDATA"),
        (smc("3 VELOCITY"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc("1 UNCORRECTED ACCELEROGRAM"), "only '2 CORRECTED ACCELEROGRAM'"),
        (smc().replace("        12", "     -9999"), "the headers give -9999 values"),
        (
            knet().replace("50Hz", "fast"),
            "rec:11: .*Sampling Freq.* = 'fast'|lacks Sampling Freq",
        ),
        (geonet().replace("at 0.020 sec", "as sampled"), "lacks the number of points"),
    ],
)
def test_refuses(tmp_path, text, message):
    path = write(tmp_path, text, "rec.AT2" if text.startswith(TITLE) else "rec")
    with pytest.raises(RecordError, match=message) as raised:
        load_record(path)
    assert path in str(raised.value)


def test_what_is_said_twice_alike_is_said_once(tmp_path):
    twice = AT2.replace("SEC", "SEC, NPTS= 4, DT= 0.020")
    assert load_record(write(tmp_path, twice, "rec")).npts == 4
    twice = esm().replace("STREAM", "NDATA: 12\nSTREAM")
    assert load_record(write(tmp_path, twice, "b")).npts == 12


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("units=m/s2", "units = m/s2 contradicts the file"),
        ("dt=0.01", r"dt = 0\.01 s contradicts the file"),
        (
            f"channel={'7' * 5000}",
            r"channel (= )?7{60}(7|;| |:).*(holds one channel|file has)",
        ),
    ],
)
def test_options_against_the_file(tmp_path, name, option, message):
    path = write(tmp_path, MADE[name], "rec")
    with pytest.raises(RecordError, match=message):
        load_record(f"{path}?{option}")


@pytest.mark.parametrize(
    ("text", "warning"),
    [
        (csmip(peak=31.0), "peak at 30.125 and the header says 31"),
        (COLUMN.replace("0.02", "0.4"), "is unusual for an accelerograph"),
        (COLUMN.replace("0.02", "0.25"), "is unusual for an accelerograph"),
        (COLUMN.replace("0.02", "0.00001"), "is unusual for an accelerograph"),
        (peer(values=ROWS + "\nEND OF RECORD, checked by X.Y.\n"), "END OF RECORD"),
        (peer(values=".1 .2 .3 .4 .5 .6 5.0"), "beyond any recorded"),
        (peer(values="0 0 0 0 0 1E-5 0"), "weaker than"),
    ],
)
def test_warnings(tmp_path, text, warning):
    assert warning in " ".join(load_record(write(tmp_path, text, "rec")).warnings)


def test_a_file_that_is_no_record_by_its_size(tmp_path):
    path = tmp_path / "large.txt"
    with path.open("wb") as file:
        file.truncate(300_000_000)
    with pytest.raises(RecordError, match="300 MB are more than a record has"):
        load_record(str(path))


def test_long_lines_are_searched_in_bounded_time(tmp_path):
    """Were whole lines searched, or digits at every division, each would take minutes."""
    many = (" ", "ACCELERATION ", "NPTS ", "DT =", "UNITS OF ", "CORRECTED ACCELEROGRAM ")
    for line in (*(words * 20_000 for words in many), "1" * 200_000 + "E"):
        with pytest.raises(RecordError):
            load_record(write(tmp_path, f"{line}\n.1\n.2\n", "rec"))


def test_what_is_told_of_a_file(tmp_path):
    made = load(tmp_path, peer())
    assert (made.name, made.source, made.format) == ("rec", "rec.AT2", "PEER AT2")
    assert EVENT in made.description
    assert "values in g" in made.description


SPELLINGS = [
    "NPTS=  7, DT= .00500 SEC",
    "NPTS=   7, DT=   .0050 SEC,                                           ",
    "NPTS=   7, DT=   .0050 SEC,   0 POLE @    30.00000 HZ,  -5 POLE @      .12000",
    "NPTS=   7  DT=  0.0050 SEC,",
    "NPTS= 7 DT= 0.0050000",
    "npts=  7, dt= .00500 sec",
    "NPTS = 7 , DT = 5.0E-03",
    "NPTS=7,DT=.005SEC",
    "    7    .0050    NPTS, DT",
    "7 0.00500 NPTS, DT",
    "  7, .0050, NPTS,DT",
    "NPTS, DT = 7, .0050",
    "NPTS=  7\nDT= .005 SEC",
    "DT= .005 SEC\nNPTS=  7",
    "NPTS=  7, DT= 5.0 MSEC",
]
"""Of count and step."""


@pytest.mark.parametrize(
    "text",
    [
        *map(peer, SPELLINGS),
        f"{TITLE}\n{EVENT}\nFilter: HP 0.1\n{UNITS}\n{NPTS}\n\n10/15/79 BASEMENT\n{ROWS}",
        f"{TITLE}\npeak in units of cm/s2: 294\n{UNITS}\n{NPTS}\n{ROWS}",
        peer(values="1.D-2-.02 3.0e-01\n .4d-1  \n  5.E-02+.06\n\n -.07   \n\n  \n"),
        *(peer().replace("\n", end) for end in ("\r\n", "\r\r\n", "\r", "\n")),
    ],
)
def test_spellings_titles_line_ends_and_ragged_values(tmp_path, text):
    made = load(tmp_path, text)
    # One multiplication separates the samples from the printed numbers.
    np.testing.assert_allclose(
        made.acceleration, np.array(IN_G) * STANDARD_GRAVITY, rtol=1e-15
    )
    assert (made.dt, made.warnings) == (0.005, ())


@pytest.mark.parametrize(
    ("line", "unit", "factor"),
    [
        (
            "ACCELERATION HISTORY IN UNITS OF G. FILTER POINTS: HP=0.07 Hz LP=23.0 Hz",
            "g",
            9.80665,
        ),
        ("acceleration time series in units of g", "g", 9.80665),
        ("ACCELERATION TIME SERIES IN UNITS OF CM/S2", "cm/s2", 0.01),
        ("ACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC", "cm/s2", 0.01),
        ("ACCELERATION TIME SERIES IN UNITS OF CM/SEC**2", "cm/s2", 0.01),
        ("ACCELERATION TIME SERIES IN UNITS OF M / S ^ 2", "m/s2", 1.0),
        ("ACCELERATION TIME SERIES IN UNITS OF MM/S/S", "mm/s2", 0.001),
        ("ACCELERATION IN GALS", "gal", 0.01),
        ("ACCELERATION TIME SERIES, UNITS: (m/s^2)", "m/s2", 1.0),
        ("ACCELERATION IN GAL", "gal", 0.01),
        ("ACCELERATION TIME SERIES. The units are (g)", "g", 9.80665),
        ("UNITS: g's", "g", 9.80665),
        ("ACCELERATION IN UNITS OF GRAVITY", "g", 9.80665),
        ("Units are g", "g", 9.80665),
    ],
)
def test_units_are_those_of_their_line(tmp_path, line, unit, factor):
    made = load(tmp_path, peer(units=line))
    assert f"values in {unit}" in made.description
    assert made.acceleration[2] == pytest.approx(0.3 * factor, rel=1e-15)


def test_a_step_that_printing_may_have_rounded(tmp_path):
    text = peer("NPTS=  7, DT=   .0039 SEC")
    made = load(tmp_path, text)
    assert made.dt == 0.0039
    assert "may be rounded" in made.warnings[0]
    assert "?dt=0.00390625" in made.warnings[0]
    exact = load(tmp_path, text, options="?dt=0.00390625")
    assert (exact.dt, exact.warnings) == (0.00390625, ())


@pytest.mark.parametrize(
    "step", [".0050", ".0150", ".0200", ".0025", "0.00390625", ".0300"]
)
def test_steps_that_cannot_be_a_rounded_rate_are_not_doubted(tmp_path, step):
    assert load(tmp_path, peer(f"NPTS=  7, DT=   {step} SEC")).warnings == ()


@pytest.mark.parametrize(
    ("name", "what"), [("rec.VT2", "velocity"), ("rec.dt2", "displacement")]
)
def test_refuses_other_quantities_by_extension(tmp_path, name, what):
    with pytest.raises(RecordError, match=f"hold {what}; give the acceleration.*rec.AT2"):
        load(tmp_path, peer(), name)


VALUE = st.floats(-3.0, 3.0, allow_nan=False, allow_subnormal=False)


@settings(deadline=None)
@given(
    st.lists(VALUE, min_size=2, max_size=23), st.floats(1e-6, 0.5), st.text(max_size=300)
)
@example([0.0, 0.0], 0.5, "SPECTRA")
@example([0.0, 0.0], 0.5, "Response spectrum; PSA in units of g")
def test_what_is_written_is_read_back(values, dt, title):
    motion = GroundMotion(
        np.array(values) * STANDARD_GRAVITY, dt, title, "s", "SMC", title
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "out.at2"
        path.write_text(at2_text(motion), encoding="utf-8", newline="\n")
        read = load_record(str(path))
    assert read.dt == dt
    # Eight digits are printed: half a unit of the last one, and the rounding of two products.
    np.testing.assert_allclose(read.acceleration, motion.acceleration, rtol=5.1e-8)


def test_layout():
    motion = GroundMotion(
        np.arange(7.0), 0.005, "name", "rec.smc", "SMC", "an event\nsomewhere"
    )
    lines = at2_text(motion).splitlines()
    assert lines[0].startswith("PEER AT2 LAYOUT, CONVERTED FROM SMC BY RPS")
    assert lines[1] == "name; an event somewhere"
    assert lines[2] == "ACCELERATION TIME SERIES IN UNITS OF G"
    assert lines[3] == "NPTS=      7, DT= 0.005 SEC"
    assert [len(line.split()) for line in lines[4:]] == [5, 2]
