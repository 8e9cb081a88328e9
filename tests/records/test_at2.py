from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

TITLE = "PEER NGA STRONG MOTION DATABASE RECORD"
EVENT = "Northridge-01, 1/17/1994, Somewhere, 9"
UNITS = "ACCELERATION TIME SERIES IN UNITS OF G"
NPTS = "NPTS=      7, DT=   .0050 SEC"
VALUES = "  .1000000E-01 -.2000000E-01  .3000000E+00  .4000000E-01  .5000000E-01\n"
VALUES += "  .6000000E-01 -.7000000E-01\n"
IN_G = [0.01, -0.02, 0.3, 0.04, 0.05, 0.06, -0.07]


def at2(npts: str = NPTS, values: str = VALUES, units: str = UNITS) -> str:
    return f"{TITLE}\n{EVENT}\n{units}\n{npts}\n{values}"


def load(folder: Path, text: str, name: str = "rec.AT2", options: str = "") -> GroundMotion:
    (folder / name).write_bytes(text.encode("latin-1"))
    return load_record(name + options, folder=folder)


def test_an_ordinary_file(tmp_path: Path) -> None:
    made = load(tmp_path, at2())
    # One multiplication separates the samples from the printed numbers.
    np.testing.assert_allclose(made.acceleration, np.array(IN_G) * STANDARD_GRAVITY, rtol=1e-15)
    assert made.dt == 0.005
    assert made.npts == 7
    assert made.name == "rec"
    assert made.source == "rec.AT2"
    assert made.format == "PEER AT2"
    assert EVENT in made.description
    assert "values in g" in made.description
    assert made.warnings == ()


@pytest.mark.parametrize(
    "line",
    [
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
    ],
)
def test_spellings_of_count_and_step(tmp_path: Path, line: str) -> None:
    made = load(tmp_path, at2(line))
    assert (made.npts, made.dt) == (7, 0.005)
    assert made.pga == pytest.approx(0.3 * STANDARD_GRAVITY, rel=1e-15)


def test_a_header_of_seven_lines(tmp_path: Path) -> None:
    text = f"{TITLE}\n{EVENT}\nFilter: HP 0.1\n{UNITS}\n{NPTS}\n\n10/15/79 BASEMENT\n{VALUES}"
    assert load(tmp_path, text).npts == 7


@pytest.mark.parametrize("end", ["\r\n", "\r\r\n", "\r", "\n"])
def test_line_ends(tmp_path: Path, end: str) -> None:
    made = load(tmp_path, at2().replace("\n", end))
    assert made.npts == 7
    assert made.acceleration[-1] == pytest.approx(-0.07 * STANDARD_GRAVITY, rel=1e-15)


def test_glued_and_ragged_values(tmp_path: Path) -> None:
    values = " -.1234E-02-.5678E-03\n.1D+00  -.5d-1+.25E-1\n   .3 \n -0.125   \n\n   \n"
    made = load(tmp_path, at2(values=values))
    in_g = [-0.001234, -0.0005678, 0.1, -0.05, 0.025, 0.3, -0.125]
    np.testing.assert_allclose(made.acceleration, np.array(in_g) * STANDARD_GRAVITY, rtol=1e-15)


def test_text_after_the_values_is_a_warning(tmp_path: Path) -> None:
    made = load(tmp_path, at2(values=VALUES + "\nEND OF RECORD, checked by X.Y.\n"))
    assert made.npts == 7
    assert "END OF RECORD" in made.warnings[0]


@pytest.mark.parametrize(
    ("line", "unit", "factor"),
    [
        ("ACCELERATION HISTORY IN UNITS OF G. FILTER POINTS: HP=0.07 Hz LP=23.0 Hz", "g", 9.80665),
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
def test_units_are_those_of_the_units_line(
    tmp_path: Path, line: str, unit: str, factor: float
) -> None:
    made = load(tmp_path, at2(units=line))
    assert f"values in {unit}" in made.description
    assert made.acceleration[2] == pytest.approx(0.3 * factor, rel=1e-15)


def test_a_step_that_printing_may_have_rounded(tmp_path: Path) -> None:
    text = at2("NPTS=  7, DT=   .0039 SEC")
    made = load(tmp_path, text)
    assert made.dt == 0.0039
    assert "may be rounded" in made.warnings[0]
    assert "?dt=0.00390625" in made.warnings[0]
    exact = load(tmp_path, text, options="?dt=0.00390625")
    assert (exact.dt, exact.warnings) == (0.00390625, ())


@pytest.mark.parametrize("step", [".0050", ".0150", ".0200", ".0025", "0.00390625", ".0300"])
def test_steps_that_cannot_be_a_rounded_rate_are_not_doubted(tmp_path: Path, step: str) -> None:
    assert load(tmp_path, at2(f"NPTS=  7, DT=   {step} SEC")).warnings == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            at2("NPTS=  9, DT= .005 SEC"),
            r"rec.AT2:6: .* 9 values, and 7 stand before the end.*correct the count",
        ),
        (at2("NPTS=  6, DT= .005 SEC"), "announces 6 values, and 7 stand before the end"),
        (at2("NPTS=  7, DT= .000 SEC"), "DT = .000 must be positive"),
        (at2("NPTS=  7, DT= -.01 SEC"), "must be positive"),
        (at2(values=""), "announces 7 values, and 0 stand before the end"),
        (at2("NPTS=  7"), "no header line gives NPTS and DT"),
        (at2("DT= .005"), "no header line gives NPTS and DT"),
        (at2(values=".1 1_000"), "and 0 stand before '.1 1_000"),
        (at2(values=".1,,2"), "and 0 stand before '.1,,2"),
        (at2(values=".1 --1"), "and 0 stand before '.1 --1"),
        (at2(values="  .1 .2 NaN .4 .5 .6 .7"), "and 0 stand before '.1 .2 NaN"),
        (
            at2(values=VALUES.replace(".6000000E-01", "************")),
            r"rec.AT2:6: .*and 5 stand before",
        ),
        (at2(values=VALUES.replace(".6000000E-01", "1E999")), "5 stand before '1E999"),
        (at2(values=VALUES.replace("-.7", "0.6.7")), "5 stand before '.6000000E-01 0.6.7"),
        (at2(values=VALUES.replace("\n", "\nNEXT RECORD\n", 1)), "5 stand before 'NEXT"),
        (at2(values=VALUES + "NEXT RECORD\n .1 .2\n"), "more numbers follow after the 7 values"),
        (at2(units="ACCELERATION TIME SERIES IN UNITS OF FURLONGS"), "not a unit of acceleration"),
        (at2(units="VELOCITY TIME SERIES IN UNITS OF CM/S"), "this is a velocity record"),
        (at2(units="DISPLACEMENT TIME HISTORY IN UNITS OF CM"), "this is a displacement record"),
        (at2(units="ACCELERATION TIME SERIES IN UNITS OF CM/S"), "not a unit of acceleration"),
        (at2(npts=f"NPTS= {'9' * 5000}, DT= .01 SEC"), "no header line gives NPTS and DT"),
    ],
)
def test_refuses(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(RecordError, match=message) as raised:
        load(tmp_path, text)
    assert str(tmp_path / "rec.AT2") in str(raised.value) or "rec.AT2" in str(raised.value)


@pytest.mark.parametrize(
    ("name", "quantity"), [("rec.VT2", "velocity"), ("rec.dt2", "displacement")]
)
def test_refuses_other_quantities_by_extension(tmp_path: Path, name: str, quantity: str) -> None:
    with pytest.raises(RecordError, match=f"hold {quantity}; give the acceleration.*rec.AT2"):
        load(tmp_path, at2(), name)


def test_a_title_may_mention_other_units(tmp_path: Path) -> None:
    text = f"{TITLE}\npeak in units of cm/s2: 294\n{UNITS}\n{NPTS}\n{VALUES}"
    assert load(tmp_path, text).pga == pytest.approx(0.3 * STANDARD_GRAVITY, rel=1e-15)


@pytest.mark.parametrize(
    ("values", "message"),
    [(".1 .2 .3 .4 .5 .6 5.0", "beyond any recorded"), ("0 0 0 0 0 1E-5 0", "weaker than")],
)
def test_implausible_peaks_are_a_warning(tmp_path: Path, values: str, message: str) -> None:
    assert message in load(tmp_path, at2(values=values)).warnings[-1]


VALUE = st.floats(-3.0, 3.0, allow_nan=False, allow_subnormal=False)


@settings(deadline=None)
@given(
    st.lists(VALUE, min_size=2, max_size=23),
    st.floats(1e-6, 1.0),
    st.text(max_size=300)
    | st.sampled_from(["NPTS= 3, DT= 1", "units: gal", "velocity  time, units of mm/s2"]),
)
def test_what_is_written_is_read_back(values: list[float], dt: float, title: str) -> None:
    motion = GroundMotion(np.array(values) * STANDARD_GRAVITY, dt, title, "s", "SMC", title)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "out.at2"
        path.write_text(at2_text(motion), encoding="utf-8", newline="\n")
        read = load_record(str(path))
    assert read.dt == dt
    # Eight digits are printed: half a unit of the last one, and the rounding of two products.
    np.testing.assert_allclose(read.acceleration, motion.acceleration, rtol=5.1e-8)


def test_layout() -> None:
    motion = GroundMotion(np.arange(7.0), 0.005, "name", "rec.smc", "SMC", "an event\nsomewhere")
    lines = at2_text(motion).splitlines()
    assert lines[0].startswith("PEER AT2 LAYOUT, CONVERTED FROM SMC BY RPS")
    assert lines[1] == "name; an event somewhere"
    assert lines[2] == "ACCELERATION TIME SERIES IN UNITS OF G"
    assert lines[3] == "NPTS=      7, DT= 0.005 SEC"
    assert [len(line.split()) for line in lines[4:]] == [5, 2]
