"""What follows from a case before any analysis: the quantities of `rps check`."""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


class Derived(NamedTuple):
    """One quantity: its name in JSON, words, symbol, SI unit, and where a structure has it."""

    name: str
    label: str
    symbol: str
    unit: str
    of: str | Callable[[PodiumStructure], Any] = ""

    def value(self, structure: PodiumStructure) -> Any:
        """Of a structure: the attribute of the name where nothing else is said."""
        if callable(self.of):
            return self.of(structure)
        return attrgetter(self.of or self.name)(structure)


GEOMETRY = (
    Derived("semi_diagonal", "semi-diagonal", "R", "m", "bearing.semi_diagonal"),
    Derived("column_height", "column height", "2H", "m", lambda s: 2.0 * s.bearing.half_height),
    Derived("flat_width", "width of the flat part", "2B", "m", lambda s: 2 * s.bearing.half_width),
    Derived("arc_radius", "radius of the arcs", "r", "m", "bearing.radius"),
    Derived("alpha", "slenderness angle", "alpha", "rad", "bearing.alpha"),
    Derived(
        "alpha_wedge", "slenderness angle of the wedge", "alpha'", "rad", "bearing.alpha_wedge"
    ),
    Derived("beta", "rolling ends at", "beta", "rad", "bearing.beta"),
    Derived("curvature_ratio", "curvature ratio", "rho", "-", "bearing.curvature_ratio"),
    Derived(
        "rho_cr_paper", "critical curvature ratio, first order", "rho_cr", "-",
        "bearing.critical_curvature_ratio_of_paper",
    ),
    Derived(
        "rho_cr_exact", "critical curvature ratio, exact", "rho_cr", "-",
        "bearing.critical_curvature_ratio",
    ),
    Derived("critical_rotation", "critical rotation", "theta_cr", "rad"),
    Derived(
        "critical_rotation_paper", "critical rotation, first order", "theta_cr", "rad",
        "bearing.critical_rotation_of_paper",
    ),
    Derived(
        "overturns", "overturning", "", "-",
        lambda s: "rolling" if s.bearing.overturns_rolling else "rocking",
    ),
)  # fmt: skip
"""Shape of the columns. `rho_cr_paper` is the first-order formula of the paper, `rho_cr_exact` the
curvature ratio at which theta_cr = beta (Theory (1.14))."""

DYNAMICS = (
    Derived("columns_mass", "all columns", "N m_c", "kg"),
    Derived("cap_beam_mass", "cap beam", "m_b", "kg"),
    Derived("superstructure_mass", "superstructure", "M_tot", "kg"),
    Derived("gamma", "cap beam over columns", "gamma", "-"),
    Derived("eta", "superstructure over cap beam", "eta", "-"),
    Derived("gamma_total", "total mass ratio", "gamma (1 + eta)", "-"),
    Derived("restitution", "restitution at impact", "e", "-"),
    Derived("uplift_acceleration", "uplift acceleration, quasi-static", "g tan(alpha)", "m/s2"),
    Derived("uplift_force", "uplift force at the cap beam", "W tan(alpha)", "N"),
    Derived("static_base_shear", "base shear at uplift", "V_st", "N"),
    Derived("initial_stiffness", "stiffness after uplift", "", "N/m"),
    Derived("rolling_period", "period of rolling, rigid building", "T", "s"),
    Derived(
        "p_hat", "frequency parameter, rigid estimate", "p_hat", "rad/s",
        "rigid_frequency_parameter",
    ),
)  # fmt: skip
"""Masses and statics."""


def _path_at_critical(structure: PodiumStructure) -> tuple[float, float]:
    """u_b and v_b at theta_cr [m]."""
    import numpy as np  # slow

    _, u, v = structure.path(np.array(structure.critical_rotation))
    return float(u), float(v)


AT_CRITICAL = (
    Derived(
        "critical_displacement", "cap beam displacement at it", "u_b", "m",
        lambda s: _path_at_critical(s)[0],
    ),
    Derived("critical_lift", "lift at it", "v_b", "m", lambda s: _path_at_critical(s)[1]),
)  # fmt: skip
"""Where the weight no longer restores."""

BOTH = (
    Derived("pass_turn", "azimuth change in a pass near upright", "Delta phi", "rad"),
    Derived("turning_inertia", "rotational inertia, upright", "K(0)", "-"),
    Derived("contact_time", "contact time of an impact", "t_c", "s", "impact_law.contact_time"),
)
"""Where both horizontal components act."""

CONTACT = (
    Derived("period_ratio", "period in full contact over T1", "r", "-", "bed.period_ratio"),
    Derived("contact_period", "first period in full contact", "T", "s", "bed.period"),
    Derived("contact_stiffness", "stiffness in full contact", "K_s", "N/m", "bed.stiffness"),
    Derived("settlement", "settlement of a joint", "D_0", "m", "bed.settlement"),
    Derived("joint_stiffness", "mean stiffness of a joint", "W/D_0", "N/m", "bed.joint_stiffness"),
    Derived("lifts_from", "ends begin to lift at", "phi_u", "rad", "bed.uplift_rotation"),
    Derived("lifts_from_ratio", "over the slenderness angle", "phi_u/alpha", "-", "bed.ratio"),
    Derived("contact_mass", "columns and cap beam at u_b", "m_0", "kg", "bed.mass"),
    Derived("contact_share", "contact length at 0.1 alpha", "", "-", "bed.contact_share"),
)
"""Of compliant ends."""

FIRST_PERIOD = Derived(
    "T1", "first period on a fixed base", "T1", "s",
    lambda s: float(s.superstructure.periods[0]) if s.superstructure else None,
)  # fmt: skip


def derived_quantities(structure: PodiumStructure) -> dict[str, Any]:
    """All of them under their names; lists by mode or storey are empty without a building."""
    building = structure.superstructure
    lists = ("periods", "damping_ratios", "stiffnesses")
    return {
        **{row.name: row.value(structure) for row in (*GEOMETRY, *AT_CRITICAL, *DYNAMICS, *BOTH)},
        "storeys": structure.storeys,
        FIRST_PERIOD.name: FIRST_PERIOD.value(structure),
        **({row.name: row.value(structure) for row in CONTACT} if structure.bed else {}),
        **{name: getattr(building, name) if building else [] for name in lists},
    }
