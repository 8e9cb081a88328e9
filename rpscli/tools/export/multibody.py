"""The podium as rigid bodies in contact, for mujoco, which knows none of our equations.

Each column slides along x and z and turns about y; an arc of radius r on its end is a
sphere of that radius around (+-B, +-(H - r)), and flat ends are four tiny spheres at the
corners. Spheres touch the ground, a plane, or the underside of the cap beam, a box that
slides along x and z; it does not tilt, as floors stay level in the model. Floors slide on
the beam, coupled by springs and dampers. Contacts push and never pull, rub without
sliding (friction 3), and give back no energy when they close: nothing says when the
podium lifts, or what happens at an impact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Array, PodiumStructure

TIME_STEP = 2e-5
"""Contacts close within some of these [s]: far below the periods of a building."""

CLOSING_STEPS = 4
"""Time constant of a contact in steps (`solref`); below 2 the engine is unstable."""

CORNER = 1e-4
"""Radius of the spheres at the corners of flat ends [m]: H is ten
thousand times as large."""

SPACING = 6.0
"""Distance between columns [m]; without influence, as the beam stays level."""

THICKNESS = 0.5
"""Of the cap beam [m]; without influence."""

OPTIONS: dict[str, object] = {
    "integrator": "implicitfast", "cone": "elliptic", "tolerance": 1e-12, "iterations": 100,
    "impratio": 100,  # friction over the normal direction, so that contacts do not creep
}  # fmt: skip
CONTACTS = {"solimp": "0.999 0.999 0.001", "friction": "3 0 0", "condim": 3, "mass": 0}


LIMITS = """\
Columns are rigid bodies in contact with ground and cap beam, which close within 0.1 ms and give
nothing back: impacts take what comes of that, e = {engine:.4g} as by the law `flexible` with a loss
of 1{other}. Columns do not slide. Arcs never end: tilts must stay below {tilt:.4g} rad.
{note}"""
SAME = 1e-3
"""Difference of two restitutions that does not show."""


class Bodies(NamedTuple):
    """R, tan(alpha), rho, I_o/(m_c R^2), masses, storeys from the
    bottom, gravity; SI units.
    """

    R: float
    tan_alpha: float
    rho: float
    inertia_ratio: float
    columns_mass: float
    cap_beam_mass: float
    masses: Sequence[float] | Array
    stiffnesses: Sequence[float] | Array
    damping_matrix: Sequence[Sequence[float]] | Array
    gravity: float


def bodies_of(structure: PodiumStructure) -> Bodies:
    """Numbers of a structure."""
    bearing = structure.bearing
    above = structure.superstructure
    names = ("masses", "stiffnesses", "damping_matrix")
    masses, stiffnesses, damping = (
        (getattr(above, name) if above else ()) for name in names
    )
    return Bodies(
        bearing.semi_diagonal, bearing.slenderness, bearing.curvature_ratio, bearing.inertia_ratio,
        structure.columns_mass, structure.cap_beam_mass, masses, stiffnesses, damping,
        structure.gravity,
    )  # fmt: skip


def description(
    of: Bodies,
    columns: int,
    *,
    time_step: float = TIME_STEP,
    closing_damping: float = 1.0,
    level: bool = True,
) -> Element:
    """The structure in the engine's language; without a cap beam columns stand free."""
    model = Element("mujoco")
    _part(model, "compiler", angle="radian", inertiafromgeom="false")
    _part(model, "option", timestep=time_step, gravity=f"0 0 {-of.gravity}", **OPTIONS)
    closing = f"{CLOSING_STEPS * time_step} {closing_damping}"
    _part(_part(model, "default"), "geom", solref=closing, **CONTACTS)
    world = _part(model, "worldbody")
    springs = _part(model, "tendon")
    _part(world, "geom", type="plane", size="0 0 1", contype=0, conaffinity=1)
    for number in range(columns):
        _add_column(world, of, number, columns)
    if of.cap_beam_mass:
        _add_cap_beam(world, of, columns, level=level)
    # Those of the first storey are in its joint.
    for i in range(1, len(of.masses)):
        law = {"stiffness": of.stiffnesses[i], "damping": -of.damping_matrix[i - 1][i]}
        between = _part(springs, "fixed", **law)
        for joint, sign in ((i, 1), (i - 1, -1)):
            _part(between, "joint", joint=f"floor {joint}", coef=sign)
    return model


def _part(of: Element, tag: str, **said: object) -> Element:
    return SubElement(of, tag, {name: str(value) for name, value in said.items()})


def model_text(structure: PodiumStructure, title: str, note: str) -> tuple[str, str]:
    """The model as a file, and its limits in words."""
    bearing = structure.bearing
    engine = replace(structure, impact_law=ImpactLaw()).restitution
    e = structure.restitution
    other = f"; the case has e = {e:.4g}, and histories part at the first impact"
    limits = LIMITS.format(
        engine=engine, other="" if abs(engine - e) < SAME else other,
        tilt=bearing.beta or bearing.critical_rotation, note=note,
    )  # fmt: skip
    model = description(bodies_of(structure), 2 if structure.cap_beam_mass else 1)
    model.set("model", title)
    _part(_part(model, "custom"), "text", name="limits", data=limits)
    indent(model)
    return tostring(model, "unicode") + "\n", limits


def half_sizes(of: Bodies) -> tuple[float, float, float]:
    """H, B and r [m]."""
    height = of.R / math.hypot(1.0, of.tan_alpha)
    return height, height * of.tan_alpha, 2.0 * of.rho * height


def _add_column(world: Element, of: Bodies, number: int, columns: int) -> None:
    H, B, r = half_sizes(of)
    r = r or CORNER
    mass = of.columns_mass / columns
    spin = (of.inertia_ratio - 1.0) * mass * of.R**2
    column = _part(world, "body", pos=f"{(number - 0.5 * (columns - 1)) * SPACING} 0 {H}")
    _part(column, "inertial", pos="0 0 0", mass=mass, diaginertia=f"{spin} {spin} {spin}")
    _part(column, "joint", name=f"across {number}", type="slide", axis="1 0 0")
    _part(column, "joint", name=f"up {number}", type="slide", axis="0 0 1")
    _part(column, "joint", name=f"tilt {number}", type="hinge", axis="0 1 0")
    # the lower spheres meet the ground (bit 1), the upper ones the beam (bit 2)
    for end, meets in ((-1, 1), (1, 2)):
        for side in (-1, 1):
            place = f"{side * B} 0 {end * (H - r)}"
            _part(
                column,
                "geom",
                type="sphere",
                size=r,
                pos=place,
                contype=meets,
                conaffinity=0,
            )


def _add_cap_beam(world: Element, of: Bodies, columns: int, *, level: bool) -> None:
    H = half_sizes(of)[0]
    half = 0.5 * THICKNESS
    reach = 0.5 * columns * SPACING
    spin = of.cap_beam_mass * (half**2 + reach**2) / 3.0
    beam = _part(world, "body", pos=f"0 0 {2.0 * H + half}")
    inertia = f"{spin} {spin} {spin}"
    _part(beam, "inertial", pos="0 0 0", mass=of.cap_beam_mass, diaginertia=inertia)
    _part(beam, "joint", name="beam across", type="slide", axis="1 0 0")
    _part(beam, "joint", name="beam up", type="slide", axis="0 0 1")
    if not level:
        _part(beam, "joint", name="beam tilt", type="hinge", axis="0 1 0")
    _part(beam, "geom", type="box", size=f"{reach} 1 {half}", contype=0, conaffinity=2)
    # Rayleigh damping: what is left of C after the storeys' dampers acts against the
    # beam.
    for i, (mass, row) in enumerate(zip(of.masses, of.damping_matrix, strict=True)):
        floor = _part(beam, "body")
        _part(floor, "inertial", pos="0 0 0", mass=mass, diaginertia="1 1 1")
        law = {"damping": sum(row), "stiffness": 0.0 if i else of.stiffnesses[0]}
        _part(floor, "joint", name=f"floor {i}", type="slide", axis="1 0 0", **law)
