"""Laws by themselves: slopes of geometry and inertia, what friction holds, a storey's loop."""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import building, podium
from two_components import frame

from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, RollingResistance
from rpscli.model.impact import ImpactLaw
from rpscli.physics.bed import first_phase, load_bed
from rpscli.physics.beginning import load_modes, load_system
from rpscli.physics.devices.acting import load_devices
from rpscli.physics.energy import slip_energy
from rpscli.physics.friction import grip_of
from rpscli.physics.lane import place_of
from rpscli.physics.records import records
from rpscli.physics.state import STATE
from rpscli.physics.storeys import base_slip, keep_slips, turn_storey
from rpscli.physics.upright import enter_phase, set_polar

F = 4e5  # N
ARCS = {"tan_wedge": 0.3, "rho": 0.5}
PLANE, EDGES = (Contact(kind, period_ratio=1.2) for kind in ("plane", "edges"))
ENDS = {
    "rigid": {"rho": 0.0},
    "rigid arcs": ARCS,
    "plane": {"contact": PLANE},
    "plane arcs": {"contact": PLANE, **ARCS},
    "edges": {"contact": EDGES},
    "edges arcs": {"contact": EDGES, **ARCS},
    "spherical": {"tan_alpha": 0.0, "tan_wedge": 0.3, "rho": 0.8},
}
DAMPER, ROLLING = FrictionDamper(5e4), RollingResistance(0.004)
FRICTION = {
    "friction": (DAMPER,),
    "rolling": (ROLLING,),
    "friction and rolling": (DAMPER, ROLLING),
}


def lane_of(structure):
    """A lane of the kernel in the phase in which a tilt to any side grows, at none."""
    state = records(STATE, 1, 2, 1)[0]
    system = stacked_systems([(structure, TimeHistorySettings())], pairs=True)[0]
    load_system(state, 0, system)
    load_devices(state, 0, system)
    load_bed(state, 0, system)
    enter_phase(state, 0, system, first_phase(system))
    return state


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_slopes_are_what_differences_tend_to(end, part):
    """Central differences of order 4 over parts of a thousandth leave some 1e-11."""
    state = lane_of(frame(3, 3.0, **ENDS[end]))
    low = max(state.x_low[0], 0.0)
    tilt = low + part * (min(state.x_high[0], 0.3) - low)
    step, at = 1e-3 * tilt, place_of(state, 0, tilt)
    around = [place_of(state, 0, tilt + k * step) for k in (-2, -1, 1, 2)]
    slopes = {
        "Bv": at.Bv_slope,
        "A": 2.0 * at.D,
        "h": at.dh,
        "K": at.K_slope,
        "G": at.G_slope,
    }
    for name, slope in slopes.items():
        values = np.array([getattr(each, name) for each in around])
        difference = np.array([1.0, -8.0, 8.0, -1.0]) @ values / (12.0 * step)
        assert slope == pytest.approx(difference, rel=1e-9, abs=1e-9)
    assert at.cone == pytest.approx((at.K - at.A) / tilt, rel=1e-9, abs=1e-11)


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("kind", ["friction", "rolling", "friction and rolling"])
def test_what_is_held_is_held_against_every_direction(kind):
    """Q.d <= P |W d| + M for 360 vectors d, on either side of the margin's zero."""
    left = lane_of(replace(frame(3, 3.0, **ENDS["spherical"]), devices=FRICTION[kind]))
    set_polar(left, 0, 0.12, 0.6, 0.8, 0.0, 0.0)
    at = place_of(left, 0, 0.12)
    P = left.share[0] * left.friction_force[0]
    M = left.share[0] * left.friction_moment[0] / left.diameter[0]
    back = at.Bv * left.weigh[0] * left.gravity[0]
    angles = np.radians(np.arange(0.0, 360.0, 0.25))
    d = np.array([np.cos(angles), np.sin(angles)])
    most = P * np.hypot(at.C * d[0], at.h * d[1]) + M
    rng = np.random.default_rng(5)
    signs = set()
    for _ in range(200):
        n, t = rng.normal(0.0, 1.5 * (P + M), 2)
        z = (0.6 * (n + back / at.C) - 0.8 * t, 0.8 * (n + back / at.C) + 0.6 * t)
        grip = grip_of(left, 0, z, (0.0, 0.0), (left.gravity[0], 0.0), 0.0)
        margin = np.min(most - at.C * n * d[0] - at.h * t * d[1])
        if abs(margin) > 1e-4 * (P + M):
            assert (margin >= 0.0) == (grip.margin >= 0.0)
            assert (grip.used <= 1.0) == (margin >= 0.0)
            signs.add(margin >= 0.0)
    assert len(signs) == 2


@pytest.mark.evidence("storeys that yield", "exact")
@pytest.mark.parametrize("hardening", [0.0, 0.05, 0.4])
def test_a_spring_beside_one_that_slips(hardening):
    """h k d and (1 - h) times an elastic-perfectly plastic spring; work is stored or yielded."""
    h, above = (
        hardening,
        replace(building(1), strengths=np.array([F]), hardening=hardening),
    )
    structure = podium(1, superstructure=above, law=ImpactLaw())
    systems, s = stacked_systems([(structure, TimeHistorySettings())]), records(STATE)[0]
    s.n, s.axes, s.dt[0] = 1, 1, 0.01
    load_modes(s, 0, systems[0], 0)
    k, shear_of = float(above.stiffnesses[0]), float(systems[0].storey_shear_of[0, 0])
    limit, work, reached, lies = F / k, 0.0, 0.0, 0.0

    def put(drift):
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
