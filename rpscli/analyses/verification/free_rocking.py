"""Free rocking of a slender block: periods and decay in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.analyses.verification.comparison import Comparison, compare, within
from rpscli.analyses.verification.structures import LINEAR, SLENDER, motion, slender_block

GROUP = "Free rocking of a slender block, R = 1 m, e = 0.9 (Housner, linear theory)"
RESTITUTION = 0.9
DT = 0.002
STARTS = (0.2, 0.5, 0.9)
"""theta/alpha at the release."""


def free_rocking() -> Iterator[Comparison]:
    """T = (4/p) acosh(1/(1 - phi)) and phi_n = 1 - sqrt(1 - e^(2n) [1 - (1 - phi_0)^2])."""
    structure = slender_block(1.0, RESTITUTION)
    p, alpha = math.sqrt(0.75 * structure.gravity), math.atan(SLENDER)
    for start in STARTS:
        settings = TimeHistorySettings(free_vibration=6.0, initial_rotation=start * alpha)
        result = time_history(structure, motion(np.zeros(2), DT), settings, with_fixed_base=False)
        impacts = [event.time for event in result.events if event.kind == "impact"]
        quarter = within(math.acosh(1.0 / (1.0 - start)) / p, LINEAR)
        where = f"phi_0 = {start:g}"
        yield compare(GROUP, f"a quarter of the period, {where}", "s", quarter, impacts[0])
        for n in (1, 2, 3):
            phi = 1.0 - math.sqrt(1.0 - RESTITUTION ** (2 * n) * (1.0 - (1.0 - start) ** 2))
            inside = (result.trace.time > impacts[n - 1]) & (result.trace.time < impacts[n])
            peak = float(np.max(np.abs(result.trace.rotation[inside])))
            # The peak lies up to half a sample from the largest sample of its parabola.
            missed = p**2 * (1.0 - phi) * DT**2 / 8.0
            known = within(phi, LINEAR + missed / phi)
            yield compare(GROUP, f"phi after {n} impacts, {where}", "-", known, peak / alpha)
            half = within(2.0 * math.acosh(1.0 / (1.0 - phi)) / p, LINEAR)
            time = impacts[n] - impacts[n - 1]
            yield compare(GROUP, f"half period after {n} impacts, {where}", "s", half, time)
