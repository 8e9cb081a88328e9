"""The equation of motion (2.3), (12.4), (13.4), and what it makes of the cap beam."""

from __future__ import annotations

from rpscli.physics.compile import inlined
from rpscli.physics.laws.place import Ends, Place


@inlined
def push(share: float, force: float, load: float, a_g: float) -> float:
    """The z of a horizontal force at the cap beam and the
    ground's acceleration [1/s2].
    """
    return share * force - load * a_g


@inlined
def felt_gravity(
    g: float, g_up: float, spared: float, floors_mass: float, V_up: float
) -> float:
    """g_f, what contacts feel of g + a_v under forces V_up of
    the floors' springs [m/s2].
    """
    return g_up - spared * (floors_mass * (g_up - g) + V_up)


@inlined
def weight_arms(
    at: Place, ends: Ends, weigh: float, w: float, g: float, g_f: float
) -> float:
    """Moment by which weight turns the tilt back, over N m_c R^2 [1/s2]."""
    return ((at.B - ends.sink * w) * g + at.Bv * (g_f - g)) * weigh


@inlined
def bed_along(ends: Ends, x: float, p: float) -> float:
    """Moment by which a bed in full contact turns the tilt back, likewise [1/s2]."""
    return ends.k * x + ends.c * p


@inlined
def bed_across(ends: Ends, per_x: float, q: float) -> float:
    """Resistance of a bed, or a rim beyond it, to what goes round [1/s2]."""
    return (ends.c + ends.rim * per_x) * q


@inlined
def bend_along(at: Place, held: float, p: float, q: float, z: float) -> float:
    """r'' along the tilt, of rates p along it and q across, under z along it [rad/s2].

    Arms, bed and devices hold it back.
    """
    turns = (at.cone + 0.5 * at.K_slope) * (q * q) - at.D * (p * p)
    return (at.C * z - held + turns) / at.A


@inlined
def bend_across(at: Place, held: float, p: float, q: float, z: float) -> float:
    """r'' across the tilt, under z across it [rad/s2]."""
    return (at.h * z - held - at.K_slope * (p * q)) / at.K


@inlined
def beam_along(at: Place, diameter: float, bend: float, p: float, q: float) -> float:
    """u_b'' along the tilt [m/s2]."""
    return diameter * (at.C * bend + at.B * (p * p) + at.dh * (q * q))


@inlined
def beam_across(at: Place, diameter: float, bend: float, p: float, q: float) -> float:
    """u_b'' across the tilt [m/s2]."""
    return diameter * (at.h * bend + 2.0 * at.dh * (p * q))


@inlined
def lift_of(at: Place, diameter: float, a: float, p: float) -> float:
    """v_b'' of x'' and x' [m/s2]."""
    return diameter * (at.Bv * a + at.Bv_slope * (p * p))
