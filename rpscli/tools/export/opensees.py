"""The podium as a spring of OpenSees that stiffens until it uplifts,
and a damper for impacts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rpscli.analyses.results import TimeHistoryResult
from rpscli.model.podium import Array
from rpscli.model.superstructure import Superstructure

BEFORE_UPLIFT = 1e-4
"""Displacement of the cap beam at which the spring uplifts, over the critical one."""

POINTS = 120
"""Of the spring on each side."""

_MODEL = '''"""{limits}
"""

import openseespy.opensees as ops

TITLE = {title}
STOREYS = {storeys}
BEAM = {beam}  # kg: cap beam, and what of the columns moves with it
PUSHED = {pushed}  # kg: what the ground's acceleration pushes
MASSES = {masses}  # kg, from the bottom
DAMPERS = {dampers}  # N s/m, between floors i and j; 0 is the cap beam
SPRINGS = {springs}  # {meaning}
DISPLACEMENTS = {displacements}  # m, of the cap beam
FORCES = {forces}  # N, that hold it there
LOSS = {loss}  # N s/m, for impacts


def build(ground, dt, released=0.0):
    """Nodes 0 (ground), 1 (cap beam) and floors above it; ground accelerations [m/s2]
    every dt.
    """
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(0, 0.0)
    ops.fix(0, 1)
    for node, mass in enumerate([BEAM, *MASSES], 1):
        ops.node(node, 0.0, "-mass", mass)
    ops.uniaxialMaterial("ElasticMultiLinear", 1, "-strain", *DISPLACEMENTS, "-stress", *FORCES)
    ops.element("zeroLength", 1, 0, 1, "-mat", 1, "-dir", 1)
    springs = [(i, i + 1, *law) for i, law in enumerate(SPRINGS, 1)]
    dashpots = [(i + 1, j + 1, 0.0, coefficient) for i, j, coefficient in DAMPERS]
    for tag, (i, j, *law) in enumerate([(0, 1, 0.0, LOSS), *springs, *dashpots], 2):
        ops.uniaxialMaterial("Steel01" if len(law) == 3 else "Elastic", tag, *law)
        ops.element("zeroLength", tag, i, j, "-mat", tag, "-dir", 1)
    for node in range(1, STOREYS + 2):
        ops.setNodeDisp(node, 1, released, "-commit")
    ops.timeSeries("Path", 1, "-dt", dt, "-values", *ground)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.pattern("Plain", 2, 1)
    ops.load(1, BEAM - PUSHED)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormUnbalance", 1e-6 * max(FORCES), 100)
    ops.algorithm("NewtonLineSearch")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
'''

LIMITS = """\
A spring between ground and cap beam follows the static force of the columns, linear up to
{before:.2g} m, where it uplifts, out and back on the same path. It leaves out the inertia of what
rises, of the order of tan(alpha)^2 = {square:.2g}. Impacts, e = {e:.4g}, are a damper of
{loss:.4g} N s/m, which takes as much in one swing from {amplitude:.4g} m, the largest in rps that
the weight restores, as an impact in its middle; of smaller swings it takes a smaller share.
{note}"""


def model_text(result: TimeHistoryResult, title: str, note: str) -> tuple[str, str]:
    """The model as a file, and its limits in words."""
    structure = result.structure
    bearing = structure.bearing
    above = structure.superstructure
    spin = (bearing.inertia_ratio - 1.0) * (1.0 + bearing.slenderness**2)
    moving = 0.25 * structure.columns_mass * (spin + 1.0) + structure.cap_beam_mass
    spring = _spring(result)
    damper = _impact_damper(result, spring, moving)
    limits = LIMITS.format(
        before=spring.before, square=bearing.slenderness**2, e=structure.restitution,
        loss=damper.loss, amplitude=damper.amplitude, note=note,
    )  # fmt: skip
    springs, meaning = _storeys(above)
    text = _MODEL.format(
        title=repr(title), limits=limits, storeys=structure.storeys,
        beam=moving, pushed=0.5 * structure.columns_mass + structure.cap_beam_mass,
        masses=[] if above is None else above.masses.tolist(), springs=springs, meaning=meaning,
        dampers=_dampers(above), displacements=spring.displacements.tolist(),
        forces=spring.forces.tolist(), loss=damper.loss,
    )  # fmt: skip
    return text, limits


class _Spring(NamedTuple):
    """Static force [N] of the columns over the displacement of the cap beam [m].

    It uplifts at the displacement `before`, and no weight restores it beyond `limit`.
    """

    before: float
    limit: float
    displacements: Array
    forces: Array


def _spring(result: TimeHistoryResult) -> _Spring:
    """The static path to both sides, linear before uplift."""
    structure = result.structure
    critical = structure.critical_rotation
    farthest = max(1.2, result.settings.overturning_limit) * critical
    largest = structure.bearing.largest_rotation
    rotation = np.linspace(0.0, min(farthest, largest), POINTS + 1)
    force, beam, _ = structure.path(rotation)
    limit = float(np.interp(critical, rotation, beam))
    before = BEFORE_UPLIFT * limit
    sides = np.concatenate(([before], beam[1:])), np.concatenate((force[:1], force[1:]))
    displacements, forces = (np.concatenate((-x[::-1], [0.0], x)) for x in sides)
    return _Spring(before, limit, displacements, forces)


class _ImpactDamper(NamedTuple):
    """Amplitude [m] of the swing of which it takes what an impact takes, and N s/m."""

    amplitude: float
    loss: float


def _impact_damper(
    result: TimeHistoryResult, spring: _Spring, moving: float
) -> _ImpactDamper:
    """The damper for impacts of a cap beam with so much moving mass [kg]."""
    structure = result.structure
    amplitude = max(
        min(result.max_cap_beam_displacement, spring.limit), 10.0 * spring.before
    )
    # Of one swing through: the speed where the beam is, of the energy at its end.
    u = np.linspace(0.0, amplitude, 2001)
    held = np.interp(u, spring.displacements, spring.forces)
    energy = np.concatenate(([0.0], np.cumsum(0.5 * (held[1:] + held[:-1]) * np.diff(u))))
    total = moving + structure.superstructure_mass
    speed = np.sqrt(2.0 * np.maximum(energy[-1] - energy, 0.0) / total)
    jumping = moving if structure.impact_law.kind == "flexible" else total
    lost = (1.0 - structure.restitution**2) * float(energy[-1]) * jumping / total
    return _ImpactDamper(amplitude, 0.5 * lost / float(np.trapezoid(speed, u)))


def _dampers(above: Superstructure | None) -> list[tuple[int, int, float]]:
    """Coefficients [N s/m] between floors, of which 0 is the cap beam."""
    if above is None:
        return []
    C = above.damping_matrix
    n = len(C)
    dampers = [(0, i + 1, float(C[i].sum())) for i in range(n)]
    dampers += [
        (i + 1, j + 1, -float(C[i, j])) for i in range(n) for j in range(i + 1, n)
    ]
    return [each for each in dampers if abs(each[2]) > 1e-9 * abs(C).max()]


def _storeys(above: Superstructure | None) -> tuple[list[tuple[float, ...]], str]:
    """Springs of the storeys, and the meaning of their numbers."""
    springs: list[tuple[float, ...]] = []
    springs += [] if above is None else [(k, 0.0) for k in above.stiffnesses.tolist()]
    meaning = "N/m and N s/m, of the storeys"
    if above is not None and above.strengths is not None:
        meaning = "N, N/m and -, of the storeys: strength, stiffness, hardening"
        laws = zip(above.strengths.tolist(), above.stiffnesses.tolist(), strict=True)
        springs = [(*law, above.hardening) for law in laws]
    return springs, meaning
