"""The first compilation of the kernels, by two processes side by side.

numba takes one core for half a minute. The two halves of the kernel are compiled into its cache,
one here and one by a second process, each by a call that has nothing to do; the kernel then finds
them there.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any, cast

import numba
import numpy as np

from rpscli.physics.compile import cache_folder
from rpscli.physics.driver import advance_lanes, switch_lane
from rpscli.physics.full_contact.fixed_base import integrate_fixed_base
from rpscli.physics.run import empty_run, empty_state
from rpscli.physics.state import GOES_ON


def compile_beside() -> None:
    """Compile both halves; what fails is left to the first call.

    Without a cache, or without machine code at all, there is nothing to prepare.
    """
    if cast("Any", numba.config).DISABLE_JIT or cache_folder() is None or not sys.executable:
        return
    command = [sys.executable, "-m", __name__]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    silent = subprocess.DEVNULL
    with subprocess.Popen(  # noqa: S603 -- this very program
        command, env=environment, stdin=silent, stdout=silent, stderr=silent
    ) as other:
        try:
            compile_switches()
        except BaseException:
            other.kill()
            raise


def compile_switches() -> None:
    """What is done for one lane."""
    switch_lane(empty_state(1), 0, GOES_ON, empty_run(1))


def compile_steps() -> None:
    """What is done for all lanes, and the building on a fixed base."""
    run = empty_run(1)
    advance_lanes(empty_state(1), run.systems, run.block, run.output.log)
    floors, largest = np.empty((0, 2, 1)), np.zeros((2, 1))
    integrate_fixed_base(run.acceleration, 1.0, run.systems, run.block, floors, largest)


if __name__ == "__main__":
    compile_steps()
