"""Forces of the shear building above the cap beam."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.jit import kernel
from rpscli.physics.layout import FLOORS
from rpscli.physics.parameters import Floors


@kernel
def floor_rates(
    floors: Floors,
    y: NDArray[np.float64],
    base: float,
    base_rate: float,
    ground: float,
    rates: NDArray[np.float64],
) -> tuple[float, float]:
    """Velocities and accelerations of the floors; the base shear and the damped power.

    M u'' = -M 1 a_g - K v - C v', with v = u - 1 u_b (Theory, section 2). Each storey pulls on the
    floor above and below it, so one pass from the bottom suffices: K is never formed.

    Parameters
    ----------
    y
        State; its floor entries are u, u' relative to the ground [m, m/s].
    base, base_rate
        u_b, u_b' [m, m/s].
    ground
        a_g [m/s2].
    rates
        Written: the floor entries of dy/dt.

    Returns
    -------
    V = 1^T (K v + C v') [N] and v'^T C v' [W].
    """
    n = floors.mass.shape[0]
    V, power = 0.0, 0.0
    below, below_rate = base, base_rate
    for i in range(n):
        u, du = y[FLOORS + i], y[FLOORS + n + i]
        sway = floors.a1 * (du - below_rate)
        force = floors.stiffness[i] * (u - below + sway)
        slip = floors.a0 * (du - base_rate)
        rates[FLOORS + i] = du
        rates[FLOORS + n + i] = -ground - force * floors.inverse_mass[i] - slip
        if i == 0:
            V += force
        else:
            rates[FLOORS + n + i - 1] += force * floors.inverse_mass[i - 1]
        V += floors.mass[i] * slip
        power += floors.stiffness[i] * sway * (du - below_rate)
        power += floors.mass[i] * slip * (du - base_rate)
        below, below_rate = u, du
    if floors.damping.shape[0] > 0:
        more = full_damping(floors, y, base_rate, rates)
        V, power = V + more[0], power + more[1]
    return V, power


@kernel
def full_damping(
    floors: Floors, y: NDArray[np.float64], base_rate: float, rates: NDArray[np.float64]
) -> tuple[float, float]:
    """The same for a damping matrix that is not a0 M + a1 K: adds to `rates`."""
    n = floors.mass.shape[0]
    V, power = 0.0, 0.0
    for i in range(n):
        force = 0.0
        for j in range(n):
            force += floors.damping[i, j] * (y[FLOORS + n + j] - base_rate)
        rates[FLOORS + n + i] -= force * floors.inverse_mass[i]
        V += force
        power += force * (y[FLOORS + n + i] - base_rate)
    return V, power


@kernel
def building_energy(floors: Floors, y: NDArray[np.float64], base: float) -> float:
    """Kinetic energy relative to the ground and strain energy of the building [J]."""
    n = floors.mass.shape[0]
    energy = 0.0
    below = base
    for i in range(n):
        u, du = y[FLOORS + i], y[FLOORS + n + i]
        energy += 0.5 * (floors.mass[i] * du**2 + floors.stiffness[i] * (u - below) ** 2)
        below = u
    return energy
