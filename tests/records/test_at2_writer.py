from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpscli.constants import STANDARD_GRAVITY
from rpscli.errors import RecordError
from rpscli.records.at2_writer import at2_text, write_at2
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.source import load_record

VALUE = st.floats(-3.0, 3.0, allow_nan=False, allow_subnormal=False)


@settings(deadline=None)
@given(
    st.lists(VALUE, min_size=2, max_size=23),
    st.floats(1e-6, 1.0),
    st.text(max_size=300) | st.sampled_from(["NPTS= 3, DT= 1", "velocity  time, units of mm/s2"]),
)
def test_what_is_written_is_read_back(values: list[float], dt: float, title: str) -> None:
    motion = GroundMotion(np.array(values) * STANDARD_GRAVITY, dt, "n", "s", "SMC", title)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "out.at2"
        write_at2(path, motion)
        read = load_record(str(path))
        assert [entry.name for entry in Path(folder).iterdir()] == ["out.at2"]
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


def test_a_folder_that_is_missing_is_named(tmp_path: Path) -> None:
    motion = GroundMotion(np.ones(3), 0.1, "n", "s", "SMC")
    with pytest.raises(RecordError, match="cannot be written: No such file"):
        write_at2(tmp_path / "nowhere" / "out.at2", motion)


def test_an_older_file_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "out.at2"
    path.write_text("old")
    write_at2(path, GroundMotion(np.ones(3), 0.1, "n", "s", "SMC"))
    assert path.read_text().startswith("PEER AT2 LAYOUT")
    assert path.stat().st_mode & 0o044 == 0o044  # as readable as any file the user makes
