from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.ground_motion import GroundMotion, MotionComponents


def motion(values: list[float], dt: float = 0.5) -> GroundMotion:
    return GroundMotion(np.array(values), dt, "name", "source.at2", "PEER AT2")


def test_samples_are_a_read_only_contiguous_copy() -> None:
    values = np.arange(10.0)[::2]
    made = GroundMotion(values, 0.1, "n", "s", "f")
    values[0] = 99.0
    assert made.acceleration.flags.c_contiguous
    assert made.acceleration[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        made.acceleration[0] = 1.0


def test_scaled_says_so_and_keeps_the_rest() -> None:
    made = motion([0.0, 1.0, -4.0])
    twice = made.scaled(-2.0)
    assert twice.acceleration.tolist() == [0.0, -2.0, 8.0]
    assert twice.pga == 8.0
    assert twice.description == "scaled by -2"
    assert twice.scaled(0.5).description == "scaled by -2; scaled by 0.5"
    assert (twice.name, twice.source, twice.dt) == (made.name, made.source, made.dt)


def test_digest_depends_on_step_and_samples_only() -> None:
    made = motion([0.0, 1.0])
    same = GroundMotion(np.array([0.0, 1.0]), 0.5, "other", "elsewhere", "pulse")
    assert made.digest == same.digest
    assert made.digest != motion([0.0, 1.0], 0.25).digest
    assert made.digest != motion([0.0, 1.0 + 1e-15]).digest
    assert made.digest != made.scaled(2.0).digest


@pytest.mark.parametrize(
    ("values", "dt", "message"),
    [
        ([[0.0, 1.0], [1.0, 2.0]], 0.1, "one row"),
        ([1.0], 0.1, "at least 2 samples"),
        ([0.0, np.nan, 1.0], 0.1, "sample 2 is nan, not finite"),
        ([0.0, 1.0], 0.0, "dt = 0.0 s must be positive"),
        ([0.0, 1.0], np.inf, "must be positive and finite"),
    ],
)
def test_refuses(values: list[Any], dt: float, message: str) -> None:
    with pytest.raises(RecordError, match=message) as raised:
        motion(values, dt)
    assert "source.at2" in str(raised.value)


def test_components_have_one_time_step() -> None:
    along = motion([1.0, -2.0])
    up = motion([5.0, 6.0], 0.2)
    with pytest.raises(RecordError, match=r"vertical .* dt = 0\.2 s, .* 0\.5 s: they must agree"):
        MotionComponents(along, up)


def test_a_second_horizontal_component() -> None:
    x, y, up = motion([1.0, -2.0]), motion([5.0, 6.0, 7.0]), motion([1.0, 0.0])
    pair = MotionComponents(x, up, y=y)
    assert [*pair.named] == ["horizontal", "y", "vertical"]
    assert pair.samples[pair.row("y")].tolist() == [5.0, 6.0, 7.0]
    assert pair.samples[pair.row("horizontal")].tolist() == [1.0, -2.0, 0.0]  # goes on as zero
    assert MotionComponents(x, up).row("y") is None
    assert (pair.npts, pair.duration, pair.dt) == (3, 1.0, 0.5)
    assert not pair.samples.flags.writeable
    assert pair.scaled(2.0).scaled(0.25).scale == 0.5
    scaled, finer = pair.scaled(2.0), pair.finer(2)
    assert scaled.y is not None
    assert scaled.y.acceleration.tolist() == [10.0, 12.0, 14.0]
    assert finer.y is not None
    assert finer.y.acceleration.tolist() == [5.0, 5.5, 6.0, 6.5, 7.0]
    digests = {MotionComponents(x, z, y=n).digest for z in (None, up) for n in (None, y, up)}
    assert len(digests) == 6
    with pytest.raises(RecordError, match=r"the y record has dt = 0.2 s"):
        MotionComponents(x, y=motion([1.0, 2.0], 0.2))
