"""Arrays that histories need while they run, and those that keep their results."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.state import Floats, Record


class KernelOutput(NamedTuple):
    """Samples and events of a history that is run by itself; of many,
    give no rows to keep none.

    Without room for samples no energy is audited; events beyond the
    log's rows are only counted.
    """

    samples: Record  # (rows,) `interface.SAMPLE`
    floors: NDArray[
        np.float64
    ]  # (rows, 4, axes n) u, u' over the ground, absolute u'', plastic drift
    log: Record  # (rows,) `interface.EVENT`
    devices: NDArray[
        np.float64
    ]  # (rows, 4, devices) force [N], path [m], energy lost, stored [J]
    finer: int = (
        1  # rows a sample: even parts of the interval at which the motion is kept as well
    )


class KernelRun(NamedTuple):
    """Histories to run, and what they leave behind; all arrays
    of records but the floats.
    """

    systems: Record  # (S,) `interface.SYSTEM`, all of the same number of storeys n
    requests: Record  # (P,) `interface.REQUEST`: the histories
    acceleration: (
        Floats  # records of the ground end to end [m/s2], linear between their samples
    )
    results: Record  # (P,) `interface.RESULT`: written
    output: KernelOutput  # samples and events, where there is one history: written
    ways: int = 1  # horizontal components: 2 with two systems of each structure
