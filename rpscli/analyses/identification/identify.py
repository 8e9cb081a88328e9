"""What a test of a structure says about its case: estimates, the keys that they are, remarks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rpscli.analyses.identification import Estimate, Identified
from rpscli.analyses.identification.rocking import rocking
from rpscli.analyses.identification.vibration import vibration
from rpscli.errors import AnalysisError, UsageError
from rpscli.model.contact import Contact
from rpscli.model.podium import Array, PodiumStructure

_ROTATION = (("rotation", "rad"), ("cap_beam_displacement", "m"))
_FLOOR, _GROUND = (("floor_acceleration", "m/s2"),), (("ground_acceleration", "m/s2"),)
TESTS = {
    "rocking": (_ROTATION,),
    "ambient": (_FLOOR,),
    "release": (_FLOOR,),
    "earthquake": (_FLOOR, _GROUND),
}
"""Columns that each test needs besides the time, one of each group, and their SI units."""


def identified(structure: PodiumStructure, test: str, columns: Mapping[str, Array]) -> Identified:
    """What one of the `TESTS` says of a structure, from columns (n,) in SI units by name."""
    found = (_rocking if test == "rocking" else _vibration)(structure, test, columns)
    for (name, _), value in found.estimates.items():
        if not value.determined:
            unknown = f"; {name} is not determined: its interval is not narrower than its value"
            found = found._replace(remarks=found.remarks + unknown)
    return found


def _rocking(structure: PodiumStructure, _: str, columns: Mapping[str, Array]) -> Identified:
    rotation = columns.get("rotation")
    if rotation is None:
        beam = columns["cap_beam_displacement"]
        x = np.linspace(0.0, structure.critical_rotation, 2001)
        rotation = np.sign(beam) * np.interp(np.abs(beam), structure.path(x)[1], x)
    return rocking(structure, columns["time"], rotation)


def _vibration(structure: PodiumStructure, test: str, columns: Mapping[str, Array]) -> Identified:
    building = structure.superstructure
    if building is None:
        raise UsageError(f"{test}: without storeys there is no period before uplift; use rocking")
    time, fixed = columns["time"], float(building.periods[0])
    step = float(time[-1] - time[0]) / (len(time) - 1)
    ground = columns.get("ground_acceleration")
    found = vibration(fixed, step, columns["floor_acceleration"], ground, free=test == "release")
    ratio = Estimate(*(value / fixed for value in found.period))
    estimates = {("period", "s"): found.period, ("damping", "-"): found.damping}
    estimates["period_ratio", "-"] = ratio
    remarks = f"period_ratio is over {fixed:.4g} s, the period of the case on a fixed base"
    if ground is not None:
        remarks += "; noise in the record of the ground is not in the intervals, which are too"
        remarks += " narrow by it"
    keys: dict[str, str] = {}
    if not ratio.low > 1.0:
        remarks += "; 1, which is rigid contact, is not excluded"
        return Identified(estimates, keys, found.misfit, remarks)
    try:
        soft = [replace(structure, contact=Contact("plane", each)).bed for each in ratio]
    except ValueError as error:
        raise AnalysisError(f"period_ratio = {ratio.value:.4g}: {error}") from None
    best, stiffest, softest = (bed for bed in soft if bed is not None)
    both = (best.stiffness, softest.stiffness, stiffest.stiffness)
    estimates["stiffness", "N/m"] = Estimate(*both)
    sunk = [bed.settlement for bed in (best, stiffest, softest) if bed.settlement is not None]
    if len(sunk) == 3:
        estimates["settlement", "m"] = Estimate(*sunk)
    keys["podium.contact.period_ratio"] = f"{ratio.value:.4g}"
    keys["podium.contact.kind"] = "plane"
    remarks += "; stiffness of the storey in full contact; a period does not show whether ends are"
    remarks += " `plane`, which the settlement is for, or `edges`: try both"
    return Identified(estimates, keys, found.misfit, remarks)
