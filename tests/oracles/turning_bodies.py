"""A slab on columns in space as rigid bodies in contact, for mujoco, without our equations.

The slab and each column are free in all six ways. An end of a column is a ring: small
spheres round the edge of its flat part, or spheres of the radius of its arc round their
centres. The upper rings meet seats, plates that slide up and down on the slab on springs
of W/delta: on stiff contacts a slab rests on one diagonal of four columns. Contacts rub
without sliding and resist pivoting by a lever.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement, tostring

import numpy as np
import pytest

from rpscli.analyses.kernels.twist import gyration
from rpscli.model.twisting import plan_of

TIME_STEP = 5e-5
"""Contacts close within some of these [s]."""
CLOSING_STEPS = 4
FLAT_RING = 361
"""Spheres of a ring: a degree apart, less than the angles between paths that decide."""
CURVED_RING = 180
SMALL = 2e-3
"""Radius of the spheres of flat ends [m]."""
LEAST_LEVER = 3e-4
"""Torsional friction of a contact over its force [m]; without it columns spin."""
SEAT_MASS = 50.0
"""Of a plate [kg], which no column has in the model."""
SEAT_DAMPING = 0.1
"""Damping ratio of the slab's vertical motion on its seats."""
THICKNESS = 0.5

OPTIONS: dict[str, object] = {
    "integrator": "implicitfast", "cone": "elliptic", "tolerance": 1e-10, "iterations": 60,
    "impratio": 20,
}  # fmt: skip


@dataclass(frozen=True)
class Pose:
    """A slab at rest: way of its centre u_x, u_y [m] and its turn [rad]."""

    u_x: float = 0.0
    u_y: float = 0.0
    psi: float = 0.0


def description(structure, pose: Pose) -> Element:
    """Ground, columns, slab and seats in the engine's language."""
    twist = structure.twist
    places = plan_of(structure)
    assert twist is not None, "asked before"
    assert places is not None, "asked before"
    model = Element("mujoco")
    _part(model, "compiler", angle="radian", inertiafromgeom="false")
    gravity = f"0 0 {-structure.gravity}"
    _part(model, "option", timestep=TIME_STEP, gravity=gravity, **OPTIONS)
    lever = max(twist.pivot_friction, LEAST_LEVER)
    contact = {
        "solref": f"{CLOSING_STEPS * TIME_STEP} 1", "solimp": "0.999 0.999 0.001",
        "friction": f"2 {lever} 0", "condim": 4, "mass": 0,
    }  # fmt: skip
    _part(_part(model, "default"), "geom", **contact)
    world = _part(model, "worldbody")
    _part(world, "geom", type="plane", size="0 0 1", contype=0, conaffinity=1)
    factors = twist.factors_of(len(places))
    lifts = []
    for number, (place, factor) in enumerate(zip(places, factors, strict=True)):
        lifts.append(_add_column(world, structure, number, place, factor, pose))
    _add_slab(world, structure, places, np.array(lifts), pose)
    return model


def _part(of: Element, tag: str, **said: object) -> Element:
    return SubElement(of, tag, {name: str(value) for name, value in said.items()})


def head_ways(places, pose: Pose):
    """(N, 2) ways of the heads of columns at `places` [m]."""
    c = math.cos(pose.psi) - 1.0
    s = math.sin(pose.psi)
    x, y = places.T
    return np.transpose([pose.u_x + c * x - s * y, pose.u_y + s * x + c * y])


def _tilt_of(structure, away: float) -> tuple[float, float]:
    """Tilt of a column whose head is so far away [rad], and how far it is lifted [m]."""
    tilts = np.linspace(0.0, structure.critical_rotation, 20001)
    _, ways, lifts = structure.path(tilts)
    tilt = float(np.interp(away, ways, tilts))
    return tilt, float(np.interp(tilt, tilts, lifts))


def _add_column(
    world: Element,
    structure,
    number: int,
    place,
    factor: float,
    pose: Pose,
) -> float:
    """A column and its rings; how far its head is lifted [m]."""
    bearing = structure.bearing
    R = bearing.semi_diagonal
    tan_a = factor * bearing.slenderness
    H = R / math.hypot(1.0, tan_a)
    B = H * tan_a
    mass = structure.columns_mass / structure.columns
    spin = (bearing.inertia_ratio - 1.0) * mass * R * R
    own = max(bearing.inertia_ratio_axial, 1e-3) * mass * R * R
    (way,) = head_ways(place[None, :], pose)
    away = float(np.hypot(*way))
    tilt, lift = _tilt_of(structure, away)
    n_x, n_y = way / away if away > 0.0 else (1.0, 0.0)
    half = math.sin(0.5 * tilt)
    turned = f"{math.cos(0.5 * tilt)} {-n_y * half} {n_x * half} 0"
    x, y = place + 0.5 * way
    middle = f"{x} {y} {H + 0.5 * lift}"
    column = _part(world, "body", name=f"column {number}", pos=middle, quat=turned)
    _part(column, "freejoint")
    inertia = f"{spin} {spin} {own}"
    _part(column, "inertial", pos="0 0 0", mass=mass, diaginertia=inertia)
    curved = bearing.curvature_ratio > 0.0
    r = 2.0 * bearing.curvature_ratio * H if curved else SMALL
    count = CURVED_RING if curved else FLAT_RING
    for end, meets in ((-1, 1), (1, 2)):
        for k in range(count if B > 0.0 else 1):
            angle = 2.0 * math.pi * k / count
            at = f"{B * math.cos(angle)} {B * math.sin(angle)} {end * (H - r)}"
            sphere = {"type": "sphere", "size": r, "pos": at}
            _part(column, "geom", contype=meets, conaffinity=0, **sphere)
    return lift


def _add_slab(world: Element, structure, places, lifts, pose: Pose) -> None:
    """The slab and its seats, which bear its weight."""
    twist = structure.twist
    assert twist is not None, "asked before"
    assert twist.seats is not None, "asked before"
    bearing = structure.bearing
    height = 2.0 * bearing.semi_diagonal / math.hypot(1.0, bearing.slenderness)
    mass = structure.cap_beam_mass
    mean = float(lifts.mean())
    level = height + mean + 0.5 * THICKNESS
    turned = f"{math.cos(0.5 * pose.psi)} 0 0 {math.sin(0.5 * pose.psi)}"
    middle = f"{pose.u_x} {pose.u_y} {level}"
    slab = _part(world, "body", name="slab", pos=middle, quat=turned)
    _part(slab, "freejoint", name="slab")
    about_z = mass * gyration(places) ** 2
    flat = 0.5 * about_z
    inertia = f"{flat} {flat} {about_z}"
    _part(slab, "inertial", pos="0 0 0", mass=mass, diaginertia=inertia)
    count = len(places)
    weight = mass / count * structure.gravity
    stiffness = weight / twist.seats
    damping = 2.0 * SEAT_DAMPING * math.sqrt(stiffness * mass / count)
    for number, (x, y) in enumerate(places.tolist()):
        at = f"{x} {y} {-0.5 * THICKNESS + lifts[number] - mean}"
        seat = _part(slab, "body", name=f"seat {number}", pos=at)
        spin = f"{SEAT_MASS} {SEAT_MASS} {SEAT_MASS}"
        _part(seat, "inertial", pos="0 0 0", mass=SEAT_MASS, diaginertia=spin)
        # Where it is drawn it bears its part of the weight, and more as it is pushed in.
        rest = lifts[number] - mean
        _part(
            seat, "joint", name=f"seat {number}", type="slide", axis="0 0 1",
            stiffness=stiffness, damping=damping, springref=-twist.seats - rest,
        )  # fmt: skip
        _part(seat, "geom", type="box", size="2 2 0.05", pos="0 0 0.05", contype=0,
              conaffinity=2)  # fmt: skip


def turned(structure, pose, seconds, every=0.005):
    """u_x, u_y, psi of the slab, let go at rest in a pose, at even times."""
    mujoco = pytest.importorskip("mujoco", reason="pip install rpscli[contact]")
    text = tostring(description(structure, pose), "unicode")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    at = int(model.joint("slab").qposadr[0])
    rows = []
    for k in range(round(seconds / every) + 1):
        if k:
            mujoco.mj_step(model, data, round(every / TIME_STEP))
        x, y, _, real, *_, about_z = data.qpos[at : at + 7]
        rows.append((x, y, 2.0 * math.atan2(about_z, real)))
    return np.array(rows)
