"""Formulas of derived quantities: an expression for each, by the name of the quantity.

An expression is empty where the case gives the quantity itself. Its letters, and how
they become symbols and numbers, are those of `derived`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rpscli.model.podium import PodiumStructure


def formulas(
    structure: PodiumStructure, podium: Mapping[str, Any], crushed: float
) -> dict[str, str]:
    """All of them; `crushed` is what is crushed at rest of the width of an end."""
    return {
        **_of_shape(structure, podium["bearing"]),
        **_of_masses(structure, podium),
        **_of_statics(structure),
        **_of_contact(structure),
        **of_column(structure, crushed),
    }


def _of_shape(structure: PodiumStructure, given: Mapping[str, Any]) -> dict[str, str]:
    """Of the columns, from dimensions or from ratios."""
    bearing = structure.bearing
    flat = bearing.is_flat
    sizes = "dimensions" in given
    first_order = "(1 - tan_alpha / tan_alpha_w) / 2"
    ratio = "radius / height" if sizes else ""
    if given.get("curvature_ratio") == "critical":
        ratio = first_order
    rolls = bearing.curvature_ratio <= bearing.critical_curvature_ratio_of_paper
    of_beta, of_exact = (
        f"asin((tan_alpha_w - tan_alpha) / (2 * {r}))" for r in ("rho", "rho_cr")
    )
    exact = f"(1 - 2 * rho_cr) * tan({of_exact}) = tan_alpha"
    return {
        "semi_diagonal": "sqrt((height)^2 + (width)^2) / 2" if sizes else "",
        "column_height": "" if sizes else "2 * R * cos(alpha)",
        "flat_width": "" if sizes else "2 * R * sin(alpha)",
        "arc_radius": "" if sizes else "rho * height",
        "alpha": "atan(width / height)" if sizes else "atan(tan_alpha)",
        "alpha_wedge": "atan(tan_alpha_w)",
        "beta": "0" if flat else of_beta,
        "curvature_ratio": ratio,
        "rho_cr_paper": first_order,
        "rho_cr_exact": "0" if flat else exact,
        "critical_rotation": _critical(flat=flat, rolls=bearing.overturns_rolling),
        "critical_rotation_paper": _critical(flat=flat, rolls=rolls),
    }


def _critical(*, flat: bool, rolls: bool) -> str:
    if flat:
        return "atan(tan_alpha)"
    if rolls:
        return "atan(tan_alpha / (1 - 2 * rho))"
    return "atan(tan_alpha_w / (1 - 2 * rho * (1 - cos(beta))))"


def _of_masses(structure: PodiumStructure, podium: Mapping[str, Any]) -> dict[str, str]:
    """Of masses and their ratios, whichever of both the case gives."""
    building = structure.superstructure
    beam = structure.cap_beam_mass > 0.0
    by_eta = building is not None and "superstructure_mass_ratio" in podium
    by_gamma = beam and "column_mass" not in podium
    by_mass = "M / eta" if by_eta else "" if "cap_beam_mass" in podium else "gamma * m_c"
    by_beam = "M / m_b" if beam else "0"

    floors = [] if building is None else building.masses.tolist()
    sum_of_floors = " + ".join(f"m_{i + 1}" for i in range(len(floors))) or "0"
    return {
        "columns_mass": "m_b / gamma" if by_gamma else "N * m_column",
        "cap_beam_mass": by_mass,
        "superstructure_mass": "n * m_i" if len(set(floors)) == 1 else sum_of_floors,
        "gamma": "" if "cap_beam_mass_ratio" in podium else "m_b / (m_c)",
        "eta": "" if by_eta else by_beam,
        "gamma_total": "gamma * (1 + eta)",
        "weight": "(m_c / 2 + m_b + M) * g",
    }


EDGES = {
    "flexible": (
        "(I - 2 * sin(alpha)^2 + 4 * gamma * cos(2 * alpha) - 4 * gamma * eta *"
        " sin(alpha)^2) / (I + 4 * gamma + 4 * gamma * eta * sin(alpha)^2)"
    ),
    "springs": "(I - 2 * sin(alpha)^2 + 4 * gamma * cos(2 * alpha)) / (I + 4 * gamma)",
    "rigid": "1 - 2 * sin(alpha)^2 * (1 + 4 * gamma_t) / (I + 4 * gamma_t)",
}
"""Restitution beside an impulse at the edges of the flat part
(Theory (4.6), (4.8), (14.5))."""


def _of_statics(structure: PodiumStructure) -> dict[str, str]:
    """Of impact, uplift, stiffness and periods."""
    law = structure.impact_law.kind
    slope = "" if structure.bearing.is_flat else " * (1 - 2 * rho * cos(alpha)^2)"
    by_edges = "f * (1 - kappa * (1 - e_edge))"
    return {
        "restitution": "f * e_given" if law == "value" else by_edges,
        "e_edge": EDGES.get("springs" if structure.upwards else law, ""),
        "uplift_acceleration": "g * tan_alpha",
        "uplift_force": "W * tan_alpha",
        "static_base_shear": "M * g * tan_alpha",
        "initial_stiffness": f"-W{slope} / (2 * R * cos(alpha)^3)",
        "rolling_period": "2 * pi * sqrt((m_c * I / 4 + m_b + M) / K)",
        "p_hat": "sqrt(g / R * (1 + 2 * gamma_t) / (I + 4 * gamma_t))",
        "T1": "2 * pi * sqrt(sum_m / sum_k)",
    }


def _of_contact(structure: PodiumStructure) -> dict[str, str]:
    """Of compliant ends: phi_u is the root of its formula (Theory (12.8))."""
    lost = "2 / 3 * sin(alpha)" if structure.contact.kind == "plane" else "0"
    stiffness = f"W * (B_u - {lost}) / (2 * R * phi_u * C_u^2)"
    return {
        "period_ratio": "T_c / T_1",
        "contact_period": "2 * pi * sqrt((m_0 + sum_M) / K_s)",
        "contact_stiffness": stiffness,
        "settlement": "phi_u * width / 2",
        "joint_stiffness": "W / D_0",
        "lifts_from": f"K_s = {stiffness}",
        "lifts_from_ratio": "phi_u / alpha",
        "contact_mass": "m_c * ((I - 1) / C_u^2 + 1 + 4 * gamma) / 4",
        "contact_share": "sqrt(phi_u / (alpha / 10))",
    }


def of_column(structure: PodiumStructure, crushed: float) -> dict[str, str]:
    """Of a column (Theory (16.2), (16.4) to (16.6)); a and b of an
    ellipse are those of (16.5).

    An end of revolution whose edge is `crushed` over its whole width bears everywhere.
    """
    design = structure.column
    on_line = design is not None and design.bears_on_line(structure.bearing)
    line = "sqrt(N_0 * E_c / (pi * L * radius))"
    ellipse = "3 * N_0 / (2 * pi * a_c * b_c)"
    segment = "N_0 / (strength * (wide / 2)^2) = p_c - sin(p_c) * cos(p_c)"
    segment = segment if crushed < 1.0 else "N_0 / (strength * pi * (wide / 2)^2)"
    turned = "(sin(x) + sin(y) * cos(x) - cos(y) * sin(x))"
    return {
        "column_rest_force": "g * (m_c + m_b + M) / N",
        "column_rest_moment": f"N_0 * (width / 2 * cos(x) + radius * {turned})",
        "contact_rest_pressure": line if on_line else ellipse,
        "crushed_rest_ratio": "N_0 / (strength * L * wide)" if on_line else segment,
    }
