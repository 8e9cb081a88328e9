from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.constants import STANDARD_GRAVITY
from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.loading import load_record

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


@pytest.mark.parametrize(
    "source", ["synthetic:?pga=0.1g&seed=1", "pulse:sine?amplitude=1&period=1"]
)
def test_what_is_made_says_that_it_is_no_recording(source: str) -> None:
    lines = at2_text(load_record(source)).splitlines()
    assert "SYNTHETIC, NOT A RECORDING" in lines[0]
    assert lines[1].startswith(source)
