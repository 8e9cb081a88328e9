"""A run that is interrupted has ended when the next one takes its memory."""

from __future__ import annotations

import signal
import time

import numpy as np
import pytest

from rpscli.physics.follow import hear
from rpscli.physics.state import Field, records

pytestmark = pytest.mark.posix  # it is interrupted by a signal


class Interrupted(BaseException):
    """What Ctrl-C is."""


def test_an_interruption_waits_for_the_end_of_the_kernel() -> None:
    state = records((Field("stop", "", "-", "asked for"),))
    ended = []

    def slow_to_hear() -> None:
        while state.view(np.ndarray)["stop"][0] == 0:
            time.sleep(0.01)
        time.sleep(0.3)  # a machine with other work
        ended.append(True)

    def interrupt(number: int, frame: object) -> None:
        raise Interrupted

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.15)
    try:
        with pytest.raises(Interrupted):
            hear(slow_to_hear, state)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert ended
