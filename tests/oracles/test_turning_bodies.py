"""Slabs that turn beside rigid bodies in contact, let go at rest (Theory, 17)."""

import math

import numpy as np
import pytest

from rpscli import Twist
from tests.oracles.turning_bodies import Pose, turned
from tests.physics.test_turning_slab import FLAT, podium, released

TURN = 0.010
DIAGONAL = 0.3 / math.sqrt(2.0)
CASES = {
    "2 x 2": ((-5.0, 5.0), Pose(0.3, 0.0, TURN)),
    "2 x 2, along the diagonal": ((-5.0, 5.0), Pose(DIAGONAL, DIAGONAL, TURN)),
    "3 x 3": ((-10.0, 0.0, 10.0), Pose(0.3, 0.0, TURN)),
}
SECONDS = 1.6


@pytest.mark.long
@pytest.mark.evidence("turning slabs", "program")
@pytest.mark.parametrize("name", CASES)
def test_a_slab_let_go_turns_as_bodies_in_contact_do(name):
    """Within 2 % of the largest turn so far until the first pass, at 1 s; within 6 % after it.

    Bodies lose energy in close passes, which the law of a pass does not have.
    """
    rows, pose = CASES[name]
    twist = Twist(seats=5e-3, pivot_friction=3e-4)
    structure = podium(FLAT, rows=rows, rows_y=rows, twist=twist)
    bodies = turned(structure, pose, SECONDS)[:, 2]
    samples, _, _ = released(
        structure, (pose.u_x, pose.u_y, pose.psi), seconds=SECONDS, sinks=5e-3
    )
    ours = samples[: len(bodies), 2]
    for part, bar in ((slice(0, 201), 0.02), (slice(None), 0.06)):
        within = bar * np.abs(bodies[part]).max()
        assert np.abs(ours[part] - bodies[part]).max() < within
