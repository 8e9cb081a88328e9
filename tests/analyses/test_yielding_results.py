"""What a history says of storeys that yield: samples, largest demands, energy, tables, limits."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conformance import conforms
from paper_structures import (
    building,
    known,
    needs_compiled_kernels,
    needs_recorded_motions,
    podium,
    waves,
    yielding,
)

import rpscli
from rpscli.analyses.demand import demand
from rpscli.analyses.result_quantities import STOREYS_YIELDING, YIELDING
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.model.impact import ImpactLaw
from rpscli.records.ground_motion import MotionComponents
from rpscli.report.bundles import history_columns, storey_columns
from rpscli.report.timehistory import timehistory_document, timehistory_tables
from rpscli.sweep.names import label
from rpscli.sweep.table import points_csv

pytestmark = [
    needs_compiled_kernels, pytest.mark.evidence("storeys that yield", "exact")
]  # fmt: skip

HEIGHTS = np.array([4.0, 3.0, 3.0])
ABOVE = replace(
    yielding(building(3), 1.2 * podium(3).static_base_shear), storey_heights=HEIGHTS
)
STRUCTURE = podium(3, superstructure=ABOVE, law=ImpactLaw())
RECORD, OTHER = waves(6.0, 0.002, 6.0, seed=12), waves(6.0, 0.002, 3.0, seed=3)
SETTINGS = TimeHistorySettings(free_vibration=6.0)
K, F = ABOVE.stiffnesses, known(ABOVE.strengths)


@pytest.fixture(scope="module")
def result():
    return time_history(STRUCTURE, RECORD, SETTINGS)


@pytest.fixture(scope="module")
def pair():
    across = replace(building(3, 0.5), strengths=1.3 * F, hardening=0.1)
    both = replace(STRUCTURE, superstructure_y=across)
    return time_history(both, MotionComponents(RECORD.scaled(0.6), y=OTHER), SETTINGS)


def of_samples(quantity, expected, found, within):
    conforms(
        "storeys that yield", quantity, expected, found, within,
        "identity", "extremes and sums of the samples",
    )  # fmt: skip


def test_largest_demands_are_those_of_the_samples(result):
    """Which are dense: within steps there is little more."""
    trace, plastic = result.trace, known(result.trace.plastic_drifts)
    largest = np.abs(trace.drifts).max(axis=0)
    mu = largest * K / F
    of_samples("ductilities", mu, result.ductilities, 1e-3 * mu)
    assert result.max_drifts == pytest.approx(largest, rel=1e-3)
    assert trace.storey_shears == pytest.approx(K * (trace.drifts - plastic), abs=1e-6)
    assert result.storey_shears == pytest.approx(
        np.abs(trace.storey_shears).max(axis=0), rel=1e-3
    )
    swing, last = np.ptp(plastic, axis=0), np.abs(plastic[-1])
    of_samples("plastic drifts [m]", swing, result.plastic_drifts, 1e-9 * swing)
    of_samples("residual drifts [m]", last, result.residual_drifts, 1e-9 * last)
    path = np.abs(np.diff(plastic, axis=0)).sum(axis=0)
    of_samples("energies yielded [J]", F * path, result.energies_yielded, 1e-2 * F * path)
    begins = [float(trace.time[np.flatnonzero(each)[0]]) for each in plastic.T]
    assert np.all(np.abs(result.first_yields - begins) <= RECORD.dt)
    assert result.ductility == result.ductilities.max() > 1.5
    assert result.residual_drift_ratio == np.max(result.residual_drifts / HEIGHTS)
    assert result.energy_yielded == result.energies_yielded.sum()
    assert result.energy.yielded == pytest.approx(known(result.energy_yielded), rel=1e-9)
    assert abs(result.energy.residual) < 1e-6 * result.energy.input
    lines = np.abs(trace.storey_shears - 0.05 * K * trace.drifts)
    assert np.all(
        lines <= 0.95 * F * (1.0 + 1e-9)
    )  # none is beyond the lines on which it yields


def test_largest_demands_need_no_samples(result):
    alone = demand(STRUCTURE, RECORD, SETTINGS)
    for quantity in (*YIELDING, *STOREYS_YIELDING):
        one, other = (np.asarray(getattr(of, quantity.name)) for of in (alone, result))
        assert np.array_equal(one, other), quantity.name


def test_of_both_components_results_are_resultants_or_the_larger(pair):
    x, y = pair.trace, known(pair.trace.y)
    slips = np.stack([known(x.plastic_drifts), known(y.plastic_drifts)])
    across = known(pair.structure.superstructure_y)
    yields = np.stack([F / K, known(across.strengths) / across.stiffnesses])
    drifts = np.abs(np.stack([x.drifts, y.drifts])).max(axis=1)
    assert pair.ductilities == pytest.approx((drifts / yields).max(axis=0), rel=1e-2)
    assert pair.plastic_drifts == pytest.approx(
        np.ptp(slips, axis=1).max(axis=0), rel=1e-9
    )
    assert pair.residual_drifts == pytest.approx(np.hypot(*slips[:, -1]), rel=1e-9)
    assert pair.max_drifts == pytest.approx(np.hypot(*drifts), rel=1e-2)
    assert np.all(pair.max_drifts >= np.hypot(x.drifts, y.drifts).max(axis=0))
    assert y.storey_shears == pytest.approx(
        across.stiffnesses * (y.drifts - slips[1]), abs=1e-6
    )


def test_files_and_tables_have_them(result, pair):
    document = timehistory_document(result)
    for quantity in (*YIELDING, *STOREYS_YIELDING):
        assert quantity.name in document
    assert document["energy"]["yielded"] == result.energy.yielded
    names = {column.name for column in storey_columns(result)}
    assert {quantity.column for quantity in STOREYS_YIELDING} <= names
    history = {column.name: column.values for column in history_columns(result)}
    plastic = known(result.trace.plastic_drifts)
    assert [*history["storey_2_plastic_drift"]] == plastic[:, 1].tolist()
    assert "storey_2_plastic_drift_y" in {column.name for column in history_columns(pair)}
    assert "energy_yielded" in history
    parts = [*timehistory_tables(result, (), "a title")]
    told = " ".join(part for part in parts if isinstance(part, str))
    assert (
        "storey 3, not the first, has the largest ductility: strengths follow the shears"
        in told
    )
    assert "elastic, fixed base" in repr(
        [part for part in parts if not isinstance(part, str)]
    )


def test_an_elastic_building_has_none_of_it():
    elastic = time_history(podium(3), RECORD, SETTINGS)
    names = {quantity.name for quantity in (*YIELDING, *STOREYS_YIELDING)}
    document = timehistory_document(elastic)
    assert not names & document.keys()
    assert "yielded" not in document["energy"]
    assert all(getattr(elastic, quantity.name) is None for quantity in YIELDING)
    assert elastic.trace.plastic_drifts is None
    heads = [
        column.name for column in (*history_columns(elastic), *storey_columns(elastic))
    ]
    assert not [head for head in heads if "plastic" in head or "yield" in head]


def test_hardening_drives_back_what_has_not_come_to_rest():
    """As long as the back force exceeds the strength; a record that ends in the first swing."""
    soft = replace(building(1), strengths=np.array([1e5]), hardening=0.5)
    pushed = replace(podium(1, superstructure=soft), bearing=podium(1, 0.8).bearing)
    record = replace(RECORD, acceleration=np.linspace(0.0, 5.0, 200))
    brief = time_history(pushed, record, TimeHistorySettings(free_vibration=0.0))
    assert brief.driven_back.tolist() == [True]
    assert any("hardening drives storey 1 back" in text for text in brief.warnings)
    rested = time_history(pushed, record, TimeHistorySettings())
    assert not rested.driven_back.any()


def test_studies_vary_strengths_and_judge_the_ductility():
    case = Path(__file__).parents[2] / "cases" / "yielding_storeys.yaml"
    asked = {
        "rps": 1, "base": str(case), "records": ["pulse:sine?amplitude=0.5g&period=0.6"],
        "vary": [{"superstructure.yield.ratio": [1.1, 30.0]}], "limits": {"ductility": 1.5},
    }  # fmt: skip
    points = rpscli.load_study(asked).run()
    weak, strong = points["ductility"]
    assert weak > 1.5
    assert strong < 1.0
    assert points["residual_drift_ratio"][1] == 0.0
    assert [verdict.exceeded for verdict in points.judgements] == [True, False]
    assert label("superstructure.yield.ratio", 1.1) == "F₁/V_st = 1.1"
    assert "on the fixed base every building is elastic" in " ".join(points.notes)
    heads = next(points_csv(points.results.table)).partition("\n")[0]
    assert "residual_drift_ratio [-]" in heads
    without = {
        "base": str(case.with_name("six_storey.yaml")),
        "limits": {"rotation_ratio": 1},
    }
    elastic = rpscli.load_study(
        asked | without | {"vary": [{"superstructure.storeys": [3]}]}
    )
    assert "ductility" not in next(points_csv(elastic.run().results.table))


@pytest.mark.long
@needs_recorded_motions
@pytest.mark.parametrize(
    ("storeys", "rotation", "shear", "ductility"),
    [(3, (0.92, 0.54, 1.05), (0.59, 0.57, 0.70), (1.8, 3.0, 4.6)),
     (6, (0.72, 0.52, 0.91), (0.77, 0.72, 0.85), (1.1, 1.5, 2.0, 3.3, 4.8, 5.8))],
)  # fmt: skip
def test_sizes_of_the_theory(storeys, rotation, shear, ductility, fema_record):
    """Under the far-field components, of histories that stand with and without strengths."""
    elastic = podium(storeys, law=ImpactLaw())
    above = yielding(building(storeys), 1.3 * elastic.static_base_shear, 0.05)
    records = [fema_record(f"farfield/{i}/{c}") for i in range(1, 23) for c in "ab"]
    found = zip(
        demand(elastic, records), demand(replace(elastic, superstructure=above), records),
        strict=True,
    )  # fmt: skip
    stood = [(e, y) for e, y in found if e.uplifts and not (e.overturned or y.overturned)]
    for name, wanted in (("max_rotation", rotation), ("max_base_shear", shear)):
        ratios = [getattr(y, name) / getattr(e, name) for e, y in stood]
        assert np.percentile(ratios, [50, 16, 84]) == pytest.approx(wanted, abs=0.011)
    medians = np.median([y.ductilities for _, y in stood], axis=0)
    assert medians == pytest.approx(ductility, abs=0.1)
    assert all(y.ductilities.argmax() > 0 for _, y in stood)
