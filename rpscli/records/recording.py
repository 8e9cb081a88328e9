"""What is known of where a motion was recorded: for clusters, filters and regressions."""

from __future__ import annotations

from typing import NamedTuple


class Recording(NamedTuple):
    """An earthquake and a station; empty or None where the source does not say.

    `event` is the earthquake with its year, `number` that of the record in the NGA-West databases
    of PEER, `distance` the closest one to the rupture [m], `vs30` [m/s] that of the ground,
    `usable_period` the longest that the filters of the record leave [s], `pulse` whether it was
    found to have a velocity pulse.
    """

    event: str = ""
    station: str = ""
    number: int | None = None
    magnitude: float | None = None
    distance: float | None = None
    vs30: float | None = None
    usable_period: float | None = None
    pulse: bool | None = None


UNKNOWN = Recording()
