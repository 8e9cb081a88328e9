"""What assumptions of the model hide: sizes in the table of THEORY.md, section 2.

Bodies in contact that do otherwise than the model assumes, beside the program: the eight seconds
with most energy of records of FEMA P695, two columns under a building of the paper.
"""

from dataclasses import replace
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy as np
import pytest
from paper_structures import (
    needs_compiled_kernels,
    oracle_system,
    part,
    podium,
)

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw

from .multibody import Departures, simulate, turning_points
from .resolved_contact import WINDOW, strongest
from .resolved_contact import structure_of as long_arcs
from .storey_lagrangian import StoreyLagrangian

pytestmark = [
    pytest.mark.long,
    needs_compiled_kernels,
    pytest.mark.skipif(
        find_spec("mujoco") is None,
        reason="the physics engine is not installed: pip install rpscli[contact]",
    ),
]

SCALES = {0.15: 1.0, 0.30: 1.5, 0.40: 2.0}
"""Of the records: stouter columns lift later."""

PLASTIC = {"closing_damping": 4.0}
"""Contacts that stay closed; critically damped ones part again with 0.135 of the velocity."""

TILTING = {"level": False}
FLOORS_ABOVE = Departures(storey_height=3.0, spacing=12.0)
FAR, NEAR, LATE = "farfield/1/b", "nearfield_pulse/9/a", "farfield/6/a"


class Size(NamedTuple):
    """Change of the largest rotation and base shear against the program, in per cent.

    `within` is some twice what half the step changes, or what is left where nothing changes.
    """

    assumption: str
    record: str
    rotation: float
    base_shear: float
    within: float
    options: dict[str, Any]
    departures: Departures = Departures()
    tan_alpha: float = 0.15
    rho: float = 0.5
    storeys: int = 3
    start: float | None = None


SIZES = (
    Size("springs pass no impulse", FAR, 0.0, 0.0, 0.3, {}),
    Size("springs pass no impulse", NEAR, 0.0, -0.5, 0.3, {}),
    Size("springs pass no impulse", LATE, 0.0, 0.0, 0.3, {}),
    Size("contacts that stay closed", FAR, 0.0, 0.0, 0.1, PLASTIC, tan_alpha=0.30),
    Size("friction of 1.3", FAR, 0.0, 0.0, 0.1, PLASTIC, Departures(0.195)),
    Size("friction of 1.3", NEAR, 0.0, 0.0, 0.1, PLASTIC, Departures(0.39), 0.30),
    Size("level, closed", FAR, 0.0, 0.0, 0.1, TILTING | PLASTIC, FLOORS_ABOVE, rho=0.0),
    Size("level, closed", LATE, 0.0, 0.0, 0.1, TILTING | PLASTIC, FLOORS_ABOVE),
    Size("level, closed", FAR, 0.0, 0.0, 0.1, TILTING | PLASTIC, FLOORS_ABOVE, 0.30),
    Size("level, lifts off", NEAR, -0.5, 0.0, 0.2, TILTING | PLASTIC, FLOORS_ABOVE, 0.30),
    Size(
        "level, lifts off", FAR, 34.6, -36.0, 0.5, TILTING | PLASTIC, FLOORS_ABOVE, 0.40
    ),
    Size("level, rebound", FAR, 3.0, -1.5, 2.0, TILTING, FLOORS_ABOVE, rho=0.0),
    Size(
        "level, rebound", FAR, -13.0, -3.4, 3.0, TILTING, FLOORS_ABOVE, rho=0.0, start=2.0
    ),
    Size("level, rebound", LATE, 9.0, 1.0, 2.0, TILTING, FLOORS_ABOVE),
    Size("vertical", FAR, -1.4, 15.5, 1.0, {"vertical_period": 0.1}),
    Size("vertical", FAR, -21.0, -3.6, 1.0, {"vertical_period": 0.25}),
    Size("vertical", NEAR, -2.7, 43.6, 1.0, {"vertical_period": 0.1}),
    Size("vertical", NEAR, -5.8, 55.0, 1.0, {"vertical_period": 0.1}, storeys=6),
)


class Walk(NamedTuple):
    """Contacts that rebound: the beam is carried over its columns [m]."""

    tan_alpha: float
    record: str
    rotation: tuple[float, float]
    base_shear: tuple[float, float]
    least: float


# Ranges of the step and of half of it, and a margin. At 0.40 the second history parts with it.
WALKS = (
    Walk(0.30, FAR, (-2.0, 1.0), (-15.0, -9.0), 4e-3),
    Walk(0.30, NEAR, (-3.5, 0.0), (-15.0, -10.0), 14e-3),
    Walk(0.40, FAR, (-3.0, 5.0), (-15.0, -8.0), 40e-3),
    Walk(0.40, NEAR, (-33.0, -10.0), (-15.0, -8.0), 100e-3),
)


def structure_of(tan_alpha, rho, storeys):
    """Of the paper, with arcs that no motion leaves, and the law `flexible`."""
    made = long_arcs(str(storeys), rho, tan_alpha)
    return replace(made, impact_law=ImpactLaw())


def followed(record, factor, start=None):
    """Of a record what is followed, from an instant [s] or where its energy is."""
    if start is None:
        return strongest(record, WINDOW).scaled(factor)
    return part(record, start, WINDOW, factor)


def both(structure, motion, departures, options):
    """Bodies and the program under one motion."""
    system = oracle_system(structure)
    bodies = simulate(
        system, motion.acceleration, motion.dt, WINDOW, departures=departures, **options
    )
    settings = TimeHistorySettings(free_vibration=motion.dt, accuracy=4.0)
    return bodies, time_history(structure, motion, settings, with_fixed_base=False)


def change(bodies, ours):
    """Of the largest rotation and the base shear, in per cent of the program's."""
    assert ours.structure.superstructure is not None
    shear = (
        ours.structure.superstructure.stiffnesses[0] * np.abs(bodies.drifts[:, 0]).max()
    )
    rotation = np.abs(bodies.rotation).max()
    return 100.0 * (rotation / ours.max_rotation - 1.0), 100.0 * (
        shear / ours.max_base_shear - 1.0
    )


def slips(structure, bodies):
    """Largest at the feet and at the heads of the columns [m]: what rolling does not explain."""
    storey, found = StoreyLagrangian(oracle_system(structure)), np.zeros(2)
    rolling = structure.bearing.curvature_ratio > 0.0
    for c in range(2):
        tilts, column = bodies.joints[f"tilt {c}"], bodies.joints[f"across {c}"]
        sizes = [storey.cap_beam(abs(x), rolling=rolling)[0].real for x in tilts]
        rolled = 0.5 * np.sign(tilts) * np.array(sizes)
        ends = column - rolled, bodies.joints["beam across"] - column - rolled
        found = np.maximum(found, [np.abs(slip).max() for slip in ends])
    return float(found[0]), float(found[1])


@pytest.mark.parametrize("size", SIZES, ids=lambda s: f"{s.assumption}, {s.record}")
def test_sizes(size, fema_record):
    structure = structure_of(size.tan_alpha, size.rho, size.storeys)
    motion = followed(fema_record(size.record), SCALES[size.tan_alpha], size.start)
    bodies, ours = both(structure, motion, size.departures, size.options)
    assert change(bodies, ours) == pytest.approx(
        (size.rotation, size.base_shear), abs=size.within
    )
    if size.departures.friction or size.options == PLASTIC:
        assert max(slips(structure, bodies)) < 1e-4


@pytest.mark.parametrize("walk", WALKS, ids=lambda w: f"{w.tan_alpha}, {w.record}")
def test_contacts_that_rebound_let_the_beam_walk(walk, fema_record):
    structure = structure_of(walk.tan_alpha, 0.5, 3)
    motion = followed(fema_record(walk.record), SCALES[walk.tan_alpha])
    bodies, ours = both(structure, motion, Departures(), {})
    rotation, base_shear = change(bodies, ours)
    assert walk.rotation[0] < rotation < walk.rotation[1]
    assert walk.base_shear[0] < base_shear < walk.base_shear[1]
    feet, heads = slips(structure, bodies)
    assert heads > max(walk.least, 5.0 * feet)


@pytest.mark.parametrize(
    ("tan_alpha", "record", "base_shear", "slip"),
    [
        (0.15, FAR, -22.0, 0.13),
        (0.15, NEAR, -32.0, 0.26),
        (0.30, FAR, -48.0, 0.15),
        (0.30, NEAR, -69.0, 0.29),
    ],
)
def test_less_friction_than_tan_alpha_makes_a_sliding_isolator(
    tan_alpha, record, base_shear, slip, fema_record
):
    """At exactly tan(alpha) columns slide and turn at once, and half the step is another motion."""
    structure = structure_of(tan_alpha, 0.5, 3)
    motion = followed(fema_record(record), SCALES[tan_alpha])
    bodies, ours = both(structure, motion, Departures(0.9 * tan_alpha), PLASTIC)
    rotation, change_of_shear = change(bodies, ours)
    assert rotation < -99.0
    assert change_of_shear == pytest.approx(base_shear, abs=2.0)
    assert slips(structure, bodies)[0] == pytest.approx(slip, rel=0.1)


@pytest.mark.parametrize(
    ("record", "columns", "base_shear", "tilt"),
    [
        (FAR, (-2.9, 2.0), 0.3, 0.35),
        (NEAR, (-2.1, 2.8), -2.4, 0.56),
        (LATE, (-2.7, 2.2), 0.1, 0.2),
    ],
)
def test_columns_of_different_height(record, columns, base_shear, tilt, fema_record):
    """By 5 %, 12 m apart on level footings; the tilt of the beam is in mrad."""
    structure = structure_of(0.15, 0.5, 3)
    more = 0.05 * structure.bearing.half_height
    departures = Departures(spacing=12.0, longer=(more, -more))
    bodies, ours = both(
        structure, followed(fema_record(record), 1.0), departures, TILTING
    )
    largest = [np.abs(bodies.joints[f"tilt {c}"]).max() for c in range(2)]
    assert 100.0 * (np.array(largest) / ours.max_rotation - 1.0) == pytest.approx(
        columns, abs=0.3
    )
    assert change(bodies, ours)[1] == pytest.approx(base_shear, abs=0.5)
    assert 1e3 * np.abs(bodies.joints["beam tilt"]).max() == pytest.approx(tilt, abs=0.02)


@pytest.mark.parametrize("storeys", [3, 6])
def test_vertical_vibration_hardly_changes_the_next_swings(storeys):
    """After a release; over the first two swings of floors that ride on the beam."""
    structure = structure_of(0.15, 0.5, storeys)
    system, released = oracle_system(structure), 0.4 * structure.bearing.alpha

    def tops(period):
        found = simulate(
            system,
            np.zeros(2),
            1.0,
            2.4,
            initial_rotation=released,
            vertical_period=period,
        )
        return turning_points(found.rotation)[1:3]

    riding = tops(None)
    for period, within in ((0.05, 0.04), (0.1, 0.005), (0.15, 0.007), (0.25, 0.022)):
        assert tops(period) == pytest.approx(riding, rel=within)


@pytest.mark.parametrize(
    ("storeys", "tan_alpha", "median", "largest"),
    [
        (3, 0.15, 2.29, 2.65),
        (6, 0.15, 1.70, 1.95),
        (9, 0.15, 1.40, 1.64),
        (3, 0.30, 2.00, 2.93),
    ],
)
def test_demands_of_far_field_records(storeys, tan_alpha, median, largest, fema_record):
    """Friction that columns need, over tan(alpha), and base shears over V_st, by the program."""
    structure = podium(storeys, tan_alpha, law=ImpactLaw())
    friction, shear = [], []
    for component in (f"farfield/{i}/{c}" for i in range(1, 23) for c in "ab"):
        found = time_history(structure, fema_record(component), with_fixed_base=False)
        if found.uplifts and found.outcome == "survived":
            friction.append(found.friction_demand / tan_alpha)
            shear.append(found.max_base_shear / structure.static_base_shear)
    assert len(shear) > 35
    assert np.median(shear) == pytest.approx(median, abs=0.01)
    assert max(shear) == pytest.approx(largest, abs=0.01)
    assert min(friction) > 1.01
    assert max(friction) < 1.06
