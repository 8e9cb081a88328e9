"""Motion under both components: near passes, symmetries, other programs, every end and device.

The histories of `both_references.json` come from a program that shares no equation with this one:
momenta of the tilt vector, complex-step derivatives of the Lagrangian, an adaptive rule of order 8
at 1e-12. Their results have ten digits.
"""

import json
import math
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from conformance import conforms
from oracles.spatial_integrator import SpatialSimulation, simulate_pair
from paper_structures import (
    ground,
    known,
    needs_compiled_kernels,
    oracle_devices,
    oracle_system,
    part,
    waves,
)
from two_components import (
    followed,
    frame,
    pair,
    part_of_pair,
    released,
    two_pulses,
)

import rpscli
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.contact import Contact
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.physics.state import IMPACT, SLIDING, STICKING, STUCK, UPLIFT
from rpscli.records.ground_motion import MotionComponents

pytestmark = needs_compiled_kernels

ORACLES = Path(__file__).parents[1] / "oracles"
REFERENCES = json.loads((ORACLES / "spatial_references.json").read_text())
OTHERS = json.loads((ORACLES / "both_references.json").read_text())
HISTORIES = {each["name"]: each for each in OTHERS["histories"]}
STEP = 0.01
ARCS = {"tan_wedge": 0.3, "rho": 0.5}
THREE = {"storeys": 3, "eta": 3.0, **ARCS}
FINE = TimeHistorySettings(free_vibration=0.0, accuracy=4.0)
X, Y = two_pulses()
PULSES = pair(X, Y, STEP)

TURNS = {
    "frame": ({}, 181.997),
    "three storeys": ({"storeys": 3, "eta": 3.0}, 187.385),
}


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("across", [4e-8, 4e-9, 1.2e-9])
@pytest.mark.parametrize("building", TURNS)
def test_angle_of_turn(building, across):
    """Without loss pi sqrt(A/K), however near (1.2e-9: the map); with an impact's straight on."""
    above, turn = TURNS[building]
    for contact_time, expected in ((0.0, turn), (2e-3, 180.0)):
        structure = frame(**above, contact_time=contact_time)
        free = released(structure, 0.06, across, 0.75, dt=1e-3)
        passed = free.passes[0]
        beyond = (np.arange(len(free.samples)) * 1e-3 > passed.time) & (
            free.samples.theta > 2e-3
        )
        azimuth = math.degrees(free.samples.azimuth[np.flatnonzero(beyond)[0]]) % 360.0
        assert azimuth == pytest.approx(expected, abs=0.003)
        if across == 1.2e-9:
            assert passed.least_tilt < 5e-10


def upwards():
    """A vertical motion with its largest pulses about uplift [m/s2]."""
    t = np.arange(0.0, 6.0, STEP)
    z, y = (np.pi * (t - 1.45) / 0.4) ** 2, (np.pi * (t - 2.3) / 0.3) ** 2
    return np.asarray(
        2.5 * (1.0 - 2.0 * z) * np.exp(-z) - 2.0 * (1.0 - 2.0 * y) * np.exp(-y)
    )


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize(
    ("vertical", "contact_time", "largest"),
    [
        (False, 0.0, 0.077501321),
        (False, 2e-3, 0.077567924),
        (True, 0.0, 0.077789294),
        (True, 2e-3, 0.077858273),
    ],
)
def test_two_pulses(vertical, contact_time, largest):
    """Maxima by two other programs, vertical motion at uplift included."""
    motion = pair(X, Y, STEP, upwards() if vertical else None)
    structure = frame(**THREE, contact_time=contact_time)
    fine = TimeHistorySettings(free_vibration=0.0, accuracy=3.0)
    finest = followed(structure, motion, fine).left.max_theta
    usual = followed(structure, motion)
    for name, found, within in (
        ("accuracy 3", finest, 1e-8),
        ("default step", usual.left.max_theta, 1e-6),
    ):
        conforms(
            "both components", f"largest tilt [rad], two pulses, {name}", largest, found,
            within, "independent program", "Cartesian tilts, and polar coordinates",
        )  # fmt: skip
    assert abs(usual.residual) < 2e-6


def polar(quantity, expected, found, within):
    conforms(
        "both components", f"{quantity}, recorded pair", expected, found, within,
        "independent program", "adaptive integrator in polar coordinates",
    )  # fmt: skip


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("row", range(len(REFERENCES["records"])))
def test_recorded_pairs_of_another_program(row, fema_record):
    """An adaptive integrator in polar coordinates, in which uplifts begin at 1e-9 rad: all
    digits that are known of it.
    """
    given = REFERENCES["records"][row]
    n, rho = given["n"], given["rho"]
    ends = {"rho": rho, "tan_wedge": 0.3} if rho else {}
    structure = frame(n, float(n), 0.1 * n or 0.3, contact_time=given["t_c"], **ends)
    history = followed(structure, part_of_pair(given, fema_record), uplift_tilt=1e-9)
    dt = given["T"] / (len(history.samples) - 1)
    # there, floors kept their velocities relative to the beam at re-contact
    until = given["recontact"] or given["T"]
    for t, x, y in given["X_Y"]:
        assert t > until or abs(history.tilt[round(t / dt)] - complex(x, y)) < 1e-7
    assert abs(history.residual) < 1e-8
    if given["recontact"]:
        assert history.recontacts.time[0] == pytest.approx(until, abs=1e-8)
        return
    polar("largest tilt [rad]", given["max"], history.left.max_theta, 5e-7)
    if given["uplift"]:
        begins = history.of_kind(UPLIFT)[0].time
        polar("time of uplift [s]", given["uplift"][0], begins, 1e-9)
    if given["passes"]:
        assert len(history.passes) == given["passes"]
        lost = history.left.energy_passes / structure.columns_mass
        polar("loss of passes over m_c [J/kg]", given["lost"], lost, 1e-6 * given["lost"])


def test_directions_are_exchanged_with_their_buildings():
    """Another building in y: x and y change places."""
    options = {"storeys": 3, "eta": 3.0, "contact_time": 2e-3}
    one = followed(frame(**options, period=0.3, period_y=0.5), PULSES)
    other = followed(frame(**options, period=0.5, period_y=0.3), pair(Y, X, STEP))
    mirrored = 1j * np.conj(one.tilt)
    assert np.max(np.abs(mirrored - other.tilt)) < 1e-6 * 0.08
    assert np.allclose(
        one.left.storey_shear_x[:3], other.left.storey_shear_y[:3], rtol=1e-5
    )
    assert one.left.storey_shear_x[0] != pytest.approx(
        one.left.storey_shear_y[0], rel=0.01
    )
    same = followed(frame(**options, period=0.3, period_y=0.3), PULSES)
    assert same.tilt.tolist() == followed(frame(**options), PULSES).tilt.tolist()


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize(
    "options", [{"contact_time": 0.0}, {"factor": 1.0 / 0.8388687078360144}]
)
def test_nothing_is_lost_without_contact_time_or_loss(options):
    history = followed(frame(**{**THREE, **options}), PULSES)
    assert len(history.passes)
    assert history.left.energy_passes == pytest.approx(
        0.0, abs=1e-12 * history.left.energy_input
    )


W = frame(3, 3.0).weight

KINDS = {
    "linear": ViscousDamper(0.3 * W),
    "root": ViscousDamper(0.2 * W, 0.5),
    "power": ViscousDamper(0.3 * W, 1.8),
    "stop": Stop(0.05, 20.0 * W, 2.0 * W),
    "no gap": Stop(0.0, 0.5 * W, 0.2 * W),
    "tendon": Tendon(0.05 * W, 3.0 * W),
    "yields": Tendon(0.05 * W, 3.0 * W, 0.11 * W),
}


def equipped(kind, storeys=3, **options):
    return frame(storeys, 3.0, contact_time=2e-3, devices=(KINDS[kind],), **options)


def beside_the_second_integrator(kind, arcs, x, y, storeys=3):
    """Cartesian, adaptive, laws as functions: the same tilts throughout."""
    structure = equipped(kind, storeys, **(ARCS if arcs else {}))
    ours = followed(structure, pair(x, y, STEP), FINE, uplift_tilt=1e-9)  # as it does
    run = SpatialSimulation(
        oracle_system(structure),
        axial=structure.bearing.inertia_ratio_axial,
        contact_time=2e-3,
        integrated_spin=True,
        begins_at=1e-9,
        devices=oracle_devices(structure),
    )
    states = simulate_pair(run, np.array([x, y, 0.0 * x]), STEP, STEP * (len(x) - 1))
    assert run.max_tilt > 1e-3
    gap = np.abs(states[:, 0] + 1j * states[:, 1] - ours.tilt)
    assert np.max(gap) < 1e-9  # 1e-12 are found, 1e-10 where a damped stop lets go
    assert abs(ours.residual) < 1e-9


def test_a_third_of_a_second_with_a_damper():
    x, y = two_pulses()[:, 80:115]
    x[0] = y[0] = 0.0
    beside_the_second_integrator("root", True, x, y, 1)


@pytest.mark.long
@pytest.mark.parametrize("arcs", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_against_the_second_integrator(kind, arcs):
    beside_the_second_integrator(kind, arcs, *two_pulses(2.0))


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("seed", range(4))
def test_energy_closes_where_tendons_yield_and_columns_go_round(seed):
    """Where x' = 0 ends yielding, what goes on across the tilt is not stopped."""
    structure = equipped("yields", 2)
    peak = 3.0 * structure.uplift_acceleration
    motion = MotionComponents(
        waves(6.0, 0.01, peak, seed), y=waves(6.0, 0.01, peak, seed + 50)
    )
    result = time_history(structure, motion, TimeHistorySettings(free_vibration=1.0))
    assert sum(event.kind == "tendon_yielding" for event in result.events) >= 1
    assert known(result.passes) >= 1
    assert abs(result.energy.residual) < 1e-7 * result.energy.input


def motion_of(reference, fema_record):
    """Sines, or a part of a recorded pair."""
    of = reference["motion"]
    if "sines" in of:
        t = np.arange(of["npts"]) * of["dt"]
        x, y = (
            np.where(
                (t >= start) & (t <= start + period),
                a * STANDARD_GRAVITY * np.sin(2.0 * np.pi * (t - start) / period),
                0.0,
            )
            for a, period, start in of["sines"]
        )
        return pair(x, y, of["dt"])
    along, across = (
        part(
            fema_record(f"farfield/{of['fema']}/{way}"),
            of["t0"],
            reference["T"],
            of["scale"],
        )
        for way in "ab"
    )
    return MotionComponents(along, y=across)


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("name", HISTORIES)
def test_histories_of_another_program(name, fema_record):
    reference = HISTORIES[name]
    motion = motion_of(reference, fema_record)
    structure = load_case({"rps": 1, **reference["case"]}).structure
    free = max(reference["T"] - motion.horizontal.duration, 0.0)
    settings = TimeHistorySettings(free_vibration=free)
    history = followed(structure, motion, settings, uplift_tilt=1e-9)  # as it does
    trace, left = np.array(reference["trace"]), history.left
    rows = np.rint(trace[:, 0] / motion.horizontal.dt).astype(int)
    tilt = trace[:, 1] + 1j * trace[:, 2]
    # 1e-10 rad are found, 5e-8 where friction lets go, of which a motion begins with some velocity
    held = left.events[SLIDING] > 0
    capability = "compliant ends" if structure.bed else "both components"

    def same(quantity, expected, found, within):
        conforms(
            capability, f"{quantity} of a history", expected, found, within,
            "independent program", "momenta, complex-step derivatives, order 8",
        )  # fmt: skip

    far = 1e-7 if held else 3e-9
    same("tilts towards x [rad]", tilt.real, history.tilt[rows].real, far)
    same("tilts towards y [rad]", tilt.imag, history.tilt[rows].imag, far)
    top = reference["max_tilt"]
    same("largest tilt [rad]", top, left.max_theta, (1e-6 if held else 1e-7) * top)
    if structure.superstructure is not None:
        elastic = elastic_shear(structure, history)[: rows[-1] + 1].max()
        shear = reference["base_shear"]
        same("base shear [N]", shear, elastic, 1e-6 * shear)
    spent = reference["energy"]
    for mine, theirs in (
        (left.energy_input, "input"),
        (left.energy_damped, "damped"),
        (left.bed_energy, "bed"),
        (left.energy_lost, "impact"),
        (left.energy_stored, "stored"),
        (left.device_energy.sum(), "devices"),
    ):
        within = (3e-7 if held else 1e-7) * spent["input"]
        same(f"energy {theirs} [J]", spent[theirs], mine, within)
    uplifts, reentries, sticks = reference["events"]
    begins_stuck = (
        left.events[STICKING] > 0 and structure.bearing.alpha * (not structure.bed) == 0
    )
    assert left.events[UPLIFT] == uplifts
    assert left.events[IMPACT] == reentries
    assert left.events[STICKING] - begins_stuck == sticks
    assert (left.phase == STUCK or history.samples.phase[-1] == STUCK) == reference[
        "stuck"
    ]


def elastic_shear(structure, history):
    """Resultant of the springs of the first storey at the samples [N]."""
    n, both = structure.storeys, []
    for axis, building in enumerate(
        (structure.superstructure, structure.superstructure_y or structure.superstructure)
    ):
        assert building is not None
        first = history.floors[:, 0, n * axis] - history.samples.beam[:, axis]
        both.append(building.stiffnesses[0] * first)
    return np.asarray(np.hypot(*both))


PLANE, EDGES = (
    Contact(kind, stiffness=6.34e8, damping=0.0) for kind in ("plane", "edges")
)


@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("reference", OTHERS["free"], ids=["near", "nearest", "edges"])
def test_free_motion_on_compliant_ends(reference):
    """Energy and momentum stay; the other program's path."""
    contact = PLANE if reference["kind"] == "plane" else EDGES
    plain = frame(loss=0.0)
    bearing = replace(plain.bearing, inertia_ratio=1.35)
    structure = replace(
        plain, bearing=bearing, columns_mass=2e4, cap_beam_mass=2e5, contact=contact
    )
    free = released(structure, 0.06, reference["across"], 10.0, accuracy=4.0)
    trace = np.array(reference["trace"])
    rows = np.rint(trace[:, 0] / STEP).astype(int)
    assert np.max(np.abs(free.tilt[rows] - trace[:, 1] - 1j * trace[:, 2])) < 1e-9
    begun = free.samples[0].energy_stored
    assert free.left.energy_stored == pytest.approx(begun, rel=1e-9)


SOFT = {"loss": 0.3, **ARCS}
ENDS = {
    "plane": {"contact": Contact("plane", period_ratio=1.2), "loss": 0.3},
    "plane arcs": {"contact": Contact("plane", period_ratio=1.2), **SOFT},
    "edges": {"contact": Contact("edges", period_ratio=1.2)},
    "edges arcs": {"contact": Contact("edges", period_ratio=1.2), **SOFT},
    "spherical": {"tan_alpha": 0.0, "tan_wedge": 0.3, "rho": 0.8},
}
GIVING_WAY = [end for end in ENDS if end != "spherical"]


@pytest.mark.parametrize("end", GIVING_WAY)
def test_sustained_upward_acceleration(end):
    """Where the bed pushes out what lifted ends turn back, histories go on, and energy closes."""
    motion = pair(X, Y, STEP, 3.0 * np.ones(len(X)))
    settings = TimeHistorySettings(free_vibration=2.0)
    history = followed(frame(3, 3.0, **ENDS[end]), motion, settings)
    assert history.left.outcome in (1, 2, 3)
    assert abs(history.residual) < 1e-6


@pytest.mark.evidence("compliant ends", "exact")
@pytest.mark.parametrize("end", GIVING_WAY)
def test_in_proportion_to_the_stiffness(end):
    """Stiffer and stiffer, the motion of rigid ends with passes that lose nothing."""
    x, y = two_pulses(2.0)
    options = {k: v for k, v in ENDS[end].items() if k != "contact"} | {"loss": 0.0}
    rigid = followed(frame(3, 3.0, **options, contact_time=0.0), pair(x, y, STEP))
    gaps = []
    for stiffness in (1e10, 1e11, 1e12):
        contact = replace(
            EDGES if end.startswith("edges") else PLANE, stiffness=stiffness
        )
        soft = followed(frame(3, 3.0, **options, contact=contact), pair(x, y, STEP))
        gaps.append(np.max(np.abs(soft.tilt - rigid.tilt)))
    assert rigid.left.max_theta > 0.02
    assert gaps[0] > 1.5 * gaps[1] > 2.2 * gaps[2]
    if end.startswith("edges"):
        assert gaps[2] < 1e-5


@pytest.mark.parametrize("aim", [0.0, 1e-12, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("contact", [PLANE, EDGES], ids=["plane", "edges"])
def test_passes_at_any_distance(contact, aim):
    """Aimed at parts of phi_u, nothing is lost without loss, and neighbours stay neighbours."""
    structure = frame(contact=contact, loss=0.0)
    assert structure.bed is not None
    u = structure.bed.uplift_rotation
    one, other = (
        released(structure, 0.06, part * u * 10.0, 3.0, accuracy=4.0)
        for part in (aim, aim * (1.0 + 1e-7))
    )
    assert one.left.energy_stored == pytest.approx(one.samples[0].energy_stored, rel=1e-9)
    assert np.max(np.abs(one.tilt - other.tilt)) < 1e-6


# What goes together.

GUIDE = Path(rpscli.__file__).with_name("GUIDE.md").read_text(encoding="utf-8")
HEAD = "| ends | components |"
REFUSED = {
    "tendon": "tendons",
    "rolling_resistance": "rolling resistance",
    "impact": "floors.*jump",
}
WORDS = {
    "viscous": (ViscousDamper(0.2 * W),),
    "friction": (FrictionDamper(0.02 * W),),
    "stop": (Stop(0.05, 20.0 * W),),
    "tendon": (Tendon(0.02 * W, W),),
    "rolling_resistance": (RollingResistance(0.01),),
}


def cells():
    """Ends, whether both components act, device or law, and whether the guide says yes."""
    rows = GUIDE[GUIDE.index(HEAD) :].split("\n\n", 1)[0].splitlines()
    names = [cell.strip().split(" ")[0].strip("`") for cell in rows[0].split("|")[1:-1]]
    for row in rows[2:]:
        kinds, components, *marks = (cell.strip() for cell in row.split("|")[1:-1])
        for end in kinds.replace("`", "").split(", "):
            for name, mark in zip(names[2:], marks, strict=True):
                yield end, components == "both", name, mark.startswith("yes")


@pytest.mark.parametrize(("end", "both", "name", "goes"), list(cells()))
def test_every_cell_of_the_guide(end, both, name, goes):
    x, y = two_pulses(3.0)
    motion = pair(x, y, STEP, 0.3 * x) if both else MotionComponents(ground(x, STEP))

    def run():
        plain = frame(3, 3.0, **({} if end == "rigid" else ENDS[end]))
        if name != "impact":
            structure = replace(plain, devices=WORDS[name])
        else:
            structure = replace(plain, impact_law=ImpactLaw("rigid"))
        follow = followed if both else sampled_history
        return follow(structure, motion, TimeHistorySettings(free_vibration=0.0))

    if goes:
        assert run().samples.theta[-1] != 0.0
    else:
        with pytest.raises(ValueError, match=REFUSED[name]):
            run()


def test_the_guide_has_every_combination():
    said = {(end, both, name) for end, both, name, _ in cells()}
    assert said == set(
        product(
            ("rigid", "plane", "edges", "spherical"), (False, True), (*WORDS, "impact")
        )
    )
