"""Laws of other packages: against those of ours that say the same, in lanes, and guarded."""

import math
from dataclasses import replace

import numpy as np
import pytest
from paper_structures import FLAT, needs_compiled_kernels, podium, printed_by, waves
from two_components import frame, pair, two_pulses

from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.schema.fields import Quantity
from rpscli.errors import PluginError
from rpscli.model.contact import Contact
from rpscli.model.devices import FrictionDamper, OwnDamper, ViscousDamper
from rpscli.model.impact import ImpactLaw
from rpscli.model.own import DamperLaw, RestitutionLaw
from rpscli.records.ground_motion import MotionComponents

DT = 0.02
ONE = MotionComponents(waves(2.0, DT, 3.5, seed=5))
ALONG, ACROSS = 0.8 * two_pulses(2.4, DT)
BOTH = pair(ALONG, ACROSS, DT)
SETTINGS = TimeHistorySettings(free_vibration=0.4, recontact_tolerance=1e-3)
C = 1.5e5


def linear(path: float, speed: float, c: float) -> float:
    return c * speed


def relieved(path: float, speed: float, c: float, opens: float) -> float:
    return c * min(speed, opens)


def opening(path: float, speed: float, c: float, opens: float) -> float:
    return opens - speed


def harder(path: float, speed: float, c: float, gap: float) -> float:
    return c * speed * (1.0 + 10.0 * max(path / gap - 1.0, 0.0))


def reached(path: float, speed: float, c: float, gap: float) -> float:
    return gap - path


def most(c: float, *_: float) -> float:
    return c


def thrice(c: float, *_: float) -> float:
    return 3.0 * c


def given(
    rate: float, tan_alpha: float, inertia: float, gamma: float, eta: float, e: float
) -> float:
    return e


def softer(
    rate: float, tan_alpha: float, inertia: float, gamma: float, eta: float
) -> float:
    return (
        0.95 - 0.5 * min(rate, 1.0) * tan_alpha + 1e-3 * (inertia - 1.0) / (gamma + eta)
    )


PLAIN = Quantity()
ONE_CONSTANT = {"c": PLAIN}
LINEAR = DamperLaw(ONE_CONSTANT, linear, most, most)
RELIEVED = DamperLaw({"c": PLAIN, "opens": PLAIN}, relieved, most, most, watched=opening)
HARDER = DamperLaw({"c": PLAIN, "gap": PLAIN}, harder, thrice, most, watched=reached)
UNWATCHED = replace(RELIEVED, watched=None)
OPENS, GAP = 0.05, 0.0235
GIVEN = RestitutionLaw({"e": PLAIN}, given)


def with_own(structure, law, *values):
    others = tuple(
        each for each in structure.devices if not isinstance(each, ViscousDamper)
    )
    return replace(structure, devices=(OwnDamper("own", law, values), *others))


def history(structure, motion=ONE, accuracy=1.0):
    settings = replace(SETTINGS, accuracy=accuracy)
    return time_history(structure, motion, settings, with_fixed_base=False)


VISCOUS = ViscousDamper(C)
SMALL = podium(1, 0.1, 0.5, R=0.4, law=ImpactLaw("flexible"))
USUAL = podium(1, 0.1, 0.5, law=ImpactLaw("flexible"))
CASES = {
    "curved ends": (replace(USUAL, devices=(VISCOUS,)), ONE),
    "flat ends and friction": (
        replace(
            podium(0, 0.15, FLAT, law=ImpactLaw("flexible")),
            devices=(VISCOUS, FrictionDamper(3e4)),
        ),
        ONE,
    ),
    "plane ends": (
        frame(
            1,
            3.0,
            tan_alpha=0.1,
            contact=Contact("plane", period_ratio=1.2),
            devices=(VISCOUS,),
        ),
        ONE,
    ),
    "both components": (frame(1, 3.0, tan_alpha=0.1, devices=(VISCOUS,)), BOTH),
    "both on curved ends": (
        frame(
            1,
            2.0,
            tan_alpha=0.1,
            tan_wedge=0.2,
            rho=0.4,
            contact_time=2e-3,
            devices=(VISCOUS,),
        ),
        BOTH,
    ),
}
of_cases = pytest.mark.parametrize("name", CASES)


@of_cases
@needs_compiled_kernels
def test_a_linear_law_is_the_viscous_damper(name):
    structure, motion = CASES[name]
    ours, own = (
        history(structure, motion),
        history(with_own(structure, LINEAR, C), motion),
    )
    assert ours.max_rotation > 1e-3
    np.testing.assert_allclose(
        own.trace.rotation, ours.trace.rotation, rtol=0.0, atol=1e-12 * ours.max_rotation
    )
    assert own.devices[0].force == pytest.approx(ours.devices[0].force, rel=1e-12)
    assert own.energy.devices == pytest.approx(ours.energy.devices, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "c"),
    [("flat ends and friction", C), ("curved ends", C), ("both components", 10.0 * C)],
)
@needs_compiled_kernels
def test_steps_end_where_a_law_has_a_kink(name, c):
    structure, motion = CASES[name]
    watched, missed = (
        with_own(structure, law, c, OPENS) for law in (RELIEVED, UNWATCHED)
    )
    fine, usual = history(watched, motion, 4.0), history(watched, motion)
    assert fine.devices[0].velocity > 2.0 * OPENS
    assert fine.impacts > 1 or name != "flat ends and friction"
    assert usual.devices[0].force == pytest.approx(OPENS * c, rel=1e-9)
    assert np.max(np.abs(usual.trace.devices.force[:, 0])) <= OPENS * c * (1.0 + 1e-9)
    errors = [
        abs(each.max_rotation - fine.max_rotation)
        for each in (usual, history(missed, motion))
    ]
    assert errors[0] < 1e-9 * fine.max_rotation
    assert errors[1] > 20.0 * errors[0]
    assert abs(usual.energy.residual) < 1e-7 * usual.energy.input


def numbers(structure, motion, count):
    scales = np.linspace(0.8, 1.4, count)
    requests = [
        DemandRequest(structure, motion, SETTINGS, float(scale)) for scale in scales
    ]
    return [each.history for each in demands(requests)]


@pytest.mark.parametrize("name", ["flat ends and friction", "both on curved ends"])
@needs_compiled_kernels
def test_the_same_bits_alone_and_in_lanes(name):
    structure, motion = CASES[name]
    law = ImpactLaw("softer", own=RestitutionLaw({}, softer), contact_time=2e-3)
    own = replace(with_own(structure, RELIEVED, C, OPENS), impact_law=law)
    together = numbers(own, motion, 40)
    assert len({each["max_theta"] for each in together}) > 30
    for scale, each in list(zip(np.linspace(0.8, 1.4, 40), together, strict=True))[::8]:
        (alone,) = demands(
            [DemandRequest(own, motion, SETTINGS, float(scale))], worth_lanes=2
        )
        assert alone.history["max_theta"] == each["max_theta"]
        assert alone.history["device_energy"][0] == each["device_energy"][0]


@of_cases
@needs_compiled_kernels
def test_a_law_that_gives_one_restitution_changes_no_bit(name):
    structure, motion = CASES[name]
    ours, e = structure.impact_law, structure.restitution
    law = ImpactLaw("given", own=GIVEN, constants=(e,), contact_time=ours.contact_time)
    other = replace(structure, impact_law=law)
    assert other.restitution == e
    one, two = history(structure, motion), history(other, motion)
    assert one.impacts or one.passes or structure.passes_smoothly
    assert np.array_equal(one.trace.rotation, two.trace.rotation)
    assert one.energy == two.energy


@needs_compiled_kernels
def test_an_impact_loses_what_its_rate_asks_for():
    structure, _ = CASES["flat ends and friction"]
    law = ImpactLaw("softer", own=RestitutionLaw({}, softer), loss=0.8)
    own = history(replace(structure, impact_law=law))
    impacts = [each for each in own.events if each.kind == "impact"]
    assert len(impacts) > 1
    b = structure.bearing
    for each in impacts:
        before, after = abs(each.rotation_rate_before), abs(each.rotation_rate_after)
        e = softer(before, b.slenderness, b.inertia_ratio, structure.gamma, structure.eta)
        assert after == pytest.approx((1.0 - 0.8 * (1.0 - e)) * before, rel=1e-12)
    assert abs(own.energy.residual) < 1e-6 * own.energy.input


def no_force(path: float, speed: float, c: float) -> float:
    return c * speed if speed <= 0.01 else math.nan


def raises(path: float, speed: float, c: float) -> float:
    if speed > 0.01:
        raise ValueError("too fast")
    return c * speed


def too_large(
    rate: float, tan_alpha: float, inertia: float, gamma: float, eta: float
) -> float:
    return 0.9 if rate < 2e-3 else 1.1


def no_number(
    rate: float, tan_alpha: float, inertia: float, gamma: float, eta: float
) -> float:
    return 0.9 if rate < 2e-3 else math.nan


@pytest.mark.parametrize("name", ["flat ends and friction", "both components"])
@pytest.mark.parametrize("law", [no_force, raises, too_large, no_number])
@needs_compiled_kernels
def test_what_a_law_may_not_give_ends_the_history(name, law):
    structure, motion = CASES[name]
    if law in (no_force, raises):
        said = f"test_own_laws.{law.__name__}: {law.__name__}("
        wrong = with_own(structure, DamperLaw(ONE_CONSTANT, law, most, most), C)
    else:
        said = (
            "restitution is not above 0 and at most 1; with laws of other packages: own"
        )
        if law is no_number:
            said = "test_own_laws.no_number: no_number("
        own = ImpactLaw("own", own=RestitutionLaw({}, law), contact_time=2e-3)
        wrong = replace(structure, impact_law=own)
    failure = history(wrong, motion).failure
    assert failure is not None
    assert said in failure
    assert "check masses" not in failure
    if law is raises:
        assert failure.endswith(", 150000): ValueError: too fast")
    if law is no_force:
        assert failure.endswith(": gives nan")


def unknown_to_numba(path: float, speed: float, c: float) -> float:
    return float(eval("c * speed"))  # noqa: S307 -- what cannot be compiled


@needs_compiled_kernels
def test_what_cannot_be_compiled_is_named():
    own = with_own(SMALL, DamperLaw(ONE_CONSTANT, unknown_to_numba, most, most), C)
    with pytest.raises(
        PluginError, match=r"test_own_laws\.unknown_to_numba cannot be compiled"
    ):
        history(own)


def test_what_is_no_law_is_refused():
    spring = DamperLaw({"k": PLAIN}, lambda path, _, k: k * path, most, most)
    with pytest.raises(PluginError, match="its force at rest, at a displacement of"):
        OwnDamper("spring", spring, (1e5,))
    gains = ImpactLaw("gains", own=RestitutionLaw({}, lambda *_: 1.5))
    with pytest.raises(
        PluginError, match=r"gains: its restitution is 1\.5 at a rate of 0\.001"
    ):
        replace(SMALL, impact_law=gains)
    for kind, own in (("elsewhere", None), ("flexible", GIVEN)):
        with pytest.raises(ValueError, match="must be flexible, rigid or value"):
            ImpactLaw(kind, own=own)


def test_a_law_answers_for_modes_and_steps():
    own = OwnDamper("own", RELIEVED, (C, 0.1))
    structure = replace(SMALL, devices=(own,))
    assert own.bounds(structure) == VISCOUS.bounds(structure) == (0.0, C)
    stiff = replace(RELIEVED, stiffness=thrice, linear=None)
    assert OwnDamper("own", stiff, (C, 0.1)).bounds(structure) == (3.0 * C, C)


@needs_compiled_kernels
def test_machine_code_from_the_cache_calls_laws_of_this_process():
    """Addresses differ from process to process; kernels on disk know none of them."""
    script = (
        "import ctypes; from physics import test_own_laws as t\n"
        "room = [ctypes.create_string_buffer(2**n) for n in range(12, 24)]\n"
        "for law in (t.RELIEVED, t.HARDER):\n"
        "    print(t.history(t.with_own(t.USUAL, law, t.C, t.GAP)).max_rotation.hex())\n"
    )
    ours = [
        history(with_own(USUAL, law, C, GAP)).max_rotation for law in (RELIEVED, HARDER)
    ]
    assert [float.fromhex(line) for line in printed_by("-c", script).split()] == ours
    assert ours[0] != ours[1]
