"""The first compilation of the kernel, by two processes side by side.

numba takes one core for more than a minute. What the kernel calls is compiled into numba's cache by
calls that have nothing to do: a step of all lanes in another process, what is done for one lane
alone and then the kernel in this one, which finds both there.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import numba
import numpy as np

from rpscli.physics.compile import cache_folder
from rpscli.physics.follow import advance, follow, look_after, next_history
from rpscli.physics.run import Output
from rpscli.physics.state import (
    EVENT,
    NO_HISTORY,
    REQUEST,
    RESULT,
    SAMPLE,
    STATE,
    SYSTEM,
    Record,
    records,
)


def can_prepare() -> bool:
    """Whether machine code is made and kept."""
    no_code = cast("Any", numba.config).DISABLE_JIT
    return bool(not no_code and cache_folder() is not None and sys.executable)


def compile_kernel(ways: int, lanes: int) -> None:
    """Compile the kernel for so many directions and lanes; what fails is left to the first call.

    Without a cache, or without machine code at all, there is nothing to prepare.
    """
    if not can_prepare():
        return
    # Without -P a numba.py in the working folder would be run.
    command = [sys.executable, "-P", "-m", __name__, str(ways), str(lanes)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    silent = subprocess.DEVNULL
    with subprocess.Popen(  # noqa: S603 -- this very program
        command, env=environment, stdin=silent, stdout=silent, stderr=silent
    ) as other:
        try:
            with garbage_kept():
                compile_alone(ways, lanes)
                other.wait()
                compile_whole(ways, lanes)
        except BaseException:
            other.kill()
            raise


def nothing_to_do(ways: int, lanes: int) -> tuple[Record, Record, Record, Record, Output]:
    """A state without histories, systems of zeros, no requests, no results, no output."""
    state = records(STATE, 1, ways, lanes)
    state.history[:] = NO_HISTORY
    none = np.empty((0, 4, 0)), np.empty((0, 4, 0))
    output = Output(records(SAMPLE, 0), none[0], records(EVENT, 0), none[1])
    return state, records(SYSTEM, ways), records(REQUEST, 0), records(RESULT, 0), output


def compile_steps(ways: int, lanes: int) -> None:
    """A step of all lanes."""
    state, systems, _, _, output = nothing_to_do(ways, lanes)
    advance(state[0], systems, output)


def compile_alone(ways: int, lanes: int) -> None:
    """What is done for one lane alone."""
    state, systems, requests, results, output = nothing_to_do(ways, lanes)
    state.outcome[:] = 0
    look_after(state[0], 0, systems, output)
    next_history(state[0], 0, systems, requests, np.empty(0), results, output)


def compile_whole(ways: int, lanes: int) -> None:
    """The kernel itself, of parts that are compiled."""
    state, systems, requests, results, output = nothing_to_do(ways, lanes)
    follow(state, systems, requests, np.empty(0), results, output)


@contextmanager
def garbage_kept() -> Iterator[None]:
    """Without looking for garbage, which costs the compiler a tenth of its time."""
    collected = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collected:
            gc.enable()


if __name__ == "__main__":
    with garbage_kept():
        compile_steps(int(sys.argv[1]), int(sys.argv[2]))
