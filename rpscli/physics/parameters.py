"""What the kernels are told: plain floats and arrays in named tuples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rpscli.physics.geometry import Phase


class Floors(NamedTuple):
    """The shear building: n floors, n may be 0.

    Damping is C = a0 M + a1 K, or the full `damping` (n, n) where that is not empty. The modes are
    those of the fixed base, mass-normalised; `participation` is Gamma_r = phi_r^T M 1.
    """

    mass: NDArray[np.float64]
    inverse_mass: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    a0: float
    a1: float
    damping: NDArray[np.float64]
    omega: NDArray[np.float64]
    xi: NDArray[np.float64]
    shapes: NDArray[np.float64]
    participation: NDArray[np.float64]


class Podium(NamedTuple):
    """The rocking storey. Letters as in the paper and in Theory, sections 1 and 2."""

    R: float
    alpha: float
    beta: float
    theta_cr: float
    theta_limit: float
    rolling: Phase
    rocking: Phase
    Io: float
    gamma: float
    eta: float
    columns_mass: float
    cap_beam_mass: float
    floors_mass: float
    gravity: float
    restitution: float
    floors_jump: bool


class Ground(NamedTuple):
    """Accelerations of the ground at equal steps, linear between samples and 0 after the last.

    `vertical` is empty or as long as `horizontal`.
    """

    horizontal: NDArray[np.float64]
    vertical: NDArray[np.float64]
    dt: float


class Numerics(NamedTuple):
    """How the motion is integrated.

    `substeps` Runge-Kutta steps are made in each interval of the record while uplifted, and
    `contact_substeps` exact steps in full contact (for the search of uplift only). At most
    `free_samples` intervals follow the record's end, fewer if `until_rest` and nothing more can
    happen. The motion starts from rest at `initial_rotation`.
    """

    substeps: int
    contact_substeps: int
    free_samples: int
    until_rest: bool
    recontact_tolerance: float
    max_events: int
    initial_rotation: float
