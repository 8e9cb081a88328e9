"""The loop of a storey under a prescribed drift, point by point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import building, podium

from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.impact import ImpactLaw
from rpscli.physics.follow import load_modes
from rpscli.physics.laws import slip_energy
from rpscli.physics.state import STATE, records
from rpscli.physics.storeys import base_slip, keep_slips, turn_storey

pytestmark = pytest.mark.evidence("storeys that yield", "exact")

F = 4e5  # N


@pytest.mark.parametrize("hardening", [0.0, 0.05, 0.4])
def test_a_spring_beside_one_that_slips(hardening: float) -> None:
    """h k d and (1 - h) times an elastic-perfectly plastic spring; work is stored or yielded."""
    h, above = hardening, replace(building(1), strengths=np.array([F]), hardening=hardening)
    structure = podium(1, superstructure=above, law=ImpactLaw())
    systems, s = stacked_systems([(structure, TimeHistorySettings())]), records(STATE)[0]
    s.n, s.axes, s.dt[0] = 1, 1, 0.01
    load_modes(s, 0, systems[0], 0)
    k, shear_of = float(above.stiffnesses[0]), float(systems[0].storey_shear_of[0, 0])
    limit, work, reached, lies = F / k, 0.0, 0.0, 0.0

    def put(drift: float) -> float:
        """Move there; the shear, and the work on the way added."""
        nonlocal work, reached
        before = k * reached - base_slip(s, 0, 0, k * reached)
        s.q[0, 0] = k * drift / shear_of
        keep_slips(s, 0, systems)
        shear = k * drift - base_slip(s, 0, 0, k * drift)
        work, reached = work + 0.5 * (before + shear) * (drift - reached), drift
        return float(shear)

    # on, back within the range, beyond the other end, short of both, on again, home
    for drift in (3.0 * limit, 1.5 * limit, -2.5 * limit, -1.2 * limit, 4.0 * limit, 0.0):
        to = 1.0 if drift > reached else -1.0
        end = lies + to * limit
        if yields := to * drift > to * end:
            assert put(end) == pytest.approx(h * k * end + (1.0 - h) * to * F, rel=1e-12)
            turn_storey(s, 0, systems, 1 if to > 0.0 else 0)
            lies = drift - to * limit
        expected = h * k * drift + (1.0 - h) * k * (drift - lies)
        assert put(drift) == pytest.approx(expected, rel=1e-12, abs=1e-12 * F)
        if yields:
            turn_storey(s, 0, systems, 1 if to > 0.0 else 0)
        assert s.mark[0, 0] == 0
        assert (1.0 - h) * s.middle[0, 0] == pytest.approx((1.0 - h) * lies, rel=1e-12)
        stored = 0.5 * h * k * drift**2 + 0.5 * (1.0 - h) * k * (drift - lies) ** 2
        assert work == pytest.approx(stored + s.energy_yielded[0], rel=1e-12)
        springs = 0.5 * s.omega2[0, 0] * s.q[0, 0] ** 2 + slip_energy(s, 0)
        assert springs == pytest.approx(stored, rel=1e-12, abs=1e-12 * F * limit)
    assert s.energy_yielded[0] == pytest.approx((1.0 - h) * F * 12.0 * limit, rel=1e-12)
    assert s.drift_most[0, 0] == pytest.approx(k * 4.0 * limit, rel=1e-12)
