"""What headers and titles state is used: units, steps, counts, quantities, events, directions."""

import math
from itertools import product

import numpy as np
import pytest
from small_records import csmip, knet

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats.at2 import at2_text
from rpscli.records.formats.record_text import uniform_step
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record
from rpscli.report.motions import two_column_text

FOUR = [0.1, -0.2, 0.3, 0.05]


def load(folder, text, options="", name="rec.txt"):
    (folder / name).write_text(text, encoding="utf-8")
    return load_record(name + options, folder=folder)


def table(form="{:.2f} {}"):
    return "\n".join(form.format(i * 0.02, value) for i, value in enumerate(FOUR))


HEADERS = [
    "# units: g\n",
    "units: g\n",
    "% a record, units = g, made by hand\n\n",
    "Time (s), Acceleration (g)\n",
    "t[s]\tacc[g]\n",
    "Time [s]   a_g [g]\nUnits of g\n",
    "The units are (g)\n",
    "unit is g\n",
    "units in g\n",
]
WITH_DT = [
    "dt: 0.02\nunits: g\n",
    "# dt = 0.02\n# units = g\n",
    "# time step: 2.E-2 s; units: g\n",
]
FORMS = ["{:.2f} {}", "{:.4e}\t{}", "{:.3f}, {}", "  {:.2f} {}"]


@pytest.mark.parametrize(
    ("header", "form"), [*product(HEADERS, FORMS), *product(WITH_DT, ["{1}"])]
)
def test_one_or_two_columns_with_a_header(tmp_path, header, form):
    made = load(tmp_path, f"{header}{table(form)}\n# the end\n")
    np.testing.assert_allclose(
        made.acceleration, np.array(FOUR) * STANDARD_GRAVITY, rtol=1e-15
    )
    assert made.dt == 0.02
    assert made.format == ("one-column text" if form == "{1}" else "two-column text")
    assert "values in g" in made.description


def test_units_that_are_given(tmp_path):
    assert load(tmp_path, table(), "?units=g").pga == pytest.approx(
        0.3 * STANDARD_GRAVITY
    )
    assert load(tmp_path, table(), "?units=m/s2").pga == 0.3
    assert load(tmp_path, table(), "?units=cm/s^2").pga == pytest.approx(0.003)


def test_one_column_with_options(tmp_path):
    text = table("{1}")
    assert load(tmp_path, text, "?dt=0.005&units=m/s2").dt == 0.005
    assert load(tmp_path, text, "?units=m/s2&dt=5 ms").dt == 0.005
    assert load_record("rec.txt", folder=tmp_path, dt=0.01, units="g").dt == 0.01


@pytest.mark.parametrize(
    "lines",
    [
        "1\n0.02\n.1\n.2\n.3",
        "3\n.1\n.2\n.3",
        "0.02\n3\n.1\n.2\n.3",
        "3.\n.1\n.2\n.3",
        "9\n.1\n.2",
    ],
)
def test_a_leading_count_or_step_is_not_an_acceleration(tmp_path, lines):
    with pytest.raises(RecordError, match="look like a header"):
        load(tmp_path, lines, "?dt=0.02&units=g")


@pytest.mark.parametrize(
    ("text", "values", "warning"),
    [
        ("0.02-0.1\n0.04-0.2\n0.06 0.3\n", [-0.1, -0.2, 0.3], "begin at 0.02 s"),  # glued
        (
            ".1 .2 .3 .4 .5\n-.2 .1\n",
            [0.1, 0.2, 0.3, 0.4, 0.5, -0.2, 0.1],
            "rows of 5 numbers",
        ),
        ("0.02\n.1\n.2\n.3", [0.02, 0.1, 0.2, 0.3], "equals dt"),
    ],
)
def test_doubted_values(tmp_path, text, values, warning):
    made = load(tmp_path, text, "?dt=0.02&units=m/s2")
    assert (made.acceleration.tolist(), made.dt) == (values, 0.02)
    assert warning in made.warnings[0]


@pytest.mark.parametrize(
    "step", [0.02, 0.005, 0.0039, 0.0024, 1.0 / 256.0, 0.0125, 1.0 / 3.0]
)
@pytest.mark.parametrize("form", ["{:.4f}", "{:.6g}", "{!r}", "{:.7e}", "{:g}"])
def test_steps_survive_the_printing_of_times(tmp_path, step, form):
    count = 3000
    rows = [f"{form.format(step * i)} {0.1 * (i % 7 - 3)}" for i in range(count)]
    made = load(tmp_path, "\n".join(rows), "?units=m/s2")
    # Two units of the last digit of the last time, and what summing steps may add, over all steps.
    unit = 10.0 ** (int(math.log10(step * (count - 1))) - 5)
    unit = {"{:.4f}": 1e-4, "{:.6g}": unit, "{:g}": unit}.get(form, unit / 100.0)
    assert abs(made.dt - step) <= (2.0 * unit + 2e-6 * step) / (count - 1)


@pytest.mark.parametrize("step", [0.02, 0.005, 0.0025, 0.01])
def test_round_steps_come_out_exactly(step):
    times = np.cumsum(np.full(9000, step)) - step  # as a loop t = t + dt prints them
    assert uniform_step(times, 1e-12) == step


COUNT, DT = 200, 0.005
TIMES = np.arange(COUNT) * DT
VALUES = 0.2 * np.sin(4.0 * np.pi * TIMES) * np.sin(np.pi * TIMES / TIMES[-1]) ** 0.5
PEAK = float(np.max(np.abs(VALUES)))


def rows(*columns, form="{:.6f}", between=","):
    lines = (
        between.join(form.format(v) for v in row) for row in zip(*columns, strict=True)
    )
    return "\n".join(lines) + "\n"


ALONE, TIMED = rows(VALUES), rows(TIMES, VALUES)
THREE = rows(VALUES, 0.5 * VALUES, 0.25 * VALUES, between="  ")
GAL = rows(100.0 * STANDARD_GRAVITY * VALUES)
TABLE = "0.00 0.1\n0.02 -0.2\n0.04 0.3\n0.06 0.05"
FIVE = ".1 .2 .3 .4 .5"
HEAD = "NUMBER OF DATA : 200\nSAMPLING INTERVAL (sec) : 0.005\nunits: g\n"


@pytest.mark.parametrize(
    ("text", "options"),
    [
        (f"units: g\ndt: 5 ms\n{ALONE}", ""),
        (f"units: g\nsampling interval (msec) = 5\n{ALONE}", ""),
        (f"units: g\nEqually spaced intervals of .005 sec.\n{ALONE}", ""),
        (f"Time [ms],Acceleration [g]\n{rows(1e3 * TIMES, VALUES)}", ""),
        (f"Time (msec),acc_x (g)\n{rows(1e3 * TIMES, VALUES)}", ""),
        (f"values as recorded in gal\ndt: 0.005\nPeak acc (g): 0.2000\n{GAL}", ""),
        (f"an invented motion\n200 0.0050\n{ALONE}", "?units=g"),
        ('"Time [s]","Acceleration [g]"\n' + TIMED.replace(",", '","').replace("\n", '"\n"'), ""),
        (
            "Time [s],Acceleration [g],Velocity [m/s],Displacement [m]\n"
            + rows(TIMES, VALUES, 2.0 * VALUES, 3.0 * VALUES),
            "",
        ),
        (f"{HEAD}   N-S   E-W   U-D\n{THREE}", "?channel=N-S"),
        (f"{HEAD}   N-S   E-W   U-D\n{rows(2.0 * VALUES, VALUES, VALUES, between=' ')}",
         "?channel=e-w"),
        (f"Time [s],Acceleration N [g],Acceleration E [g]\n{rows(TIMES, VALUES, VALUES / 2)}",
         "?channel=Acceleration N"),
        (f"Time [s],Acceleration [g]\n{TIMED}" + "\0" * 300, ""),
        (f"Time,Acceleration\ns,g\n{TIMED}", ""),
        (f"(s)   (g)\n{TIMED}", ""),
        (f"Time, Acceleration in g\n{TIMED}", ""),
        (f"Time [s],Acceleration (N-S)\n{TIMED}", "?units=g"),
        (f"units: g\n{rows(TIMES, VALUES / 2, VALUES)}", "?channel=3"),
    ],
)  # fmt: skip
def test_units_steps_counts_and_columns(tmp_path, text, options):
    made = load(tmp_path, text.removesuffix('"'), options)
    assert (made.npts, made.dt) == (COUNT, DT)
    np.testing.assert_allclose(made.acceleration, VALUES * STANDARD_GRAVITY, atol=1e-5)


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (
            f"# units: g\n{TABLE}",
            "?units=m/s2",
            "units = m/s2 contradicts the file, which says g",
        ),
        (f"# units: parsec\n{TABLE}", "", "not a unit of acceleration"),
        (
            f"# dt: 0.01\n{TABLE}",
            "?units=g",
            r"says dt = 0.01 s and the times advance by 0.02 s",
        ),
        (f"# npts: 5\n{TABLE}", "?units=g", r"announces 5 values and the file holds 4"),
        (TABLE, "", r"does not state the units.*\?units=g"),
        (".1\n-.2\n.3\n", "?units=g", r"does not state its sampling interval.*\?dt="),
        (".1\n-.2\n.3\n", "?dt=-0.01&units=g", r"dt = -0\.01 s must be positive"),
        (
            f"{FIVE}\n{FIVE} .6\n",
            "?dt=0.01&units=g",
            "a row of 6 numbers among rows of 5",
        ),
        (TABLE, "?units=furlong", "units = 'furlong' is not known"),
        (
            TABLE,
            "?units=g&dt=0.01",
            "dt = 0.01 s contradicts the file, which says 0.02 s",
        ),
        (
            "0 .1\n.02 .1\n.04 .2\n.07 .1\n.08 .2\n",
            "?units=g&dt=0.02",
            "after sample 3 is 0.03 s",
        ),
        (
            "0 .1\n.02 .1\n.02 .2\n.04 .3\n",
            "?units=g&dt=0.02",
            "after sample 2; sort them",
        ),
        (".3 0.0\n.1 .02\n.2 .04\n.1 .06\n", "?units=g&dt=0.02", "do not increase"),
        (
            "0 .1 1\n.02 .1 2\n.04 .2 3\n",
            "?units=g&dt=0.02",
            "time and several quantities",
        ),
        ("0 .1\n.02\n.04 .2\n", "?units=g&dt=0.02", "a row of 1 numbers among rows of 2"),
        (
            "0 .1\n.02 .1\nend\n.04 .2\n",
            "?units=g&dt=0.02",
            "rec.txt:3: 'end' stands among",
        ),
        ("0 .1\n.02 nan\n", "?units=g&dt=0.02", "nan"),
        ("a\nb\n", "?units=g&dt=0.02", "no known format"),
        (f"Time (s),Acceleration (g x 10)\n{TIMED}", "", "'g x 10', which is not a unit"),
        (f"Time (min),Acceleration (g)\n{TIMED}", "", "a time in 'min' is not known"),
        (
            f"Time [samples],Acceleration [g]\n{TIMED}",
            "",
            "a time in 'samples' is not known",
        ),
        (f"units: g\ndt: 0.005.3\n{ALONE}", "", "'0.005.3' is not a finite number"),
        (f"units: g\ndt: 5 min\n{ALONE}", "", "a time in 'min' is not known"),
        (
            f"Period [s],Spectral Acceleration [g]\n{rows(TIMES + 0.02, VALUES)}",
            "",
            "a spectrum",
        ),
        (
            f"time [s],displacement [mm]\n{TIMED}",
            "?units=g",
            ":1: .*is a displacement record",
        ),
        (f"time,displacement\n{TIMED}", "?units=g", "this is a displacement record"),
        (
            f"time;velocity\n{rows(TIMES, VALUES, between=' ')}",
            "?units=g",
            "a velocity record",
        ),
        (
            f"{HEAD}   N-S   E-W   U-D\n{THREE}",
            "",
            r"3 channels; .*\?channel=1.*1: N-S; 2: E-W",
        ),
        (
            f"units: g\n  N00E  N90E  V\n---+---+---\n{THREE}",
            "?dt=0.005",
            "1: N00E; 2: N90E; 3: V",
        ),
        (f"{HEAD}{THREE}", "", "as many as there are rows of 3 numbers"),
        (
            f"{HEAD}   N-S   E-W   U-D\n{THREE}",
            "?channel=north",
            "there is no channel north",
        ),
        (
            f"199 0.0050\n{ALONE}",
            "?units=g",
            "look like the number of values and their step",
        ),
        (f"units: g\ndt: 5 ms\ndt: 0.01\n{ALONE}", "", "contradicts dt = 5 ms of line 2"),
        (f"Acceleration [g]\ndt: 0.005\n{ALONE}", "?units=gal", "contradicts the file"),
        (
            f"Time [s],Acceleration [counts]\n{TIMED}",
            "?units=g",
            "'counts', which is not a unit",
        ),
        (f"Time [s],Acceleration [cm]\n{TIMED}", "?units=g", "'cm', which is not a unit"),
        (f"units: g\n{rows(TIMES, VALUES, VALUES)}", "", "by its place, .channel=2"),
    ],
)
def test_refuses(tmp_path, text, options, message):
    with pytest.raises(RecordError, match=message):
        load(tmp_path, text, options)


@pytest.mark.parametrize(
    ("part", "end"), [(slice(60, None), "first"), (slice(None, -60), "last")]
)
def test_a_motion_that_does_not_begin_and_end_at_rest_is_a_warning(tmp_path, part, end):
    t = np.arange(400) * 0.005
    values = np.sin(20.0 * t) * np.sin(np.pi * t / t[-1])
    text = "units: g\ndt: 0.005\n{}"
    assert not load(tmp_path, text.format(rows(values))).warnings
    (warning,) = load(tmp_path, text.format(rows(values[part]))).warnings
    assert warning.startswith(f"the {end} value is 0.")


def test_an_offset_is_a_warning(tmp_path):
    (warning,) = load(tmp_path, f"units: g\ndt: 0.005\n{rows(VALUES + 0.05)}").warnings
    assert "of the peak: an offset of the instrument?" in warning
    assert load(tmp_path, f"units: g\ndt: 0.005\n{ALONE}").warnings == ()


def test_a_peak_that_the_header_contradicts_is_a_warning(tmp_path):
    for line in ("Peak acc (gal): {}", "Peak acceleration = {} gal at 2 s"):
        text = f"units: g\ndt: 0.005\n{line}\n{ALONE}"
        assert (
            load(tmp_path, text.format(f"{100.0 * STANDARD_GRAVITY * PEAK:.2f}")).warnings
            == ()
        )
        (warning,) = load(tmp_path, text.format("98.07")).warnings
        assert "the values peak at 0.192696 and the header says 0.100004" in warning


AT2 = "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   200, DT=   .0050 SEC\n"


WRITTEN = {
    "columns": (f"units: gal, dt: 5 ms, npts: 200\n{GAL}", "x.txt"),
    "titles": (f"Time [ms],Acceleration [g]\n{rows(1e3 * TIMES, VALUES)}", "x.csv"),
    "at2": (f"{AT2}{rows(VALUES, form='{:.7E}')}", "x.at2"),
    "knet": (knet(), "x.EW"),
    "csmip": (csmip(), "x.v2"),
    "pulse": ("", "pulse:sine?amplitude=0.2 g&period=1&dt=0.005"),
    "synthetic": ("", "synthetic:?pga=0.2g&seed=1&duration=1&dt=0.005"),
}


def written(folder, motion, form):
    """The motion as it is read back from an AT2 file or a text of two columns."""
    text = at2_text(motion) if form == "at2" else two_column_text(motion)
    return load(folder, text, name="y.at2" if form == "at2" else "y.txt")


@pytest.mark.parametrize("kind", WRITTEN)
@pytest.mark.parametrize("form", ["at2", "text"])
def test_what_is_written_reads_back(tmp_path, kind, form):
    text, name = WRITTEN[kind]
    made = load(tmp_path, text, name=name) if text else load_record(name)
    again = written(tmp_path, made, form)
    assert (again.npts, again.dt) == (made.npts, made.dt)
    digits = 1e-7 if form == "at2" else 1e-8
    np.testing.assert_allclose(
        again.acceleration, made.acceleration, atol=digits * made.pga
    )
    assert written(tmp_path, again, "text").npts == made.npts


@pytest.mark.parametrize(
    "title",
    ["units: furlongs", "Units of gal", "dt: 3", "DT= 3 SEC", "NPTS= 7", "number of data: 9",
     "sampling interval (ms) = 2", "equally spaced intervals of 3 sec", "velocity time series",
     "velocity  time, units of mm/s2", "NPTS= 3, DT= 1"],
)  # fmt: skip
@pytest.mark.parametrize("form", ["at2", "text"])
def test_a_title_states_nothing(tmp_path, title, form):
    motion = GroundMotion(VALUES * STANDARD_GRAVITY, DT, "x", "s", "SMC", title)
    again = written(tmp_path, motion, form)
    assert (again.npts, again.dt) == (COUNT, DT)
    assert again.pga == pytest.approx(motion.pga, rel=1e-7)
