"""Whole histories of shipped motions against a second integrator.

Its unknowns are the tilt and the storey drifts, its mass matrix is full, its steps are those of
DOP853, and full contact is a matrix exponential; it shares nothing with the kernels. It is too slow
to run here: a test of the program computes the numbers below again.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import rpscli.records
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification.comparison import Comparison, Known, compare, within
from rpscli.analyses.verification.structures import FLAT, paper_podium
from rpscli.records.source import load_record

GROUP = "Earthquakes against a second integrator (DOP853 in tilt and drifts)"
FREE_VIBRATION = 2.0
ACCURACY = 4.0
"""Steps a quarter as long as usual: both integrators are converged then."""

CONVERGED = 2e-7
"""Impacts multiply what is left of the errors of both."""


class Reference(NamedTuple):
    """A history, and what the second integrator finds: max |theta| [rad], V_b/V_st, impacts.

    Parameters
    ----------
    record
        Name of a shipped motion.
    storeys, tan_alpha, rho
        Of the paper's structure.
    max_rotation
        max |theta| [rad].
    base_shear_ratio
        V_b/V_st.
    impacts
        How many.
    """

    record: str
    storeys: int
    tan_alpha: float
    rho: float
    max_rotation: float
    base_shear_ratio: float
    impacts: int


REFERENCES = (
    Reference("synthetic_far_field", 3, 0.10, 1.5, 0.0702881264, 2.252459866, 52),
    Reference("synthetic_far_field", 3, 0.15, 0.25, 0.0736422804, 2.233656228, 209),
    Reference("synthetic_near_field_pulse", 2, 0.20, 1.5, 0.0425053056, 2.764409418, 124),
    Reference("synthetic_near_field_pulse", 3, 0.20, FLAT, 0.2207060255, 2.437501670, 111),
)


def shipped_record(name: str) -> str:
    """Source of a motion that comes with the program."""
    return str(Path(rpscli.records.__file__).with_name("shipped") / f"{name}.at2")


def histories() -> Iterator[Comparison]:
    """Largest rotation and base shear, and the number of impacts."""
    settings = TimeHistorySettings(
        free_vibration=FREE_VIBRATION, accuracy=ACCURACY, recontact_rule="relative"
    )
    for row in REFERENCES:
        structure = paper_podium(row.storeys, row.tan_alpha, row.rho)
        record = load_record(shipped_record(row.record))
        result = time_history(structure, record, settings, with_fixed_base=False)
        ends = f"rho = {row.rho:g}" if row.rho else "flat"
        short = row.record.removeprefix("synthetic_").replace("_", " ")
        where = f"{short}, n = {row.storeys}, tan a = {row.tan_alpha:g}, {ends}"
        shear = result.max_base_shear / structure.static_base_shear
        for name, unit, known, computed in (
            ("theta", "rad", within(row.max_rotation, CONVERGED), result.max_rotation),
            ("V_b/V_st", "-", within(row.base_shear_ratio, CONVERGED), shear),
            ("impacts", "-", Known(float(row.impacts), 0.0), float(result.impacts)),
        ):
            yield compare(GROUP, f"{name}, {where}", unit, known, computed)
