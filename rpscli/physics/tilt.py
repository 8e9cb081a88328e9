"""The equation of motion of the tilt, and the contact geometry compiled for the kernels.

The tilt is x = |theta| >= 0 and s = sign(theta); a motion to the left is the mirror image of one
to the right, so only the horizontal actions carry s. Kept beyond x = 0 and x = beta the right-hand
side is smooth, which is what the event location needs.
"""

from __future__ import annotations

from rpscli.physics import geometry
from rpscli.physics.geometry import Phase
from rpscli.physics.part import part

lever_arm = part(geometry.lever_arm)
path_height = part(geometry.path_height)
squared_distance = part(geometry.squared_distance)
cap_beam_displacement = part(geometry.cap_beam_displacement)
cap_beam_lift = part(geometry.cap_beam_lift)


@part
def tilt_inertia(
    inertia: float, beam: float, building: float, phase: Phase, B: float, C: float
) -> float:
    """A(x) = Io - 1 + (1 + 4 gamma) S + 4 gamma eta B^2 (paper, Table 1).

    `inertia` is Io - 1, `beam` 1 + 4 gamma, `building` 4 gamma eta.
    """
    return inertia + beam * squared_distance(phase, C) + building * (B * B)


@part
def tilt_inertia_slope(beam: float, building: float, phase: Phase, B: float, C: float) -> float:
    """D(x) = A'(x)/2, with S' = 2 c B and B' = c - C.

    The paper's Table 1 lacks the factor 4 gamma eta in the rocking phase (c = 0).
    """
    return B * (beam * phase.c + building * (phase.c - C))


@part
def restoring(D: float, B: float, rate: float, weight: float) -> float:
    """What turns the tilt back whatever the ground and the building do [rad/s2].

    `weight` is (g/R)(1 + 2 gamma + 2 gamma eta), with g + a_v where the ground moves vertically.
    """
    return B * weight + D * (rate * rate)


@part
def tilt_acceleration(per_inertia: float, restoring: float, C: float, action: float) -> float:
    """x'' of A x'' = -B (g/R)(1 + 2 gamma + 2 gamma eta) - D x'^2 - C s action (paper, Eq. 2).

    `action` is s (a_g/R (1 + 2 gamma) - 2 V/(N m_c R)), the only term that waits for the base
    shear V; `per_inertia` is 1/A. All but that in [rad/s2].
    """
    return -(restoring + C * action) * per_inertia
