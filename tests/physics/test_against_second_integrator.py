"""Whole histories against an integrator of other unknowns, other steps and another event search."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from conformance import conforms
from oracles.second_integrator import simulate
from paper_structures import (
    FLAT,
    building,
    needs_compiled_kernels,
    oracle_devices,
    oracle_system,
    part,
    podium,
    waves,
)

from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import ModalDamping, RayleighDamping

pytestmark = needs_compiled_kernels

DT = 0.02
RIGID, FLEXIBLE = ImpactLaw("rigid"), ImpactLaw("flexible")


class Case(NamedTuple):
    """A structure, the peak acceleration [g tan alpha], and whether the ground also rises."""

    structure: PodiumStructure
    peak: float
    shaken_upwards: bool = False


CASES = {
    "frame, flat": Case(podium(0, 0.15, FLAT), 2.5),
    "frame, rolling to rocking": Case(podium(0, 0.10, 1.5), 4.0, shaken_upwards=True),
    "frame, negative stiffness": Case(podium(0, 0.20, 0.26), 3.0),
    "one storey, flat": Case(podium(1, 0.15, FLAT), 2.5, shaken_upwards=True),
    "one storey, zero stiffness": Case(podium(1, 0.15, 0.5, law=FLEXIBLE), 3.0),
    "one storey, measured restitution": Case(
        podium(1, 0.15, 1.5, law=ImpactLaw("value", 0.8)), 3.0
    ),
    "three storeys, flat": Case(podium(3, 0.10, FLAT, law=FLEXIBLE), 3.0),
    "three storeys, negative": Case(podium(3, 0.15, 0.26), 3.0, shaken_upwards=True),
    "three storeys, zero": Case(podium(3, 0.15, 0.5, R=0.6), 3.0),
    "three storeys, positive": Case(
        podium(3, 0.10, 1.5, law=FLEXIBLE), 4.0, shaken_upwards=True
    ),
    "modal damping": Case(
        podium(2, 0.15, 0.5, superstructure=building(2, damping=ModalDamping(0.03))), 3.0
    ),
    "undamped": Case(
        podium(2, 0.15, 0.3, superstructure=building(2, damping=RayleighDamping(0.0))),
        3.0,
    ),
}


RESTS = 1e-300
"""So that a tolerance of what does not move is positive, too."""


def agree(
    structure,
    record,
    vertical,
    free_vibration,
    tolerance,
    capability="buildings on bearings under earthquakes",
):
    """Compare two histories; returns the program's own."""

    def same(quantity, expected, found, within):
        conforms(
            capability, f"{quantity} of a history", expected, found, within + RESTS,
            "independent program", "second integrator, DOP853 in tilt and drifts",
        )  # fmt: skip

    settings = TimeHistorySettings(free_vibration=free_vibration, accuracy=4.0)
    result = time_history(
        structure, record, settings, vertical=vertical, with_fixed_base=False
    )
    other = simulate(
        oracle_system(structure),
        record.acceleration,
        record.dt,
        av=None if vertical is None else vertical.acceleration,
        free_vibration=free_vibration,
        devices=oracle_devices(structure),
    )
    assert (result.impacts, result.uplifts) == (other.impacts, other.uplifts)
    assert result.overturned == other.overturned
    largest = other.max_rotation
    same("largest tilt [rad]", largest, result.max_rotation, tolerance * largest)
    size = float(np.max(np.abs(other.theta)))
    rotation = result.trace.rotation[: len(other.theta)]
    expected = other.theta[: len(rotation)]
    same("tilts [rad]", expected, rotation, 10.0 * tolerance * size)
    if structure.storeys:
        shears = other.max_storey_shears_at_samples
        sampled = np.max(np.abs(result.trace.storey_shears), axis=0)
        same("largest storey shears [N]", shears, sampled, 10.0 * tolerance * shears)
        assert np.all(result.storey_shears >= (1.0 - 1e-9) * sampled)
    supplied = max(abs(result.energy.input), 1.0)
    lost = result.energy.impact
    same(
        "energy lost at impacts [J]", other.energy_lost, lost, 10.0 * tolerance * supplied
    )
    if structure.devices and not other.overturned:
        found = result.trace.devices
        taken = found.energy[-1] + found.stored[-1]
        within = 10.0 * tolerance * supplied
        same("work of devices [J]", np.asarray(other.device_work), taken, within)
        for device, demand, plastic in zip(
            structure.devices, result.devices, other.plastic, strict=True
        ):
            if isinstance(device, Tendon):
                left = max(0.0, device.prestress - device.stiffness * plastic)
                force = device.stiffness * float(result.structure.bearing.half_width)
                assert demand.remaining_prestress == pytest.approx(
                    left, abs=tolerance * force
                )
    return result


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize("name", CASES)
def test_both_roads_lead_to_the_same_history(name):
    structure, peak, shaken_upwards = CASES[name]
    record = waves(1.6, DT, peak * structure.uplift_acceleration, seed=len(name))
    vertical = waves(1.6, DT, 3.0, seed=99) if shaken_upwards else None
    # both converge to 1e-9 before impacts multiply that by up to a hundred
    assert agree(structure, record, vertical, 0.6, 1e-7).impacts >= 1


def with_devices(structure, *kinds):
    """The structure with devices that matter to it."""
    F, W, B = structure.uplift_force, structure.weight, structure.bearing.half_width
    known = {
        "linear damper": ViscousDamper(0.4 * F),
        "damper of 0.5": ViscousDamper(0.3 * F, 0.5),
        "damper of 1.6": ViscousDamper(0.5 * F, 1.6),
        "friction": FrictionDamper(0.3 * F),
        "much friction": FrictionDamper(1.1 * F),
        "rolling resistance": RollingResistance(0.1 * B),
        "stop": Stop(0.04, 20.0 * F),
        "damped stop": Stop(0.03, 20.0 * F, F),
        "stop without gap": Stop(0.0, 2.0 * F, 0.1 * F),
        "tendon": Tendon(0.03 * W, W),
        "yielding tendon": Tendon(0.02 * W, 3.0 * W, 0.04 * W),
        "loose tendon": Tendon(0.005 * W, 3.0 * W, 0.02 * W),
    }
    return replace(structure, devices=tuple(known[kind] for kind in kinds), columns=4)


EQUIPPED = {
    "linear damper": (podium(3, 0.15, 0.5, law=FLEXIBLE), 3.0),
    "damper of 0.5": (podium(1, 0.15, FLAT), 3.0),
    "damper of 1.6": (podium(2, 0.15, 1.5), 3.0),
    "friction": (podium(3, 0.15, 0.5), 3.0),
    "much friction": (podium(3, 0.15, 0.5, law=FLEXIBLE), 4.0),
    "much friction, rolling resistance": (podium(2, 0.10, 0.3, law=FLEXIBLE), 4.0),
    "rolling resistance": (podium(0, 0.15, 0.5), 3.0),
    "stop": (podium(3, 0.10, FLAT, law=FLEXIBLE), 3.0),
    "damped stop": (podium(3, 0.15, 0.5), 3.0),
    "stop without gap": (podium(2, 0.15, 0.26), 3.0),
    "tendon": (podium(3, 0.15, 0.26), 3.0),
    "yielding tendon": (podium(3, 0.10, FLAT, law=FLEXIBLE), 3.0),
    "loose tendon": (podium(0, 0.10, 1.5), 4.0),
    "friction, damped stop": (podium(3, 0.15, 0.5, law=FLEXIBLE), 3.0),
    "friction, linear damper, stop, yielding tendon": (
        podium(3, 0.10, 0.5, law=FLEXIBLE),
        4.0,
    ),
}


QUICK = {
    "damper of 0.5", "damped stop", "stop without gap", "loose tendon",
    "much friction, rolling resistance", "friction, linear damper, stop, yielding tendon",
}  # fmt: skip
"""Each kind of device once; the others are long."""


@pytest.mark.evidence("devices", "program")
@pytest.mark.parametrize(
    "names",
    [
        pytest.param(names, marks=[] if names in QUICK else pytest.mark.long)
        for names in EQUIPPED
    ],
)
def test_both_roads_with_devices(names):
    bare, peak = EQUIPPED[names]
    structure = with_devices(bare, *names.split(", "))
    record = waves(1.6, DT, peak * structure.uplift_acceleration, seed=len(names))
    vertical = waves(1.6, DT, 3.0, seed=99) if len(names) % 2 else None
    result = agree(structure, record, vertical, 0.6, 1e-7, "devices")
    assert result.uplifts >= 1
    kinds = {event.kind for event in result.events}
    assert ("sticking" in kinds) >= ("much friction" in names)
    assert ("stop_met" in kinds) >= ("stop" in names and "gap" not in names)
    assert ("tendon_yielding" in kinds) >= ("yielding" in names or "loose" in names)
    assert ("tendon_slack" in kinds) >= ("loose" in names)


MODAL = building(2, damping=ModalDamping(0.03))
SOON_AT_REST = [
    podium(0, 0.15, FLAT, law=ImpactLaw("value", 0.4)),
    podium(1, 0.15, 0.5, law=ImpactLaw("rigid", factor=0.6)),
    podium(3, 0.15, FLAT, law=ImpactLaw("flexible", factor=0.6)),
    podium(2, 0.15, 0.5, law=ImpactLaw("value", 0.4), superstructure=MODAL),
]


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize(
    "structure", SOON_AT_REST, ids=lambda s: f"{s.storeys}-{s.impact_law.kind}"
)
def test_both_roads_lock_alike(structure):
    """Through re-contacts and what follows in full contact and beyond."""
    record = waves(2.4, DT, 1.6 * structure.uplift_acceleration, seed=5)
    result = agree(structure, record, None, 0.6, 1e-7)
    assert [event.kind for event in result.events].count("recontact") >= 2


@pytest.mark.evidence("vertical motion", "program")
@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.parametrize(
    ("rho", "law"), [(FLAT, RIGID), (0.26, FLEXIBLE), (0.5, RIGID), (1.5, FLEXIBLE)]
)
def test_both_roads_under_a_piece_of_an_earthquake(rho, law, fema_record):
    whole = fema_record("farfield/1/b")
    peak = int(np.argmax(np.abs(whole.acceleration))) * whole.dt
    record = part(whole, max(peak - 100 * whole.dt, 0.0), 199 * whole.dt)
    structure = podium(3, 0.10, rho, law=law)
    assert agree(structure, record, None, 0.5, 1e-7).impacts >= 1


@pytest.mark.evidence("buildings on bearings under earthquakes", "program")
@pytest.mark.long
@pytest.mark.parametrize("seed", range(100))
def test_both_roads_for_random_structures(seed):
    rng = np.random.default_rng(seed)
    n, tan_alpha = int(rng.integers(0, 5)), rng.uniform(0.05, 0.25)
    damping = RayleighDamping(float(rng.choice([0.0, 0.02, 0.1])))
    period = float(rng.choice([0.03, 0.1, 0.3])) * max(n, 1)
    structure = podium(
        n,
        tan_alpha,
        float(rng.choice([FLAT, 0.26, 0.5, 1.5])),
        R=float(rng.choice([0.5, 1.5, 5.0])),
        law=rng.choice(np.array([RIGID, FLEXIBLE], dtype=object)),
        superstructure=building(n, period, damping) if n else None,
    )
    peak = rng.uniform(1.5, 5.0) * structure.uplift_acceleration
    record = waves(4.0, DT, peak, seed=seed)
    vertical = waves(4.0, DT, 3.0, seed=seed + 1000) if seed % 2 else None
    agree(structure, record, vertical, 2.0, 1e-5)
