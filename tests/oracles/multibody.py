"""Bodies in contact in mujoco: the model that `rps export` writes, run here, and what tests add.

The model is text that can be read by itself; nothing of it comes from the equations of the program.
What it cannot do: a sphere goes on rolling where an arc would end, so tilts must stay below beta.

Of devices a linear damper and friction act in the joint along which the cap beam slides, a stop is
a spring with a dead band there. A tendon is a cable from the ground through the middle of both ends
of a column to the beam, which pulls beyond its own length; rolling resistance is a coefficient of
the contacts, which takes the normal force as it is at each instant. Exponents and yielding the
engine has not. What bodies do otherwise than the model assumes are changes of the compiled text.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import SubElement, tostring

import numpy as np

from rpscli.tools.export.multibody import (
    SPACING,
    THICKNESS,
    TIME_STEP,
    Bodies,
    description,
    half_sizes,
)

from .crossings import Array
from .devices import Friction, RollingResistance, Stop, Tendon, Viscous
from .storey_lagrangian import Contact, StoreyLagrangian

STEPS_TOGETHER = 10
"""Steps under one value of the ground acceleration, that of their middle."""

ANCHORED = 1e-5
"""Depth of a cable's ends beyond the joints [m]: without it it has no direction at rest."""

SETTLING = 0.02
"""Time at rest before the ground moves [s], in which contacts take up the weight."""


LOWER, UPPER = 1, 2
"""Bits of the spheres at both ends of a column in the description."""

BOX = 6
"""`mjGEOM_BOX` of the engine."""

FOOTING = 2.0
"""Half size of the block under a column [m], more than any column travels."""


@dataclass(frozen=True)
class Departures:
    """Lengths in metres; without any, the description stays as it is.

    Contacts slide by Coulomb's law with `friction` in place of 3. A beam that is free to tilt takes
    floors with it that stand `storey_height` above each other. Columns stand `spacing` apart, and
    each is so much `longer` than said, with the same ends and mass, on a footing as much lower.
    """

    friction: float | None = None
    storey_height: float = 0.0
    spacing: float = SPACING
    longer: tuple[float, ...] = ()

    def apply(self, specification, columns, storeys):
        """Change the engine's specification."""
        for geom in specification.geoms if self.friction else ():
            geom.friction = self.friction, 0.0, 0.0
        for i in range(storeys):
            height = 0.5 * THICKNESS + (i + 1) * self.storey_height
            floor = specification.joint(f"floor {i}").parent
            floor.pos = 0.0, 0.0, height if self.storey_height else 0.0
        if self.spacing != SPACING:
            self._space(specification, columns)
        if any(self.longer):
            self._lengthen(specification)

    def _space(self, specification, columns):
        """The beam grows with the distance of the columns, and keeps its mass."""
        for c in range(columns):
            specification.joint(f"tilt {c}").parent.pos[0] *= self.spacing / SPACING
        beam = specification.joint("beam across").parent
        box = beam.geoms[0]
        box.size[0] *= self.spacing / SPACING
        beam.inertia = [beam.mass * (box.size[0] ** 2 + box.size[2] ** 2) / 3.0] * 3

    def _lengthen(self, specification):
        """All tops stay level; nothing stands on the ground itself any more."""
        world = specification.worldbody
        world.geoms[0].pos = 0.0, 0.0, -FOOTING
        for c, more in enumerate(self.longer):
            column = specification.joint(f"tilt {c}").parent
            column.pos[2] -= 0.5 * more
            for geom in column.geoms:
                geom.pos[2] += 0.5 * more * (1.0 if geom.contype == UPPER else -1.0)
            place = column.pos[0], 0.0, -more - FOOTING
            world.add_geom(
                type=BOX, pos=place, size=[FOOTING] * 3, contype=0, conaffinity=LOWER
            )


NO_DEPARTURES = Departures()


@dataclass(frozen=True, eq=False)
class MultibodyResult:
    """Tilt (mean of the columns) and drifts of each storey every `STEPS_TOGETHER` steps.

    `apart` is the longest time during which a column touched only the ground or only the beam [s].
    `carried` is the force under the floors over their weight, where they stand on vertical springs.
    `joints` has the position of each by its name [m or rad].
    """

    time: Array
    rotation: Array
    drifts: Array
    apart: float
    joints: Mapping[str, Array]
    carried: Array | None = None


def simulate(
    system,
    ag,
    dt,
    duration,
    *,
    initial_rotation=0.0,
    columns=2,
    time_step=TIME_STEP,
    level=True,
    closing_damping=1.0,
    devices=(),
    vertical_period=None,
    departures=NO_DEPARTURES,
):
    """Response to ground acceleration samples [m/s2] from rest, or after release from a tilt.

    Unless `level`, the cap beam may tilt on its columns. `closing_damping` is that of contacts over
    critical: at 1 they part again with exp(-2) = 0.135 of the speed at which they closed; more
    than that keeps them closed. With a `vertical_period`, the first one, floors stand on equal
    vertical springs with 5 % of damping in the first mode, in proportion to stiffness.
    """
    import mujoco  # an extra

    upright = None if vertical_period is None else Upright(system, vertical_period)
    bodies = Bodies(*(getattr(system, name) for name in Bodies._fields))
    described = description(
        bodies, columns, time_step=time_step, closing_damping=closing_damping, level=level
    )
    add_devices(described, devices, columns, half_sizes(bodies)[0], time_step)
    if upright:
        upright.add(described)
    specification = mujoco.MjSpec.from_string(tostring(described, "unicode"))
    departures.apply(specification, columns, len(system.masses))
    model = specification.compile()
    data = mujoco.MjData(model)
    _place(data, system, columns, initial_rotation)
    if not initial_rotation:
        mujoco.mj_step(model, data, round(SETTLING / time_step))
    interval = STEPS_TOGETHER * time_step
    count = round(duration / interval)
    middles = (np.arange(count) + 0.5) * interval
    pushes = np.interp(middles, np.arange(len(ag)) * dt, ag, right=0.0)
    rows = np.empty((count + 1, model.nq))
    touching, carried = np.empty(count + 1), np.ones(count + 1)
    for j in range(count + 1):
        if j:
            model.opt.gravity[0] = -pushes[j - 1]
            mujoco.mj_step(model, data, STEPS_TOGETHER)
        rows[j] = data.qpos
        touching[j] = data.ncon
        if upright:
            joint = data.joint("lift 0")
            carried[j] = upright.carried(float(joint.qpos[0]), float(joint.qvel[0]))
    needed = columns * (2 if system.cap_beam_mass else 1)
    joints = {
        model.joint(k).name: rows[:, model.jnt_qposadr[k]] for k in range(model.njnt)
    }
    floors = [
        np.zeros(count + 1),
        *(joints[f"floor {i}"] for i in range(len(system.masses))),
    ]
    return MultibodyResult(
        time=np.arange(count + 1, dtype=np.float64) * interval,
        rotation=np.mean([joints[f"tilt {c}"] for c in range(columns)], axis=0),
        drifts=np.diff(np.transpose(floors), axis=1),
        apart=interval * _longest(touching[1:] < needed),
        joints=joints,
        carried=carried if upright else None,
    )


def turning_points(rotation):
    """Largest |theta| of each swing, one a side."""
    swings = np.split(rotation, np.flatnonzero(np.diff(np.sign(rotation))) + 1)
    return np.array([np.max(np.abs(swing)) for swing in swings])


class Upright:
    """Floors on equal vertical springs, at rest under their weight."""

    def __init__(self, system, period):
        self.masses, n = np.asarray(system.masses), len(system.masses)
        chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        chain[-1, -1] = 1.0
        first = min(np.linalg.eigvals(chain / self.masses[:, None]).real)
        self.stiffness = (2.0 * math.pi / period) ** 2 / first
        self.damping = self.stiffness * 2.0 * 0.05 * period / (2.0 * math.pi)
        self.weights = system.gravity * np.cumsum(self.masses[::-1])[::-1]

    def add(self, described):
        """The freedom of each floor to rise, on a spring to what is below."""
        tendons = described.findall("tendon")[0]
        for i in range(len(self.masses)):
            law = {"stiffness": f"{self.stiffness}", "damping": f"{self.damping}"}
            rest = f"{self.rest(i)}"
            lift = {"name": f"lift {i}", "type": "slide", "axis": "0 0 1"}
            floor = owner(described, f"floor {i}")
            SubElement(floor, "joint", lift if i else lift | law | {"springref": rest})
            if i:
                spring = SubElement(tendons, "fixed", law | {"springlength": rest})
                for joint, sign in ((i, "1"), (i - 1, "-1")):
                    SubElement(spring, "joint", joint=f"lift {joint}", coef=sign)

    def rest(self, i):
        """How far the weight above compresses a spring [m]."""
        return float(self.weights[i] / self.stiffness)

    def carried(self, lift, rate):
        """Force under the first floor over the weight above."""
        force = self.stiffness * (self.rest(0) - lift) - self.damping * rate
        return float(force / self.weights[0])


def owner(described, joint):
    """The body that moves by a joint."""
    return described.findall(f".//joint[@name='{joint}']/..")[0]


def _place(data, system, columns, rotation):
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


def _longest(flags):
    """Length of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags, [0]))))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def add_devices(described, devices, columns, H, time_step):
    """Dampers and friction along the beam's way, resistance of contacts, stops and cables."""
    damping = sum(
        d.coefficient for d in devices if isinstance(d, Viscous) and d.exponent == 1.0
    )
    friction = sum(d.force for d in devices if isinstance(d, Friction))
    lever = sum(d.lever for d in devices if isinstance(d, RollingResistance))
    for joint in described.findall(".//joint[@name='beam across']"):
        joint.attrib |= {
            "damping": f"{damping}", "frictionloss": f"{friction}",
            "solreffriction": f"{2.0 * time_step} 1", "solimpfriction": "0.9999 0.9999 0.001",
        }  # fmt: skip
    if lever:  # in six dimensions
        described.findall("default/geom")[0].attrib |= {
            "friction": f"3 0 {lever}",
            "condim": "6",
        }
        # As stiff as the normal direction, or columns that come down later stay behind for good.
        described.findall("option")[0].set("impratio", "1")
    tendons = described.findall("tendon")[0]
    for device in devices:
        if isinstance(device, Stop):
            law = {"stiffness": f"{device.stiffness}"}
            spring = SubElement(
                tendons, "fixed", law | {"springlength": f"{-device.gap} {device.gap}"}
            )
            SubElement(spring, "joint", joint="beam across", coef="1")
        elif isinstance(device, Tendon):
            slack = 2.0 * (H + ANCHORED) - device.prestress / device.stiffness
            law = {"stiffness": f"{device.columns / columns * device.stiffness}"}
            for c in range(columns):
                cable = SubElement(
                    tendons, "spatial", law | {"springlength": f"0 {slack}"}
                )
                for name in ("ground", "foot", "head", "beam"):
                    SubElement(cable, "site", site=f"{name} {c}")
    for c in range(
        columns if any(isinstance(device, Tendon) for device in devices) else 0
    ):
        column = owner(described, f"tilt {c}")
        place = column.attrib["pos"].split()[0]
        # Where a cable begins in the ground, the middle of both ends, where it ends in the beam.
        for name, body, pos in (
            ("ground", described.findall("worldbody")[0], f"{place} 0 {-ANCHORED}"),
            ("foot", column, f"0 0 {-H}"),
            ("head", column, f"0 0 {H}"),
            (
                "beam",
                owner(described, "beam across"),
                f"{place} 0 {ANCHORED - 0.5 * THICKNESS}",
            ),
        ):
            SubElement(body, "site", name=f"{name} {c}", pos=pos)


# A round column with flat ends on the ground, its beam and floors, under both components.
#
# One column stands for all. A cylinder touches a plane exactly, while a rim of spheres under the
# beam would be an arc; so the beam is tied to twice the column's displacement instead, which is
# what its upper contact does. Hinges about x, y and x again whose outer angles are equal leave the
# rotations about horizontal axes, psi = -phi, so that the column does not roll out.

CONTACT_TIME = 8e-5


def inertia_ratios(tan_alpha):
    """Io and I_3/(m_c R^2) of a solid cylinder."""
    square = tan_alpha**2 / (1.0 + tan_alpha**2)
    return 1.0 + square / 4.0 + (1.0 - square) / 3.0, square / 2.0


def round_column(along_x, along_y):
    """The model; stiffness-proportional damping alone, between neighbouring floors."""
    height = along_x.R / math.hypot(1.0, along_x.tan_alpha)
    width = height * along_x.tan_alpha
    ratio, axial = inertia_ratios(along_x.tan_alpha)
    assert math.isclose(ratio, along_x.inertia_ratio)
    mass = along_x.columns_mass
    across, spin = (ratio - 1.0) * mass * along_x.R**2, axial * mass * along_x.R**2
    hinges = "".join(
        f'<joint name="{name}" type="hinge" axis="{axis}" armature="{1e-5 * across}"/>'
        for name, axis in (("outer", "1 0 0"), ("inner", "0 1 0"), ("again", "1 0 0"))
    )
    column = f"""<body pos="0 0 {height}">{slides("column")}{hinges}
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{across} {across} {spin}"/>
      <geom type="cylinder" size="{width} {height}"/></body>"""
    ties = '<joint joint1="outer" joint2="again" polycoef="0 1 0 0 0"/>'
    beam = ""
    if along_x.cap_beam_mass:
        ties += "".join(
            f'<joint joint1="beam {axis}" joint2="column {axis}" polycoef="0 2 0 0 0"/>'
            for axis in "xyz"
        )
        beam = f'<body pos="0 0 {2 * height}">{slides("beam")}{inertial(along_x.cap_beam_mass)}'
        beam += "".join(floor(i, along_x, along_y) for i in range(len(along_x.masses)))
        beam += "</body>" * (len(along_x.masses) + 1)
    contact = f'solref="{CONTACT_TIME} 1" solimp="0.99 0.999 0.001 0.5 2"'
    return f"""<mujoco>
  <compiler angle="radian"/>
  <option timestep="{TIME_STEP}" gravity="0 0 {-along_x.gravity}" integrator="implicitfast"
   cone="elliptic" impratio="100" tolerance="1e-12" iterations="50"/>
  <default><geom friction="3 0 0" {contact}/><equality {contact}/></default>
  <worldbody><geom type="plane" size="20 20 1"/>{column}{beam}</worldbody>
  <equality>{ties}</equality></mujoco>"""


def slides(name):
    return "".join(
        f'<joint name="{name} {axis}" type="slide" axis="{direction}"/>'
        for axis, direction in (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))
    )


def inertial(mass):
    return f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>'


def floor(i, along_x, along_y):
    """One floor on springs to what is below, whose body it is in; left open."""
    joints = ""
    for axis, direction, way in (("x", "1 0 0", along_x), ("y", "0 1 0", along_y)):
        summation = np.tril(np.ones((len(way.masses),) * 2))
        damping = summation.T @ way.damping_matrix @ summation
        assert np.allclose(damping, np.diag(np.diag(damping)))
        joints += f"""<joint name="floor {i} {axis}" type="slide" axis="{direction}"
          stiffness="{way.stiffnesses[i]}" damping="{damping[i, i]}"/>"""
    return f'<body pos="0 0 1">{joints}{inertial(along_x.masses[i])}'


def simulate_pair(along_x, along_y, ground, dt, duration):
    """Times and (X, Y) under `ground` (3, m: a_x, a_y, a_v), from rest."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(round_column(along_x, along_y))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, round(SETTLING / TIME_STEP))
    interval = STEPS_TOGETHER * TIME_STEP
    count = round(duration / interval)
    middles = (np.arange(count) + 0.5) * interval
    samples = np.arange(ground.shape[1]) * dt
    pushes = [np.interp(middles, samples, row, right=0.0) for row in ground]
    hinges = [int(model.joint(name).qposadr[0]) for name in ("outer", "inner")]
    tilts = np.zeros((count + 1, 2))
    for j in range(count):
        model.opt.gravity[:] = -np.array([row[j] for row in pushes])
        model.opt.gravity[2] -= along_x.gravity
        mujoco.mj_step(model, data, STEPS_TOGETHER)
        outer, inner = data.qpos[hinges]
        # the axis of the rotation qx(outer) qy(inner) qx(outer)
        axis = np.array([math.cos(inner / 2.0) * math.sin(outer), math.sin(inner / 2.0)])
        size = math.hypot(*axis)
        angle = 2.0 * math.atan2(size, math.cos(inner / 2.0) * math.cos(outer))
        if size > 0.0:
            tilts[j + 1] = angle / size * axis[1], -angle / size * axis[0]
    return interval * np.arange(count + 1, dtype=np.float64), tilts
