"""From which displacement a slab is unstable against turning (`model.twisting`)."""

import numpy as np
import pytest

from rpscli import Bearing, PodiumStructure
from rpscli.model.twisting import plan_of, unstable_from

SQUARE = (0.0, 10.0), (0.0, 10.0)
LONG = (0.0, 10.0), (0.0, 30.0)


def podium(plan, rho=0.0, wedge=None):
    wedge = wedge or (0.3 if rho else 0.15)
    return PodiumStructure(
        Bearing(1.5, 0.15, wedge, rho), 4e3, 4e4, rows=plan[0], rows_y=plan[1], columns=4
    )


@pytest.mark.parametrize(
    ("plan", "rho", "ratio"),
    [  # first displacements at which energies of turned slabs fall, in steps of 0.05
        (SQUARE, 0.0, 0.50),
        (SQUARE, 0.25, 0.50),
        (SQUARE, 0.5, 0.55),
        (SQUARE, 1.5, 0.50),
        (LONG, 0.5, 0.55),
        (LONG, 1.5, 0.20),
    ],
)
def test_as_the_energies_of_turned_slabs_have_it(plan, rho, ratio):
    assert ratio - 0.05 <= unstable_from(podium(plan, rho)) <= ratio


@pytest.mark.parametrize("plan", [SQUARE, LONG])
def test_energy_of_a_turned_slab_changes_its_sign_there(plan):
    """Lifts of single columns, each by its own displacement: no formula of the module."""
    structure = podium(plan, 0.5)
    places = plan_of(structure)
    tilts = np.linspace(1e-5, structure.critical_rotation, 20001)
    _, moved, lift = structure.path(tilts)

    def gain(u, axis, psi=1e-3):
        cosine, sine = np.cos(psi), np.sin(psi)
        turned = places @ np.array([[cosine, sine], [-sine, cosine]]) - places
        turned[:, axis] += u
        return np.interp(np.hypot(*turned.T), moved, lift).mean() - np.interp(
            u, moved, lift
        )

    u = unstable_from(structure) * moved[-1]
    signs = [min(gain(part * u, axis) for axis in (0, 1)) for part in (0.97, 1.03)]
    assert signs[0] > 0.0 > signs[1]


def test_without_rows_in_both_directions_nothing_is_said():
    assert unstable_from(PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e3, 4e4)) is None
