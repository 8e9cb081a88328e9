"""The first compilation of the kernels, by two processes side by side.

numba takes one core for half a minute. What the kernel calls is compiled into numba's cache, one
part here and one by a second process, each by calls that have nothing to do; the kernel then finds
it there.
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
from rpscli.physics.driver import advance_lanes, integrate, stand_lane, switch_lane
from rpscli.physics.full_contact.fixed_base import integrate_fixed_base
from rpscli.physics.run import empty_run, empty_state
from rpscli.physics.state import GOES_ON


def compile_kernel() -> None:
    """Compile the kernel; what fails in a part is left to the first call.

    Without a cache, or without machine code at all, there is nothing to prepare.
    """
    if cast("Any", numba.config).DISABLE_JIT or cache_folder() is None or not sys.executable:
        return
    command = [sys.executable, "-m", __name__]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    silent = subprocess.DEVNULL
    with (
        garbage_kept(),
        subprocess.Popen(  # noqa: S603 -- this very program
            command, env=environment, stdin=silent, stdout=silent, stderr=silent
        ) as other,
    ):
        try:
            compile_one_lane()
            other.wait()
            integrate(empty_run(1), 1)
        except BaseException:
            other.kill()
            raise


def compile_one_lane() -> None:
    """What is done for one lane: it stands, or switches; both call much that is the same."""
    switch_lane(empty_state(1), 0, GOES_ON, empty_run(1))
    stand_lane(empty_state(1), 0, GOES_ON, empty_run(1))


def compile_all_lanes() -> None:
    """Steps of all lanes, and the building on a fixed base."""
    run, floors, largest = empty_run(1), np.empty((0, 2, 1)), np.zeros((2, 1))
    advance_lanes(empty_state(1), run.systems, run.block, run.output.log)
    integrate_fixed_base(run.acceleration, 1.0, run.systems, run.block, floors, largest)


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
        compile_all_lanes()
