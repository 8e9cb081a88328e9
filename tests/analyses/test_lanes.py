"""Many histories side by side give the bits of each one alone, in any order and company."""

from dataclasses import replace

import numpy as np
import pytest
from paper_structures import (
    COMPILED,
    FLAT,
    building,
    ground,
    needs_compiled_kernels,
    podium,
    waves,
)

from rpscli.analyses.demand import DemandRequest, demand, demands
from rpscli.analyses.kernels.history import sampled_history
from rpscli.analyses.largest_demands import Demand, Demands
from rpscli.analyses.result_quantities import HISTORY, IMPACTS, STOREY_SHEARS
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.errors import CaseError, UsageError
from rpscli.model.impact import ImpactLaw
from rpscli.model.superstructure import ModalDamping, RayleighDamping
from rpscli.physics.state import LANES, STATES, UPLIFT
from rpscli.records.ground_motion import MotionComponents

ALONE = 10**9
"""Worth lanes only for more histories than there ever are: all run one after the other."""

SIDE_BY_SIDE = 1

RECORDS = [waves(2.5, 0.02, 4.0, seed=41), waves(1.7, 0.01, 4.0, seed=42)]
"""Of different lengths and time steps."""

UPWARDS = [waves(2.5, 0.02, 2.0, seed=43), waves(0.9, 0.01, 2.0, seed=44)]
MOTIONS = [
    *map(MotionComponents, RECORDS),
    *(MotionComponents(one, up) for one, up in zip(RECORDS, UPWARDS, strict=True)),
]

LAWS = [ImpactLaw("rigid"), ImpactLaw("flexible"), ImpactLaw("value", 0.85)]

SETTINGS = [
    TimeHistorySettings(free_vibration=0.5),
    TimeHistorySettings(free_vibration=0.3, accuracy=2.0),
    TimeHistorySettings(free_vibration=1.0, recontact_tolerance=1e-4),
    TimeHistorySettings(),
    TimeHistorySettings(free_vibration=0.5, initial_rotation=-0.03),
    TimeHistorySettings(free_vibration=0.5, max_events=5),
]


def structures(storeys, modal):
    """Six that differ in shape, size, law and damping."""
    rng = np.random.default_rng(10 * storeys + modal)
    found = []
    for ratio in (0.0, 0.02, 0.05, 0.05, 0.1, 0.3):
        damping = ModalDamping(ratio) if modal else RayleighDamping(ratio)
        period = float(rng.uniform(0.05, 0.2)) * storeys
        found.append(
            podium(
                storeys,
                float(rng.uniform(0.08, 0.2)),
                float(rng.choice([FLAT, 0.3, 0.5, 1.5])),
                R=float(rng.uniform(0.7, 2.0)),
                law=LAWS[int(rng.integers(3))],
                superstructure=building(storeys, period, damping) if storeys else None,
            )
        )
    return found


SCALES = (0.1, 0.7, 1.0, 1.9, 4.0)
POWERS_OF_TWO = (0.25, 0.5, 1.0, 2.0, 4.0)


def ensemble(groups, each, scales=SCALES):
    """Random histories: some at rest, some overturning, some that fail."""
    rng = np.random.default_rng(7)
    requests = []
    for storeys, modal in groups:
        choices = structures(storeys, modal)
        for i in range(each):
            structure = choices[int(rng.integers(len(choices)))]
            motion, settings = MOTIONS[int(rng.integers(4))], SETTINGS[i % len(SETTINGS)]
            requests.append(
                DemandRequest(structure, motion, settings, float(rng.choice(scales)))
            )
    # and one whose motion is soon no longer finite, which must not spread
    requests.append(replace(requests[0], scale=2.0**800))
    return [requests[i] for i in rng.permutation(len(requests))]


def bits(found):
    """Everything that a study keeps, and the accelerations: equal only if every bit is."""
    arrays = (found.storey_shears.tobytes(), found.floor_accelerations.tobytes())
    alone = Demands.of_one(found.structure, found.history)
    columns = alone.columns((*HISTORY, *IMPACTS, STOREY_SHEARS))
    results = [column.tobytes() for column in columns.values()]
    return [found.outcome, found.failure, *results, *arrays]


def all_bits(requests, worth_lanes):
    with np.errstate(all="ignore"):
        found = demands(requests, worth_lanes=worth_lanes)
        return [bits(demand) for demand in found]


def companies(requests):
    """Batches of many sizes, in orders of their own, that leave lanes empty or not."""
    rng = np.random.default_rng(3)
    everyone = np.arange(len(requests))
    yield everyone[::-1].tolist()
    if not COMPILED:
        return
    yield everyone.tolist()
    for size in (1, 2, LANES - 1, LANES, LANES + 1, 3 * LANES + 5):
        yield rng.permutation(everyone)[:size].tolist()
    yield [*everyone[:20].tolist(), *everyone[:20].tolist()]  # twice the same


def check(requests):
    alone = [all_bits([request], ALONE)[0] for request in requests]
    for company in companies(requests):
        together = all_bits([requests[i] for i in company], SIDE_BY_SIDE)
        assert together == [alone[i] for i in company]


@needs_compiled_kernels
def test_lanes_give_the_bits_of_single_histories():
    check(ensemble([(3, False)], 60))


EVERY_HEIGHT = [(0, False), *((n, modal) for n in (1, 2, 3) for modal in (False, True))]


@pytest.mark.long
@pytest.mark.parametrize(("groups", "each"), [(EVERY_HEIGHT, 40), ([(33, False)], 20)])
def test_lanes_give_them_of_any_height(groups, each):
    check(ensemble(groups, each))


MIXED = ensemble(
    [(0, False), (1, False), (2, True), (3, False), (3, True)], 12, POWERS_OF_TWO
)


@needs_compiled_kernels
def test_a_history_alone_is_that_of_the_scaled_record():
    """One kernel for all heights and dampings: mixed batches, and `sampled_history`.

    The kernel rounds a scaled acceleration and what is added to it once, the scaled record twice:
    only a power of two makes no difference.
    """
    together = all_bits(MIXED, ALONE)
    assert together[::-1] == all_bits(MIXED[::-1], ALONE)
    for request, found in zip(MIXED, together, strict=True):
        of = {
            name: each.scaled(request.scale)
            for name, each in request.motion.named.items()
        }
        motion = MotionComponents(of["horizontal"], of.get("vertical"), y=of.get("y"))
        with np.errstate(all="ignore"):
            run = sampled_history(request.structure, motion, request.settings)
        assert bits(Demand(request.structure, run.history)) == found


@needs_compiled_kernels
def test_the_histories_compared_are_of_all_kinds():
    with np.errstate(all="ignore"):
        found = demands(MIXED, worth_lanes=ALONE)
    outcomes = {d.outcome for d in found}
    assert {"at_rest", "survived", "failed"} < outcomes
    assert any(outcome.startswith("overturned") for outcome in outcomes)
    assert sum(d.impacts > 5 for d in found) > len(found) / 4
    assert any(d.failure is not None and "no longer finite" in d.failure for d in found)
    assert any(d.failure is not None and "max_events" in d.failure for d in found)


def test_histories_without_end_are_refused_before_they_begin():
    record = ground([0.0, 1.0, 0.0], 1e18)
    with pytest.raises(
        CaseError, match=r"must not be more than 1e\+10: the record is too long"
    ):
        demands(
            [DemandRequest(podium(0), MotionComponents(record), TimeHistorySettings())]
        )


def test_a_sequence_of_motions_gives_a_sequence_of_demands():
    structure = podium(2, 0.15, 0.5)
    found = demand(structure, RECORDS)
    alone = [demand(structure, record) for record in RECORDS]
    assert [bits(each) for each in found] == [bits(each) for each in alone]
    assert demand(structure, []) == []
    with pytest.raises(UsageError, match="goes with a single record"):
        demand(structure, RECORDS, vertical=UPWARDS[0])
    with pytest.raises(UsageError, match="given as str"):
        demand(structure, ["a.at2"])


@needs_compiled_kernels
@pytest.mark.parametrize("pairs", [False, True])
def test_who_waits_for_a_lane_keeps_its_bits(pairs):
    """More histories than all groups have places, of which many move at once and some never do."""
    system = replace(structures(2, modal=False)[2], impact_law=ImpactLaw("flexible"))
    scales = np.linspace(0.05, 1.2, (STATES + 1) * LANES)
    motion = MotionComponents(
        RECORDS[0], y=waves(2.5, 0.02, 3.0, seed=45) if pairs else None
    )
    settings = TimeHistorySettings(free_vibration=0.2)
    requests = [DemandRequest(system, motion, settings, float(scale)) for scale in scales]
    together = [
        each.history.tobytes() for each in demands(requests, worth_lanes=SIDE_BY_SIDE)
    ]
    some = slice(None, None, 13)
    alone = [
        each.history.tobytes() for each in demands(requests[some], worth_lanes=ALONE)
    ]
    assert alone == together[some]
    moved = [
        each.history["events"][UPLIFT] > 0 for each in demands(requests, worth_lanes=1)
    ]
    assert 2 * LANES < sum(moved) < len(moved)
