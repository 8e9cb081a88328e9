"""The podium as rigid bodies in contact, in a physics engine that knows none of our equations.

mujoco moves bodies under gravity, springs and contacts. Each column slides along x and z and turns
about y; an arc of radius r on its end is a sphere of that radius around (+-B, +-(H - r)), and flat
ends are four tiny spheres at the corners. Spheres touch the ground, a plane, or the underside of
the cap beam, a box that slides along x and z; it does not tilt, as floors stay level in the model.
Floors slide on the beam, coupled by springs and dampers. The ground motion is horizontal gravity.

Nothing says when the storey lifts, what happens at an impact, or which law floors obey: contacts
push and never pull, rub without sliding (friction 3), and give back no energy when they close.
What it cannot do: a sphere goes on rolling where an arc would end, so tilts must stay below beta.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .crossings import Array
from .devices import OracleDevice, RollingResistance
from .multibody_devices import (
    anchors,
    beam_joint,
    contact_friction,
    ducts,
    holds,
    springs,
)
from .storey_lagrangian import Contact, OracleSystem, StoreyLagrangian

TIME_STEP = 2e-5
"""Contacts close within some of these [s]: far below the periods of a building."""

CLOSING_STEPS = 4
"""Time constant of a contact in steps (`solref`); below 2 the engine is unstable."""

STEPS_TOGETHER = 10
"""Steps under one value of the ground acceleration, that of their middle."""

CORNER = 1e-4
"""Radius of the spheres at the corners of flat ends [m]: H is ten thousand times as large."""

SETTLING = 0.02
"""Time at rest before the ground moves [s], in which contacts take up the weight."""

SPACING = 6.0
"""Distance between columns [m]; without influence, as the beam stays level."""

THICKNESS = 0.5
"""Of the cap beam [m]; without influence."""

OPTIONS = 'integrator="implicitfast" cone="elliptic" tolerance="1e-12" iterations="100"'

STIFF_FRICTION = 100
"""Over that of the normal direction (`impratio`), so that contacts do not creep; where they resist
rolling it is 1, or columns that come down after the others stay behind for good."""


@dataclass(frozen=True, eq=False)
class MultibodyResult:
    """Tilt (mean of the columns) and drifts of each storey every `STEPS_TOGETHER` steps.

    `apart` is the longest time during which a column touched only the ground or only the beam [s].
    `carried` is the force under the floors over their weight, where they stand on vertical springs.
    """

    time: Array
    rotation: Array
    drifts: Array
    apart: float
    carried: Array | None = None


def simulate(
    system: OracleSystem,
    ag: Array,
    dt: float,
    duration: float,
    *,
    initial_rotation: float = 0.0,
    columns: int = 2,
    time_step: float = TIME_STEP,
    level: bool = True,
    closing_damping: float = 1.0,
    devices: Sequence[OracleDevice] = (),
    vertical_period: float | None = None,
) -> MultibodyResult:
    """Response to ground acceleration samples [m/s2] from rest, or after release from a tilt.

    Unless `level`, the cap beam may tilt on its columns. `closing_damping` is that of contacts over
    critical: at 1 they part again with exp(-2) = 0.135 of the speed at which they closed; more
    than that keeps them closed. With a `vertical_period`, the first one, floors stand on equal
    vertical springs with 5 % of damping in the first mode, in proportion to stiffness.
    """
    import mujoco  # an extra

    upright = None if vertical_period is None else Upright(system, vertical_period)
    text = description(
        system,
        columns,
        time_step,
        closing_damping,
        level=level,
        devices=devices,
        upright=upright,
    )
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    _place(data, system, columns, initial_rotation)
    if not initial_rotation:
        mujoco.mj_step(model, data, round(SETTLING / time_step))
    interval = STEPS_TOGETHER * time_step
    count = round(duration / interval)
    middles = (np.arange(count) + 0.5) * interval
    pushes = np.interp(middles, np.arange(len(ag)) * dt, ag, right=0.0)
    tilts = _addresses(model, [f"tilt {c}" for c in range(columns)])
    floors = _addresses(model, [f"floor {i}" for i in range(len(system.masses))])
    rows = np.empty((count + 1, 1 + len(floors)))
    touching, carried = np.empty(count + 1), np.ones(count + 1)
    for j in range(count + 1):
        if j:
            model.opt.gravity[0] = -pushes[j - 1]
            mujoco.mj_step(model, data, STEPS_TOGETHER)
        rows[j] = data.qpos[tilts].mean(), *data.qpos[floors]
        touching[j] = data.ncon
        if upright:
            joint = data.joint("lift 0")
            carried[j] = upright.carried(float(joint.qpos[0]), float(joint.qvel[0]))
    needed = columns * (2 if system.cap_beam_mass else 1)
    return MultibodyResult(
        time=np.arange(count + 1, dtype=np.float64) * interval,
        rotation=rows[:, 0],
        drifts=np.diff(rows[:, 1:], axis=1, prepend=0.0),
        apart=interval * _longest(touching[1:] < needed),
        carried=carried if upright else None,
    )


class Upright:
    """Floors on equal vertical springs, at rest under their weight."""

    def __init__(self, system: OracleSystem, period: float) -> None:
        self.masses, n = np.asarray(system.masses), len(system.masses)
        chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        chain[-1, -1] = 1.0
        first = min(np.linalg.eigvals(chain / self.masses[:, None]).real)
        self.stiffness = (2.0 * math.pi / period) ** 2 / first
        self.damping = self.stiffness * 2.0 * 0.05 * period / (2.0 * math.pi)
        self.weights = system.gravity * np.cumsum(self.masses[::-1])[::-1]

    def joint(self, i: int) -> str:
        """The freedom of a floor to rise, with the spring to the beam for the first."""
        spring = f'stiffness="{self.stiffness}" springref="{self.rest(0)}"' if i == 0 else ""
        damping = f'damping="{self.damping}"' if i == 0 else ""
        return f'<joint name="lift {i}" type="slide" axis="0 0 1" {spring} {damping}/>'

    def spring(self, i: int) -> str:
        """Between a floor and the one below."""
        return (
            f'<fixed stiffness="{self.stiffness}" damping="{self.damping}"'
            f' springlength="{self.rest(i)}"><joint joint="lift {i}" coef="1"/>'
            f'<joint joint="lift {i - 1}" coef="-1"/></fixed>'
        )

    def rest(self, i: int) -> float:
        """How far the weight above compresses a spring [m]."""
        return float(self.weights[i] / self.stiffness)

    def carried(self, lift: float, rate: float) -> float:
        """Force under the first floor over the weight above."""
        force = self.stiffness * (self.rest(0) - lift) - self.damping * rate
        return float(force / self.weights[0])


def description(
    system: OracleSystem,
    columns: int,
    time_step: float,
    damping: float,
    *,
    level: bool,
    devices: Sequence[OracleDevice] = (),
    upright: Upright | None = None,
) -> str:
    """The structure in the engine's language."""
    bodies = [_column(system, c, columns) for c in range(columns)]
    bodies += [anchors(c, _place_of(c, columns)) for c in range(columns)]
    if system.cap_beam_mass:
        joint = beam_joint(devices, time_step)
        bodies.append(_cap_beam(system, columns, joint, level=level, upright=upright))
    stiff = 1 if any(isinstance(d, RollingResistance) for d in devices) else STIFF_FRICTION
    above = [upright.spring(i) for i in range(1, len(system.masses))] if upright else []
    tendons = [*_storeys(system), *above, *springs(devices, columns, _half_sizes(system)[0])]
    return f"""
    <mujoco>
      <compiler angle="radian" inertiafromgeom="false"/>
      <option timestep="{time_step}" gravity="0 0 {-system.gravity}"
              impratio="{stiff}" {OPTIONS}/>
      <default>
        <geom solref="{CLOSING_STEPS * time_step} {damping}" solimp="0.999 0.999 0.001"
              {contact_friction(devices)} mass="0"/>
      </default>
      <worldbody>
        <geom type="plane" size="0 0 1" contype="0" conaffinity="1"/>
        {"".join(bodies)}
      </worldbody>
      <tendon>{"".join(tendons)}</tendon>
    </mujoco>"""


def _half_sizes(system: OracleSystem) -> tuple[float, float, float]:
    """H, B and r [m]."""
    height = system.R / math.hypot(1.0, system.tan_alpha)
    return height, height * system.tan_alpha, 2.0 * system.rho * height


def _column(system: OracleSystem, number: int, columns: int) -> str:
    H, B, r = _half_sizes(system)
    r = r or CORNER
    mass = system.columns_mass / columns
    spin = (system.inertia_ratio - 1.0) * mass * system.R**2
    # the lower spheres meet the ground (bit 1), the upper ones the beam (bit 2)
    ends = "".join(
        f'<geom type="sphere" size="{r}" pos="{side * B} 0 {end * (H - r)}"'
        f' contype="{1 if end < 0 else 2}" conaffinity="0"/>'
        for end in (-1, 1)
        for side in (-1, 1)
    )
    return f"""
    <body pos="{_place_of(number, columns)} 0 {H}">
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{spin} {spin} {spin}"/>
      <joint name="across {number}" type="slide" axis="1 0 0"/>
      <joint name="up {number}" type="slide" axis="0 0 1"/>
      <joint name="tilt {number}" type="hinge" axis="0 1 0"/>
      {ends}{ducts(number, H)}
    </body>"""


def _place_of(number: int, columns: int) -> float:
    return (number - 0.5 * (columns - 1)) * SPACING


def _cap_beam(
    system: OracleSystem, columns: int, joint: str, *, level: bool, upright: Upright | None = None
) -> str:
    H, half, reach = _half_sizes(system)[0], 0.5 * THICKNESS, 0.5 * columns * SPACING
    spin = system.cap_beam_mass * (half**2 + reach**2) / 3.0
    # Rayleigh damping: what is left of C after the storeys' dampers acts against the beam.
    floors = "".join(
        f'<body><inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>'
        f'<joint name="floor {i}" type="slide" axis="1 0 0" damping="{damping}"'
        f' stiffness="{0.0 if i else system.stiffnesses[0]}"/>'
        f"{upright.joint(i) if upright else ''}</body>"
        for i, (mass, damping) in enumerate(
            zip(system.masses, system.damping_matrix.sum(axis=1), strict=True)
        )
    )
    return f"""
    <body pos="0 0 {2.0 * H + half}">
      <inertial pos="0 0 0" mass="{system.cap_beam_mass}" diaginertia="{spin} {spin} {spin}"/>
      <joint name="beam across" type="slide" axis="1 0 0" {joint}/>
      <joint name="beam up" type="slide" axis="0 0 1"/>
      {"" if level else '<joint name="beam tilt" type="hinge" axis="0 1 0"/>'}
      <geom type="box" size="{reach} 1 {half}" contype="0" conaffinity="2"/>
      {"".join(holds(c, _place_of(c, columns), -half) for c in range(columns))}
      {floors}
    </body>"""


def _storeys(system: OracleSystem) -> Iterator[str]:
    """Springs and dampers between the floors; those of the first storey are in its joint."""
    for i in range(1, len(system.masses)):
        yield (
            f'<fixed stiffness="{system.stiffnesses[i]}"'
            f' damping="{-system.damping_matrix[i - 1, i]}">'
            f'<joint joint="floor {i}" coef="1"/><joint joint="floor {i - 1}" coef="-1"/></fixed>'
        )


def _addresses(model: Any, names: list[str]) -> list[int]:
    return [int(model.joint(name).qposadr[0]) for name in names]


def _place(data: Any, system: OracleSystem, columns: int, rotation: float) -> None:
    """Columns tilted on their edges with the beam on top, at rest."""
    if not rotation:
        return
    storey = StoreyLagrangian(system)
    side = 1 if rotation > 0.0 else -1
    contact = Contact(side, rolling=abs(rotation) < storey.beta)
    shift, _, _ = storey.cap_beam(abs(rotation), rolling=contact.rolling)
    placed = {"beam across": side * shift.real, "beam up": shift.imag}
    for c in range(columns):
        placed |= {
            f"across {c}": 0.5 * side * shift.real,
            f"up {c}": 0.5 * shift.imag,
            f"tilt {c}": rotation,
        }
    for name, value in placed.items():
        if system.cap_beam_mass or not name.startswith("beam"):
            data.joint(name).qpos[0] = value


def _longest(flags: NDArray[np.bool_]) -> int:
    """Length of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags, [0]))))
    return int(np.max(edges[1::2] - edges[::2], initial=0))
