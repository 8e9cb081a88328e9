"""Random structures under random motions: an outcome, the energy, and the mirror image for each.

Far beyond what anybody builds: undamped and overdamped, of stiff storeys and of one in four
seconds, on columns of a hand and of a house, under ground that falls faster than gravity.
"""

import math
from dataclasses import replace
from random import Random

import numpy as np
import pytest
from paper_structures import (
    FLAT,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    yielding,
)

from hunt.trials import hunt, hunted, shares
from rpscli.analyses.kernels.systems import (
    MOST_LOST,
    START_SPEED,
    most_seconds,
    steps_a_second,
)
from rpscli.analyses.settings import LONGEST_FREE_VIBRATION, TimeHistorySettings
from rpscli.analyses.timehistory import denser_trace, time_history
from rpscli.analyses.trace import ENERGIES
from rpscli.model.bearing import Bearing
from rpscli.model.contact import Contact
from rpscli.model.devices import (
    FrictionDamper,
    RollingResistance,
    Stop,
    Tendon,
    ViscousDamper,
)
from rpscli.model.impact import ImpactLaw
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import (
    ModalDamping,
    RayleighDamping,
    Superstructure,
    profile_stiffnesses,
)
from rpscli.records.ground_motion import MotionComponents

pytestmark = [
    pytest.mark.posix,
    pytest.mark.evidence("steps, events, energy", "exact"),
]  # trials are timed by its signals

OVERTURNED = {"overturned_rolling", "overturned_rocking"}
OUTCOMES = {"at_rest", "survived", "stays_tilted", "failed"} | OVERTURNED
RESIDUAL = 1e-6
"""Of the energy: what the step is made for. Ground that gives the last of several modes nearly all
energy may have up to `MOST_LOST` of it lost, 1 of 2,000 above 1e-6; shorter steps must close."""

BED_RESIDUAL = 1e-3
"""On compliant ends, at usual steps: 5 of 410 are above 1e-6, the largest 4.6e-4, where impacts
lose nothing or ends have no damping: errors of thousands of passages and minutes of vibration add
up. With steps a quarter as long all must be below 1e-6, which an error of equations would not."""

PAIR_RESIDUAL = 1e-4
"""Under both components 1.5 % are above 1e-6, the largest of 1,014 4.4e-5."""

MOST_SECONDS = 5.0
"""Of a history, as it is estimated; longer ones are not followed."""

MOST_STEPS = 300_000
"""Of a history, some seconds; longer ones are followed for a shorter time after the record."""


def logarithmic(random, low, high):
    return math.exp(random.uniform(math.log(low), math.log(high)))


def random_building(random):
    n = random.choice([0, 1, 1, 2, 2, 3, 3, 4, 6, 9, 15, 25, 33, 60])
    if not n:
        return None
    masses = np.array([logarithmic(random, 1e5, 4e5) for _ in range(n)])
    stiffnesses = profile_stiffnesses(
        masses,
        logarithmic(random, 0.02, 4.0),
        random.choice(["sine", "uniform", "linear"]),
    )
    if random.random() < 0.2:
        stiffnesses = stiffnesses * [logarithmic(random, 0.5, 2.0) for _ in range(n)]
    ratio = random.choice([0.0, 0.01, 0.05, 0.05, 0.2, 0.9, random.uniform(0.0, 1.5)])
    modes = random.choice([(1, 2), (1, 1), (1, 3)])
    modal = random.random() < 0.2
    return Superstructure(
        masses,
        stiffnesses,
        ModalDamping(ratio) if modal else RayleighDamping(ratio, modes),
    )


def structure(random):
    slope = logarithmic(random, 0.03, 0.8)
    rho = random.choice([0.0, 0.0, 0.25, 0.5, 0.5, 1.0, random.uniform(0.0, 2.0)])
    bearing = Bearing(
        logarithmic(random, 0.2, 10.0), slope, slope * random.uniform(1.0, 4.0), rho
    )
    law = random.choice(
        [
            ImpactLaw("flexible"),
            ImpactLaw("rigid"),
            ImpactLaw("value", random.uniform(0.1, 1.0)),
        ]
    )
    columns = logarithmic(random, 1e3, 1e5)
    return PodiumStructure(
        bearing,
        columns,
        columns * logarithmic(random, 0.3, 30),
        random_building(random),
        law,
    )


def structure_on_a_bed(random):
    """Compliant ends, from hardly to barely holding the weight; perhaps with dampers."""
    system = structure(random)
    kind = random.choice(["plane", "plane", "edges"])
    sizes = {}
    ways = ["stiffness", *(["settlement"] if system.bearing.is_flat else [])]
    way = random.choice([*ways, *(["period_ratio"] * 3 if system.storeys else [])])
    if way == "period_ratio":
        sizes[way] = 1.0 + logarithmic(random, 3e-3, 1.5)
    elif way == "settlement":
        sizes[way] = system.bearing.half_width * logarithmic(random, 1e-6, 0.05)
    else:
        sizes[way] = (
            system.weight / system.bearing.semi_diagonal * logarithmic(random, 3.0, 1e5)
        )
    damping = random.choice([0.0, 0.03, 0.03, logarithmic(random, 1e-3, 1.0)])
    devices = random.choice(
        [(), (), (FrictionDamper(0.3 * random.random() * system.uplift_force),)]
    )
    return replace(
        system,
        impact_law=ImpactLaw("flexible", loss=random.choice([0.0, 0.3, 1.0])),
        contact=Contact(kind, damping=damping, **sizes),
        devices=devices,
    )


def device(random, system):
    """One that matters, of any kind."""
    force, width = system.uplift_force, system.bearing.half_width
    part, choice = random.uniform(0.05, 0.6), random.choice
    weight = system.weight / system.columns
    exponent = choice([1.0, 0.2, 0.5, 1.5, 2.0])
    prestress = 0.2 * part * weight
    kinds = [
        ViscousDamper(part * force / 0.3**exponent, exponent),
        FrictionDamper(2.0 * part * force),
        Stop(choice([0.0, 0.02, 0.1]), 20.0 * part * force, choice([0.0, part * force])),
        Tendon(
            prestress, 4.0 * part * weight / width, choice([math.inf, 2.0 * prestress])
        ),
        RollingResistance(0.1 * part * width),
    ]
    return choice(kinds)


def structure_with_devices(random):
    """Of a usual size, with one to four devices on six columns."""
    storeys, rho = random.choice([0, 1, 3, 6]), random.choice([FLAT, 0.3, 0.5, 1.0])
    law = ImpactLaw(random.choice(["rigid", "flexible"]))
    above = building(storeys) if storeys else None
    bare = podium(
        storeys, random.uniform(0.06, 0.25), rho, R=random.uniform(0.7, 2.0), law=law,
        superstructure=above,
    )  # fmt: skip
    bare = replace(bare, columns=6)
    devices = tuple(device(random, bare) for _ in range(random.randrange(1, 5)))
    return replace(bare, devices=devices)


def spherical_structure(random):
    """Without a flat part, with all but tendons."""
    system = structure_with_devices(random)
    bearing = Bearing(system.bearing.semi_diagonal, 0.0, 0.3, random.uniform(0.51, 2.0))
    devices = tuple(each for each in system.devices if not isinstance(each, Tendon))
    return replace(system, bearing=bearing, impact_law=ImpactLaw(), devices=devices)


def samples(random, peak):
    noise = np.random.default_rng(random.randrange(2**32))
    count = random.randrange(2, 500)
    time = np.arange(count)
    kind = random.randrange(6)
    if kind == 0:
        shape = noise.normal(size=count)
    elif kind == 1:
        shape = np.sin(time * random.uniform(0.005, 1.0))
    elif kind == 2:
        shape = np.zeros(count)
        shape[noise.integers(count, size=3)] = noise.uniform(-1.0, 1.0, 3)
    elif kind == 3:
        shape = np.sign(np.sin(time * random.uniform(0.005, 0.5)))
    elif kind == 4:
        shape = np.cumsum(noise.normal(size=count))
    else:
        shape = noise.normal(size=count) * np.exp(
            -(((time - count / 2) / (count / 6)) ** 2)
        )
    return peak * shape / max(float(np.max(np.abs(shape))), 1e-12)


def motions(random):
    dt = random.choice([0.002, 0.005, 0.01, 0.01, 0.02, 0.05])
    along = samples(random, 9.81 * logarithmic(random, 0.02, 3.0))
    record = ground(along, dt)
    if random.random() < 0.7:
        return record, None
    up = samples(random, 9.81 * logarithmic(random, 0.02, 3.0))
    return record, ground(up, dt)


def settings(random, system, record):
    largest = 0.999 * system.bearing.largest_rotation / system.critical_rotation
    start = 0.0
    if random.random() < 0.15:
        share = random.choice([-1.0, 1.0]) * logarithmic(random, 1e-6, 0.95)
        start = share * system.critical_rotation
    rate = steps_a_second(system)
    left = MOST_STEPS / rate - record.duration
    chosen = TimeHistorySettings(
        initial_rotation=start,
        recontact_tolerance=logarithmic(random, 1e-8, 1e-4),
        overturning_limit=min(random.uniform(1.0, 2.0), largest),
    )
    return (
        chosen
        if left > LONGEST_FREE_VIBRATION
        else replace(chosen, free_vibration=max(left, 0.0))
    )


def residual(result):
    """The error of the audit over the largest of its entries at any sample.

    At the end the ground may have taken back most of what it gave.
    """

    def error(trace):
        entries = (getattr(trace, name) for name in (*ENERGIES, "energy_damped_vertical"))
        largest = max(float(np.max(np.abs(entry))) for entry in entries)
        return abs(result.energy.residual) / largest if largest > 0.0 else 0.0

    found = error(result.trace)
    # an excursion may lie between two samples, and be lifted and down again
    return (
        found
        if found <= RESIDUAL
        else error(denser_trace(result, result.record.dt / 100.0))
    )


def nothing_pushed(motion, result):
    """Whether the structure uplifted before the ground moved sideways."""
    uplift = result.events[0].time if result.events else result.duration
    sideways = [each for each in (motion.horizontal, motion.y) if each is not None]
    return not any(a.acceleration[: math.ceil(uplift / a.dt) + 1].any() for a in sideways)


def shaking(random, system, *, pairs):
    """A random motion, and settings for it."""
    record, vertical = motions(random)
    across = None

    def as_long(values):
        return ground(np.pad(values, (0, record.npts))[: record.npts], record.dt)

    if pairs:
        across = as_long(np.zeros(1))
        if random.random() < 0.9:
            across = as_long(samples(random, 9.81 * logarithmic(random, 0.02, 3.0)))
        vertical = None if vertical is None else as_long(vertical.acceleration)
    chosen = settings(random, system, record)
    if pairs:
        free = random.choice([0.0, 1.0, 5.0])
        chosen = replace(chosen, free_vibration=free, initial_rotation=0.0)
    elif system.bed and abs(chosen.initial_rotation) <= system.bed.uplift_rotation:
        chosen = replace(chosen, initial_rotation=0.0)  # below it a release is refused
    return MotionComponents(record, vertical, y=across), chosen


def opposite(motion):
    across = None if motion.y is None else motion.y.scaled(-1.0)
    return MotionComponents(motion.horizontal.scaled(-1.0), motion.vertical, y=across)


def judged_history(random, draw=structure, *, pairs=False):
    """An outcome, the energy, and the history under the opposite motion."""
    try:
        system = draw(random)
    except ValueError:  # an arc that does not reach its wedge, a restitution below zero
        return "refused"
    motion, chosen = shaking(random, system, pairs=pairs)
    if most_seconds(system, chosen, motion) > MOST_SECONDS:
        return "not followed: stiff floors on light columns take millions of steps"
    here = time_history(system, motion, chosen, with_fixed_base=False)
    assert here.outcome in OUTCOMES
    assert (here.failure is not None) == (here.outcome == "failed"), here.failure
    assert math.isfinite(here.max_rotation)
    assert np.isfinite(here.trace.rotation).all()
    assert np.isfinite(here.trace.floor_displacements).all()
    if here.outcome == "failed":
        return f"failed: {(here.failure or '')[:40]}"
    error, limit = residual(here), PAIR_RESIDUAL if pairs else RESIDUAL
    coarse = BED_RESIDUAL if system.bed else (MOST_LOST if system.storeys > 1 else limit)
    if limit < error <= coarse:
        finer = replace(chosen, accuracy=4.0)
        error = residual(time_history(system, motion, finer, with_fixed_base=False))
    assert error <= limit, f"residual {error:.2g}, {here.outcome}"
    assert system.impact_law.kind != "flexible" or here.energy.created == 0.0
    # Each device dissipates, or gives back what it took. Friction that lets go to any side is
    # booked with the speed at which sliding begins (Theory (13.26)), some times within a sample.
    taken, radius = here.trace.devices.energy, system.bearing.semi_diagonal
    begun = 4.0 * 0.5 * system.weight * radius * START_SPEED**2 if pairs else 0.0
    assert np.all(np.diff(taken, axis=0) >= -1e-9 * np.max(taken, initial=1.0) - begun)
    up = motion.vertical
    falls = up is not None and float(up.acceleration.min()) < -system.gravity
    thrown = up is not None and system.upwards is not None  # by floors on springs
    unpushed = (falls or thrown) and nothing_pushed(motion, here)
    if unpushed or (falls and (pairs or system.storeys == 0)):
        # where nothing pushes, what has no weight uplifts, and nothing says to which side
        return here.outcome
    mirrored = replace(chosen, initial_rotation=-chosen.initial_rotation)
    there = time_history(system, opposite(motion), mirrored, with_fixed_base=False)
    assert here.outcome == there.outcome
    # of pairs the tilt is the size of a vector
    sign = 1.0 if pairs else -1.0
    if (
        system.bearing.is_spherical and not pairs
    ):  # at rest upright neither side is the first
        apart = here.trace.rotation + there.trace.rotation
        assert np.max(np.abs(apart)) <= 1e-6 * here.max_rotation
        return here.outcome
    assert np.array_equal(here.trace.rotation, sign * there.trace.rotation)
    for one, other in ((here.trace, there.trace), (here.trace.y, there.trace.y)):
        if one is not None and other is not None:
            assert np.array_equal(one.floor_displacements, -other.floor_displacements)
    assert here.energy == there.energy
    return here.outcome


def structure_of_a_pair(random):
    """With passes of 0 to 20 ms of contact, perhaps other columns in spin, or stiffnesses in y."""
    system = structure(random)
    law = ImpactLaw(
        "flexible",
        loss=random.choice([1.0, 1.0, random.uniform(0.0, 1.2)]),
        contact_time=random.choice([0.0, 2e-3, logarithmic(random, 1e-5, 0.02)]),
    )
    axial = logarithmic(random, 1e-3, 1.0)
    if random.random() < 0.3:
        system = replace(
            system, bearing=replace(system.bearing, inertia_ratio_axial=axial)
        )
    return replace(perhaps_other_across(random, system), impact_law=law)


def perhaps_other_across(random, system):
    """Perhaps with other stiffnesses in y."""
    above = system.superstructure
    if above is None or random.random() >= 0.4:
        return system
    other = replace(above, stiffnesses=above.stiffnesses * logarithmic(random, 0.1, 10.0))
    return replace(system, superstructure_y=other)


def smooth_structure_of_a_pair(random):
    """On compliant or spherical ends, or with friction on rigid ones; perhaps softer in y."""
    kind = random.choice(["bed", "bed", "spherical", "spherical", "rigid"])
    system = structure_on_a_bed(random) if kind == "bed" else structure_of_a_pair(random)
    held = 0.3 * random.random() * system.weight * max(system.bearing.slenderness, 0.05)
    rolling = RollingResistance(0.1 * random.random() * system.bearing.semi_diagonal)
    friction = random.choice(
        [(FrictionDamper(held),), (rolling,), (FrictionDamper(held), rolling)]
    )
    if kind == "rigid":
        return replace(system, devices=friction)
    if kind == "spherical":
        R, wedge = system.bearing.semi_diagonal, logarithmic(random, 0.05, 0.8)
        bearing = Bearing(R, 0.0, wedge, random.uniform(0.51, 2.0))
        devices = random.choice([(), friction])
        system = replace(system, bearing=bearing, impact_law=ImpactLaw(), devices=devices)
    return perhaps_other_across(random, system)


def with_floors_of_its_own(random, draw):
    """Floors on vertical springs, storeys that yield, or both."""
    system, kind = draw(random), random.choice(["springs", "springs", "yields", "both"])
    if (above := system.superstructure) is None:
        return system
    law = system.impact_law
    if law.kind != "flexible":
        law = ImpactLaw("flexible", loss=random.choice([1.0, random.uniform(0.0, 1.2)]))
    if kind != "yields":
        period = logarithmic(random, 0.02, 1.0)
        damping = random.choice([0.0, 0.05, 0.05, random.uniform(0.0, 0.5)])
        above = replace(above, vertical_period=period, vertical_damping=damping)
    if kind != "springs":
        first = system.static_base_shear * logarithmic(random, 0.2, 5.0)
        above = yielding(
            above, first, random.choice([0.0, 0.05, random.uniform(0.0, 0.9)])
        )
    across = system.superstructure_y
    if across is not None:
        across = replace(above, stiffnesses=across.stiffnesses)
    return replace(system, superstructure=above, superstructure_y=across, impact_law=law)


LOST_TOO_MUCH = [
    "20270-histories 0-60", "20271-histories 2-608", "20281-histories 0-735",
    "20411-histories 0-489", "20412-histories 0-908", "41261-histories 0-405",
    "41271-histories 0-231", "271127-histories 3-51", "271201-devices-565",
]  # fmt: skip


@needs_compiled_kernels
@pytest.mark.parametrize("seed", LOST_TOO_MUCH)
def test_histories_that_lost_too_much(seed):
    # at coarser steps, also of one storey and of one damped by 90 %; where the last term happened
    # to be small; and the last mode of sixty storeys has no mass that could lose any
    draw = structure_with_devices if "devices" in seed else structure
    assert judged_history(Random(seed), draw) in OUTCOMES  # noqa: S311 -- no secret


@needs_compiled_kernels
@shares
@pytest.mark.parametrize("part", range(4))
def test_histories(part, long):
    hunt(f"histories {part}", judged_history, 3, 1000 if long else None)


@needs_compiled_kernels
@hunted("devices", 30, 1000)
def test_devices(random):
    return judged_history(random, structure_with_devices)


@needs_compiled_kernels
@hunted("spherical ends", 30, 1000)
def test_spherical_ends(random):
    return judged_history(random, spherical_structure)


@needs_compiled_kernels
@hunted("compliant ends", 6, 1000)
def test_ends_that_give_way(random):
    return judged_history(random, structure_on_a_bed)


@needs_compiled_kernels
@hunted("pairs", 4, 1000)
def test_pairs(random):
    return judged_history(random, structure_of_a_pair, pairs=True)


@needs_compiled_kernels
def test_friction_that_hardly_slides_takes_few_steps():
    """Errors of a third of the velocity at which it stops had 2.1 million of 60,000 taken."""
    draw = Random("271305-pairs on every end-194")  # noqa: S311 -- no secret
    system = smooth_structure_of_a_pair(draw)
    motion, chosen = shaking(draw, system, pairs=True)
    steps = time_history(system, motion, chosen, with_fixed_base=False).history["steps"]
    assert 0 < steps < 2e5


@needs_compiled_kernels
def test_large_plastic_drifts_take_few_steps():
    """Rounding of what they take from the base shear had 394,000 of 21,000 steps taken."""
    draw = Random("271702-floors of their own-13")  # noqa: S311 -- no secret
    system = with_floors_of_its_own(
        draw, draw.choice([structure, structure, structure_on_a_bed])
    )
    motion, chosen = shaking(draw, system, pairs=False)
    cut = ground(motion.horizontal.acceleration[:14], motion.horizontal.dt)
    short = replace(chosen, free_vibration=0.0)
    ended = time_history(system, MotionComponents(cut), short, with_fixed_base=False)
    assert (ended.ductility or 0.0) > 1e3
    assert 0 < ended.history["steps"] < 5e4


@needs_compiled_kernels
def test_a_pass_that_ends_a_yield_happens_once():
    """It began anew, below its range by rounding, and lost 4e-5 of the energy without an entry."""
    draw = Random("271801-pairs under floors of their own-134")  # noqa: S311 -- no secret
    kind = draw.choice([structure_of_a_pair, smooth_structure_of_a_pair])
    system = with_floors_of_its_own(draw, kind)
    motion, chosen = shaking(draw, system, pairs=True)
    x, up, y = (
        ground(each.acceleration[81:112], each.dt)
        for each in (motion.horizontal, motion.vertical, motion.y)
        if each is not None
    )
    short = replace(chosen, free_vibration=0.0)
    ended = time_history(
        system, MotionComponents(x, up, y=y), short, with_fixed_base=False
    )
    assert (ended.passes or 0) > 0
    assert residual(ended) <= RESIDUAL


@needs_compiled_kernels
@hunted("pairs on every end", 6, 1000)
def test_pairs_on_every_end(random):
    return judged_history(random, smooth_structure_of_a_pair, pairs=True)


@needs_compiled_kernels
@hunted("floors of their own", 8, 1000)
def test_floors_of_their_own(random):
    draw = random.choice([structure, structure, structure_on_a_bed])
    return judged_history(random, lambda of: with_floors_of_its_own(of, draw))


@needs_compiled_kernels
@hunted("pairs under floors of their own", 8, 1000)
def test_pairs_under_floors_of_their_own(random):
    draw = random.choice([structure_of_a_pair, smooth_structure_of_a_pair])
    return judged_history(random, lambda of: with_floors_of_its_own(of, draw), pairs=True)
