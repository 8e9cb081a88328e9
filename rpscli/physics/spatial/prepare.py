"""The first compilation of the kernel for both components, by two other processes.

This process finds the parts in numba's cache. Were they compiled here, the compiler would merge
them into what calls them, and round other sums: a history would not have the same bits in the
process that compiled its kernel and in the next.
"""

from __future__ import annotations

import sys

import numpy as np

from rpscli.physics.core.records import NO_HISTORY, Record, records
from rpscli.physics.planar.prepare import can_prepare, compiling, garbage_kept
from rpscli.physics.planar.run import Output, Run
from rpscli.physics.planar.state import BLOCK, REQUEST, SYSTEM
from rpscli.physics.spatial.driver import advance_lanes_3d, integrate_lanes_3d, next_history_3d
from rpscli.physics.spatial.events import resolve_step_3d
from rpscli.physics.spatial.full_contact import follow_full_contact_3d
from rpscli.physics.spatial.state import EVENT_3D, RESULT_3D, SAMPLE_3D, STATE_3D

PARTS = ("contact", "steps")


def compile_pairs() -> None:
    """Compile the kernel; what fails in a part is left to the first call."""
    if not can_prepare():
        return
    others = [compiling(__name__, part) for part in PARTS]
    try:
        for other in others:
            other.wait()
        with garbage_kept():
            integrate_lanes_3d(nothing_to_do(), records(BLOCK, 2), no_run())
    except BaseException:
        for other in others:
            other.kill()
        raise


def nothing_to_do() -> Record:
    """Lanes without histories."""
    state = records(STATE_3D)
    state.lanes, state.history[:] = 1, NO_HISTORY
    return state


def no_run() -> Run:
    """No history at all, of one structure of zeros."""
    output = Output(
        records(SAMPLE_3D, 0), np.empty((0, 2, 0)), records(EVENT_3D, 0), np.empty((0, 4, 0))
    )
    systems, requests = records(SYSTEM, 2), records(REQUEST, 0)
    return Run(systems, requests, np.empty(0), records(RESULT_3D, 0), output)


def compile_part(part: str) -> None:
    """Full contact and what begins a history; or steps, and those that end on an event."""
    state, run, blocks = nothing_to_do(), no_run(), records(BLOCK, 2)
    both = run.systems[0], run.systems[1]
    if part == "contact":
        follow_full_contact_3d(state[0], 0, both, blocks, run.acceleration, run.output)
        next_history_3d(state[0], 0, run)
    else:
        advance_lanes_3d(state, run.systems, blocks, run.output)
        resolve_step_3d(state[0], 0, both, blocks[0], run.output)


if __name__ == "__main__":
    with garbage_kept():
        compile_part(sys.argv[1])
