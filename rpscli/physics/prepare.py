"""The first compilation of the kernel, by two processes side by side.

numba takes one core for half a minute. What the kernel calls is compiled into numba's cache before
it: a step of all lanes in another process, what is done for one lane alone and then the kernel, by
a call that has nothing to do, in this one, which finds both there.
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
from numba.core import types

from rpscli.physics.compile import cache_folder
from rpscli.physics.fields import Fields, Rows
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


def inside(ways: int, lanes: int) -> tuple[Any, ...]:
    """Types of the same within the kernel."""
    state, *others = nothing_to_do(ways, lanes)
    *rows, output = map(numba.typeof, others)
    samples, floors, log, devices, finer = output.types
    kept = types.NamedTuple((Rows(samples.dtype), floors, Rows(log.dtype), devices, finer), Output)
    return Fields(numba.typeof(state).dtype), *(Rows(kind.dtype) for kind in rows), kept


def compile_steps(ways: int, lanes: int) -> None:
    """A step of all lanes."""
    state, systems, _, _, output = inside(ways, lanes)
    cast("Any", advance).compile((state, systems, output))


def compile_alone(ways: int, lanes: int) -> None:
    """What is done for one lane alone."""
    state, systems, requests, results, output = inside(ways, lanes)
    lane, acceleration = numba.intp, numba.float64[::1]
    cast("Any", look_after).compile((state, lane, systems, output))
    given = state, lane, systems, requests, acceleration, results, output
    cast("Any", next_history).compile(given)


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
