"""A round column with flat ends on the ground, its beam and floors, as bodies in contact in mujoco.

One column stands for all. A cylinder touches a plane exactly, while a rim of spheres under the beam
would be an arc; so the beam is tied to twice the column's displacement instead, which is what its
upper contact does. Hinges about x, y and x again whose outer angles are equal leave the rotations
about horizontal axes, psi = -phi, so that the column does not roll out.
"""

from __future__ import annotations

import math

import numpy as np

from .crossings import Array
from .storey_lagrangian import OracleSystem

TIME_STEP = 2e-5
CONTACT_TIME = 8e-5
SETTLING = 0.02
STEPS_TOGETHER = 10
"""Steps under one value of the ground acceleration, that of their middle."""


def inertia_ratios(tan_alpha: float) -> tuple[float, float]:
    """Io and I_3/(m_c R^2) of a solid cylinder."""
    square = tan_alpha**2 / (1.0 + tan_alpha**2)
    return 1.0 + square / 4.0 + (1.0 - square) / 3.0, square / 2.0


def description(along_x: OracleSystem, along_y: OracleSystem) -> str:
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


def slides(name: str) -> str:
    return "".join(
        f'<joint name="{name} {axis}" type="slide" axis="{direction}"/>'
        for axis, direction in (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))
    )


def inertial(mass: float) -> str:
    return f'<inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>'


def floor(i: int, along_x: OracleSystem, along_y: OracleSystem) -> str:
    """One floor on springs to what is below, whose body it is in; left open."""
    joints = ""
    for axis, direction, way in (("x", "1 0 0", along_x), ("y", "0 1 0", along_y)):
        summation = np.tril(np.ones((len(way.masses),) * 2))
        damping = summation.T @ way.damping_matrix @ summation
        assert np.allclose(damping, np.diag(np.diag(damping)))
        joints += f"""<joint name="floor {i} {axis}" type="slide" axis="{direction}"
          stiffness="{way.stiffnesses[i]}" damping="{damping[i, i]}"/>"""
    return f'<body pos="0 0 1">{joints}{inertial(along_x.masses[i])}'


def simulate(
    along_x: OracleSystem, along_y: OracleSystem, ground: Array, dt: float, duration: float
) -> tuple[Array, Array]:
    """Times and (X, Y) under `ground` (3, m: a_x, a_y, a_v), from rest."""
    import mujoco  # an extra

    model = mujoco.MjModel.from_xml_string(description(along_x, along_y))
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
