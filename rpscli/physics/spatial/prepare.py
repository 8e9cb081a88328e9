"""The first compilation of the kernel for both components, as `planar.prepare`."""

from __future__ import annotations

import sys

import numpy as np

from rpscli.physics.core.records import NO_HISTORY, Record, records
from rpscli.physics.planar.prepare import compile_in_parts, garbage_kept
from rpscli.physics.planar.run import Output, Run
from rpscli.physics.planar.state import BLOCK, REQUEST, SYSTEM
from rpscli.physics.spatial.driver import advance_lanes_3d, integrate_lanes_3d, next_history_3d
from rpscli.physics.spatial.events import resolve_step_3d
from rpscli.physics.spatial.full_contact import follow_full_contact_3d
from rpscli.physics.spatial.state import EVENT_3D, RESULT_3D, SAMPLE_3D, STATES_3D


def compile_pairs(variant: str) -> None:
    """Compile the kernel; what fails in a part is left to the first call."""
    compile_in_parts(__name__, variant)


def nothing_to_do(variant: str) -> tuple[Record, Record, Run]:
    """Lanes without histories, blocks, and a run of one structure of zeros."""
    state = records(STATES_3D[variant])
    state.lanes, state.history[:] = 1, NO_HISTORY
    output = Output(
        records(SAMPLE_3D, 0), np.empty((0, 2, 0)), records(EVENT_3D, 0), np.empty((0, 4, 0))
    )
    systems, requests = records(SYSTEM, 2), records(REQUEST, 0)
    return (
        state,
        records(BLOCK, 2),
        Run(systems, requests, np.empty(0), records(RESULT_3D, 0), output),
    )


def compile_phases(variant: str) -> None:
    """Full contact, and what begins a history."""
    state, blocks, run = nothing_to_do(variant)
    follow_full_contact_3d(state[0], 0, run.systems, blocks, run.acceleration, run.output)
    next_history_3d(state[0], 0, run)


def compile_whole(variant: str) -> None:
    """The kernel itself, of parts that are compiled."""
    integrate_lanes_3d(*nothing_to_do(variant))


def compile_steps(variant: str) -> None:
    """Steps of all lanes, and those of one that end on an event."""
    state, blocks, run = nothing_to_do(variant)
    advance_lanes_3d(state, run.systems, blocks, run.output)
    resolve_step_3d(state[0], 0, run.systems, blocks[0], run.output)


if __name__ == "__main__":
    with garbage_kept():
        globals()[f"compile_{sys.argv[1]}"](sys.argv[2])
