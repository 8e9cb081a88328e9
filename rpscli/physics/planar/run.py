"""What histories need while they run, and where their results go."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.core.records import LANES, Floats, Record, records
from rpscli.physics.planar.state import (
    BLOCKS,
    EVENT,
    REQUEST,
    RESULT,
    SAMPLE,
    STATES,
    SYSTEM,
)


class Output(NamedTuple):
    """Samples and events of a history that is run by itself; of many, give no rows to keep none.

    Without room for samples no energy is audited; events beyond the log's rows are only counted.
    """

    samples: Record  # (rows,) `state.SAMPLE`
    floors: NDArray[np.float64]  # (rows, 2, n) u and u' of the floors over the ground [m, m/s]
    log: Record  # (rows,) `state.EVENT`
    devices: NDArray[np.float64]  # (rows, 4, devices) force [N], path [m], energy lost, stored [J]
    finer: int = 1  # rows a sample: even parts of the interval at which the motion is kept as well


class Run(NamedTuple):
    """Histories to run, and what they leave behind; all arrays of records but the floats."""

    systems: Record  # (S,) `state.SYSTEM`, all of the same number of storeys n
    requests: Record  # (P,) `state.REQUEST`: the histories
    acceleration: Floats  # records of the ground end to end [m/s2], linear between their samples;
    # behind them what full contact on beds makes of states
    results: Record  # (P,) `state.RESULT`: written
    output: Output  # samples and events, where there is one history: written


def variant_of(run: Run) -> str:
    """Which of `state.STATES` the structures of a run ask for."""
    systems = run.systems.view(np.ndarray)  # fields of records take ten times as long
    if systems["compliant"].any():
        return "compliant"
    return "devices" if systems["devices"].any() else "plain"


def empty_state(storeys: int, lanes: int = LANES, *, variant: str = "plain") -> Record:
    """Lanes with nothing to do, an array of one record; all of them are used, or one."""
    state = records(STATES[variant])
    state.n, state.lanes = storeys, lanes
    return state


def empty_block(storeys: int, *, variant: str = "plain") -> Record:
    """Room for a block of steps in full contact, an array of one record."""
    block = records(BLOCKS[variant])
    block.n = storeys
    return block


def empty_run(storeys: int) -> Run:
    """No history at all, of one structure of zeros."""
    systems = records(SYSTEM)
    systems.n = storeys
    return Run(
        systems=systems,
        requests=records(REQUEST, count=0),
        acceleration=np.empty(0),
        results=records(RESULT, count=0),
        output=Output(
            samples=records(SAMPLE, count=0),
            floors=np.empty((0, 2, storeys)),
            log=records(EVENT, count=0),
            devices=np.empty((0, 4, 0)),
        ),
    )
