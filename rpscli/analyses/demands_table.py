"""Largest demands of many histories as columns.

>>> from rpscli import Bearing, PodiumStructure, demand, load_record
>>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
>>> pulse = load_record("pulse:sine?amplitude=0.4g&period=0.8")
>>> found = table(demand(podium, [pulse, pulse.scaled(0.5)]))
>>> found["outcome"].tolist(), found["max_base_shear"].tolist()
(['survived', 'survived'], [0.0, 0.0])
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.largest_demands import Demand
from rpscli.analyses.result_quantities import EVERY
from rpscli.errors import require_kind
from rpscli.shown import data_frame


class DemandTable(dict[str, NDArray[Any]]):
    """Columns by name, a row a history, in SI units; NaN where one has no such result."""

    @property
    def units(self) -> dict[str, str]:
        """SI units of the columns; ``-`` for those without one."""
        return {name: EVERY[name].unit if name in EVERY else "-" for name in self}

    def to_dataframe(self) -> Any:
        """The columns as a table of pandas, which must be installed, with their units as
        its `attrs["units"]`.
        """
        frame = data_frame(self)
        frame.attrs["units"] = self.units
        return frame


def table(demands: Iterable[Demand]) -> DemandTable:
    """Outcomes and scalar results of histories, from `demand` or `time_history`.

    Parameters
    ----------
    demands
        Their results; a column that only some have is NaN in the others.
    """
    rows = []
    for place, each in enumerate([demands] if isinstance(demands, Demand) else demands):
        require_kind(each, Demand, f"demands[{place}]", "give results of histories")
        rows.append(each.scalars())
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: [row.get(name) for row in rows] for name in names}
    return DemandTable(
        {
            name: np.array(values, dtype=None if name == "outcome" else float)
            for name, values in columns.items()
        }
    )
