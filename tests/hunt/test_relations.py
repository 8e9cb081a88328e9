"""Relations that hold whatever the numbers are: random structures against themselves.

Twelve kinds of structures under random motions, each with another one that must say the same:
bit for bit where nothing is rounded otherwise, else within what 1e-9 more motion does to that
history, a hundred times. What that moves by a thousandth is chaotic, and says nothing.
"""

from contextlib import suppress
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from paper_structures import ground, needs_compiled_kernels

from hunt.test_random_histories import (
    perhaps_other_across,
    shaking,
    smooth_structure_of_a_pair,
    spherical_structure,
    structure,
    structure_of_a_pair,
    structure_on_a_bed,
    structure_with_devices,
    with_floors_of_its_own,
)
from hunt.trials import hunted
from rpscli.analyses.demand import DemandRequest, demands
from rpscli.analyses.kernels.systems import most_seconds
from rpscli.analyses.timehistory import time_history
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.records.ground_motion import MotionComponents

pytestmark = [
    pytest.mark.posix,
    pytest.mark.evidence("steps, events, energy", "exact"),
]  # trials are timed by its signals

MOST_SECONDS = 1.0
"""Of a history, as it is estimated; longer ones are not followed."""

MORE_MOTION = 1e-9
TIMES = 100.0
"""A difference counts above what so much more motion does, so many times."""

ROUNDING = 1e-10
"""Of the largest rotation: the least difference that counts where sums are rounded otherwise."""

STEPS = 1e-5
"""The same where steps are others: what they are made for."""

CHAOTIC = 1e-3

PLANE = [
    structure,
    structure_with_devices,
    structure_on_a_bed,
    spherical_structure,
    lambda random: with_floors_of_its_own(random, structure),
    lambda random: with_floors_of_its_own(random, structure_on_a_bed),
]
PAIRS = [
    structure_of_a_pair,
    smooth_structure_of_a_pair,
    lambda random: perhaps_other_across(random, structure_on_a_bed(random)),
    lambda random: with_floors_of_its_own(random, structure_of_a_pair),
    lambda random: with_floors_of_its_own(random, smooth_structure_of_a_pair),
    lambda random: replace(
        structure_of_a_pair(random), devices=(FrictionDamper(1e3 * random.random()),)
    ),
]


class Refused(Exception):
    """What the model does not take, or what would take too long."""


MOST_DRAWS = 8


def drawn(random, kinds):
    """The first system, motion and settings of some that the model takes."""
    for _ in range(MOST_DRAWS):
        with suppress(Refused):
            return one_drawn(random, kinds)
    raise Refused


def one_drawn(random, kinds):
    """A system, a motion and settings for a short history, perhaps under a pair."""
    pairs = kinds is PAIRS
    try:
        system = random.choice(kinds)(random)
    except ValueError as error:
        raise Refused from error
    motion, chosen = shaking(random, system, pairs=pairs)
    chosen = replace(chosen, free_vibration=random.choice([0.0, 0.3, 1.0]))
    if most_seconds(system, chosen, motion) > MOST_SECONDS:
        raise Refused
    return system, motion, chosen


def history(system, motion, chosen):
    found = time_history(system, motion, chosen, with_fixed_base=False)
    if found.outcome == "failed":
        raise Refused
    return found


def relation(name, quick, many, *, kinds=(PLANE, PAIRS)):
    """A relation as two hunts: every trial draws from one half of the kinds."""

    def tests_of(holds):
        def trial(random):
            try:
                return holds(random, *drawn(random, random.choice(kinds))) or "held"
            except Refused:
                return "refused"

        return needs_compiled_kernels(hunted(f"relation: {name}", quick, many)(trial))

    return tests_of


def same_bits(one, other, last=None):
    """Outcome aside, the same rotations and displacements up to a sample."""
    for of, to in ((one.trace, other.trace), (one.trace.y, other.trace.y)):
        if of is None or to is None:
            assert of is to
            continue
        assert np.array_equal(
            of.floor_displacements[:last], to.floor_displacements[:last]
        )
        assert np.array_equal(of.shear_top[:last], to.shear_top[:last])
    assert np.array_equal(one.trace.rotation[:last], other.trace.rotation[:last])


def close(here, there, least, *, factor=1.0, shift=0):
    """The same history but for rounding or steps, the rotations of `there` times a factor."""
    count = min(len(here.trace.time), len(there.trace.time) - shift)
    one = here.trace.rotation[:count]
    other = factor * there.trace.rotation[shift : shift + count]
    size = max(float(np.max(np.abs(one))), 1e-12)
    apart = float(np.max(np.abs(one - other))) / size
    if apart <= least:
        return "held"
    more = history(here.structure, here.motion.scaled(1.0 + MORE_MOTION), here.settings)
    common = min(count, len(more.trace.rotation))
    moved = float(np.max(np.abs(one[:common] - more.trace.rotation[:common]))) / size
    if TIMES * moved > CHAOTIC:
        return "chaotic"
    assert apart <= max(least, TIMES * moved), f"{apart:.2g}, by more motion {moved:.2g}"
    return "held by what more motion does"


@relation("one mirrored component", 8, 500, kinds=(PAIRS,))
def test_mirrors_of_one_component(random, system, motion, chosen):
    """Under a pair -x alone and -y alone mirror the motion, to the last bit."""
    here = history(system, motion, chosen)
    x, up, y = motion.horizontal, motion.vertical, motion.y
    if up is not None and float(up.acceleration.min()) < -system.gravity:
        return "unsure"  # where nothing weighs, nothing says to which side
    turned = random.choice(["x", "y"])
    x, y = (x.scaled(-1.0), y) if turned == "x" else (x, y.scaled(-1.0))
    there = history(system, MotionComponents(x, up, y=y), chosen)
    assert np.array_equal(here.trace.rotation, there.trace.rotation)
    signs = (-1.0, 1.0) if turned == "x" else (1.0, -1.0)
    for sign, of, to in zip(
        signs, (here.trace, here.trace.y), (there.trace, there.trace.y), strict=True
    ):
        assert np.array_equal(of.floor_displacements, sign * to.floor_displacements)
    return here.outcome


@relation("causality", 12, 500)
def test_the_trace_does_not_depend_on_what_follows(random, system, motion, chosen):
    """Samples behind an instant change nothing before it."""
    here = history(system, motion, chosen)
    last = random.randrange(1, motion.npts)

    def changed(of):
        if of is None:
            return None
        values = of.acceleration.copy()
        values[last + 1 :] *= random.choice([0.0, -1.0, 0.5])
        return ground(values, of.dt)

    parts = (changed(each) for each in (motion.horizontal, motion.vertical, motion.y))
    x, up, y = parts
    there = history(system, MotionComponents(x, up, y=y), chosen)
    kept = min(last + 1, len(here.trace.time), len(there.trace.time))
    same_bits(here, there, kept)
    return here.outcome


@relation("lanes", 8, 300)
def test_lanes_company_and_order_change_no_bit(random, system, motion, chosen):
    """Side by side with others, in another order, alone, and with samples."""
    weaker = replace(system, columns_mass=system.columns_mass * 1.01)
    if weaker.contact.period_ratio is not None:
        weaker = system
    scales = [1.0, 0.3, random.uniform(0.1, 2.0), 0.7]
    requests = [DemandRequest(system, motion, chosen, scale) for scale in scales]
    requests += [DemandRequest(weaker, motion, chosen, scale) for scale in scales]
    order = random.sample(range(len(requests)), len(requests))
    together = demands(requests, worth_lanes=1)
    mixed = demands([requests[i] for i in order], worth_lanes=1)
    alone = demands([requests[0]], worth_lanes=10**9)[0]
    assert together[0].history.tobytes() == alone.history.tobytes()
    for place, number in enumerate(order):
        assert mixed[place].history.tobytes() == together[number].history.tobytes()
    sampled = history(system, motion, chosen)
    assert sampled.max_rotation == alone.max_rotation
    assert sampled.outcome == alone.outcome
    assert sampled.max_base_shear == alone.max_base_shear
    return alone.outcome


def heavier(device, factor):
    """A device with all forces times a factor; levers of rolling are lengths."""
    names = {
        ViscousDamper: ["coefficient"],
        FrictionDamper: ["force"],
        Stop: ["stiffness", "damping"],
        Tendon: ["prestress", "stiffness", "yield_force"],
        RollingResistance: [],
    }[type(device)]
    return replace(device, **{name: factor * getattr(device, name) for name in names})


def heavier_building(of, factor):
    if of is None:
        return None
    strengths = None if of.strengths is None else of.strengths * factor
    return replace(
        of,
        masses=of.masses * factor,
        stiffnesses=of.stiffnesses * factor,
        strengths=strengths,
    )


@relation("masses", 12, 500)
def test_masses_and_forces_have_no_scale(random, system, motion, chosen):
    """Masses, stiffnesses and forces times a power of two give the same motion."""
    factor = 2.0 ** random.choice([-3, -1, 1, 2, 4])
    contact = system.contact
    if contact.stiffness is not None:
        contact = replace(contact, stiffness=contact.stiffness * factor)
    other = replace(
        system,
        columns_mass=system.columns_mass * factor,
        cap_beam_mass=system.cap_beam_mass * factor,
        superstructure=heavier_building(system.superstructure, factor),
        superstructure_y=heavier_building(system.superstructure_y, factor),
        contact=contact,
        devices=tuple(heavier(each, factor) for each in system.devices),
    )
    here = history(system, motion, chosen)
    return close(here, history(other, motion, chosen), ROUNDING)


@relation("Froude", 12, 500)
def test_lengths_and_accelerations_have_scales(random, system, motion, chosen):
    """Gravity and accelerations times four, times halved: the same rotations."""

    def stiffer(of):
        if of is None:
            return None
        strengths = None if of.strengths is None else of.strengths * 4.0
        period = None if of.vertical_period is None else of.vertical_period / 2.0
        return replace(
            of,
            stiffnesses=of.stiffnesses * 4.0,
            strengths=strengths,
            vertical_period=period,
        )

    def device(of):
        if isinstance(of, ViscousDamper):
            return replace(of, coefficient=of.coefficient * 4.0 * 0.5**of.exponent)
        made = heavier(of, 4.0)
        return replace(made, damping=made.damping / 2.0) if isinstance(of, Stop) else made

    def faster(of):
        return None if of is None else ground(4.0 * of.acceleration, of.dt / 2.0)

    contact = system.contact
    if contact.stiffness is not None:
        contact = replace(contact, stiffness=contact.stiffness * 4.0)
    law = system.impact_law
    other = replace(
        system,
        gravity=system.gravity * 4.0,
        superstructure=stiffer(system.superstructure),
        superstructure_y=stiffer(system.superstructure_y),
        contact=contact,
        impact_law=replace(law, contact_time=law.contact_time / 2.0),
        devices=tuple(map(device, system.devices)),
    )
    if motion.y is not None and not system.passes_smoothly:
        above = system.superstructure
        if above is None or above.vertical_period is None:
            raise Refused  # shocks have a time of their own, which does not shrink
    settings = replace(chosen, free_vibration=chosen.free_vibration / 2.0)
    parts = map(faster, (motion.horizontal, motion.vertical, motion.y))
    x, up, y = parts
    here = history(system, motion, chosen)
    return close(here, history(other, MotionComponents(x, up, y=y), settings), STEPS)


@relation("exchange", 10, 500, kinds=(PAIRS,))
def test_x_and_y_may_be_exchanged(random, system, motion, chosen):
    """The structure and its motion seen from the other side."""
    del random
    x, up, y = motion.horizontal, motion.vertical, motion.y
    other = system
    if system.superstructure_y is not None:
        if system.contact.period_ratio is not None:
            raise Refused  # which is that of x
        other = replace(
            system,
            superstructure=system.superstructure_y,
            superstructure_y=system.superstructure,
        )
    here = history(system, motion, chosen)
    there = history(other, MotionComponents(y, up, y=x), chosen)
    return close(here, there, ROUNDING)


@relation("split devices", 12, 500)
def test_devices_may_be_split_and_stand_in_any_order(random, system, motion, chosen):
    """Two halves act as the whole."""
    if not system.devices:
        raise Refused

    def half(device):
        if isinstance(device, RollingResistance):
            return replace(device, lever=0.5 * device.lever)
        return heavier(device, 0.5)

    halves = [half(each) for each in system.devices for _ in range(2)]
    random.shuffle(halves)
    try:
        other = replace(system, devices=tuple(halves))
    except ValueError as error:  # more than a structure may have
        raise Refused from error
    here = history(system, motion, chosen)
    return close(here, history(other, motion, chosen), ROUNDING)


@relation("zeros", 12, 500)
def test_zeros_before_and_behind_a_record(random, system, motion, chosen):
    """A record that begins later, or ends later, is the same record."""
    if chosen.initial_rotation:
        raise Refused  # what is let go does not wait
    shift = random.choice([0, 0, 1, 7, 100])
    behind = 0 if shift else random.choice([1, 50])

    def padded(before, after):
        """With so many zeros at the ends, the first of which are between straight lines."""
        parts = (
            None
            if each is None
            else ground(np.pad(each.acceleration, (before, after)), each.dt)
            for each in (motion.horizontal, motion.vertical, motion.y)
        )
        x, up, y = parts
        return MotionComponents(x, up, y=y)

    here = history(system, padded(1, 1), chosen)
    there = history(system, padded(1 + shift, 1 + behind), chosen)
    return close(here, there, STEPS if behind else ROUNDING, shift=shift)


@needs_compiled_kernels
@pytest.mark.parametrize("kinds", [PLANE, PAIRS], ids=["plane", "pairs"])
def test_what_differs_is_seen(kinds):
    """A thousandth more mass is no rounding: the comparison has power."""
    seen = 0
    for number in range(12):
        draw = Random(f"power-{number}")  # noqa: S311 -- no secret
        with suppress(Refused):
            system, motion, chosen = drawn(draw, kinds)
            here = history(system, motion, chosen)
            heavy = replace(system, cap_beam_mass=system.cap_beam_mass * 1.001)
            other = history(heavy, motion, chosen)
            moves = here.max_rotation > 0.0 and here.max_rotation != other.max_rotation
            if not moves:
                continue
            try:
                assert close(here, other, ROUNDING) == "chaotic"
            except AssertionError:
                seen += 1
    assert seen >= 2
