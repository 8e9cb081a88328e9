"""What follows from a case before any analysis: the quantities of `rps check`."""

from __future__ import annotations

from typing import Any

from rpscli.model.podium import PodiumStructure

Document = dict[str, Any]


def derived_quantities(structure: PodiumStructure) -> Document:
    """Shape, masses, statics and periods under the names of the JSON document, SI units.

    ``rho_cr_paper`` is the first-order formula of the paper, ``rho_cr_exact`` the curvature ratio
    at which theta_cr = beta (Theory, section 9). Without a building its periods are empty.
    """
    return {
        **_shape(structure),
        **_masses(structure),
        **_statics(structure),
        **_building(structure),
    }


def _shape(structure: PodiumStructure) -> Document:
    b = structure.bearing
    return {
        "semi_diagonal": b.semi_diagonal,
        "column_height": 2.0 * b.half_height,
        "flat_width": 2.0 * b.half_width,
        "arc_radius": b.radius,
        "alpha": b.alpha,
        "alpha_wedge": b.alpha_wedge,
        "beta": b.beta,
        "curvature_ratio": b.curvature_ratio,
        "rho_cr_paper": b.critical_curvature_ratio_of_paper,
        "rho_cr_exact": b.critical_curvature_ratio,
        "critical_rotation": b.critical_rotation,
        "critical_rotation_paper": b.critical_rotation_of_paper,
        "overturns": "rolling" if b.overturns_rolling else "rocking",
    }


def _masses(structure: PodiumStructure) -> Document:
    return {
        "columns_mass": structure.columns_mass,
        "cap_beam_mass": structure.cap_beam_mass,
        "superstructure_mass": structure.superstructure_mass,
        "gamma": structure.gamma,
        "eta": structure.eta,
        "gamma_total": structure.gamma_total,
        "restitution": structure.restitution,
    }


def _statics(structure: PodiumStructure) -> Document:
    return {
        "uplift_acceleration": structure.uplift_acceleration,
        "uplift_force": structure.uplift_force,
        "static_base_shear": structure.static_base_shear,
        "initial_stiffness": structure.initial_stiffness,
        "p_hat": structure.rigid_frequency_parameter,
    }


def _building(structure: PodiumStructure) -> Document:
    building = structure.superstructure
    if building is None:
        return {"storeys": 0, "T1": None, "periods": [], "damping_ratios": [], "stiffnesses": []}
    return {
        "storeys": building.storeys,
        "T1": float(building.periods[0]),
        "periods": building.periods,
        "damping_ratios": building.damping_ratios,
        "stiffnesses": building.stiffnesses,
    }
