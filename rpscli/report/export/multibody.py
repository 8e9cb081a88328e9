"""The podium as rigid bodies in contact, for mujoco, which knows none of our equations.

Each column slides along x and z and turns about y; an arc of radius r on its end is a sphere of
that radius around (+-B, +-(H - r)), and flat ends are four tiny spheres at the corners. Spheres
touch the ground, a plane, or the underside of the cap beam, a box that slides along x and z; it
does not tilt, as floors stay level in the model. Floors slide on the beam, coupled by springs and
dampers. Contacts push and never pull, rub without sliding (friction 3), and give back no energy
when they close: nothing says when the storey lifts, or what happens at an impact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from rpscli.model.podium import Array, PodiumStructure

TIME_STEP = 2e-5
"""Contacts close within some of these [s]: far below the periods of a building."""

CLOSING_STEPS = 4
"""Time constant of a contact in steps (`solref`); below 2 the engine is unstable."""

CORNER = 1e-4
"""Radius of the spheres at the corners of flat ends [m]: H is ten thousand times as large."""

SPACING = 6.0
"""Distance between columns [m]; without influence, as the beam stays level."""

THICKNESS = 0.5
"""Of the cap beam [m]; without influence."""

STIFF_FRICTION = 100
"""Over that of the normal direction (`impratio`), so that contacts do not creep."""

OPTIONS = 'integrator="implicitfast" cone="elliptic" tolerance="1e-12" iterations="100"'


class Bodies(NamedTuple):
    """R, tan(alpha), rho, I_o/(m_c R^2), masses, storeys from the bottom, gravity; SI units."""

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


class Added(NamedTuple):
    """Further parts of the model: attributes, joints and sites, springs."""

    beam_joint: str = ""
    contacts: str = 'friction="3 0 0" condim="3"'
    friction: int = STIFF_FRICTION
    in_ground: Callable[[int, float], str] = lambda _, __: ""
    in_column: Callable[[int, float], str] = lambda _, __: ""
    in_beam: Callable[[int, float], str] = lambda _, __: ""
    on_floor: Callable[[int], str] = lambda _: ""
    springs: Iterable[str] = ()


PLAIN = Added()


def bodies_of(structure: PodiumStructure) -> Bodies:
    """Numbers of a structure."""
    bearing, above = structure.bearing, structure.superstructure
    names = ("masses", "stiffnesses", "damping_matrix")
    masses, stiffnesses, damping = ((getattr(above, name) if above else ()) for name in names)
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
    added: Added = PLAIN,
) -> str:
    """The structure in the engine's language; without a cap beam columns stand free."""
    bodies = [_column(of, c, columns, added) for c in range(columns)]
    bodies += [added.in_ground(c, _place_of(c, columns)) for c in range(columns)]
    if of.cap_beam_mass:
        bodies.append(_cap_beam(of, columns, added, level=level))
    return f"""
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <option timestep="{time_step}" gravity="0 0 {-of.gravity}" impratio="{added.friction}" {OPTIONS}/>
  <default>
    <geom solref="{CLOSING_STEPS * time_step} {closing_damping}" solimp="0.999 0.999 0.001"
          {added.contacts} mass="0"/>
  </default>
  <worldbody>
    <geom type="plane" size="0 0 1" contype="0" conaffinity="1"/>{"".join(bodies)}
  </worldbody>
  <tendon>{"".join((*_storeys(of), *added.springs))}</tendon>
</mujoco>"""


def half_sizes(of: Bodies) -> tuple[float, float, float]:
    """H, B and r [m]."""
    height = of.R / math.hypot(1.0, of.tan_alpha)
    return height, height * of.tan_alpha, 2.0 * of.rho * height


def _column(of: Bodies, number: int, columns: int, added: Added) -> str:
    H, B, r = half_sizes(of)
    r = r or CORNER
    mass = of.columns_mass / columns
    spin = (of.inertia_ratio - 1.0) * mass * of.R**2
    # the lower spheres meet the ground (bit 1), the upper ones the beam (bit 2)
    ends = "".join(
        f'\n      <geom type="sphere" size="{r}" pos="{side * B} 0 {end * (H - r)}"'
        f' contype="{1 if end < 0 else 2}" conaffinity="0"/>'
        for end in (-1, 1)
        for side in (-1, 1)
    )
    return f"""
    <body pos="{_place_of(number, columns)} 0 {H}">
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{spin} {spin} {spin}"/>
      <joint name="across {number}" type="slide" axis="1 0 0"/>
      <joint name="up {number}" type="slide" axis="0 0 1"/>
      <joint name="tilt {number}" type="hinge" axis="0 1 0"/>{ends}{added.in_column(number, H)}
    </body>"""


def _place_of(number: int, columns: int) -> float:
    return (number - 0.5 * (columns - 1)) * SPACING


def _cap_beam(of: Bodies, columns: int, added: Added, *, level: bool) -> str:
    H, half, reach = half_sizes(of)[0], 0.5 * THICKNESS, 0.5 * columns * SPACING
    spin = of.cap_beam_mass * (half**2 + reach**2) / 3.0
    # Rayleigh damping: what is left of C after the storeys' dampers acts against the beam.
    floors = "".join(
        f'\n      <body><inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>'
        f'<joint name="floor {i}" type="slide" axis="1 0 0" damping="{sum(row)}"'
        f' stiffness="{0.0 if i else of.stiffnesses[0]}"/>{added.on_floor(i)}</body>'
        for i, (mass, row) in enumerate(zip(of.masses, of.damping_matrix, strict=True))
    )
    return f"""
    <body pos="0 0 {2.0 * H + half}">
      <inertial pos="0 0 0" mass="{of.cap_beam_mass}" diaginertia="{spin} {spin} {spin}"/>
      <joint name="beam across" type="slide" axis="1 0 0" {added.beam_joint}/>
      <joint name="beam up" type="slide" axis="0 0 1"/>
      {"" if level else '<joint name="beam tilt" type="hinge" axis="0 1 0"/>'}
      <geom type="box" size="{reach} 1 {half}" contype="0" conaffinity="2"/>
      {"".join(added.in_beam(c, _place_of(c, columns)) for c in range(columns))}{floors}
    </body>"""


def _storeys(of: Bodies) -> Iterator[str]:
    """Springs and dampers between the floors; those of the first storey are in its joint."""
    for i in range(1, len(of.masses)):
        yield (
            f'\n    <fixed stiffness="{of.stiffnesses[i]}"'
            f' damping="{-of.damping_matrix[i - 1][i]}">'
            f'<joint joint="floor {i}" coef="1"/><joint joint="floor {i - 1}" coef="-1"/></fixed>'
        )
