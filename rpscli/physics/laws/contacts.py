"""Forces of contacts at both ends of the columns (8.4)."""

from __future__ import annotations

from typing import NamedTuple

from rpscli.physics.compile import inlined


class Masses(NamedTuple):
    """Of a storey [kg]."""

    columns: float
    cap_beam: float
    floors: float
    riding: float  # of floors that are lifted with the cap beam: all, or none


@inlined
def shears(masses: Masses, beam: float, a_g: float, V: float) -> tuple[float, float]:
    """F of all columns at their upper and lower ends, in one direction [N].

    It acts to the right on what is above, under u_b'' and a_g; V is the base shear and
    what devices push the beam with.
    """
    upper = masses.cap_beam * (beam + a_g) - V
    return upper, upper + masses.columns * (0.5 * beam + a_g)


@inlined
def normal_forces(
    masses: Masses, g: float, g_up: float, lift: float, V_up: float, pull: float
) -> tuple[float, float]:
    """N on the upper and the lower ends of all columns [N].

    Under g + a_v, v_b'', the floors' springs upwards and the pull of tendons.
    """
    borne = (masses.floors - masses.riding) * g - V_up
    upper = (masses.cap_beam + masses.riding) * (g_up + lift) + pull + borne
    return upper, upper + masses.columns * (g_up + 0.5 * lift)
