"""The first compilation of the kernels, by other processes, two of them side by side.

numba takes one core for most of a minute. What the kernel calls is compiled into numba's cache, in
two parts, each by calls that have nothing to do; a third process finds them there and compiles the
kernel. The parts are chosen so that what they have in common, which is compiled twice, is little.

This process compiles nothing, but loads the kernel as later ones do. Had it parts in memory, it
would run theirs in place of the kernel's own copies of some functions, with other products and sums
rounded once, and other last bits.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, cast

import numba
import numpy as np

from rpscli.physics.core.compile import cache_folder
from rpscli.physics.core.records import NO_HISTORY, Record
from rpscli.physics.planar.driver import advance_lanes, integrate_lanes, next_history
from rpscli.physics.planar.events import go_on_restarted, resolve_step
from rpscli.physics.planar.full_contact.follow import follow_full_contact
from rpscli.physics.planar.full_contact.modal_block import integrate_fixed_base
from rpscli.physics.planar.run import empty_block, empty_run, empty_state


def compile_kernel(variant: str) -> None:
    """Compile the kernel, of any variant; what fails in a part is left to the first call."""
    compile_in_parts(__name__, variant)


def compile_in_parts(module: str, variant: str) -> None:
    """Compile two parts, then the whole, by running a module like this one.

    Without a cache, or without machine code at all, there is nothing to prepare.
    """
    if not can_prepare():
        return
    for parts in (("phases", "steps"), ("whole",)):
        with ExitStack() as running:
            others = [running.enter_context(compiling(module, part, variant)) for part in parts]
            try:
                for other in others:
                    other.wait()
            except BaseException:
                for other in others:
                    other.kill()
                raise


def can_prepare() -> bool:
    """Whether machine code is made and kept."""
    no_code = cast("Any", numba.config).DISABLE_JIT
    return bool(not no_code and cache_folder() is not None and sys.executable)


def compiling(module: str, part: str, variant: str) -> subprocess.Popen[bytes]:
    """Another process that compiles a part: it runs a module like this one."""
    # Without -P a numba.py in the working folder would be run.
    command = [sys.executable, "-P", "-m", module, part, variant]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    silent = subprocess.DEVNULL
    return subprocess.Popen(  # noqa: S603 -- this very program
        command, env=environment, stdin=silent, stdout=silent, stderr=silent
    )


def compile_phases(variant: str) -> None:
    """Full contact, what begins a phase or a history, and the building on a fixed base."""
    run, s = empty_run(1), no_histories(variant)[0]
    block = empty_block(1, variant=variant)
    follow_full_contact(s, 0, run.systems[0], block[0], run.acceleration, run.output)
    next_history(s, 0, run)
    go_on_restarted(s, 0, run.systems[0], run.output)
    floors, largest = np.empty((0, 2, 1)), np.zeros((2, 1))
    integrate_fixed_base(run.acceleration, 1.0, 1, 0, run.systems, empty_block(1), floors, largest)


def compile_whole(variant: str) -> None:
    """The kernel itself, of parts that are compiled."""
    block = empty_block(1, variant=variant)
    integrate_lanes(empty_state(1, 1, variant=variant), block, empty_run(1))


def compile_steps(variant: str) -> None:
    """Uplifted steps of all lanes, and those of one that end on an event."""
    run, state = empty_run(1), no_histories(variant)
    block = empty_block(1, variant=variant)
    advance_lanes(state, run.systems, block, run.output)
    resolve_step(state[0], 0, run.systems[0], block[0], run.output)


def no_histories(variant: str) -> Record:
    """Lanes for which there is nothing to do."""
    state = empty_state(1, variant=variant)
    state.history[:] = NO_HISTORY
    return state


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
        globals()[f"compile_{sys.argv[1]}"](sys.argv[2])
