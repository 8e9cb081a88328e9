from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.formats.record_text import uniform_step
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

VALUES = [0.1, -0.2, 0.3, 0.05]


def load(folder: Path, text: str, options: str = "", name: str = "rec.txt") -> GroundMotion:
    (folder / name).write_text(text)
    return load_record(name + options, folder=folder)


def table(step: float = 0.02, form: str = "{:.2f} {}") -> str:
    return "\n".join(form.format(i * step, value) for i, value in enumerate(VALUES))


@pytest.mark.parametrize(
    "header",
    [
        "# units: g\n",
        "units: g\n",
        "% a record, units = g, made by hand\n\n",
        "Time (s), Acceleration (g)\n",
        "t[s]\tacc[g]\n",
        "Time [s]   a_g [g]\nUnits of g\n",
    ],
)
@pytest.mark.parametrize("form", ["{:.2f} {}", "{:.4e}\t{}", "{:.3f}, {}", "  {:.2f};{}"])
def test_two_columns(tmp_path: Path, header: str, form: str) -> None:
    text = header + table(form=form.replace(";", " "))
    made = load(tmp_path, text)
    np.testing.assert_allclose(made.acceleration, np.array(VALUES) * STANDARD_GRAVITY, rtol=1e-15)
    assert made.dt == 0.02
    assert made.format == "two-column text"
    assert "values in g" in made.description


def test_units_have_to_be_known(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match=r"does not state the units.*\?units=g"):
        load(tmp_path, table())
    assert load(tmp_path, table(), "?units=g").pga == pytest.approx(0.3 * STANDARD_GRAVITY)
    assert load(tmp_path, table(), "?units=m/s2").pga == 0.3
    assert load(tmp_path, table(), "?units=cm/s^2").pga == pytest.approx(0.003)


@pytest.mark.parametrize(
    ("header", "options", "message"),
    [
        ("# units: g\n", "?units=m/s2", "units = m/s2 contradicts the file, which says g"),
        ("# units: parsec\n", "", "not a unit of acceleration"),
        ("# dt: 0.01\n", "?units=g", r"says dt = 0.01 s and the times advance by 0.02 s"),
        ("# npts: 5\n", "?units=g", r"announces 5 values and the file holds 4"),
        ("", "?units=furlong", "units = 'furlong' is not known"),
        ("", "?units=g&dt=0.01", "dt = 0.01 s contradicts the file, which says 0.02 s"),
    ],
)
def test_contradictions(tmp_path: Path, header: str, options: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load(tmp_path, header + table(), options)


def test_a_header_that_agrees(tmp_path: Path) -> None:
    made = load(tmp_path, "# npts = 4, dt = 0.02 s, units: m/s2\n" + table())
    assert (made.npts, made.dt, made.pga) == (4, 0.02, 0.3)


def test_glued_columns(tmp_path: Path) -> None:
    made = load(tmp_path, "0.00-0.1\n0.02-0.2\n0.04 0.3\n", "?units=m/s2")
    assert made.acceleration.tolist() == [-0.1, -0.2, 0.3]
    assert made.dt == 0.02


def test_times_that_do_not_begin_at_zero_are_a_warning(tmp_path: Path) -> None:
    text = "0.02 0.1\n0.04 0.2\n0.06 0.3\n"
    made = load(tmp_path, text, "?units=g")
    assert made.npts == 3
    assert "begin at 0.02 s" in made.warnings[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0 .1\n.02 .1\n.04 .2\n.07 .1\n.08 .2\n", "after sample 3 is 0.03 s"),
        ("0 .1\n.02 .1\n.02 .2\n.04 .3\n", "do not increase after sample 2; sort them"),
        (".3 0.0\n.1 .02\n.2 .04\n.1 .06\n", "do not increase"),
        ("0 .1 1\n.02 .1 2\n.04 .2 3\n", "time and several quantities"),
        ("0 .1\n.02\n.04 .2\n", "a row of 1 numbers among rows of 2"),
        ("0 .1\n.02 .1\nend\n.04 .2\n", r"rec.txt:3: 'end' stands among the values"),
        ("0 .1\n.02 nan\n", "nan"),
        ("a\nb\n", "no known format"),
    ],
)
def test_refuses(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(RecordError, match=message):
        load(tmp_path, text, "?units=g&dt=0.02")


@pytest.mark.parametrize(
    "header",
    ["dt: 0.005\nunits: g\n", "# dt = 0.005\n# units = g\n", "# time step: 5.0E-3 s; units: g\n"],
)
def test_one_column_with_a_header(tmp_path: Path, header: str) -> None:
    made = load(tmp_path, header + "\n".join(map(str, VALUES)) + "\n# the end\n")
    np.testing.assert_allclose(made.acceleration, np.array(VALUES) * STANDARD_GRAVITY, rtol=1e-15)
    assert made.dt == 0.005
    assert made.format == "one-column text"


def test_one_column_with_options(tmp_path: Path) -> None:
    text = "\n".join(map(str, VALUES))
    assert load(tmp_path, text, "?dt=0.005&units=m/s2").dt == 0.005
    assert load(tmp_path, text, "?units=m/s2&dt=5 ms").dt == 0.005
    assert load_record("rec.txt", folder=tmp_path, dt=0.01, units="g").dt == 0.01
    with pytest.raises(RecordError, match=r"does not state its sampling interval.*\?dt="):
        load_record("rec.txt?units=g", folder=tmp_path)
    with pytest.raises(RecordError, match=r"dt = -0\.01 s must be positive"):
        load_record("rec.txt?dt=-0.01&units=g", folder=tmp_path)


@pytest.mark.parametrize(
    "lines",
    ["1\n0.02\n.1\n.2\n.3", "3\n.1\n.2\n.3", "0.02\n3\n.1\n.2\n.3", "3.\n.1\n.2\n.3", "9\n.1\n.2"],
)
def test_a_leading_count_or_step_is_not_an_acceleration(tmp_path: Path, lines: str) -> None:
    with pytest.raises(RecordError, match="look like a header"):
        load(tmp_path, lines, "?dt=0.02&units=g")


def test_a_first_value_that_equals_the_step_is_a_warning(tmp_path: Path) -> None:
    made = load(tmp_path, "0.02\n.1\n.2\n.3", "?dt=0.02&units=g")
    assert "equals dt" in made.warnings[0]


def test_the_body_of_an_at2_file(tmp_path: Path) -> None:
    made = load(tmp_path, ".1 .2 .3 .4 .5\n-.2 .1 -.3 .1 .2\n.7 .8\n", "?dt=0.01&units=m/s2")
    assert made.npts == 12
    assert made.acceleration[-1] == 0.8
    assert "rows of 5 numbers" in made.warnings[0]
    with pytest.raises(RecordError, match="a row of 6 numbers among rows of 5"):
        load(tmp_path, ".1 .2 .3 .4 .5\n.1 .2 .3 .4 .5 .6\n", "?dt=0.01&units=m/s2")


@pytest.mark.parametrize("step", [0.02, 0.005, 0.0039, 0.0024, 1.0 / 256.0, 0.0125, 1.0 / 3.0])
@pytest.mark.parametrize("form", ["{:.4f}", "{:.6g}", "{!r}", "{:.7e}", "{:g}"])
def test_steps_survive_the_printing_of_times(tmp_path: Path, step: float, form: str) -> None:
    count = 3000
    rows = [f"{form.format(step * i)} {0.1 * (i % 7)}" for i in range(count)]
    made = load(tmp_path, "\n".join(rows), "?units=m/s2")
    # Two units of the last digit of the last time, and what summing steps may add, over all steps.
    unit = 10.0 ** (int(math.log10(step * (count - 1))) - 5)
    unit = {"{:.4f}": 1e-4, "{:.6g}": unit, "{:g}": unit}.get(form, unit / 100.0)
    assert abs(made.dt - step) <= (2.0 * unit + 2e-6 * step) / (count - 1)


@pytest.mark.parametrize("step", [0.02, 0.005, 0.0025, 0.01])
def test_round_steps_come_out_exactly(step: float) -> None:
    times = np.cumsum(np.full(9000, step)) - step  # as a loop t = t + dt prints them
    assert uniform_step(times, 1e-12) == step
