"""Both components on compliant and spherical ends, with friction and rolling resistance.

The histories of `both_references.json` come from a program that shares no equation with this one:
momenta of the tilt vector, complex-step derivatives of the Lagrangian, an adaptive rule of order 8
at 1e-12. Their results have ten digits.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from paper_structures import Array, RecordLoader, ground, needs_compiled_kernels
from two_components import History, followed, frame, pair, released, two_pulses

import rpscli
from rpscli.analyses.kernels.history import SampledHistory, sampled_history
from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.case.case import load_case
from rpscli.constants import STANDARD_GRAVITY
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, RollingResistance, Stop, Tendon, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import Device, PodiumStructure
from rpscli.physics.bed import first_phase, load_bed
from rpscli.physics.devices import load_devices
from rpscli.physics.follow import load_system
from rpscli.physics.friction import grip_of
from rpscli.physics.laws import place_of
from rpscli.physics.state import IMPACT, SLIDING, STATE, STICKING, STUCK, UPLIFT, Record, records
from rpscli.physics.upright import enter_phase, set_polar
from rpscli.records.ground_motion import MotionComponents

REFERENCES: dict[str, list[dict[str, Any]]] = json.loads(
    (Path(__file__).parents[1] / "oracles" / "both_references.json").read_text()
)
HISTORIES = {each["name"]: each for each in REFERENCES["histories"]}
STEP = 0.01


def motion_of(reference: dict[str, Any], fema_record: RecordLoader) -> MotionComponents:
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
    both = [fema_record(f"farfield/{of['fema']}/{way}") for way in "ab"]
    dt = both[0].dt
    first, count = round(of["t0"] / dt), round(reference["T"] / dt) + 1
    x, y = (of["scale"] * each.acceleration[first : first + count] for each in both)
    return pair(x, y, dt)


@needs_compiled_kernels
@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("name", HISTORIES)
def test_histories_of_another_program(name: str, fema_record: RecordLoader) -> None:
    reference = HISTORIES[name]
    motion = motion_of(reference, fema_record)
    structure = load_case({"rps": 1, **reference["case"]}).structure
    free = max(reference["T"] - motion.horizontal.duration, 0.0)
    history = followed(structure, motion, TimeHistorySettings(free_vibration=free))
    trace, left = np.array(reference["trace"]), history.left
    rows = np.rint(trace[:, 0] / motion.horizontal.dt).astype(int)
    tilt = trace[:, 1] + 1j * trace[:, 2]
    # 1e-10 rad are found, 5e-8 where friction lets go, of which a motion begins with some velocity
    held = left.events[SLIDING] > 0
    assert np.max(np.abs(history.tilt[rows] - tilt)) < (1e-7 if held else 3e-9)
    assert left.max_theta == pytest.approx(reference["max_tilt"], rel=1e-6 if held else 1e-7)
    if structure.superstructure is not None:
        elastic = elastic_shear(structure, history)[: rows[-1] + 1].max()
        assert elastic == pytest.approx(reference["base_shear"], rel=1e-6)
    spent = reference["energy"]
    for mine, theirs in (
        (left.energy_input, "input"),
        (left.energy_damped, "damped"),
        (left.bed_energy, "bed"),
        (left.energy_lost, "impact"),
        (left.energy_stored, "stored"),
        (left.device_energy.sum(), "devices"),
    ):
        assert mine == pytest.approx(
            spent[theirs], abs=(3e-7 if held else 1e-7) * spent["input"]
        ), theirs
    uplifts, reentries, sticks = reference["events"]
    begins_stuck = left.events[STICKING] > 0 and structure.bearing.alpha * (not structure.bed) == 0
    assert left.events[UPLIFT] == uplifts
    assert left.events[IMPACT] == reentries
    assert left.events[STICKING] - begins_stuck == sticks
    assert (left.phase == STUCK or history.samples.phase[-1] == STUCK) == reference["stuck"]


def elastic_shear(structure: PodiumStructure, history: History) -> Array:
    """Resultant of the springs of the first storey at the samples [N]."""
    n, both = structure.storeys, []
    for axis, building in enumerate(
        (structure.superstructure, structure.superstructure_y or structure.superstructure)
    ):
        assert building is not None
        first = history.floors[:, 0, n * axis] - history.samples.beam[:, axis]
        both.append(building.stiffnesses[0] * first)
    return np.asarray(np.hypot(*both))


PLANE, EDGES = (Contact(kind, stiffness=6.34e8, damping=0.0) for kind in ("plane", "edges"))


@needs_compiled_kernels
@pytest.mark.evidence("both components", "program")
@pytest.mark.parametrize("reference", REFERENCES["free"], ids=["near", "nearest", "edges"])
def test_free_motion_on_compliant_ends(reference: dict[str, Any]) -> None:
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


W = frame(3, 3.0).weight
SOFT: dict[str, Any] = {"loss": 0.3, "tan_wedge": 0.3, "rho": 0.5}
ENDS: dict[str, dict[str, Any]] = {
    "plane": {"contact": Contact("plane", period_ratio=1.2), "loss": 0.3},
    "plane arcs": {"contact": Contact("plane", period_ratio=1.2), **SOFT},
    "edges": {"contact": Contact("edges", period_ratio=1.2)},
    "edges arcs": {"contact": Contact("edges", period_ratio=1.2), **SOFT},
    "spherical": {"tan_alpha": 0.0, "tan_wedge": 0.3, "rho": 0.8},
}
RIGID: dict[str, dict[str, Any]] = {"rigid": {"rho": 0.0}, "rigid arcs": SOFT}
DEVICES: dict[str, tuple[Device, ...]] = {
    "": (),
    "viscous": (ViscousDamper(0.2 * W),),
    "friction": (FrictionDamper(0.02 * W),),
    "rolling": (RollingResistance(0.02),),
    "friction and rolling": (FrictionDamper(0.01 * W), RollingResistance(0.01)),
}


def structure_of(end: str, kind: str = "", **options: Any) -> PodiumStructure:
    return frame(3, 3.0, devices=DEVICES[kind], **{**ENDS[end], **options})


@needs_compiled_kernels
@pytest.mark.parametrize("end", [end for end in ENDS if end != "spherical"])
def test_sustained_upward_acceleration(end: str) -> None:
    """Where the bed pushes out what lifted ends turn back, histories go on, and energy closes."""
    x, y = two_pulses()
    up = 3.0 * np.ones(len(x))
    settings = TimeHistorySettings(free_vibration=2.0)
    history = followed(structure_of(end), pair(x, y, STEP, up), settings)
    assert history.left.outcome in (1, 2, 3)
    assert abs(history.residual) < 1e-6


# Geometry and inertia.


def lane_of(structure: PodiumStructure) -> Record:
    """A lane of the kernel in the phase in which a tilt to any side grows, at none."""
    state = records(STATE, 1, 2, 1)[0]
    system = stacked_systems([(structure, TimeHistorySettings())], pairs=True)[0]
    load_system(state, 0, system)
    load_devices(state, 0, system)
    load_bed(state, 0, system)
    enter_phase(state, 0, system, first_phase(system))
    return state


@pytest.mark.evidence("both components", "exact")
@pytest.mark.parametrize("end", ["rigid", "rigid arcs", *ENDS])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_slopes_are_what_differences_tend_to(end: str, part: float) -> None:
    """Central differences of order 4 over parts of a thousandth leave some 1e-11."""
    state = lane_of(frame(3, 3.0, **RIGID.get(end) or ENDS[end]))
    low = max(state.x_low[0], 0.0)
    tilt = low + part * (min(state.x_high[0], 0.3) - low)
    step, at = 1e-3 * tilt, place_of(state, 0, tilt)
    around = [place_of(state, 0, tilt + k * step) for k in (-2, -1, 1, 2)]
    slopes = {"Bv": at.Bv_slope, "A": 2.0 * at.D, "h": at.dh, "K": at.K_slope, "G": at.G_slope}
    for name, slope in slopes.items():
        values = np.array([getattr(each, name) for each in around])
        difference = np.array([1.0, -8.0, 8.0, -1.0]) @ values / (12.0 * step)
        assert slope == pytest.approx(difference, rel=1e-9, abs=1e-9)
    assert at.cone == pytest.approx((at.K - at.A) / tilt, rel=1e-9, abs=1e-11)


# What friction holds.


@pytest.mark.evidence("devices", "exact")
@pytest.mark.parametrize("kind", ["friction", "rolling", "friction and rolling"])
def test_what_is_held_is_held_against_every_direction(kind: str) -> None:
    """Q.d <= P |W d| + M for 360 vectors d, on either side of the margin's zero."""
    left = lane_of(structure_of("spherical", kind))
    set_polar(left, 0, 0.12, 0.6, 0.8, 0.0, 0.0)
    at = place_of(left, 0, 0.12)
    P = left.share[0] * left.friction_force[0]
    M = left.share[0] * left.friction_moment[0] / left.diameter[0]
    back = at.Bv * left.weigh[0] * left.gravity[0]
    angles = np.radians(np.arange(0.0, 360.0, 0.25))
    d = np.array([np.cos(angles), np.sin(angles)])
    most = P * np.hypot(at.C * d[0], at.h * d[1]) + M
    rng = np.random.default_rng(5)
    signs = set()
    for _ in range(200):
        n, t = rng.normal(0.0, 1.5 * (P + M), 2)
        z = (0.6 * (n + back / at.C) - 0.8 * t, 0.8 * (n + back / at.C) + 0.6 * t)
        grip = grip_of(left, 0, z, (0.0, 0.0), (left.gravity[0], 0.0), 0.0)
        margin = np.min(most - at.C * n * d[0] - at.h * t * d[1])
        if abs(margin) > 1e-4 * (P + M):
            assert (margin >= 0.0) == (grip.margin >= 0.0)
            assert (grip.used <= 1.0) == (margin >= 0.0)
            signs.add(margin >= 0.0)
    assert len(signs) == 2


# What the laws are made of.


@needs_compiled_kernels
@pytest.mark.evidence("compliant ends", "exact")
@pytest.mark.parametrize("end", [end for end in ENDS if end != "spherical"])
def test_in_proportion_to_the_stiffness(end: str) -> None:
    """Stiffer and stiffer, the motion of rigid ends with passes that lose nothing."""
    x, y = two_pulses(2.0)
    options = {k: v for k, v in ENDS[end].items() if k != "contact"} | {"loss": 0.0}
    rigid = followed(frame(3, 3.0, **options, contact_time=0.0), pair(x, y, STEP))
    gaps = []
    for stiffness in (1e10, 1e11, 1e12):
        contact = replace(EDGES if end.startswith("edges") else PLANE, stiffness=stiffness)
        soft = followed(frame(3, 3.0, **options, contact=contact), pair(x, y, STEP))
        gaps.append(np.max(np.abs(soft.tilt - rigid.tilt)))
    assert rigid.left.max_theta > 0.02
    assert gaps[0] > 1.5 * gaps[1] > 2.2 * gaps[2]
    if end.startswith("edges"):
        assert gaps[2] < 1e-5


@needs_compiled_kernels
@pytest.mark.parametrize("aim", [0.0, 1e-12, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("contact", [PLANE, EDGES], ids=["plane", "edges"])
def test_passes_at_any_distance(contact: Contact, aim: float) -> None:
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
WORDS: dict[str, tuple[Device, ...]] = {
    "viscous": (ViscousDamper(0.2 * W),),
    "friction": (FrictionDamper(0.02 * W),),
    "stop": (Stop(0.05, 20.0 * W),),
    "tendon": (Tendon(0.02 * W, W),),
    "rolling_resistance": (RollingResistance(0.01),),
}


def cells() -> Iterator[tuple[str, bool, str, bool]]:
    """Ends, whether both components act, device or law, and whether the guide says yes."""
    rows = GUIDE[GUIDE.index(HEAD) :].split("\n\n", 1)[0].splitlines()
    names = [cell.strip().split(" ")[0].strip("`") for cell in rows[0].split("|")[1:-1]]
    for row in rows[2:]:
        kinds, components, *marks = (cell.strip() for cell in row.split("|")[1:-1])
        for end in kinds.replace("`", "").split(", "):
            for name, mark in zip(names[2:], marks, strict=True):
                yield end, components == "both", name, mark.startswith("yes")


@needs_compiled_kernels
@pytest.mark.parametrize(("end", "both", "name", "goes"), list(cells()))
def test_every_cell_of_the_guide(end: str, both: bool, name: str, goes: bool) -> None:
    x, y = two_pulses(3.0)
    motion = pair(x, y, STEP, 0.3 * x) if both else MotionComponents(ground(x, STEP))

    def run() -> History | SampledHistory:
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


def test_the_guide_has_every_combination() -> None:
    said = {(end, both, name) for end, both, name, _ in cells()}
    assert said == set(
        product(("rigid", "plane", "edges", "spherical"), (False, True), (*WORDS, "impact"))
    )
