"""Measurements on a standing structure, and what they say about its case, with intervals.

Restitution and rolling resistance come from free rocking, first period and damping
before uplift from accelerations of a floor.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rpscli.model.podium import Array, PodiumStructure
from rpscli.tools.identify.estimates import Identified
from rpscli.tools.identify.rocking import rocking
from rpscli.tools.identify.vibration import vibration_of_case

_ROTATION = (("rotation", "rad"), ("cap_beam_displacement", "m"))
_FLOOR = (("floor_acceleration", "m/s2"),)
_GROUND = (("ground_acceleration", "m/s2"),)
TESTS = {
    "rocking": (_ROTATION,),
    "ambient": (_FLOOR,),
    "release": (_FLOOR,),
    "earthquake": (_FLOOR, _GROUND),
}
"""Columns that each test needs besides the time, one of each
group, and their SI units."""


def identified(
    structure: PodiumStructure, test: str, columns: Mapping[str, Array]
) -> Identified:
    """Properties of a structure that one of the `TESTS` shows, from columns (n,) in SI
    units by name.
    """
    if test == "rocking":
        if (rotation := columns.get("rotation")) is None:
            beam = columns["cap_beam_displacement"]
            x = np.linspace(0.0, structure.critical_rotation, 2001)
            rotation = np.sign(beam) * np.interp(np.abs(beam), structure.path(x)[1], x)
        found = rocking(structure, columns["time"], rotation)
    else:
        found = vibration_of_case(structure, test, columns)
    for (name, _), value in found.estimates.items():
        if not value.determined:
            unknown = (
                f"; {name} is not determined: its interval is not narrower than its value"
            )
            found = found._replace(remarks=found.remarks + unknown)
    return found
