"""Say whether histories have the same bits alone and in lanes, by kernels that others compiled."""

from __future__ import annotations

import numpy as np
from two_components import frame, pair, two_pulses

from rpscli.analyses.demand import Request, demands
from rpscli.analyses.settings import TimeHistorySettings


def main() -> None:
    x, y = two_pulses()
    arcs = frame(3, 3.0, tan_wedge=0.3, rho=0.5, contact_time=2e-3)
    settings = TimeHistorySettings(free_vibration=2.0)
    requests = [
        Request(structure, pair(factor * x, y, 0.01), settings)
        for structure in (arcs, frame(3, 3.0))
        for factor in np.linspace(0.5, 1.6, 20)
    ]
    together, alone = demands(requests), demands(requests, worth_lanes=1000)
    assert len({one.max_rotation for one in together}) > len(requests) / 2  # some overturn
    for one, other in zip(together, alone, strict=True):
        assert one.history.tobytes() == other.history.tobytes()


if __name__ == "__main__":
    main()
